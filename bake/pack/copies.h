/* copies.c: where in its pixel each sample of anti-aliasing lies. */
#ifndef VIT_BAKE_COPIES_H
#define VIT_BAKE_COPIES_H

#include "vitrine_pack.h"
#include <stdbool.h>

/* Offsets of `count` samples (1, 2, 4, 8 or 16) from the pixel's centre, pixels: in -0.5..0.5 for a box filter, in -1..1 and
 * dense towards the centre for a tent. The first is the nearest to the centre; a single one is the centre. Those beyond `count`
 * are 0. */
void copies_place(uint32_t count, bool tent, float offset[VIT_MAX_COPIES][2]);

#endif
