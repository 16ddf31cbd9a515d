/* walls.c: which cells thin walls part, so that places on one side do not read what is known on the other. */
#ifndef VIT_CACHE_WALLS_H
#define VIT_CACHE_WALLS_H

#include "cache/points_met.h"

typedef struct cache_walls_input {
    const photon_rays *rays;
    const cache_sights *sights;
    const cache_met *met;
    const float *value; /* a row of `met` */
    float step;         /* edge of a box of level 0, m */
    double worth;       /* a plane takes so much of the values' variance away, at least */
    unsigned threads;   /* 0: all cores; changes no byte */
} cache_walls_input;

/* A cell is parted where two places that read it do not see each other for a wall between them, by the plane in the wall's
 * middle: of those met between pairs of places the one that leaves the least variance on its two sides. False: out of memory.
 */
bool cache_walls_find(const cache_walls_input *in, cache_walls *out);
/* Records of the planes: walls->count. Returns their number. */
uint32_t cache_walls_put(const cache_walls *w, vit_cache_cell *cells);
void cache_walls_free(cache_walls *w);

#endif
