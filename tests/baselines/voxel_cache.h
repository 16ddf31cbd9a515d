/* Fixed voxels: what a place has is the mean of all places in its voxel and of its side, the plain cache that implicit random
 * points replace (Delaere 2020). Voxels are the boxes of the world-space cache (bake/cache/points.h), levels by distance; none
 * is mixed. */
#ifndef VIT_TESTS_VOXEL_CACHE_H
#define VIT_TESTS_VOXEL_CACHE_H

#include "cache/points.h"
#include "cache/sights.h"

#include <stdlib.h>

typedef struct voxel {
    int32_t box[3];
    uint32_t level, side, count;
    double sum;
} voxel;

typedef struct voxel_cache {
    voxel *slots;
    uint32_t slot_count; /* a power of two */
    uint32_t filled;
} voxel_cache;

static inline voxel voxel_of(const vit_scene *s, const cache_sight *at) {
    const float p[3] = {at->position.x, at->position.y, at->position.z}, n[3] = {at->normal.x, at->normal.y, at->normal.z};
    float next;
    voxel v = {.level = cache_level(s, at->distance, &next)};
    const cache_place place = cache_place_of(p, 1.0f / s->cache_step * (1.0f / (float)(1u << v.level)));
    for (uint32_t k = 0; k < 3; k++) {
        v.box[k] = place.box[k];
        if (fabsf(n[k]) > fabsf(n[v.side / 2]))
            v.side = 2 * k;
    }
    v.side += n[v.side / 2] < 0.0f;
    return v;
}

/* The voxel's slot, an empty one where it is not there. */
static inline voxel *voxel_slot(const voxel_cache *c, const voxel *v) {
    uint32_t at = cache_seed(v->box, v->level * VIT_CACHE_SIDES + v->side);
    for (;; at++) {
        voxel *there = &c->slots[at & (c->slot_count - 1)];
        if (there->count == 0 || (there->box[0] == v->box[0] && there->box[1] == v->box[1] && there->box[2] == v->box[2] &&
                                  there->level == v->level && there->side == v->side))
            return there;
    }
}

/* False: out of memory. */
static inline bool voxel_cache_fill(const vit_scene *s, const cache_sights *sights, const float *value, voxel_cache *c) {
    for (c->slot_count = 64; c->slot_count < 2 * sights->count; c->slot_count *= 2)
        ;
    c->slots = calloc(c->slot_count, sizeof *c->slots);
    for (uint32_t i = 0; i < sights->count && c->slots; i++) {
        const voxel v = voxel_of(s, &sights->sight[i]);
        voxel *slot = voxel_slot(c, &v);
        if (slot->count == 0) {
            *slot = v;
            c->filled++;
        }
        slot->count++;
        slot->sum += (double)value[i];
    }
    return c->slots != NULL;
}

static inline double voxel_cache_read(const vit_scene *s, const voxel_cache *c, const cache_sight *at) {
    const voxel v = voxel_of(s, at), *slot = voxel_slot(c, &v);
    return slot->count > 0 ? slot->sum / slot->count : 1.0;
}

#endif
