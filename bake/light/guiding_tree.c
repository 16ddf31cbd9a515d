/* Paths are guided in the numbers that choose them, not in space: so any light is, and its first reflection with it.
 * kernels/METHODS.md, "Guided photons". */
#include "light/guiding_tree.h"
#include "common/kernel_math.h"
#include "vitrine_pack.h"
#include <stdlib.h>

#define LEAST 8u    /* samples of a box that is halved */
#define HALVINGS 16 /* of a dimension */
#define BINS 8
#define DOUBT 1.0f /* samples that are taken to be in each half besides those that are */
#define HEAVY 8.0f /* heavier samples than so many mean ones weigh as much: one path is no reason to send all there */

typedef struct box {
    float low[GUIDING_DIMENSIONS], high[GUIDING_DIMENSIONS];
    int halved[GUIDING_DIMENSIONS];
} box;

typedef struct building {
    guiding_tree *g;
    guiding_tree_sample *samples;
    uint32_t dimensions;
    float mean; /* weight of a sample */
} building;

/* The dimension along which weights are least even; the one halved least if all are alike. */
static uint32_t uneven(const building *b, const box *at, uint32_t begin, uint32_t end) {
    uint32_t best = VIT_NONE;
    double most = 0;
    for (uint32_t k = 0; k < b->dimensions; k++) {
        double bin[BINS] = {0}, sum = 0, square = 0;
        if (at->halved[k] == HALVINGS)
            continue;
        const float scale = (float)BINS / (at->high[k] - at->low[k]);
        for (uint32_t i = begin; i < end; i++) {
            const int n = (int)((b->samples[i].at[k] - at->low[k]) * scale);
            bin[n < BINS ? n : BINS - 1] += (double)b->samples[i].weight;
        }
        for (int n = 0; n < BINS; n++) {
            sum += bin[n];
            square += bin[n] * bin[n];
        }
        const double by = BINS * square / (sum * sum) + 1e-3 * (HALVINGS - at->halved[k]); /* 1..BINS */
        if (best == VIT_NONE || by > most) {
            best = k;
            most = by;
        }
    }
    return best;
}

/* Samples of the lower half first, either half in its order. Returns where the other begins. */
static uint32_t part(const building *b, guiding_tree_sample *spare, uint32_t begin, uint32_t end, uint32_t dimension,
                     float middle) {
    uint32_t low = begin, high = 0;
    for (uint32_t i = begin; i < end; i++)
        if (b->samples[i].at[dimension] < middle)
            b->samples[low++] = b->samples[i];
        else
            spare[high++] = b->samples[i];
    memcpy(b->samples + low, spare, high * sizeof *spare);
    return low;
}

static float weigh(const building *b, uint32_t begin, uint32_t end) {
    double sum = 0;
    for (uint32_t i = begin; i < end; i++)
        sum += (double)b->samples[i].weight;
    return (float)(sum / (double)b->mean);
}

/* share: of the guided paths in the box; size: of the cube. */
static void halve(building *b, guiding_tree_sample *spare, const box *at, uint32_t begin, uint32_t end, double share,
                  double size) {
    guiding_tree *g = b->g;
    const uint32_t me = g->count++;
    const bool may = end - begin >= LEAST && g->count + 2 < GUIDING_NODES && weigh(b, begin, end) > 0.0f;
    const uint32_t k = may ? uneven(b, at, begin, end) : VIT_NONE;
    g->nodes[me] = (guiding_tree_node){.dimension = k};
    if (k == VIT_NONE) {
        g->gain += share * (share / size);
        return;
    }
    box low = *at, high = *at;
    const float middle = 0.5f * (at->low[k] + at->high[k]);
    low.high[k] = high.low[k] = middle;
    low.halved[k]++;
    high.halved[k]++;
    const uint32_t split = part(b, spare, begin, end, k, middle);
    const double lower = (double)weigh(b, begin, split), upper = (double)weigh(b, split, end),
                 q = (lower + (double)DOUBT) / (lower + upper + 2.0 * (double)DOUBT), even = (double)GUIDING_EVENLY;
    g->nodes[me].left = (float)(((1.0 - even) * share * q + even * 0.5 * size) / ((1.0 - even) * share + even * size));
    halve(b, spare, &low, begin, split, share * q, 0.5 * size);
    g->nodes[me].right = g->count;
    halve(b, spare, &high, split, end, share * (1.0 - q), 0.5 * size);
}

bool guiding_tree_build(guiding_tree_sample *samples, uint32_t count, uint32_t dimensions, guiding_tree *out) {
    *out = (guiding_tree){0};
    building b = {.g = out, .samples = samples, .dimensions = dimensions};
    uint32_t kept = 0;
    double sum = 0;
    for (uint32_t i = 0; i < count; i++)
        if (samples[i].weight > 0.0f) {
            sum += (double)samples[i].weight;
            samples[kept++] = samples[i];
        }
    if (kept == 0)
        return true;
    const float heavy = HEAVY * (float)(sum / kept);
    sum = 0;
    for (uint32_t i = 0; i < kept; i++) {
        samples[i].weight = float_min(samples[i].weight, heavy);
        sum += (double)samples[i].weight;
    }
    b.mean = (float)(sum / kept);
    guiding_tree_sample *spare = malloc(kept * sizeof *spare);
    out->nodes = malloc(GUIDING_NODES * sizeof *out->nodes);
    if (!spare || !out->nodes) {
        free(spare);
        guiding_tree_free(out);
        return false;
    }
    box all = {{0}, {0}, {0}};
    for (uint32_t k = 0; k < dimensions; k++)
        all.high[k] = 1.0f;
    halve(&b, spare, &all, 0, kept, 1.0, 1.0);
    free(spare);
    guiding_tree_node *shorter = realloc(out->nodes, out->count * sizeof *shorter);
    out->nodes = shorter ? shorter : out->nodes;
    return true;
}

void guiding_tree_free(guiding_tree *g) {
    free(g->nodes);
    *g = (guiding_tree){0};
}

float guiding_tree_point(const guiding_tree *g, uint32_t paths, uint32_t i, uint32_t number, float at[GUIDING_DIMENSIONS]) {
    uint32_t random = pcg(number * 2u + 0x9e3779b9u), node = 0;
    double t = ((double)i + (double)random * 0x1p-32) / (double)paths, density = 1.0;
    float low[GUIDING_DIMENSIONS] = {0}, size[GUIDING_DIMENSIONS] = {1, 1, 1, 1, 1, 1};
    while (g->nodes[node].dimension != VIT_NONE) {
        const guiding_tree_node *n = g->nodes + node;
        const double left = (double)n->left;
        const bool right = t >= left;
        size[n->dimension] *= 0.5f;
        t = right ? (t - left) / (1.0 - left) : t / left;
        density *= 2.0 * (right ? 1.0 - left : left);
        low[n->dimension] += right ? size[n->dimension] : 0.0f;
        node = right ? n->right : node + 1;
    }
    for (int k = 0; k < GUIDING_DIMENSIONS; k++) {
        random = pcg(random + 0x85ebca6bu);
        at[k] = low[k] + size[k] * unit_float(random);
        at[k] = float_min(at[k], 0x1.fffffep-1f);
    }
    return (float)density;
}
