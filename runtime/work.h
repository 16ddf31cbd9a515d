/* work.c: exact work of the last frame's passes, from what the device counted (kernels/work.clh) and from sizes. */
#ifndef VIT_WORK_H
#define VIT_WORK_H

#include "passes.h"

/* Words of the buffer `work`: VIT_WORK_COUNT times two, low first, for each row of vit_passes. */
#define VIT_WORK_WORDS (VIT_MAX_PASSES * VIT_WORK_COUNT * 2)

/* Fills in the work of `out`. words: the buffer `work`; c: the frame's VIT_COUNTERS; both as the device left them. */
void vit_work_read(const uint32_t *words, const vit_scene *s, const vit_launch *l, const uint32_t *c, vit_statistics *out);

#endif
