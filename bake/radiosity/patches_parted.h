/* patches_parted.c: cells that something stands on, as a thin wall on a floor that goes on beneath it. They belong to no
 * cluster, but to a patch on either side. Private to bake/radiosity. */
#ifndef VIT_RADIOSITY_PATCHES_PARTED_H
#define VIT_RADIOSITY_PATCHES_PARTED_H

#include "radiosity/patches_met.h"

/* edge: of cells, m. Fills apart and beside. False: out of memory. */
bool patches_find_parts(const patches_input *in, float edge, patch_set *p);
/* Gives them their patches, once all other cells have theirs: those that are seen from where paths met the part. False: out of
 * memory. */
bool patches_place_parts(const patches_input *in, const patches_met *m, float edge, patch_set *p);

#endif
