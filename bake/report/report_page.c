/* report_page.c: index.html, from top to bottom. Nothing in it is loaded from anywhere: a content policy says so as well. */
#include "report/report_parts.h"
#include "common/fail.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static void print_head(const cost_results *r, FILE *to) {
    (void)fputs(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'; "
        "script-src 'unsafe-inline'\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light "
        "dark\">\n"
        "<title>What accuracy costs: ",
        to);
    text_html(to, r->scene);
    (void)fprintf(to, "</title>\n<style>\n%s</style>\n</head>\n<body>\n<header>\n<h1>What accuracy costs: ", report_css);
    text_html(to, r->scene);
    (void)fputs("</h1>\n", to);
}

static void fact(FILE *to, const char *name, const char *value) {
    (void)fprintf(to, "<div><dt>%s</dt><dd>", name);
    text_html(to, value);
    (void)fputs("</dd></div>\n", to);
}

static void print_facts(const cost_results *r, FILE *to) {
    const reference *f = &r->reference;
    char text[160];
    (void)fputs("<dl class=\"facts\">\n", to);
    (void)snprintf(text, sizeof text, "%u \xC3\x97 %u pixels", r->width, r->height);
    fact(to, "Frames timed", text);
    (void)snprintf(text, sizeof text, "frame %u on %u \xC3\x97 %u pixels, spacing %u", r->frame, f->width, f->height, r->every);
    fact(to, "Compared", text);
    (void)snprintf(text, sizeof text, "%u, interleaved, %u frames each", r->count, r->settings[0].timed);
    fact(to, "Settings", text);
    fact(to, "Device", r->device);
    fact(to, "CPU", r->cpu);
    (void)snprintf(text, sizeof text, "%u paths a pixel, own NMSE %.2g, %.0f s, %.0f million rays", f->samples, f->error,
                   f->seconds, (double)f->rays * 1e-6);
    fact(to, "Reference", text);
    (void)fputs("</dl>\n</header>\n<main>\n<section id=\"summary\"><h2>In short</h2>\n", to);
    report_summary(r, to);
    (void)fputs("</section>\n", to);
}

/* Indices of the points in each of the plot's data sets, in the order of report_plots.c (the front by time), so that report.js
 * can name them. */
static bool print_series(const cost_results *r, report_measure by, FILE *to) {
    uint32_t *pareto = malloc(r->count * sizeof pareto[0]);
    if (!pareto)
        return false;
    const uint32_t count = report_pareto_front(r, by, pareto);
    (void)fputs("<figure class=\"chart\" data-front=\"", to);
    for (uint32_t k = 0; k < count; k++)
        if (pareto[k] != 0)
            (void)fprintf(to, "%" PRIu32 " ", pareto[k]);
    (void)fputs("\" data-others=\"", to);
    for (uint32_t i = 1; i < r->count; i++)
        if (report_set(&r->settings[i], by) == REPORT_OTHERS)
            (void)fprintf(to, "%" PRIu32 " ", i);
    (void)fputs("\" data-elsewhere=\"", to);
    for (uint32_t i = 1; i < r->count; i++)
        if (report_set(&r->settings[i], by) == REPORT_ELSEWHERE)
            (void)fprintf(to, "%" PRIu32 " ", i);
    (void)fputs("\">\n", to);
    free(pareto);
    return true;
}

static vit_status print_error_plots(const cost_results *r, FILE *to, vit_text *why) {
    (void)fputs("<section id=\"error-time\"><h2>Error against time</h2>\n<p>Down and left is better. No setting is at once "
                "faster and nearer "
                "to the reference than one on the <b class=\"front\">Pareto front</b>; the line is the best error that each "
                "time buys. Both "
                "axes are logarithmic. <span class=\"js\">Point at a dot for its name; click for its details.</span></p>\n"
                "<ul class=\"legend\"><li><i class=\"dot\" style=\"background:var(--c5)\"></i>on the front</li>"
                "<li><i class=\"dot\" style=\"background:var(--c6)\"></i>default</li>"
                "<li><i class=\"dot\" style=\"background:var(--c4)\"></i>others</li>"
                "<li><i class=\"dot\" style=\"border:2px solid var(--c4)\"></i>another output size or lanes: no part of the "
                "front</li></ul>\n",
                to);
    vit_status status = VIT_OK;
    for (report_measure by = REPORT_NMSE; by <= REPORT_RELMSE && status == VIT_OK; by++) {
        if (!print_series(r, by, to)) {
            return bake_fail(why, VIT_FAILED, "report: out of memory");
        }
        status = report_plot_error(r, by, to, why);
        (void)fprintf(to, "<figcaption>%s</figcaption></figure>\n",
                      by == REPORT_NMSE ? "NMSE: errors in bright places weigh most."
                                        : "relMSE: dark places weigh as much as bright ones.");
    }
    (void)fputs("</section>\n<section id=\"pareto\"><h2>The fronts</h2>\n"
                "<p>Fastest first, with the time that the path tracer takes to the same error.</p>\n",
                to);
    report_table_pareto(r, to);
    (void)fputs("</section>\n", to);
    return status;
}

static void print_prices(const cost_results *r, FILE *to) {
    (void)fputs(
        "<section id=\"knobs\"><h2>What each knob buys</h2>\n<p>Settings that differ from the default in one knob: the change "
        "of the "
        "frame\xE2\x80\x99s median time and of the error, and their quotient (in thousandths of error a millisecond). Where a "
        "setting is nearer and slower, the "
        "quotient is the error "
        "bought with a millisecond: the more the better, best first. Where it is further off and faster, it is the error paid "
        "for a "
        "millisecond saved: the less the better, best first. Times in brackets differ by less than twice their standard error: "
        "no difference that can be told from noise.</p>\n<div class=\"pair\">\n",
        to);
    report_table_prices(r, REPORT_NMSE, to);
    report_table_prices(r, REPORT_RELMSE, to);
    (void)fputs("</div></section>\n", to);
}

static vit_status print_time(const cost_results *r, FILE *to, vit_text *why) {
    (void)fputs("<section id=\"stages\"><h2>Where the time goes</h2>\n<p>Medians of each pass. The tick and the number are the "
                "whole frame\xE2\x80\x99s median, "
                "timed without looking at passes. Blue names are on a front; the dashed line is the default.</p>\n<figure "
                "class=\"chart\">\n",
                to);
    const vit_status status = report_plot_stack(r, to, why);
    (void)fputs("</figure>\n</section>\n", to);
    return status;
}

static vit_status print_tracer(const cost_results *r, FILE *to, vit_text *why) {
    vit_status status = VIT_OK;
    (void)fputs("<section id=\"tracer\"><h2>Beside a path tracer</h2>\n", to);
    if (!(r->path_tracer_ms > 0)) {
        (void)fputs("<p>The path tracer was not timed.</p></section>\n", to);
        return VIT_OK;
    }
    (void)fputs("<p>The dashed line is the reference\xE2\x80\x99s path tracer (Embree), timed in the same run between the "
                "settings: its error "
                "falls as one over its time. Circles are paths a pixel.</p>\n<div class=\"pair\">\n",
                to);
    for (report_measure by = REPORT_NMSE; by <= REPORT_RELMSE && status == VIT_OK; by++) {
        (void)fputs("<figure class=\"chart small\">\n", to);
        status = report_plot_tracer(r, by, to, why);
        (void)fputs("</figure>\n", to);
    }
    (void)fputs("</div></section>\n", to);
    return status;
}

static void print_details(const cost_results *r, FILE *to) {
    (void)fputs("<section id=\"all\"><h2>All settings</h2>\n<p>Errors of the total light against the reference with the same "
                "bounce limit, then of "
                "the indirect light alone. <span class=\"js\">Click a heading to sort, a row for its passes.</span> # is the "
                "order of the sweep. "
                "Work is the weighted sum of exact counts, equal on every device.</p>\n",
                to);
    report_table_settings(r, to);
    (void)fputs(
        "</section>\n<section id=\"passes\"><h2>Passes and exact work of one setting</h2>\n<noscript><p>This table "
        "needs JavaScript; "
        "report.json has the same numbers.</p></noscript>\n"
        "<div class=\"controls js\"><label>Setting <select id=\"setting\"></select></label></div>\n<p id=\"values\" "
        "class=\"values\"></p>\n"
        "<div class=\"wide\"><table id=\"pass-table\" class=\"js\"></table></div>\n</section>\n"
        "<section id=\"bounces\"><h2>What the error is made of</h2>\n<p>Of the default. What the bounce limit leaves out stays "
        "however many photons there are; direct light is computed, not estimated: its error should be next to nothing.</p>\n",
        to);
    report_table_errors(r, to);
    (void)fputs("</section>\n", to);
}

static const char METHOD[] =
    "<section id=\"method\"><h2>How it was measured</h2>\n"
    "<p>Errors are of linear radiance times exposure (RGBA32F frames) against a path-traced reference of the same camera, "
    "lights, materials "
    "and bounces, over all compared pixels and channels; I is the frame, R the reference, \xE2\x9F\xA8 \xE2\x9F\xA9 a "
    "mean.</p>\n<dl class=\"terms\">\n"
    "<dt>NMSE</dt><dd>\xE2\x9F\xA8(I \xE2\x88\x92 R)\xC2\xB2\xE2\x9F\xA9 / \xE2\x9F\xA8R\xE2\x9F\xA9\xC2\xB2</dd>\n"
    "<dt>relMSE</dt><dd>\xE2\x9F\xA8(I \xE2\x88\x92 R)\xC2\xB2 / (R\xC2\xB2 + 0.01 "
    "\xE2\x9F\xA8R\xE2\x9F\xA9\xC2\xB2)\xE2\x9F\xA9: dark places count</dd>\n"
    "<dt>Bias</dt><dd>\xE2\x9F\xA8I \xE2\x88\x92 R\xE2\x9F\xA9 / \xE2\x9F\xA8R\xE2\x9F\xA9</dd>\n"
    "<dt>PSNR, SSIM</dt><dd>after the sRGB curve, clamped; SSIM of luma in windows of 8 \xC3\x97 8</dd>\n"
    "<dt>Largest local</dt><dd>the largest |mean error| of a block of 16 \xC3\x97 16 compared pixels / "
    "\xE2\x9F\xA8R\xE2\x9F\xA9</dd>\n"
    "<dt>Signed error map</dt><dd>(I \xE2\x88\x92 R) / \xE2\x88\x9A(R\xC2\xB2 + 0.01 \xE2\x9F\xA8R\xE2\x9F\xA9\xC2\xB2) of "
    "luminance, linear from \xE2\x88\x92"
    "1 to 1, clamped</dd>\n"
    "<dt>Squared error map</dt><dd>(I \xE2\x88\x92 R)\xC2\xB2 / \xE2\x9F\xA8R\xE2\x9F\xA9\xC2\xB2, logarithmic from 0.0001 to "
    "10; its mean is NMSE</dd>\n"
    "<dt>Path tracer at equal error</dt><dd>time and error of one path a pixel of the whole frame, with error \xE2\x88\x9D 1 / "
    "paths; below one path a "
    "pixel, where none exists, the figure is only that rule\xE2\x80\x99s</dd>\n"
    "<dt>ms, p95, MAD</dt><dd>median, 95th percentile and median absolute deviation of the frames\xE2\x80\x99 "
    "times</dd>\n</dl>\n</section>\n";

vit_status report_page(const cost_results *r, FILE *to, vit_text *why) {
    print_head(r, to);
    print_facts(r, to);
    vit_status status = print_error_plots(r, to, why);
    if (status != VIT_OK)
        return status;
    print_prices(r, to);
    status = print_time(r, to, why);
    if (status == VIT_OK)
        status = print_tracer(r, to, why);
    if (status != VIT_OK)
        return status;
    (void)fputs("<section id=\"look\"><h2>Look at it</h2>\n", to);
    if (!report_look(r, to)) {
        return bake_fail(why, VIT_FAILED, "report: out of memory for a picture");
    }
    (void)fputs("</section>\n", to);
    print_details(r, to);
    (void)fputs(METHOD, to);
    (void)fputs("</main>\n<footer>Vitrine " VIT_VERSION ", vitrine-cost. The same numbers: report.csv, report.json.</footer>\n"
                "<script type=\"application/json\" id=\"data\">",
                to);
    report_json(r, to);
    (void)fprintf(to, "</script>\n<script>\n%s</script>\n</body>\n</html>\n", report_js);
    return VIT_OK;
}
