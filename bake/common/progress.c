#include "common/progress.h"
#include <stdarg.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

double progress_now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

progress progress_make(bool quiet) {
    return (progress){.quiet = quiet, .terminal = !quiet && isatty(STDERR_FILENO)};
}

progress progress_within(const progress *outer) {
    return (progress){.quiet = true, .terminal = outer->terminal};
}

static void wipe(const progress *p) {
    if (p->terminal && p->stage)
        fputs("\r\033[K", stderr);
}

void progress_end(progress *p) {
    wipe(p);
    if (p->stage && !p->quiet)
        fprintf(stderr, "%-28s %7.2f s\n", p->stage, progress_now() - p->began);
    p->stage = NULL;
}

void progress_stage(progress *p, const char *stage) {
    progress_end(p);
    p->stage = stage;
    p->began = p->drawn = progress_now();
    if (p->terminal)
        fprintf(stderr, "%-28s", stage);
}

void progress_step(progress *p, double fraction) {
    double t = progress_now(), spent = t - p->began;
    if (!p->terminal || !p->stage || t - p->drawn < 0.1)
        return;
    p->drawn = t;
    fprintf(stderr, "\r\033[K%-28s %3.0f %%", p->stage, 100 * fraction);
    if (fraction > 0 && spent > 1)
        fprintf(stderr, "  %.0f s left", spent * (1 - fraction) / fraction);
    fflush(stderr);
}

void progress_line(progress *p, bool always, const char *format, ...) {
    va_list list;
    if (p->quiet && !always)
        return;
    wipe(p);
    va_start(list, format);
    vfprintf(stderr, format, list);
    va_end(list);
    fputc('\n', stderr);
}
