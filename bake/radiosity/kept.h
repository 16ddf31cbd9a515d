/* kept.c: baked light that was made before. Quality "auto" and a sweep ask for it again and again, with other settings that do
 * not touch it, and it takes minutes. */
#ifndef VIT_RADIOSITY_KEPT_H
#define VIT_RADIOSITY_KEPT_H

#include "radiosity/baked.h"

#define BAKED_KEPT 4 /* at most; the one asked for longest ago goes first */

typedef struct baked_kept_one {
    baked_input in; /* its numbers alone count */
    uint64_t effects, asked;
    baked baked;
} baked_kept_one;

/* Zero to begin with. All are of one scene's triangles, materials and tracks. */
typedef struct baked_kept {
    baked_kept_one one[BAKED_KEPT];
    uint64_t asked, found; /* times */
} baked_kept;

/* A copy of what was baked of `in` with these effects, if it is there. */
bool baked_kept_get(baked_kept *k, const baked_input *in, uint64_t effects, baked *out);
/* Keeps a copy, if there is memory. */
void baked_kept_put(baked_kept *k, const baked_input *in, uint64_t effects, const baked *b);
void baked_kept_free(baked_kept *k);

#endif
