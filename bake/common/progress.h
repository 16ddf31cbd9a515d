/* progress.c: what the baker says while it works: one line that redraws itself with an estimate of the time left on a
 * terminal, a plain line a stage otherwise. */
#ifndef VIT_BAKE_PROGRESS_H
#define VIT_BAKE_PROGRESS_H

#include <stdbool.h>

typedef struct progress {
    bool quiet, terminal;
    const char *stage;   /* text of the caller's, alive while the stage lasts */
    double began, drawn; /* seconds, monotonic */
} progress;

progress progress_make(bool quiet);
/* Of work that is part of a stage of another's: shows its stages while they last, on a terminal, and leaves no lines. */
progress progress_within(const progress *outer);
/* Ends the stage before, if any. */
void progress_stage(progress *p, const char *stage);
/* fraction of the stage done, 0..1; redraws at most ten times a second. */
void progress_step(progress *p, double fraction);
/* A line of its own: a warning or a result. Even when quiet if `always`. */
void progress_line(progress *p, bool always, const char *format, ...) __attribute__((format(printf, 3, 4)));
void progress_end(progress *p);
/* Seconds since some moment, monotonic. */
double progress_now(void);

#endif
