/* report_stack.c: a bar a setting, in the sweep's order, stacked from the milliseconds of its passes. */
#include "report/report_parts.h"
#include "common/fail.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 1000, LEFT = 270, RIGHT = 945, ROW = 19, HEAD = 8, FOOT = 44, NAME_MOST = 40 };

/* Passes of all settings by name, as a frame runs them; the largest have colours of their own. */
typedef struct stack_pass {
    const char *name;
    double sum; /* ms, over the settings */
    int colour; /* STACK and on; STACK + STACK_COLOURS: one of the others */
} stack_pass;

typedef struct stack {
    stack_pass passes[VIT_MAX_PASSES * 2];
    uint32_t count, others;
    double longest; /* ms: of bars and frames */
} stack;

static uint32_t find_pass(const stack *s, const char *name) {
    uint32_t i = 0;
    while (i < s->count && strcmp(s->passes[i].name, name) != 0)
        i++;
    return i;
}

static double positive(double ms) {
    return ms > 0 && isfinite(ms) ? ms : 0;
}

static void add_setting(stack *s, const cost_setting *t) {
    double bar = 0;
    for (uint32_t p = 0; p < t->pass_count; p++) {
        const uint32_t at = find_pass(s, t->pass_names[p]), most = sizeof s->passes / sizeof s->passes[0];
        if (at == most)
            continue;
        if (at == s->count)
            s->passes[s->count++] = (stack_pass){.name = t->pass_names[p], .colour = STACK + STACK_COLOURS};
        s->passes[at].sum += positive(t->pass_ms[p]);
        bar += positive(t->pass_ms[p]);
    }
    s->longest = fmax(s->longest, fmax(bar, positive(t->ms)));
}

/* Colours for those of the largest sums, in the order of the passes. */
static void give_colours(stack *s) {
    for (int k = 0; k < STACK_COLOURS; k++) {
        stack_pass *largest = NULL;
        for (uint32_t i = 0; i < s->count; i++)
            if (s->passes[i].colour == STACK + STACK_COLOURS && s->passes[i].sum > 0 &&
                (!largest || s->passes[i].sum > largest->sum))
                largest = &s->passes[i];
        if (largest)
            largest->colour = STACK;
    }
    int next = STACK;
    for (uint32_t i = 0; i < s->count; i++)
        if (s->passes[i].colour == STACK)
            s->passes[i].colour = next++;
        else
            s->others++;
}

static void print_legend(const stack *s, FILE *to) {
    (void)fputs("<ul class=\"legend\">", to);
    for (uint32_t i = 0; i < s->count; i++)
        if (s->passes[i].colour < STACK + STACK_COLOURS) {
            (void)fprintf(to, "<li><i style=\"background:var(--c%d)\"></i>", s->passes[i].colour);
            text_html(to, s->passes[i].name);
            (void)fputs("</li>", to);
        }
    if (s->others)
        (void)fprintf(to, "<li><i style=\"background:var(--c%d)\"></i>other passes (%u)</li>", STACK + STACK_COLOURS,
                      s->others);
    (void)fputs("<li><i class=\"tick\"></i>whole frame</li></ul>\n", to);
}

static double ms_of_colour(const stack *s, const cost_setting *t, int colour) {
    double ms = 0;
    for (uint32_t p = 0; p < t->pass_count; p++) {
        const uint32_t at = find_pass(s, t->pass_names[p]);
        if (at < s->count && s->passes[at].colour == colour)
            ms += positive(t->pass_ms[p]);
    }
    return ms;
}

/* Rows of: middle, bottom's and top's milliseconds, for one colour. */
static void print_colour(const stack *s, const cost_results *r, int colour, FILE *to) {
    (void)fprintf(to, "$c%d << EOD\n", colour);
    for (uint32_t i = 0; i < r->count; i++) {
        double from = 0;
        for (int below = STACK; below < colour; below++)
            from += ms_of_colour(s, &r->settings[i], below);
        (void)fprintf(to, "%u %.9g %.9g\n", i, from, from + ms_of_colour(s, &r->settings[i], colour));
    }
    (void)fputs("EOD\n", to);
}

static void print_rows(const cost_results *r, FILE *to) {
    for (uint32_t i = 0; i < r->count; i++) {
        const cost_setting *s = &r->settings[i];
        const int colour = i == 0 ? DEFAULT : s->pareto || s->pareto_relmse ? FRONT : SOFT;
        (void)fputs("set label ", to);
        char name[COST_NAME + 12];
        (void)snprintf(name, sizeof name, "%u  %s", i, s->name);
        text_gnuplot(to, name, NAME_MOST);
        (void)fprintf(to, " at 0,%u right offset -0.8,0 tc rgb '#0101%02x'\nset label '", i, colour);
        text_ms(to, s->ms);
        (void)fprintf(to, "' at screen %.6f, first %u right tc rgb '#0101%02x'\n", 1 - 8.0 / WIDTH, i, colour);
    }
    (void)fputs("$frames << EOD\n", to);
    for (uint32_t i = 0; i < r->count; i++)
        (void)fprintf(to, "%.9g %u\n", positive(r->settings[i].ms), i);
    (void)fputs("EOD\n", to);
}

static void print_script(const stack *s, const cost_results *r, uint32_t height, FILE *to) {
    (void)fprintf(
        to, "set lmargin at screen %.6f\nset rmargin at screen %.6f\nset tmargin at screen %.6f\nset bmargin at screen %.6f\n",
        (double)LEFT / WIDTH, (double)RIGHT / WIDTH, 1 - (double)HEAD / height, (double)FOOT / height);
    (void)fprintf(to, "unset key\nset border 1 lc rgb '#0101%02x'\nset yrange [%u.5:-0.5]\nunset ytics\n", SOFT, r->count - 1);
    (void)fprintf(
        to, "set xrange [0:%.9g]\nset xtics nomirror scale 0.6 tc rgb '#0101%02x'\nset grid x lt 1 lw 0.6 lc rgb '#0101%02x'\n",
        s->longest * 1.02, SOFT, GRID);
    (void)fprintf(to, "set xlabel 'milliseconds' tc rgb '#0101%02x'\nset style fill solid 1 noborder\n", SOFT);
    for (int c = STACK; c <= STACK + STACK_COLOURS; c++)
        print_colour(s, r, c, to);
    print_rows(r, to);
    (void)fprintf(to, "set arrow from %.9g,-0.5 to %.9g,%u.5 nohead lw 1 dt 3 lc rgb '#0101%02x'\nplot ",
                  positive(r->settings[0].ms), positive(r->settings[0].ms), r->count - 1, DEFAULT);
    for (int c = STACK; c <= STACK + STACK_COLOURS; c++)
        (void)fprintf(to, "$c%d using 2:1:2:3:($1-0.36):($1+0.36) with boxxyerror lc rgb '#0101%02x', ", c, c);
    (void)fprintf(to, "$frames using 1:($2-0.42):(0):(0.84) with vectors nohead lw 1.6 lc rgb '#0101%02x'\n", INK);
}

vit_status report_plot_stack(const cost_results *r, FILE *to, vit_text *why) {
    stack s = {.count = 0};
    for (uint32_t i = 0; i < r->count; i++)
        add_setting(&s, &r->settings[i]);
    if (!(s.longest > 0)) {
        (void)fputs("<p>No passes were timed.</p>\n", to);
        return VIT_OK;
    }
    give_colours(&s);
    print_legend(&s, to);
    const report_drawing d = {"plot-stack", "Milliseconds a pass, stacked, for each setting", WIDTH,
                              HEAD + FOOT + ROW * r->count, false};
    char *script = NULL;
    size_t size = 0;
    FILE *text = open_memstream(&script, &size);
    if (text)
        print_script(&s, r, d.height, text);
    vit_status status;
    if (text && fclose(text) == 0)
        status = report_gnuplot(&d, script, to, why);
    else
        status = bake_fail(why, VIT_FAILED, "report: out of memory for a plot");
    free(script);
    return status;
}
