/* zones/kept.c: zones and areas that were baked before. A sweep asks for the same ones again and again: they do not depend on
 * the number of photons, the estimate or the tile. */
#ifndef VIT_BAKE_ZONES_KEPT_H
#define VIT_BAKE_ZONES_KEPT_H

#include "zones/zones.h"

#define ZONES_KEPT 64                     /* at most, and so many bytes; the one asked for longest ago goes first */
#define ZONES_BYTES ((uint64_t)512 << 20) /* two in any case */

typedef struct zones_kept_one {
    float radius, flatten;
    uint32_t width, height, bounces, lights;
    bool zones, by_light, areas, guided;
    bool *gives; /* a light */
    uint64_t asked, bytes;
    cells cells;
    zones_found found;
} zones_kept_one;

/* Zero to begin with. All are of one scene's triangles, materials and tracks. */
typedef struct zones_kept {
    zones_kept_one one[ZONES_KEPT];
    uint64_t asked;
} zones_kept;

/* As zones_bake(), with a copy of what was kept if there is one; keeps what it bakes, if there is memory. */
vit_status zones_kept_bake(zones_kept *k, const zones_input *in, cells *out, zones_found *found, vit_text *why);
void zones_kept_free(zones_kept *k);

#endif
