/* report.c: what the player says: progress, tables, the summary. */
#ifndef VIT_PLAY_REPORT_H
#define VIT_PLAY_REPORT_H

#include "times.h"
#include "vitrine.h"
#include <stdbool.h>
#include <stdio.h>

/* Times of the last frames. Memory is taken once, at the start. */
typedef struct report {
    uint32_t passes;  /* columns of pass_ms; 0: passes are not timed */
    uint32_t room;    /* frames that fit; older ones are overwritten */
    uint64_t frames;  /* frames so far */
    double *frame_ms; /* [room] */
    double *pass_ms;  /* [passes][room] */
    double *sorted;   /* [room], for medians */
    double began_ms;  /* when the first frame was begun */
    bool progress;    /* draw a progress line on stderr */
    double drawn_ms;  /* when it was last drawn; 0: not at all */
} report;

/* `frames`: how many will be played. `passes`: 0, or vit_requirements.pass_count with a profiled vit. */
vit_status report_begin(report *r, uint64_t frames, uint32_t passes, bool progress, vit_text *why);
/* Notes a frame that took `ms`; with passes, reads their times back from `v`. */
vit_status report_frame(report *r, vit *v, double ms, vit_text *why);
void report_free(report *r);

/* Frame `done` of `all` (UINT64_MAX: without an end) is finished; drawn a few times a second. report_progress_clear() makes
 * room for other text. */
void report_progress(report *r, uint64_t done, uint64_t all);
void report_progress_clear(report *r);

/* Frames that times are of, at most the last 4096; what their times say, ms: seen from the host, and of a pass. */
size_t report_timed(const report *r);
times report_frame_times(const report *r);
times report_pass_times(const report *r, uint32_t pass);

/* --report: time a pass, memory a buffer, work of the last frame. */
void report_print(const report *r, const vit_requirements *need, const vit_statistics *s, uint64_t late, bool paced, FILE *to);
/* One line: frames, seconds, milliseconds per frame, the device's name; `end` closes it. */
void report_closing(const report *r, const char *device, const char *end, FILE *to);
/* One line if a bound dropped anything, else nothing. */
void report_dropped(const vit_statistics *s, FILE *to);
/* One line a fault of the log, if there are any. */
void report_faults(vit *v, FILE *to);

/* --explain. `file` names the pack, `pack_bytes` is its size. */
void report_explain(const char *file, size_t pack_bytes, const vit_requirements *need, FILE *to);

#endif
