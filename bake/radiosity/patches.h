/* patches.c: surfaces as a number of patches, each taken for one in all that radiosity computes: small flat pieces (cells) of
 * triangles' sides that light gets from to the path's cameras, clustered from the whole down where most such light leaves
 * surfaces that are large, bent, or hidden from each other, as the floor on both sides of a thin wall (patches_parted.c: cells
 * right under the wall). Sides that no light
 * reaches, and mirrors and glass, belong to no patch. */
#ifndef VIT_RADIOSITY_PATCHES_H
#define VIT_RADIOSITY_PATCHES_H

#include "geometry/cells.h"
#include "light/photon_rays.h"
#include "motion/tracks.h"
#include "radiosity/separation.h"

#define PATCHES_MOST 65536u

typedef struct patches_input {
    const photon_rays *rays; /* of the scene whose materials and textures count */
    const geometry *geometry;
    const tracks *tracks;           /* the path's cameras */
    uint32_t frames, width, height; /* of the path; pixels */
    uint32_t count;                 /* patches wanted, 1..PATCHES_MOST; there are fewer if there are fewer cells */
    unsigned threads;               /* 0: all cores; changes no byte */
} patches_input;

typedef struct radiosity_patch {
    vec3 center, normal; /* mean by area; the normal is unit, or 0 where all sides of a ball are one patch */
    float area;          /* m2, > 0 */
    float albedo[3];     /* mean by area, 0..VIT_MAX_ALBEDO */
    uint32_t first;      /* of its cells in patches.cell; they end where the next patch's begin */
} radiosity_patch;

#define PATCHES_POINTS 128u /* of a patch, at most */

typedef struct patch_point {
    uint32_t side;
    float b1, b2;
} patch_point;

typedef struct patch_set {
    const geometry *geometry;
    cells cells;
    radiosity_patch *patch; /* count + 1: the last has no cells */
    uint32_t count;
    uint32_t *cell;        /* all patches' cells, one patch after another */
    double *cell_sum;      /* area of these cells up to the end of each, m2, anew in each patch */
    patch_point *points;   /* PATCHES_POINTS per patch: where paths from the cameras met it, as dense as they do */
    uint32_t *point_count; /* a patch: how many of its points are there */
    uint32_t *met;         /* a patch: how many paths met it */
    uint32_t *patch_of;    /* a cell: its patch, or VIT_NONE */
    separations apart;     /* cells that something stands on; they belong to no patch's cells */
    uint32_t (*beside)[2]; /* one of these: its patches in front of the plane and behind it, or VIT_NONE */
    double area;           /* of all patches, m2 */
    double hidden;         /* share of pairs of cells of a patch that something between them hides from each other, by area */
} patch_set;

/* VIT_FAILED: out of memory. On failure there is nothing to free. A scene without a cell that reflects has no patch. */
vit_status patches_make(const patches_input *in, patch_set *out, vit_text *why);
void patches_free(patch_set *p);

/* A place on a patch, even over its area for 0 <= u, v, w < 1: its side and barycentric weights. */
uint32_t patches_place(const patch_set *p, uint32_t of, float u, float v, float w, float *b1, float *b2);
/* The patch of a place of a side, or VIT_NONE. */
uint32_t patches_at(const patch_set *p, uint32_t side, float b1, float b2);

#endif
