/* patches_met.c: where paths from the cameras meet surfaces: which cells matter, and at which places of patches direct light is
 * asked for. Private to bake/radiosity. */
#ifndef VIT_RADIOSITY_PATCHES_MET_H
#define VIT_RADIOSITY_PATCHES_MET_H

#include "radiosity/patches.h"

typedef struct patches_met {
    patch_point *places; /* of one path after another; side VIT_NONE: none */
    size_t count;
} patches_met;

/* False: out of memory. */
bool patches_find_met(const patches_input *in, patches_met *out);
void patches_met_free(patches_met *m);

/* A cell: how many paths met it; one that a camera sees itself counts for little, as it need not give light. The caller's;
 * NULL: out of memory. */
float *patches_met_worth(const patches_met *m, const cells *c);
/* Fills in points, their count and `met`, which is 0, once cells have their patches: a reservoir of all places (Vitter 1985),
 * the same whatever the threads. */
void patches_keep_points(const patches_met *m, patch_set *p);

#endif
