/* The parts of the report, in the order in which the data flows. All print to a stream; report.c sees to memory and files. */
#ifndef VIT_COST_REPORT_PARTS_H
#define VIT_COST_REPORT_PARTS_H

#include "common/json.h"
#include "report/results.h"
#include <stdio.h>

/* ---- report_text.c: numbers and text in each language but JSON. Text that is no UTF-8 is mended with U+FFFD. ---- */
void text_csv(FILE *to, const char *text);                    /* with its quotes */
void text_html(FILE *to, const char *text);                   /* for elements and quoted attributes */
void text_gnuplot(FILE *to, const char *text, uint32_t most); /* with its quotes; cut to `most` characters */
uint32_t text_length(const char *text);                       /* characters, not bytes */
void text_format(FILE *to, const char *format, double value); /* for people: one double, a real minus, a dash if not finite */
void text_3digits(FILE *to, double value);                    /* for people: three digits, their zeros too */
void text_ms(FILE *to, double ms);                            /* 3 or 4 digits, for people */
void text_count(FILE *to, uint64_t count);                    /* exact, digits in groups of three */

/* ---- report_derive.c: what follows from the results ---- */
typedef enum report_measure { REPORT_NMSE, REPORT_RELMSE } report_measure;
const char *report_measure_name(report_measure by);
double report_error(const cost_setting *s, report_measure by); /* total light */
bool report_on_pareto_front(const cost_setting *s, report_measure by);
/* How a setting but the default is drawn. */
typedef enum report_drawn { REPORT_OTHERS, REPORT_FRONT, REPORT_ELSEWHERE } report_drawn;
report_drawn report_set(const cost_setting *s, report_measure by);
/* Indices of the front's settings, fastest first; `out` has room for r->count. */
uint32_t report_pareto_front(const cost_results *r, report_measure by, uint32_t *out);
/* Milliseconds until the path tracer's error is the setting's; NAN where either is unknown or 0. */
double report_equal_ms(const cost_results *r, const cost_setting *s, report_measure by);
double report_equal_paths(const cost_results *r, const cost_setting *s, report_measure by); /* a pixel */

/* What one knob does to the default: X(name, meaning), best first. */
#define REPORT_KINDS(X)                                                                                                        \
    X(GAIN, "Nearer to the reference and not measurably slower")                                                               \
    X(BUYS, "Nearer and slower: error bought for time")                                                                        \
    X(SAVES, "Further off and faster: time saved for error")                                                                   \
    X(SAME, "The same error: only time differs")                                                                               \
    X(LOSES, "Further off and not measurably faster")
typedef enum report_kind {
#define X(name, meaning) REPORT_##name,
    REPORT_KINDS(X)
#undef X
} report_kind;
typedef struct report_price {
    uint32_t setting;
    report_kind kind;
    double ms, error; /* the setting's less the default's */
    bool timed;       /* |ms| is more than twice its standard error: a difference that is no noise */
    double rate;      /* |error| / |ms|, 0 unless BUYS or SAVES */
} report_price;
/* The settings that differ from the default in one knob: kinds in the order above, within BUYS the most error a millisecond
 * first, within SAVES the least. `out` has room for r->count; returns how many. */
uint32_t report_prices(const cost_results *r, report_measure by, report_price *out);

/* ---- report_csv.c, report_json.c ---- */
void report_csv(const cost_results *r, FILE *to);
void report_json(const cost_results *r, FILE *to);

/* ---- report_image.c: PNG files as data: URIs. False: out of memory, or libpng fails. ---- */
enum { REPORT_COLOURS = 65 };
typedef struct report_map {
    uint8_t rgb[REPORT_COLOURS][3];
} report_map;
report_map report_map_signed(void);  /* blue, white, red for -1, 0, 1 */
report_map report_map_squared(void); /* dark to bright for 1e-4 to 10, logarithmic */
bool report_png_rgb(FILE *to, const uint8_t *rgb, uint32_t width, uint32_t height);
bool report_png_map(FILE *to, const uint8_t *index, uint32_t width, uint32_t height, const report_map *map);

/* ---- report_pictures.c: the settings that are shown, as pictures ---- */
typedef struct report_pictures {
    uint32_t width, height, block; /* pixels of a picture; each is the mean of block x block pixels of the grid */
    uint32_t count;                /* settings shown; 0: no images in the results */
    uint32_t *settings;            /* their indices: default, fronts, the worst */
} report_pictures;
bool report_pictures_choose(const cost_results *r, report_pictures *out);
void report_pictures_free(report_pictures *p);
bool report_reference_uri(const cost_results *r, const report_pictures *p, FILE *to);
bool report_frame_uri(const cost_setting *s, const cost_results *r, const report_pictures *p, FILE *to);
bool report_signed_uri(const cost_setting *s, const cost_results *r, const report_pictures *p, FILE *to);
bool report_squared_uri(const cost_setting *s, const cost_results *r, const report_pictures *p, FILE *to);

/* ---- report_labels.c: where labels go so that they hide neither points nor each other ---- */
typedef struct report_label {
    double x, y;          /* of the point, pixels, y down */
    double width, height; /* of the text */
    double left, top;     /* out: the text's box */
    bool led;             /* out: so far from its point that it needs a line to it */
} report_label;
typedef struct report_span {
    double x0, y0, x1, y1; /* a thing not to be covered: point, or segment parallel to an axis; x0 <= x1, y0 <= y1 */
} report_span;
void report_place_labels(report_label *labels, uint32_t count, const report_span *avoid, uint32_t avoid_count,
                         const report_span *inside);

/* ---- report_gnuplot.c: runs gnuplot on a script and prints its drawing as an <svg> element. Colours #0101NN of the script
 * become the style sheet's --cN, so that a plot follows the page into the dark; names are made unique by `id`. ---- */
typedef struct report_drawing {
    const char *id, *alt;   /* of the element; what it shows, for those who do not see it */
    uint32_t width, height; /* pixels */
    bool alone;             /* a file of its own, without a style sheet: #0101NN become the light page's colours */
} report_drawing;
vit_status report_gnuplot(const report_drawing *d, const char *script, FILE *to, vit_text *why);

/* ---- the plots ---- */
enum { INK = 1, SOFT = 2, GRID = 3, DOT = 4, FRONT = 5, DEFAULT = 6, TRACER = 7, STACK = 10 }; /* --cN of report.css */
enum { STACK_COLOURS = 9 }; /* STACK .. STACK + 8, then others */
/* report_axes.c: logarithmic axes about positive values. */
typedef struct report_axis {
    double low, high; /* 0 < low < high */
} report_axis;
bool report_axis_of(const double *values, uint32_t count, double pad_low, double pad_high,
                    report_axis *out);              /* false: none > 0 */
double report_axis_at(report_axis a, double value); /* 0 .. 1 along it */
void report_axis_print(FILE *to, const char *letter, report_axis a, const char *title);
/* report_plots.c, report_stack.c */
vit_status report_plot_error(const cost_results *r, report_measure by, FILE *to, vit_text *why);
vit_status report_plot_tracer(const cost_results *r, report_measure by, FILE *to, vit_text *why);
vit_status report_plot_stack(const cost_results *r, FILE *to, vit_text *why);

/* ---- report.c: files, made in memory and put under their names whole ---- */
vit_status report_folder(const char *folder, vit_text *why); /* makes it, and those above it */
typedef vit_status report_part_fn(const void *results, FILE *to, vit_text *why);
vit_status report_file(const void *results, const char *folder, const char *name, report_part_fn *part, vit_text *why);

/* ---- the page: report_page.c joins report_tables.c (tables), report_look.c (pictures) and the plots ---- */
void report_table_settings(const cost_results *r, FILE *to);
void report_table_pareto(const cost_results *r, FILE *to);
void report_table_prices(const cost_results *r, report_measure by, FILE *to);
void report_table_errors(const cost_results *r, FILE *to); /* bounce limit */
void report_summary(const cost_results *r, FILE *to);
bool report_look(const cost_results *r, FILE *to);
vit_status report_page(const cost_results *r, FILE *to, vit_text *why);
extern const char report_css[], report_js[]; /* made from report.css and report.js by the Makefile */

#endif
