/* report_tables.c: the report's tables. A cell's data-v is the number to sort by, with all its digits. */
#include "report/report_parts.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Headings, numbers to the right as their cells. */
typedef struct column {
    const char *title;
    bool number;
} column;

static void print_headings(FILE *to, const column *columns, size_t count) {
    (void)fputs("<thead><tr>", to);
    for (size_t i = 0; i < count; i++)
        (void)fprintf(to, "<th scope=\"col\"%s>%s</th>", columns[i].number ? " class=\"n\"" : "", columns[i].title);
    (void)fputs("</tr></thead>\n", to);
}
#define HEADINGS(to, columns) print_headings(to, columns, sizeof(columns) / sizeof(columns)[0])

static void begin_cell(FILE *to, double value) {
    (void)fputs("<td class=\"n\" data-v=\"", to);
    text_number(to, value, "");
    (void)fputs("\">", to);
}

/* `format` takes one double. */
static void cell(FILE *to, double value, const char *format) {
    begin_cell(to, value);
    text_format(to, format, value);
    (void)fputs("</td>", to);
}

static void cell_error(FILE *to, double error) {
    begin_cell(to, error);
    text_3digits(to, error);
    (void)fputs("</td>", to);
}

static void cell_ms(FILE *to, double ms) {
    begin_cell(to, ms);
    text_ms(to, ms);
    (void)fputs("</td>", to);
}

static void cell_name(FILE *to, const cost_setting *s, bool is_default) {
    (void)fprintf(to, "<th scope=\"row\"%s title=\"",
                  is_default                      ? " class=\"default\""
                  : s->pareto || s->pareto_relmse ? " class=\"front\""
                                                  : "");
    text_html(to, s->values);
    (void)fputs("\">", to);
    text_html(to, s->name);
    (void)fputs("</th>", to);
}

static const char *front_text(const cost_setting *s) {
    if (s->pareto && s->pareto_relmse)
        return "both";
    return s->pareto ? "NMSE" : s->pareto_relmse ? "relMSE" : "";
}

static void print_setting(const cost_results *r, uint32_t i, FILE *to) {
    const cost_setting *s = &r->settings[i];
    (void)fprintf(to, "<tr data-setting=\"%" PRIu32 "\"><td class=\"n\" data-v=\"%" PRIu32 "\">%" PRIu32 "</td>", i, i, i);
    cell_name(to, s, i == 0);
    (void)fputs("<td>", to);
    text_html(to, s->knob);
    (void)fprintf(to, "</td><td>%s</td>", front_text(s));
    cell_ms(to, s->ms);
    cell_ms(to, s->ms_p95);
    cell_ms(to, s->ms_mad);
    cell_error(to, s->total.nmse);
    cell_error(to, s->total.relmse);
    cell(to, 100 * s->total.bias, "%+.1f");
    cell(to, s->total.psnr, "%.1f");
    cell(to, s->total.ssim, "%.3f");
    cell_error(to, s->total.local);
    cell_error(to, s->indirect.nmse);
    cell_error(to, s->indirect.relmse);
    cell(to, 100 * s->indirect.bias, "%+.1f");
    cell(to, (double)s->device_bytes / 1048576, "%.1f");
    cell(to, (double)s->pack_bytes / 1048576, "%.2f");
    cell(to, s->bake_seconds, "%.1f");
    cell(to, (double)s->work * 1e-6, "%.1f");
    (void)fputs("</tr>\n", to);
}

void report_table_settings(const cost_results *r, FILE *to) {
    static const column columns[] = {{"#", true},
                                     {"Setting", false},
                                     {"Knob", false},
                                     {"Front", false},
                                     {"ms", true},
                                     {"p95 ms", true},
                                     {"MAD ms", true},
                                     {"NMSE", true},
                                     {"relMSE", true},
                                     {"Bias %", true},
                                     {"PSNR dB", true},
                                     {"SSIM", true},
                                     {"Largest local", true},
                                     {"Indirect NMSE", true},
                                     {"Indirect relMSE", true},
                                     {"Indirect bias %", true},
                                     {"Device MiB", true},
                                     {"Pack MiB", true},
                                     {"Bake s", true},
                                     {"Work, millions", true}};
    (void)fputs("<div class=\"wide full\"><table id=\"settings\" class=\"sortable\" data-sort=\"4\">", to);
    HEADINGS(to, columns);
    (void)fputs("<tbody>\n", to);
    for (uint32_t i = 0; i < r->count; i++)
        print_setting(r, i, to);
    (void)fputs("</tbody></table></div>\n", to);
}

static void cell_ratio(FILE *to, double ratio) {
    begin_cell(to, ratio);
    if (isfinite(ratio))
        (void)fprintf(to, "%.*f\xC3\x97", ratio < 9.95 ? 1 : 0, ratio);
    else
        (void)fputs("\xE2\x80\x93", to);
    (void)fputs("</td>", to);
}

/* Both fronts in one table, fastest first; the default is there in any case. */
void report_table_pareto(const cost_results *r, FILE *to) {
    static const column columns[] = {{"#", true},
                                     {"Setting", false},
                                     {"On the front of", false},
                                     {"ms", true},
                                     {"p95 ms", true},
                                     {"NMSE", true},
                                     {"relMSE", true},
                                     {"Bias %", true},
                                     {"Path tracer, ms to the same NMSE", true},
                                     {"Times as long", true},
                                     {"Path tracer, ms to the same relMSE", true},
                                     {"Times as long", true}};
    (void)fputs("<div class=\"wide\"><table id=\"front\" class=\"sortable\">", to);
    HEADINGS(to, columns);
    (void)fputs("<tbody>\n", to);
    double above = -INFINITY;
    uint32_t last = 0;
    for (uint32_t printed = 0; printed < r->count; printed++) { /* the next by (ms, index) */
        uint32_t next = r->count;
        for (uint32_t i = 0; i < r->count; i++) {
            const cost_setting *s = &r->settings[i];
            const bool after = s->ms > above || (s->ms == above && i > last);
            if ((i == 0 || s->pareto || s->pareto_relmse) && after && (next == r->count || s->ms < r->settings[next].ms))
                next = i;
        }
        if (next == r->count)
            break;
        const cost_setting *s = &r->settings[next];
        const double nmse_ms = report_equal_ms(r, s, REPORT_NMSE), relmse_ms = report_equal_ms(r, s, REPORT_RELMSE);
        (void)fprintf(to, "<tr data-setting=\"%" PRIu32 "\"><td class=\"n\" data-v=\"%" PRIu32 "\">%" PRIu32 "</td>", next,
                      next, next);
        cell_name(to, s, next == 0);
        (void)fprintf(to, "<td>%s</td>", front_text(s)[0] ? front_text(s) : "neither");
        cell_ms(to, s->ms);
        cell_ms(to, s->ms_p95);
        cell_error(to, s->total.nmse);
        cell_error(to, s->total.relmse);
        cell(to, 100 * s->total.bias, "%+.1f");
        cell_ms(to, nmse_ms);
        cell_ratio(to, nmse_ms / s->ms);
        cell_ms(to, relmse_ms);
        cell_ratio(to, relmse_ms / s->ms);
        (void)fputs("</tr>\n", to);
        above = s->ms;
        last = next;
    }
    (void)fputs("</tbody></table></div>\n", to);
}

static void print_price(const cost_results *r, const report_price *p, report_measure by, FILE *to) {
    const double base = report_error(&r->settings[0], by);
    (void)fprintf(to, "<tr data-setting=\"%" PRIu32 "\">", p->setting);
    cell_name(to, &r->settings[p->setting], false);
    (void)fputs("<td>", to);
    text_html(to, r->settings[p->setting].knob);
    (void)fputs("</td>", to);
    cell(to, p->ms, p->timed ? "%+.2f" : "(%+.2f)");
    cell(to, p->error, p->error == 0 ? "%.0f" : "%+.2g");
    cell(to, base > 0 ? 100 * p->error / base : (double)NAN, p->error == 0 ? "%.0f" : "%+.1f");
    cell_error(to, p->rate > 0 ? 1000 * p->rate : (double)NAN);
    (void)fputs("</tr>\n", to);
}

void report_table_prices(const cost_results *r, report_measure by, FILE *to) {
    static const char *const meanings[] = {
#define X(name, meaning) meaning,
        REPORT_KINDS(X)
#undef X
    };
    report_price *prices = malloc(r->count * sizeof prices[0]);
    const uint32_t count = prices ? report_prices(r, by, prices) : 0;
    const char *measure = report_measure_name(by);
    if (count == 0)
        (void)fputs("<p>No setting differs from the default in one knob.</p>\n", to);
    else {
        const column columns[] = {{"Setting", false},
                                  {"Knob", false},
                                  {"ms", true},
                                  {measure, true},
                                  {"%", true},
                                  {"10<sup>\xE2\x88\x92"
                                   "3</sup> a ms",
                                   true}};
        (void)fprintf(to, "<table class=\"prices\" id=\"prices-%s\"><caption>By %s</caption>",
                      by == REPORT_NMSE ? "nmse" : "relmse", measure);
        HEADINGS(to, columns);
    }
    for (uint32_t i = 0; i < count; i++) {
        if (i == 0 || prices[i].kind != prices[i - 1].kind)
            (void)fprintf(to, "%s<tbody><tr class=\"group\"><th colspan=\"6\" scope=\"rowgroup\">%s</th></tr>\n",
                          i ? "</tbody>" : "", meanings[prices[i].kind]);
        print_price(r, &prices[i], by, to);
    }
    if (count)
        (void)fputs("</tbody></table>\n", to);
    free(prices);
}

static void print_errors(const char *name, const cost_error *e, FILE *to) {
    (void)fprintf(to, "<tr><th scope=\"row\">%s</th>", name);
    cell_error(to, e->nmse);
    cell_error(to, e->relmse);
    cell(to, 100 * e->bias, "%+.2f");
    cell(to, e->psnr, "%.1f");
    cell(to, e->ssim, "%.4f");
    cell_error(to, e->local);
    (void)fputs("</tr>\n", to);
}

void report_table_errors(const cost_results *r, FILE *to) {
    const cost_setting *d = &r->settings[0];
    static const column columns[] = {{"", false},       {"NMSE", true}, {"relMSE", true},       {"Bias %", true},
                                     {"PSNR dB", true}, {"SSIM", true}, {"Largest local", true}};
    (void)fputs("<div class=\"wide\"><table id=\"truncation\">", to);
    HEADINGS(to, columns);
    (void)fputs("<tbody>\n", to);
    print_errors("What the bounce limit alone leaves out", &r->truncation, to);
    print_errors("Default, all light, against the reference with the same limit", &d->total, to);
    print_errors("Default, all light, against the reference without a limit", &d->unlimited, to);
    print_errors("Default, indirect light alone, same limit", &d->indirect, to);
    print_errors("Default, direct light alone: no estimate\xE2\x80\x99s fault", &r->direct, to);
    (void)fputs("</tbody></table></div>\n", to);
}
