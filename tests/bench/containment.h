/* What hanging photons on inner nodes would save: a photon whose sphere holds a node's whole box reaches all that lies below
 * and need not descend further. Counted on the host from the buffers of a frame, by the tests of splat.cl; without stopping,
 * the count of pairs must be the device's. */
#ifndef VIT_BENCH_CONTAINMENT_H
#define VIT_BENCH_CONTAINMENT_H

#include "variant.h"

/* Of one frame, with or without stopping at contained nodes. */
typedef struct descent {
    uint64_t leaf_pairs;  /* photons on clusters */
    uint64_t inner_pairs; /* photons on inner nodes that they contain; 0 without stopping */
    uint64_t passed;      /* entries of inner lists that only lead further down */
    uint64_t tests;       /* photon-node tests */
    uint64_t evaluations; /* photons times view samples that the estimate goes through */
} descent;

typedef struct hierarchy {
    uint32_t nodes, leaves_begin, max_nodes;
    const uint32_t *first, *count; /* children */
    const float *plane;            /* 12 max_nodes: lo, hi of positions, lo, hi of normals */
    const uint64_t *samples;       /* view samples below each node */
} hierarchy;

static inline float node_plane(const hierarchy *h, uint32_t k, uint32_t node) {
    return h->plane[(size_t)k * h->max_nodes + node];
}

/* splat_touch of splat.cl. */
static inline bool photon_touches(const hierarchy *h, uint32_t node, const vit_photon *p) {
    float o[3], least[3];
    for (uint32_t k = 0; k < 3; k++) {
        const float x = p->position[k], d = p->direction[k];
        const float lo = node_plane(h, k, node), hi = node_plane(h, 3 + k, node);
        const float a = d * node_plane(h, 6 + k, node), b = d * node_plane(h, 9 + k, node);
        const float inside = x < hi ? x : hi;
        o[k] = x - (lo > inside ? lo : inside);
        least[k] = a < b ? a : b;
    }
    return fmaf(o[2], o[2], fmaf(o[1], o[1], o[0] * o[0])) < p->radius2 * 1.000001f && least[0] + least[1] + least[2] < 1e-6f;
}

/* Is the box's farthest corner within the sphere? */
static inline bool photon_contains(const hierarchy *h, uint32_t node, const vit_photon *p) {
    float d2 = 0;
    for (uint32_t k = 0; k < 3; k++) {
        const float a = fabsf(p->position[k] - node_plane(h, k, node)), b = fabsf(p->position[k] - node_plane(h, 3 + k, node));
        const float d = a > b ? a : b;
        d2 += d * d;
    }
    return d2 <= p->radius2;
}

static inline void descend(const hierarchy *h, uint32_t parent, const vit_photon *p, bool stop, descent *d) {
    const uint32_t first = h->first[parent], end = first + h->count[parent];
    for (uint32_t node = first; node < end; node++) {
        d->tests++;
        if (!photon_touches(h, node, p))
            continue;
        if (node >= h->leaves_begin) {
            d->leaf_pairs++;
            d->evaluations += h->samples[node];
        } else if (stop && photon_contains(h, node, p)) {
            d->inner_pairs++;
            d->evaluations += h->samples[node];
        } else {
            d->passed++;
            descend(h, node, p, stop, d);
        }
    }
}

/* View samples below each node. Children have greater indices than their parents. */
static inline uint64_t *samples_below(player *p, const hierarchy *h) {
    const vit_scene *s = p->v->pack.scene;
    uint32_t *keys = player_buffer(p, B_keys), *masks = player_buffer(p, B_masks), *prefix = player_buffer(p, B_prefix);
    uint64_t *below = bench_array(h->max_nodes, sizeof *below);
    for (uint32_t i = 0; i < s->samples; i++) {
        if (keys[i] == VIT_NONE)
            continue;
        const uint32_t word = s->level_first[s->levels - 1] + (keys[i] >> 5);
        uint32_t node = prefix[word];
        for (uint32_t lower = masks[word] & ((1u << (keys[i] & 31u)) - 1u); lower; lower &= lower - 1)
            node++;
        below[node]++;
    }
    for (uint32_t node = h->leaves_begin; node-- > 0;)
        for (uint32_t c = 0; c < h->count[node]; c++)
            below[node] += below[h->first[node] + c];
    free(keys);
    free(masks);
    free(prefix);
    return below;
}

/* Floats that order as integers do: vit_from_ordered in strict.clh. */
static inline void planes_decode(int32_t *plane, size_t count) {
    for (size_t i = 0; i < count; i++)
        plane[i] ^= plane[i] < 0 ? 0x7fffffff : 0;
}

/* Both descents of the frame that `p`, which lists photons, rendered last. */
static inline void containment_count(player *p, descent *without, descent *with) {
    const vit_scene *s = p->v->pack.scene;
    const vit_statistics stats = player_stats(p);
    hierarchy h = {.nodes = stats.nodes, .leaves_begin = stats.nodes - stats.clusters, .max_nodes = p->v->launch.max_nodes};
    uint32_t *first = player_buffer(p, B_node_first), *count = player_buffer(p, B_node_count);
    int32_t *bounds = player_buffer(p, B_bounds);
    float *plane = bench_array((size_t)h.max_nodes * 12, sizeof *plane);
    vit_photon *photons = player_buffer(p, B_photons);
    planes_decode(bounds, (size_t)h.max_nodes * 12);
    memcpy(plane, bounds, (size_t)h.max_nodes * 12 * sizeof *plane);
    h.first = first;
    h.count = count;
    h.plane = plane;
    uint64_t *samples = samples_below(p, &h);
    h.samples = samples;
    *without = *with = (descent){0};
    for (uint32_t i = 0; i < s->photons; i++) {
        if (!(photons[i].radius2 > 0))
            continue;
        descend(&h, 0, &photons[i], false, without);
        descend(&h, 0, &photons[i], true, with);
    }
    if (without->leaf_pairs != stats.pairs || without->leaf_pairs + without->passed != stats.list)
        bench_fail("the host counts %llu pairs in %llu entries, the device %u in %u", (unsigned long long)without->leaf_pairs,
                   (unsigned long long)(without->leaf_pairs + without->passed), stats.pairs, stats.list);
    free(first);
    free(count);
    free(bounds);
    free(plane);
    free(photons);
    free(samples);
}

#endif
