/* report_summary.c: the report in a few sentences, made from the results alone. */
#include "report/report_parts.h"

#include <math.h>
#include <stdlib.h>

static void name(const cost_results *r, uint32_t i, FILE *to) {
    (void)fputs("<b>", to);
    text_html(to, r->settings[i].name);
    (void)fputs("</b>", to);
}

static const char *which_fronts(const cost_setting *s) {
    if (s->pareto && s->pareto_relmse)
        return "both Pareto fronts";
    if (s->pareto)
        return "the Pareto front of NMSE, not on that of relMSE";
    if (s->pareto_relmse)
        return "the Pareto front of relMSE, not on that of NMSE";
    return "neither Pareto front: others are no slower and no further off, and better in one";
}

static void say_default(const cost_results *r, FILE *to) {
    const cost_setting *d = &r->settings[0];
    (void)fputs("<li>The <b>default</b> takes ", to);
    text_ms(to, d->ms);
    (void)fputs(" ms a frame (95 % within ", to);
    text_ms(to, d->ms_p95);
    (void)fprintf(to, " ms) at NMSE %.3g, relMSE %.3g and a bias of ", d->total.nmse, d->total.relmse);
    text_format(to, "%+.1f", 100 * d->total.bias);
    (void)fprintf(to, " %%. It is on %s.</li>\n", which_fronts(d));
}

/* Frames of an idle machine deviate by 1 or 2 %. */
static void say_noise(const cost_results *r, FILE *to) {
    const cost_setting *d = &r->settings[0];
    if (d->ms_mad > 0.05 * d->ms)
        (void)fprintf(to,
                      "<li><b class=\"warn\">The machine was busy</b>: half of the default\xE2\x80\x99s frames are more than "
                      "%.0f %% off their median. "
                      "Read times and fronts with care.</li>\n",
                      100 * d->ms_mad / d->ms);
}

static void say_tracer(const cost_results *r, FILE *to) {
    const cost_setting *d = &r->settings[0];
    const double nmse = report_equal_ms(r, d, REPORT_NMSE), relmse = report_equal_ms(r, d, REPORT_RELMSE);
    if (!isfinite(nmse) && !isfinite(relmse))
        return;
    (void)fputs("<li>A path tracer on the same processor, in the same run, needs ", to);
    if (isfinite(nmse)) {
        text_ms(to, nmse);
        (void)fprintf(to, " ms to the default\xE2\x80\x99s NMSE: <b>%.*f times as long</b> (%.3g paths a pixel)%s",
                      nmse / d->ms < 9.95 ? 1 : 0, nmse / d->ms, report_equal_paths(r, d, REPORT_NMSE),
                      isfinite(relmse) ? "; and " : "");
    }
    if (isfinite(relmse)) {
        text_ms(to, relmse);
        (void)fprintf(to, " ms to its relMSE: <b>%.*f times as long</b> (%.3g paths a pixel)", relmse / d->ms < 9.95 ? 1 : 0,
                      relmse / d->ms, report_equal_paths(r, d, REPORT_RELMSE));
    }
    (void)fputs(".</li>\n", to);
}

static void say_front(const cost_results *r, uint32_t *pareto, FILE *to) {
    const uint32_t count = report_pareto_front(r, REPORT_NMSE, pareto);
    if (count == 0)
        return;
    const cost_setting *fast = &r->settings[pareto[0]], *near = &r->settings[pareto[count - 1]];
    (void)fprintf(to, "<li>%u of %u settings are on the front of NMSE, from ", count, r->count);
    text_ms(to, fast->ms);
    (void)fprintf(to, " ms at %.3g (", fast->total.nmse);
    name(r, pareto[0], to);
    (void)fputs(") to ", to);
    text_ms(to, near->ms);
    (void)fprintf(to, " ms at %.3g (", near->total.nmse);
    name(r, pareto[count - 1], to);
    (void)fputs(").</li>\n", to);
}

static void change(const report_price *p, FILE *to) {
    text_format(to, "NMSE %+.2g", p->error);
    text_format(to, " for %+.2f ms.</li>\n", p->ms);
}

static void say_price(const cost_results *r, report_price *prices, FILE *to) {
    const uint32_t count = report_prices(r, REPORT_NMSE, prices);
    for (uint32_t i = 0; i < count; i++)
        if (prices[i].kind == REPORT_GAIN && prices[i].ms < 0.05 * r->settings[0].ms) {
            (void)fputs("<li>One knob makes the default nearer without measurable cost in time: ", to);
            name(r, prices[i].setting, to);
            (void)fputs(": ", to);
            change(&prices[i], to);
            break;
        }
    for (uint32_t i = 0; i < count; i++)
        if (prices[i].kind == REPORT_BUYS) {
            (void)fputs("<li>Of the knobs that trade time for accuracy, ", to);
            name(r, prices[i].setting, to);
            (void)fputs(" buys most a millisecond: ", to);
            change(&prices[i], to);
            break;
        }
}

static void say_reference(const cost_results *r, FILE *to) {
    double least = INFINITY;
    for (uint32_t i = 0; i < r->count; i++)
        if (r->settings[i].total.nmse > 0)
            least = fmin(least, r->settings[i].total.nmse);
    const bool good = r->reference.error * 10 <= least;
    (void)fprintf(to, "<li>The reference\xE2\x80\x99s own error is %.2g (NMSE of its mean, %u paths a pixel)",
                  r->reference.error, r->reference.samples);
    if (isfinite(least) && r->reference.error > 0)
        (void)fprintf(to, ", %.3g times below the smallest error reported: %s", least / r->reference.error,
                      good ? "good"
                           : "<b class=\"warn\">too near, it should be 10 times: read the smallest errors with care</b>");
    (void)fprintf(to, ".</li>\n<li>The bounce limit leaves out light worth NMSE %.2g, bias ", r->truncation.nmse);
    text_format(to, "%+.2f", 100 * r->truncation.bias);
    (void)fputs(" %, against a reference without one.</li>\n", to);
}

void report_summary(const cost_results *r, FILE *to) {
    uint32_t *pareto = malloc(r->count * sizeof pareto[0]);
    report_price *prices = malloc(r->count * sizeof prices[0]);
    (void)fputs("<ul class=\"summary\">\n", to);
    if (pareto && prices) {
        say_default(r, to);
        say_noise(r, to);
        say_tracer(r, to);
        say_front(r, pareto, to);
        say_price(r, prices, to);
        say_reference(r, to);
    }
    (void)fputs("</ul>\n", to);
    free(pareto);
    free(prices);
}
