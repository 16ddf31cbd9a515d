/* points.h: the cells and implicit points of the world-space cache, as kernels/cache.clh has them, to the bit
 * (kernels/METHODS.md, "World-space cache"). */
#ifndef VIT_CACHE_POINTS_H
#define VIT_CACHE_POINTS_H

#include "common/kernel_math.h"
#include "vitrine_pack.h"
#include <stdbool.h>

/* Where a place is among the boxes of a level. */
typedef struct cache_place {
    int32_t box[3];
    float in[3]; /* in it, 0..1 */
} cache_place;

/* Half of it, rounded down: >> 1 of a negative number is the compiler's choice. */
static inline int32_t cache_half(int32_t box) {
    return box >= 0 ? box / 2 : -((1 - box) / 2);
}

/* inverse: boxes a metre. */
static inline cache_place cache_place_of(const float p[3], float inverse) {
    cache_place r;
    for (int k = 0; k < 3; k++) {
        const float x = float_min(float_max(p[k] * inverse, -VIT_CACHE_FARTHEST), VIT_CACHE_FARTHEST), low = floorf(x);
        r.box[k] = (int32_t)low;
        r.in[k] = x - low;
    }
    return r;
}

static inline uint32_t cache_seed(const int32_t cell[3], uint32_t level) {
    return pcg((uint32_t)cell[0] + pcg((uint32_t)cell[1] + pcg((uint32_t)cell[2] + pcg(level))));
}

static inline uint32_t cache_tag(const int32_t cell[3]) {
    return ((uint32_t)cell[0] * VIT_CACHE_TAG_X + (uint32_t)cell[1] * VIT_CACHE_TAG_Y + (uint32_t)cell[2] * VIT_CACHE_TAG_Z) &
           VIT_CACHE_TAG;
}

/* A plane that parts a cell, as its record has it (kernels/cache_cell.clh). */
typedef struct cache_plane {
    uint32_t normal; /* 0: there is none */
    float from;
} cache_plane;

static inline bool cache_before(const cache_plane *p, const float at[3]) {
    float n[3];
    for (int k = 0; k < 3; k++)
        n[k] = (float)((int)(p->normal >> 10 * k & 1023u) - VIT_CACHE_NORMAL);
    return fmaf(n[0], at[0], fmaf(n[1], at[1], fmaf(n[2], at[2], p->from))) >= 0.0f;
}

/* From the corner of the cell, in boxes. */
static inline void cache_from_corner(const cache_place *p, const int32_t cell[3], float at[3]) {
    for (int k = 0; k < 3; k++)
        at[k] = (float)(p->box[k] - 2 * cell[k]) + p->in[k];
}

/* side: 2 axis, and 1 more where the normal's component is negative; of a parted cell's parts VIT_CACHE_SIDES more and twice as
 * many. */
static inline uint32_t cache_key(uint32_t seed, uint32_t side) {
    const uint32_t key = pcg(seed + VIT_CACHE_POINTS + side);
    return key == VIT_CACHE_EMPTY ? 0 : key;
}

/* Squared distance of the place from the point of the box that is `by` from its own, in edges of a box. random: of the point.
 */
static inline float cache_distance2(const cache_place *p, const int by[3], uint32_t random) {
    const float wide = 1.0f - 2.0f * VIT_CACHE_MARGIN, step = wide / 1024.0f;
    float d[3];
    for (int k = 0; k < 3; k++)
        d[k] = fmaf((float)(random >> 10 * k & 1023u), step, (float)by[k] + VIT_CACHE_MARGIN + 0.5f * step) - p->in[k];
    return fmaf(d[2], d[2], fmaf(d[1], d[1], d[0] * d[0]));
}

static inline float cache_weight(float distance2) {
    const float near = float_max(fmaf(distance2, -1.0f / (VIT_CACHE_REACH * VIT_CACHE_REACH), 1.0f), 0.0f);
    return near * near;
}

static inline float cache_share(float component) {
    return float_max(fmaf(component, component, -VIT_CACHE_FLAT), 0.0f);
}

/* Level of detail at a distance from the eye, and how much of the next one is mixed in. */
static inline uint32_t cache_level(const vit_scene *s, float distance, float *next) {
    const float last = (float)(1u << (s->cache_levels - 1u));
    const float wanted = float_min(float_max(distance * s->cache_detail, 1.0f), last);
    int exponent;
    const float over = 2.0f * frexpf(wanted, &exponent);
    *next = float_max(fmaf(over, 2.0f, -3.0f), 0.0f);
    return (uint32_t)(exponent - 1);
}

#endif
