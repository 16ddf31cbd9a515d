/* work_count.c: exact work of frames, from an open pack of its own, since counting makes frames slower. */
#ifndef VIT_PLAY_WORK_COUNT_H
#define VIT_PLAY_WORK_COUNT_H

#include "report.h"
#include <signal.h>
#include <stdio.h>

/* What frames first .. end - 1 took, each rendered once. */
typedef struct work_counts {
    uint32_t first, end;
    uint64_t frames; /* counted so far: end - first when whole */
    uint32_t passes, kinds;
    uint32_t lanes;      /* in use: what kinds that are not `same` depend on */
    vit_statistics last; /* of the last frame */
    const char *pass_names[VIT_MAX_PASSES];
    const char *kind_names[VIT_MAX_WORKS];
    int same[VIT_MAX_WORKS];                                                         /* 1: equal on every device */
    uint64_t sum[VIT_MAX_PASSES][VIT_MAX_WORKS], max[VIT_MAX_PASSES][VIT_MAX_WORKS]; /* over the frames */
} work_counts;

/* Opens the pack of `how` to count, in an arena of its own, and closes it again; draws progress if asked. Stops between frames
 * once *stop is set: `frames` tells. VIT_FAILED: out of memory, or what vit_open() and vit_frame() say. */
vit_status work_count(const vit_open_info *how, uint32_t first, uint32_t end, bool progress, const volatile sig_atomic_t *stop,
                      work_counts *out, vit_text *why);

/* A table: pass, kind, a frame on average, the most of a frame. */
void work_print(const work_counts *w, FILE *to);

#endif
