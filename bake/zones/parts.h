/* What the parts of zones_bake() share; zones.c calls them in this order. */
#ifndef VIT_BAKE_ZONES_PARTS_H
#define VIT_BAKE_ZONES_PARTS_H

#include "common/parallel.h"
#include "light/photon_rays.h"
#include "zones/zones.h"

#define ZONES_FINE 0.125f   /* edges of cells that are seen, in radii */
#define ZONES_COARSE 0.25f  /* of the others; also a patch's edge */
#define ZONES_POINTS 450.0f /* area points on a square of the radius */
#define ZONES_TRIES 16u     /* rays that look whether a point is open */
#define ZONES_FAR 0.05f     /* that are not longer than this part of the scene's diagonal need not be longer than a radius */
#define ZONES_NEAR 0.12f    /* radii about a surface's point in which its irradiance is measured */
#define ZONES_LIKE 2.0f     /* surfaces whose irradiance differs by a larger factor are unlike lit */
#define ZONES_LEAST_AREA                                                                                                       \
    0.06f /* with less of the kernel on accepted surfaces, those lit alike count, seen or not, if there are any */

/* A small piece of surface, for integrals over area. */
typedef struct area_point {
    vec3 p, n;  /* on the surface; unit geometric normal of its side */
    float area; /* m2; 0: closed, light does not get there */
    uint32_t patch, cell;
    float flux; /* W of photons of the mean frame, its share of the cell's */
} area_point;

/* Cells of one direction in one cube; photons that land in a patch have one zone. */
typedef struct patch {
    vec3 center;           /* of its points, mean */
    float area, flux;      /* m2 open; W of photons of the mean frame */
    uint32_t first, count; /* its points */
    uint32_t zone;
} patch;

/* Photons of a patch that a receiver should accept, or not; its weight in the receiver's kernel. */
typedef struct pair {
    uint32_t receiver, patch;
    float weight, wrong; /* of the kernel; cost of accepting what should not be */
    bool accept, alike;  /* alike: accepted but for sight */
} pair;

/* Cells that lie close together and face alike accept the same zones. */
typedef struct receiver {
    uint32_t cell; /* that stands for all */
    vec3 p, n;
    uint32_t first, count;  /* its pairs */
    uint32_t accept, alike; /* zones */
} receiver;

typedef struct zones {
    const zones_input *in;
    const geometry *g;
    photon_scene scene;
    photon_rays rays;
    float radius, flatten;
    uint64_t *seen; /* hash set of the cubes that the path sees */
    uint32_t seen_room;
    uint8_t *seen_side;
    float (*seen_at)[2]; /* a cell: b1, b2 on its side of the point next to its middle that the path sees */
    float *seen_off;     /* its distance from the middle, squared; FLT_MAX: none */
    cells *c;
    uint32_t *patch_of, *receiver_of; /* a cell; VIT_NONE */
    patch *patches;
    uint32_t patch_count;
    area_point *points; /* sorted by patch */
    uint32_t point_count;
    receiver *receivers;
    uint32_t receiver_count;
    pair *pairs; /* sorted by receiver */
    size_t pair_count;
    zones_found *found;
} zones;

/* A regular grid over things with positions, for neighbours within the radius. */
typedef struct grid {
    vec3 lo;
    float inv; /* 1 / edge */
    int nx, ny, nz;
    uint32_t *start, *item; /* items of box b: item[start[b]] .. item[start[b + 1] - 1], ascending */
} grid;

bool grid_make(grid *g, const vec3 *at, size_t stride, uint32_t count, float edge);
void grid_free(grid *g);
/* Runs f for the items in the boxes that touch the cube of `reach` about p: one by one, or as stretches of `item`, a row of
 * boxes each. */
void grid_near(const grid *g, vec3 p, float reach, void (*f)(void *user, uint32_t item), void *user);
void grid_rows(const grid *g, vec3 p, float reach, void (*f)(void *user, uint32_t begin, uint32_t end), void *user);
/* Lets every box begin at a multiple of `width` items; the gaps are VIT_NONE. *slots: items then, 0 if there are none. False:
 * out of memory. */
bool grid_align(grid *g, uint32_t width, uint32_t *slots);

/* Kernel (1 - d^2 / r^2) of a sample at p with normal n for a point at q; 0 outside. */
float zones_kernel(const zones *z, vec3 p, vec3 n, vec3 q);
/* Photons are stored on the triangle: it is no mirror and no glass. */
bool zones_lands(const zones *z, uint32_t triangle);
/* A key that is equal for places in one box, `edge` metres wide and a quarter of it deep, that face alike (6 directions). Never
 * 0. */
uint64_t zones_key(vec3 p, vec3 n, float edge);

/* zones.c: what the camera sees. zones/surface.c: patches, photons, open points. zones/sight.c: receivers and pairs.
 * zones/colour.c: patches' zones and receivers' accepts. zones/area.c: effective areas. False: out of memory. */
bool zones_patches(zones *z, vit_text *why);
bool zones_pairs(zones *z);
bool zones_colour(zones *z);
bool zones_areas(zones *z);

#endif
