/* report_look.c: pictures beside the reference, wiped over each other and as maps of error. */
#include "report/report_parts.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static bool print_scale(const report_map *map, const char *id, const char *label, const char *const ticks[],
                        uint32_t tick_count, FILE *to) {
    uint8_t index[REPORT_COLOURS];
    for (uint32_t i = 0; i < REPORT_COLOURS; i++)
        index[i] = (uint8_t)i;
    (void)fprintf(to, "<div class=\"scale\" id=\"%s\"><span>%s</span><img alt=\"colour scale\" src=\"", id, label);
    const bool done = report_png_map(to, index, REPORT_COLOURS, 1, map);
    (void)fputs("\"><div class=\"ticks\">", to);
    for (uint32_t i = 0; i < tick_count; i++)
        (void)fprintf(to, "<span>%s</span>", ticks[i]);
    (void)fputs("</div></div>\n", to);
    return done;
}

static bool print_scales(FILE *to) {
    static const char *const one[] = {"\xE2\x88\x92"
                                      "1",
                                      "\xE2\x88\x92"
                                      "0.5",
                                      "0", "0.5", "1"},
                             *const decades[] = {"0.0001", "0.001", "0.01", "0.1", "1", "10"};
    const report_map with_sign = report_map_signed(), squared = report_map_squared();
    return print_scale(&with_sign, "scale-signed", "Signed error: blue too dark, red too bright", one, 5, to) &&
           print_scale(&squared, "scale-squared", "Squared error: the pixel\xE2\x80\x99s part of NMSE", decades, 6, to);
}

typedef bool uri_fn(const cost_setting *s, const cost_results *r, const report_pictures *p, FILE *to);

static bool print_image(const cost_results *r, const report_pictures *p, uint32_t setting, const char *kind, const char *alt,
                        uri_fn *uri, FILE *to) {
    (void)fprintf(to, "<figure><img id=\"%s-%" PRIu32 "\" width=\"%u\" height=\"%u\" alt=\"%s: ", kind, setting, p->width,
                  p->height, alt);
    text_html(to, r->settings[setting].name);
    (void)fputs("\" src=\"", to);
    const bool done = uri(&r->settings[setting], r, p, to);
    (void)fprintf(to, "\"><figcaption>%s</figcaption></figure>\n", alt);
    return done;
}

static const char *on_which_fronts(const cost_setting *s) {
    if (s->pareto && s->pareto_relmse)
        return ", on both fronts";
    return s->pareto ? ", on the front of NMSE" : s->pareto_relmse ? ", on the front of relMSE" : "";
}

static bool print_setting(const cost_results *r, const report_pictures *p, uint32_t i, FILE *to) {
    const cost_setting *s = &r->settings[i];
    (void)fprintf(to, "<section class=\"shown\" data-setting=\"%" PRIu32 "\"><h3>", i);
    text_html(to, s->name);
    (void)fputs("</h3><p>", to);
    text_ms(to, s->ms);
    (void)fprintf(to, " ms, NMSE %.3g, relMSE %.3g, bias ", s->total.nmse, s->total.relmse);
    text_format(to, "%+.1f", 100 * s->total.bias);
    (void)fprintf(to, " %%%s</p><div class=\"row\">\n", on_which_fronts(s));
    const bool done = print_image(r, p, i, "frame", "Frame", report_frame_uri, to) &&
                      print_image(r, p, i, "signed", "Signed error", report_signed_uri, to) &&
                      print_image(r, p, i, "squared", "Squared error", report_squared_uri, to);
    (void)fputs("</div></section>\n", to);
    return done;
}

/* The reference beside the frame and the error; report.js fills in the chosen setting's pictures. */
static bool print_compare(const cost_results *r, const report_pictures *p, FILE *to) {
    (void)fprintf(
        to,
        "<div class=\"controls js\"><label>Setting <select id=\"picture\"></select></label>"
        "<label>Error <select id=\"error-kind\"><option value=\"signed\">signed</option><option "
        "value=\"squared\">squared</option>"
        "</select></label><label>Reference <input id=\"wipe\" type=\"range\" min=\"0\" max=\"100\" value=\"50\" "
        "aria-label=\"How much of the reference is seen\"> frame</label></div>\n"
        "<div class=\"compare\"><figure class=\"js\"><div class=\"wipe\" id=\"wiped\" style=\"aspect-ratio:%u/%u\">"
        "<img id=\"wipe-frame\" alt=\"Frame of the chosen setting\"><img id=\"wipe-reference\" alt=\"Reference\"></div>"
        "<figcaption>Left of the line the reference, right of it the frame: drag</figcaption></figure>\n"
        "<figure class=\"js\"><img id=\"chosen-error\" width=\"%u\" height=\"%u\" alt=\"Error of the chosen setting\">"
        "<figcaption id=\"chosen-caption\"></figcaption></figure>\n"
        "<figure><img id=\"reference\" width=\"%u\" height=\"%u\" alt=\"Reference: path traced\" src=\"",
        p->width, p->height, p->width, p->height, p->width, p->height);
    const bool done = report_reference_uri(r, p, to);
    (void)fputs("\"><figcaption>Reference</figcaption></figure>\n"
                "<figure class=\"js\"><img id=\"chosen-frame\" alt=\"Frame of the chosen "
                "setting\"><figcaption>Frame</figcaption></figure></div>\n",
                to);
    return done;
}

bool report_look(const cost_results *r, FILE *to) {
    report_pictures p;
    if (!report_pictures_choose(r, &p))
        return false;
    if (p.count == 0) {
        (void)fputs("<p>The results hold no images.</p>\n", to);
        report_pictures_free(&p);
        return true;
    }
    (void)fprintf(to,
                  "<p>Pictures of %u of the %u settings: the default, the settings on the fronts and the worst by NMSE. "
                  "Exposure is applied, "
                  "then the sRGB curve, clamped. ",
                  p.count, r->count);
    if (r->every > 1)
        (void)fprintf(to, "The reference was computed at every %u%s pixel both ways. ", r->every,
                      r->every == 2   ? "nd"
                      : r->every == 3 ? "rd"
                                      : "th");
    if (p.block > 1)
        (void)fprintf(to, "A pixel below is the mean of %u \xC3\x97 %u of the compared pixels. ", p.block, p.block);
    (void)fputs("</p>\n", to);
    bool done = print_compare(r, &p, to) && print_scales(to);
    (void)fputs("<details open><summary>All pictures</summary>\n", to);
    for (uint32_t k = 0; k < p.count && done; k++)
        done = print_setting(r, &p, p.settings[k], to);
    (void)fputs("</details>\n", to);
    report_pictures_free(&p);
    return done;
}
