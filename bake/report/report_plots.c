/* report_plots.c: error against time, alone and beside a path tracer. */
#include "report/report_parts.h"
#include "common/fail.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Names of up to NAME_MOST characters stand at up to NAMES points of a front; more or longer ones are numbers with a key. */
enum { NAME_MOST = 40, NAMES = 9, MARKS = 12 };

/* The area between the axes, in pixels of the drawing. */
typedef struct plot {
    const cost_results *r;
    report_measure by;
    report_drawing drawing;
    double left, right, top, bottom;
    report_axis x, y; /* milliseconds, error */
    uint32_t *pareto, front_count;
} plot;

static double px(const plot *p, double ms) {
    return p->left + report_axis_at(p->x, ms) * (p->right - p->left);
}

static double py(const plot *p, double error) {
    return p->bottom - report_axis_at(p->y, error) * (p->bottom - p->top);
}

static double ms_of(const plot *p, uint32_t i) {
    return p->r->settings[i].ms;
}

static double error_of(const plot *p, uint32_t i) {
    return report_error(&p->r->settings[i], p->by);
}

static bool drawn(const plot *p, uint32_t i) {
    return ms_of(p, i) > 0 && isfinite(ms_of(p, i)) && error_of(p, i) > 0 && isfinite(error_of(p, i));
}

static void print_frame(const plot *p, FILE *to) {
    const double w = p->drawing.width, h = p->drawing.height;
    char title[80];
    (void)fprintf(
        to, "set lmargin at screen %.6f\nset rmargin at screen %.6f\nset tmargin at screen %.6f\nset bmargin at screen %.6f\n",
        p->left / w, p->right / w, 1 - p->top / h, 1 - p->bottom / h);
    (void)fprintf(to, "unset key\nset border 3 lc rgb '#0101%02x'\nset tics nomirror scale 0.6,0.3\n", SOFT);
    (void)fprintf(to, "set grid x y lt 1 lw 0.6 lc rgb '#0101%02x'\n", GRID);
    report_axis_print(to, "x", p->x, "milliseconds a frame (median)");
    (void)snprintf(title, sizeof title, "%s of the total light", report_measure_name(p->by));
    report_axis_print(to, "y", p->y, title);
}

/* Data of the plots: others, the front's stair, the front's points, the default, those that differ elsewhere than in the
 * quality block. Each begins with a point that is not drawn: gnuplot wants one. */
static void print_data(const plot *p, FILE *to) {
    (void)fputs("$others << EOD\nNaN NaN\n", to);
    for (uint32_t i = 1; i < p->r->count; i++)
        if (drawn(p, i) && report_set(&p->r->settings[i], p->by) == REPORT_OTHERS)
            (void)fprintf(to, "%.9g %.9g\n", ms_of(p, i), error_of(p, i));
    (void)fputs("EOD\n$stair << EOD\nNaN NaN\n", to);
    for (uint32_t k = 0; k < p->front_count; k++) {
        const uint32_t i = p->pareto[k];
        if (k == 0)
            (void)fprintf(to, "%.9g %.9g\n", ms_of(p, i), p->y.high);
        (void)fprintf(to, "%.9g %.9g\n", ms_of(p, i), error_of(p, i));
        if (k + 1 == p->front_count)
            (void)fprintf(to, "%.9g %.9g\n", p->x.high, error_of(p, i));
    }
    (void)fputs("EOD\n$front << EOD\nNaN NaN\n", to);
    for (uint32_t k = 0; k < p->front_count; k++)
        if (p->pareto[k] != 0)
            (void)fprintf(to, "%.9g %.9g\n", ms_of(p, p->pareto[k]), error_of(p, p->pareto[k]));
    (void)fputs("EOD\n$default << EOD\nNaN NaN\n", to);
    if (drawn(p, 0))
        (void)fprintf(to, "%.9g %.9g\n", ms_of(p, 0), error_of(p, 0));
    (void)fputs("EOD\n$elsewhere << EOD\nNaN NaN\n", to);
    for (uint32_t i = 1; i < p->r->count; i++)
        if (drawn(p, i) && report_set(&p->r->settings[i], p->by) == REPORT_ELSEWHERE)
            (void)fprintf(to, "%.9g %.9g\n", ms_of(p, i), error_of(p, i));
    (void)fputs("EOD\n", to);
}

/* In gnuplot's order 1 to 5: report.js finds the points by it. */
static void print_plot(FILE *to) {
    (void)fprintf(to,
                  "plot $others with points pt 7 ps 0.75 lc rgb '#0101%02x', $stair with steps lw 1.6 lc rgb '#0101%02x', "
                  "$front with points pt 7 ps 1.0 lc rgb '#0101%02x', $default with points pt 13 ps 1.5 lc rgb '#0101%02x', "
                  "$elsewhere with points pt 6 ps 0.75 lw 2 lc rgb '#0101%02x'",
                  DOT, FRONT, FRONT, DEFAULT, DOT);
}

/* Everything drawn: points as small boxes, the front's stair as segments. Returns how many; `out` has room for 3 a setting
 * and 2. */
static uint32_t obstacles(const plot *p, report_span *out) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < p->r->count; i++)
        if (drawn(p, i)) {
            const double x = px(p, ms_of(p, i)), y = py(p, error_of(p, i));
            out[count++] = (report_span){x - 5, y - 5, x + 5, y + 5};
        }
    double above = p->top;
    for (uint32_t k = 0; k < p->front_count; k++) {
        const double x = px(p, ms_of(p, p->pareto[k])), y = py(p, error_of(p, p->pareto[k]));
        const double until = k + 1 < p->front_count ? px(p, ms_of(p, p->pareto[k + 1])) : p->right;
        out[count++] = (report_span){x - 1, above, x + 1, y};
        out[count++] = (report_span){x, y - 1, until, y + 1};
        above = y;
    }
    return count;
}

static void print_label(const plot *p, const report_label *l, const char *name, int colour, FILE *to) {
    const double w = p->drawing.width, h = p->drawing.height;
    if (l->led) { /* to the box's nearest point */
        const double x = fmin(fmax(l->x, l->left), l->left + l->width), y = fmin(fmax(l->y, l->top), l->top + l->height);
        (void)fprintf(to, "set arrow from screen %.6f,%.6f to screen %.6f,%.6f nohead lw 0.7 lc rgb '#0101%02x'\n", x / w,
                      1 - y / h, l->x / w, 1 - l->y / h, SOFT);
    }
    (void)fputs("set label ", to);
    text_gnuplot(to, name, NAME_MOST);
    (void)fprintf(to, " at screen %.6f,%.6f left tc rgb '#0101%02x'\n", l->left / w, 1 - (l->top + l->height / 2) / h, colour);
}

static bool numbered(const plot *p) {
    bool longer = p->front_count > NAMES;
    for (uint32_t k = 0; k < p->front_count; k++)
        longer = longer || text_length(p->r->settings[p->pareto[k]].name) > NAME_MOST;
    return longer;
}

/* Ways of making indirect light have their names wherever they lie. */
static bool is_method(const plot *p, uint32_t i) {
    return strcmp(p->r->settings[i].knob, "indirect") == 0 && drawn(p, i);
}

/* What stands at a setting's point. */
static void name_point(const plot *p, uint32_t i, char out[COST_NAME]) {
    if (i > 0 && numbered(p) && !is_method(p, i))
        (void)snprintf(out, COST_NAME, "%u", i);
    else
        (void)snprintf(out, COST_NAME, "%s", p->r->settings[i].name);
    const char *maker = i == 0 ? strstr(p->r->settings[0].values, "indirect = \"") : NULL;
    if (maker) {
        maker += strlen("indirect = \"");
        (void)snprintf(out, COST_NAME, "default: %.*s", (int)strcspn(maker, "\""), maker);
    }
}

static void print_key(const plot *p, FILE *to) {
    if (!numbered(p))
        return;
    (void)fputs("<ul class=\"key\">", to);
    for (uint32_t k = 0; k < p->front_count; k++)
        if (p->pareto[k] != 0 && !is_method(p, p->pareto[k])) {
            (void)fprintf(to, "<li data-setting=\"%u\"><b class=\"front\">%u</b> ", p->pareto[k], p->pareto[k]);
            text_html(to, p->r->settings[p->pareto[k]].name);
            (void)fputs("</li>", to);
        }
    (void)fputs("</ul>\n", to);
}

static bool on_front(const plot *p, uint32_t i) {
    for (uint32_t k = 0; k < p->front_count; k++)
        if (p->pareto[k] == i)
            return true;
    return false;
}

/* Names the default, the front's settings and the ways of making indirect light. False: out of memory. */
static bool print_labels(const plot *p, FILE *to) {
    report_span *avoid = malloc((3 * (size_t)p->r->count + 2) * sizeof avoid[0]);
    report_label *labels = calloc((size_t)p->r->count + 1, sizeof labels[0]);
    uint32_t *named = malloc(((size_t)p->r->count + 1) * sizeof named[0]), count = 0;
    if (avoid && labels && named) {
        if (drawn(p, 0))
            named[count++] = 0;
        for (uint32_t k = 0; k < p->front_count; k++)
            if (p->pareto[k] != 0)
                named[count++] = p->pareto[k];
        for (uint32_t i = 1; i < p->r->count; i++)
            if (is_method(p, i) && !on_front(p, i))
                named[count++] = i;
        for (uint32_t k = 0; k < count; k++) {
            char name[COST_NAME];
            name_point(p, named[k], name);
            const uint32_t length = text_length(name);
            labels[k] = (report_label){.x = px(p, ms_of(p, named[k])), .y = py(p, error_of(p, named[k])), .height = 14};
            labels[k].width = 6.6 * (length < NAME_MOST ? length : NAME_MOST) + 2; /* 12 pixel sans-serif */
        }
        const report_span inside = {p->left + 2, 2, p->right, p->bottom - 2};
        report_place_labels(labels, count, avoid, obstacles(p, avoid), &inside);
        for (uint32_t k = 0; k < count; k++) {
            char name[COST_NAME];
            name_point(p, named[k], name);
            print_label(p, &labels[k], name, named[k] == 0 ? DEFAULT : INK, to);
        }
    }
    const bool done = avoid && labels && named;
    free(avoid);
    free(labels);
    free(named);
    return done;
}

/* The front's drawable settings; axes about all settings and `more` pairs of (ms, error). False: nothing to draw or no memory.
 */
static bool prepare(plot *p, const double (*more)[2], uint32_t more_count, double above) {
    const uint32_t count = p->r->count;
    double *ms = malloc(((size_t)count + more_count) * sizeof ms[0]),
           *error = malloc(((size_t)count + more_count) * sizeof error[0]);
    p->pareto = malloc(count * sizeof p->pareto[0]);
    bool done = ms && error && p->pareto;
    if (done) {
        uint32_t used = 0;
        for (uint32_t i = 0; i < count; i++)
            if (drawn(p, i)) {
                ms[used] = ms_of(p, i);
                error[used++] = error_of(p, i);
            }
        for (uint32_t i = 0; i < more_count; i++) {
            ms[used] = more[i][0];
            error[used++] = more[i][1];
        }
        const uint32_t all = report_pareto_front(p->r, p->by, p->pareto);
        for (uint32_t k = 0; k < all; k++)
            if (drawn(p, p->pareto[k]))
                p->pareto[p->front_count++] = p->pareto[k];
        done = report_axis_of(ms, used, 0.12, 0.06, &p->x) && report_axis_of(error, used, 0.12, above, &p->y);
    }
    free(ms);
    free(error);
    return done;
}

static vit_status draw(const plot *p, char *script, FILE *to, vit_text *why) {
    return report_gnuplot(&p->drawing, script, to, why);
}

static vit_status out_of_memory(vit_text *why) {
    return bake_fail(why, VIT_FAILED, "report: out of memory for a plot");
}

static void say_nothing_drawn(const plot *p, FILE *to) {
    (void)fprintf(to, "<p>No setting has both a time and a %s above 0: there is nothing to plot.</p>\n",
                  report_measure_name(p->by));
}

vit_status report_plot_error(const cost_results *r, report_measure by, FILE *to, vit_text *why) {
    plot p = {.r = r, .by = by, .left = 72, .right = 984, .top = 14, .bottom = 466};
    p.drawing =
        by == REPORT_NMSE
            ? (report_drawing){"plot-nmse", "NMSE against milliseconds a frame, with the Pareto front", 1000, 520, false}
            : (report_drawing){"plot-relmse", "relMSE against milliseconds a frame, with the Pareto front", 1000, 520, false};
    char *script = NULL;
    size_t size = 0;
    vit_status status = VIT_OK;
    if (!prepare(&p, NULL, 0, 0.06)) {
        say_nothing_drawn(&p, to);
    } else {
        FILE *text = open_memstream(&script, &size);
        bool done = text != NULL;
        if (done) {
            print_frame(&p, text);
            print_data(&p, text);
            done = print_labels(&p, text);
            print_plot(text);
            (void)fputc('\n', text);
            done = fclose(text) == 0 && done;
        }
        status = done ? draw(&p, script, to, why) : out_of_memory(why);
        print_key(&p, to);
    }
    free(script);
    free(p.pareto);
    return status;
}

/* Its error falls as 1 / time: a straight line, marked at 1, 4, 16, ... paths per pixel; an arrow from the default to it. */
static void print_tracer(const plot *p, double one, FILE *to) {
    const double ms = p->r->path_tracer_ms, from = fmax(p->x.low, ms * one / p->y.high),
                 until = fmin(p->x.high, ms * one / p->y.low);
    (void)fprintf(to, "$tracer << EOD\n%.9g %.9g\n%.9g %.9g\nEOD\n$marks << EOD\nNaN NaN NaN\n", from, ms * one / from, until,
                  ms * one / until);
    double paths = 1;
    for (int i = 0; i < MARKS; i++, paths *= 4)
        if (paths * ms <= p->x.high && paths * ms >= p->x.low && one / paths >= p->y.low && one / paths <= p->y.high)
            (void)fprintf(to, "%.9g %.9g %g\n", paths * ms, one / paths, paths);
    (void)fputs("EOD\n", to);
    const double equal = report_equal_ms(p->r, &p->r->settings[0], p->by);
    if (!drawn(p, 0) || !isfinite(equal))
        return;
    const double ratio = equal / ms_of(p, 0);
    (void)fprintf(to, "set arrow from %.9g,%.9g to %.9g,%.9g head filled size screen 0.016,18 lw 1.4 lc rgb '#0101%02x'\n",
                  ms_of(p, 0), error_of(p, 0), equal, error_of(p, 0), DEFAULT);
    (void)fprintf(to, "set label '%.*f times as long' at %.9g,%.9g center offset 0,0.7 tc rgb '#0101%02x'\n",
                  ratio < 9.95 ? 1 : 0, ratio, sqrt(equal * ms_of(p, 0)), error_of(p, 0), DEFAULT);
}

vit_status report_plot_tracer(const cost_results *r, report_measure by, FILE *to, vit_text *why) {
    plot p = {.r = r, .by = by, .left = 66, .right = 546, .top = 14, .bottom = 336};
    const char *const ids[] = {"plot-tracer-nmse", "plot-tracer-relmse"};
    p.drawing =
        (report_drawing){ids[by], "Error against time: the settings' points and the path tracer's line", 560, 390, false};
    const double one = by == REPORT_NMSE ? r->path_tracer_nmse : r->path_tracer_relmse;
    const double more[][2] = {{r->path_tracer_ms, one},
                              {report_equal_ms(r, &r->settings[0], by), report_error(&r->settings[0], by)}};
    if (!(r->path_tracer_ms > 0 && one > 0)) {
        (void)fprintf(to, "<p>The path tracer's %s was not measured.</p>\n", report_measure_name(by));
        return VIT_OK;
    }
    char *script = NULL;
    size_t size = 0;
    vit_status status = VIT_OK;
    if (!prepare(&p, more, 2, 0.12)) {
        say_nothing_drawn(&p, to);
    } else {
        FILE *text = open_memstream(&script, &size);
        if (text) {
            print_frame(&p, text);
            print_data(&p, text);
            print_tracer(&p, one, text);
            print_plot(text);
            (void)fprintf(
                text,
                ", $tracer with lines lw 1.6 dt 2 lc rgb '#0101%02x', $marks with points pt 6 ps 0.7 lc rgb '#0101%02x', "
                "$marks using 1:2:3 with labels left offset 0.6,0.6 tc rgb '#0101%02x'\n",
                TRACER, TRACER, TRACER);
        }
        status = text && fclose(text) == 0 ? draw(&p, script, to, why) : out_of_memory(why);
    }
    free(script);
    free(p.pareto);
    return status;
}
