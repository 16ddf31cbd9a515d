/* The catalogue of hard cases: a test measures how wrong the worst of its inputs comes out and holds that to a bound. Rows are
 * printed, asserted and written to VIT_BUILD_DIR/numeric/PROGRAM.csv, sweeps to PROGRAM.NAME.csv there; `make numeric` makes
 * one table and the plots of them. */
#ifndef VIT_TESTS_CATALOGUE_H
#define VIT_TESTS_CATALOGUE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdbool.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* `make numeric` asks for the whole of cases that `make test` takes a part of. */
static inline bool catalogue_whole(void) {
    const char *wish = getenv("VITRINE_NUMERIC");
    return wish && strcmp(wish, "whole") == 0;
}

/* A file of this program in the catalogue's folder; name: "" or ".SWEEP". */
static inline FILE *catalogue_create(const char *name) {
    char path[512];
    const char *slash = strrchr(__BASE_FILE__, '/'), *from = slash ? slash + 1 : __BASE_FILE__;
    (void)mkdir(VIT_BUILD_DIR "/numeric", 0777);
    (void)snprintf(path, sizeof path, VIT_BUILD_DIR "/numeric/%.*s%s.csv", (int)strcspn(from, "."), from, name);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    return f;
}

/* A column of text; its commas are written as semicolons. */
static inline void catalogue_text(FILE *f, const char *text) {
    for (; *text; text++)
        (void)fputc(*text == ',' ? ';' : *text, f);
    (void)fputc(',', f);
}

/* One row, measured: `worst` of `what` must not exceed `bound` (0: none may be wrong; then `unit` says of how many). The texts
 * hold neither quotes nor commas. A worst that is no number fails. */
static inline void catalogue_row(const char *hard_case, const char *what, double worst, double bound, const char *unit) {
    static FILE *rows; /* open to the program's end */
    if (!rows) {
        rows = catalogue_create("");
        (void)fprintf(rows, "case,what,bound,worst,unit,\n");
    }
    catalogue_text(rows, hard_case);
    catalogue_text(rows, what);
    (void)fprintf(rows, "%.9g,%.9g,", bound, worst);
    catalogue_text(rows, unit);
    (void)fputc('\n', rows);
    (void)fflush(rows);
    (void)printf("%-28s %-58s worst %-11.4g bound %-11.4g %s\n", hard_case, what, worst, bound, unit);
    (void)fflush(stdout);
    if (!(worst <= bound))
        fail_msg("%s: %s: %.9g is over the bound of %.9g %s", hard_case, what, worst, bound, unit);
}

/* A row of what must not happen at all: `wrong` of `count` things. */
static inline void catalogue_none(const char *hard_case, const char *what, uint64_t wrong, uint64_t count, const char *things) {
    char unit[64];
    (void)snprintf(unit, sizeof unit, "of %llu %s", (unsigned long long)count, things);
    assert_true(count > 0);
    catalogue_row(hard_case, what, (double)wrong, 0, unit);
}

/* Where something stops to hold: points to be drawn on logarithmic axes. What is 0 is drawn at the foot. Labels hold no quotes.
 */
typedef struct catalogue_point {
    double x, y;
} catalogue_point;

static inline void catalogue_sweep(const char *name, const char *x_label, const char *y_label, const catalogue_point *points,
                                   size_t count) {
    char suffix[96];
    (void)snprintf(suffix, sizeof suffix, ".%s", name);
    FILE *f = catalogue_create(suffix);
    catalogue_text(f, x_label);
    catalogue_text(f, y_label);
    (void)fputc('\n', f);
    for (size_t i = 0; i < count; i++)
        (void)fprintf(f, "%.9g,%.9g\n", points[i].x, points[i].y);
    assert_int_equal(fclose(f), 0);
}

#endif
