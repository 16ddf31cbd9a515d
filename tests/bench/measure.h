/* What all benches share: series of values, their medians, the CSV file, and giving up with one line. */
#ifndef VIT_BENCH_MEASURE_H
#define VIT_BENCH_MEASURE_H

#include "vitrine.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#ifdef __GNUC__
__attribute__((format(printf, 1, 2), noreturn))
#endif
static inline void
bench_fail(const char *format, ...) {
    va_list a;
    va_start(a, format);
    fputs("bench: ", stderr);
    vfprintf(stderr, format, a);
    fputc('\n', stderr);
    va_end(a);
    exit(VIT_FAILED);
}

/* VITRINE_BENCH=smoke: every bench to its end, tiny and once, on our own scenes, with all that it verifies; its times say
 * nothing. */
static inline bool bench_smoke(void) {
    const char *wish = getenv("VITRINE_BENCH");
    return wish && strcmp(wish, "smoke") == 0;
}

static inline int bench_rounds(int usual) {
    return bench_smoke() ? 1 : usual;
}

/* Device 0; where no kernel of OpenCL is what a bench is about, a smoke run takes the device that compiles nothing. */
static inline unsigned bench_device(void) {
    return bench_smoke() ? VIT_DEVICE_HOST : 0;
}

static inline void *bench_array(size_t count, size_t size) {
    void *p = calloc(count ? count : 1, size);
    if (!p)
        bench_fail("out of memory");
    return p;
}

static inline void bench_folder(const char *path) {
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        bench_fail("%s: %s", path, strerror(errno));
}

static inline double bench_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#define SERIES_MAX 64

typedef struct series {
    double value[SERIES_MAX];
    int count;
} series;

static inline void series_add(series *s, double value) {
    if (s->count == SERIES_MAX)
        bench_fail("a series of more than %d values", SERIES_MAX);
    s->value[s->count++] = value;
}

static inline int series_order(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static inline double series_median(const series *s) {
    series sorted = *s;
    if (s->count == 0)
        return 0;
    qsort(sorted.value, (size_t)s->count, sizeof *sorted.value, series_order);
    return 0.5 * (sorted.value[(s->count - 1) / 2] + sorted.value[s->count / 2]);
}

/* Median of the distances to the median. */
static inline double series_mad(const series *s) {
    series distance = {.count = s->count};
    const double middle = series_median(s);
    for (int i = 0; i < s->count; i++)
        distance.value[i] = fabs(s->value[i] - middle);
    return series_median(&distance);
}

/* Rates from times: `amount` each `unit` seconds; e.g. 1e3 and rays for M rays/s from ms. */
static inline series series_rate(const series *ms, double amount) {
    series r = {.count = ms->count};
    for (int i = 0; i < ms->count; i++)
        r.value[i] = ms->value[i] > 0 ? amount / ms->value[i] : 0;
    return r;
}

/* Of y over x, positive: least squares of log y over log x. */
static inline double bench_exponent(const double *x, const double *y, int count) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (int i = 0; i < count; i++) {
        const double a = log(x[i]), b = log(y[i]);
        sx += a;
        sy += b;
        sxx += a * a;
        sxy += a * b;
    }
    return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

/* One value that is the same each time. */
static inline series series_exact(double value) {
    return (series){.value = {value}, .count = 1};
}

/* build/bench/NAME.csv, begun anew by each run; a smoke run's does not take its place. */
typedef struct csv {
    FILE *file;
    char date[32], cpu[128];
    vit_text device;
} csv;

static inline void csv_cpu(char *out, size_t size) {
    char line[256];
    FILE *f = fopen("/proc/cpuinfo", "r");
    snprintf(out, size, "unknown");
    while (f && fgets(line, sizeof line, f)) {
        const char *value = strchr(line, ':');
        if (strncmp(line, "model name", 10) == 0 && value) {
            line[strcspn(line, "\n")] = 0;
            snprintf(out, size, "%s", value + 1 + strspn(value + 1, " "));
            break;
        }
    }
    if (f)
        fclose(f);
}

/* Text as a CSV field: quoted, quotes inside become apostrophes. */
static inline void csv_field(FILE *f, const char *text) {
    fputc('"', f);
    for (; *text; text++)
        fputc(*text == '"' ? '\'' : *text, f);
    fputs("\",", f);
}

static inline const char *bench_results(void) {
    return bench_smoke() ? "build/bench-smoke" : "build/bench";
}

static inline csv csv_open(const char *name) {
    csv c = {0};
    char path[256];
    const time_t now = time(NULL);
    struct tm utc;
    bench_folder("build");
    bench_folder(bench_results());
    snprintf(path, sizeof path, "%s/%s.csv", bench_results(), name);
    c.file = fopen(path, "w");
    if (!c.file)
        bench_fail("%s: %s", path, strerror(errno));
    gmtime_r(&now, &utc);
    strftime(c.date, sizeof c.date, "%Y-%m-%dT%H:%M:%SZ", &utc);
    csv_cpu(c.cpu, sizeof c.cpu);
    if (!vit_device_name(0, &c.device))
        bench_fail("no OpenCL device");
    fputs("date,cpu,device,scene,size,what,median,mad,unit,n\n", c.file);
    printf("\n== %s: %s, CPU %s, OpenCL %s\n", name, c.date, c.cpu, c.device.text);
    return c;
}

static inline void csv_row(csv *c, const char *of, const char *size, const char *what, const series *s, const char *unit) {
    const char *const texts[] = {c->date, c->cpu, c->device.text, of, size, what};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        csv_field(c->file, texts[i]);
    fprintf(c->file, "%.9g,%.4g,%s,%d\n", series_median(s), series_mad(s), unit, s->count);
    fflush(c->file);
}

static inline void csv_close(csv *c, const char *name) {
    if (fclose(c->file) != 0)
        bench_fail("%s/%s.csv: %s", bench_results(), name, strerror(errno));
    printf("\n-> %s/%s.csv\n", bench_results(), name);
}

#endif
