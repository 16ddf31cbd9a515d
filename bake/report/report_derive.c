/* report_derive.c: fronts in order, the path tracer at equal error, what one knob buys. */
#include "report/report_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *report_measure_name(report_measure by) {
    return by == REPORT_NMSE ? "NMSE" : "relMSE";
}

double report_error(const cost_setting *s, report_measure by) {
    return by == REPORT_NMSE ? s->total.nmse : s->total.relmse;
}

bool report_on_pareto_front(const cost_setting *s, report_measure by) {
    return by == REPORT_NMSE ? s->pareto : s->pareto_relmse;
}

report_drawn report_set(const cost_setting *s, report_measure by) {
    return report_on_pareto_front(s, by) ? REPORT_FRONT : s->elsewhere ? REPORT_ELSEWHERE : REPORT_OTHERS;
}

uint32_t report_pareto_front(const cost_results *r, report_measure by, uint32_t *out) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        if (!report_on_pareto_front(&r->settings[i], by))
            continue;
        uint32_t at = count++;
        for (; at > 0 && r->settings[out[at - 1]].ms > r->settings[i].ms; at--)
            out[at] = out[at - 1];
        out[at] = i;
    }
    return count;
}

double report_equal_paths(const cost_results *r, const cost_setting *s, report_measure by) {
    const double one = by == REPORT_NMSE ? r->path_tracer_nmse : r->path_tracer_relmse, error = report_error(s, by);
    return one > 0 && error > 0 ? one / error : (double)NAN;
}

double report_equal_ms(const cost_results *r, const cost_setting *s, report_measure by) {
    return r->path_tracer_ms > 0 ? r->path_tracer_ms * report_equal_paths(r, s, by) : (double)NAN;
}

/* Standard error of a median: 1.253 (for normal noise) x 1.4826 MAD / sqrt(frames). */
static double median_error(const cost_setting *s) {
    return 1.858 * s->ms_mad / sqrt(s->timed > 0 ? s->timed : 1);
}

static report_price price_of(const cost_results *r, uint32_t i, report_measure by) {
    const cost_setting *s = &r->settings[i], *d = &r->settings[0];
    report_price p = {.setting = i, .ms = s->ms - d->ms, .error = report_error(s, by) - report_error(d, by)};
    p.timed = fabs(p.ms) > 2 * hypot(median_error(s), median_error(d));
    const bool slower = p.timed && p.ms > 0, faster = p.timed && p.ms < 0;
    p.kind = p.error < 0   ? (slower ? REPORT_BUYS : REPORT_GAIN)
             : p.error > 0 ? (faster ? REPORT_SAVES : REPORT_LOSES)
                           : REPORT_SAME;
    if (p.kind == REPORT_BUYS || p.kind == REPORT_SAVES)
        p.rate = fabs(p.error) / fabs(p.ms);
    return p;
}

/* By kind; then the most useful first; then as in the sweep. */
static int compare_prices(const void *a, const void *b) {
    const report_price *p = a, *q = b;
    if (p->kind != q->kind)
        return p->kind < q->kind ? -1 : 1;
    double x = 0, y = 0;
    switch (p->kind) {
    case REPORT_BUYS:
        x = -p->rate;
        y = -q->rate;
        break;
    case REPORT_SAVES:
        x = p->rate;
        y = q->rate;
        break;
    case REPORT_SAME:
        x = p->ms;
        y = q->ms;
        break;
    case REPORT_GAIN:
    case REPORT_LOSES:
        x = p->error;
        y = q->error;
        break;
    }
    if (x != y)
        return x < y ? -1 : 1;
    return p->setting < q->setting ? -1 : p->setting > q->setting;
}

uint32_t report_prices(const cost_results *r, report_measure by, report_price *out) {
    uint32_t count = 0;
    for (uint32_t i = 1; i < r->count; i++) {
        const cost_setting *s = &r->settings[i];
        if (strcmp(s->knob, "default") != 0 && strcmp(s->knob, "several") != 0 && isfinite(s->ms) &&
            isfinite(report_error(s, by)))
            out[count++] = price_of(r, i, by);
    }
    qsort(out, count, sizeof out[0], compare_prices);
    return count;
}
