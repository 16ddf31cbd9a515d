/* separation.c: a plane between the places of a flat cell that something standing on it hides from each other, as a thin wall
 * on a floor that goes on beneath it. Light must not be averaged across such a plane. */
#ifndef VIT_RADIOSITY_SEPARATION_H
#define VIT_RADIOSITY_SEPARATION_H

#include "geometry/cells.h"
#include "light/photon_rays.h"

#define SEPARATION_PLACES 19u /* of a cell that look at each other */
#define SEPARATION_EVERYWHERE ((1u << SEPARATION_PLACES) - 1u)
#define SEPARATION_LIFT 0.04f /* of a cell's edge: how far above the surface places look at each other */

typedef struct separation {
    float normal[3], offset; /* places p with normal . p > offset are in front */
    uint32_t places;         /* bits: places of the cell in front */
    uint32_t further[2];     /* of separations.found: what parts those in front, those behind, once more; VIT_NONE: nothing */
} separation;

/* A cell that is looked at. */
typedef struct separation_cell {
    uint32_t side;
    cell_corners corners;
    float lift; /* how far above the surface its places look at each other, m: separation_lift() */
} separation_cell;

typedef struct separations_input {
    const photon_rays *rays;
    const geometry *geometry;
    uint32_t count;                                                  /* of cells */
    bool (*cell)(void *user, uint32_t number, separation_cell *out); /* false: nothing stands on it */
    void *user;
    unsigned threads; /* 0: all cores; changes no byte */
} separations_input;

typedef struct separations {
    uint32_t *of; /* a cell: what parts it, of `found`; VIT_NONE: all its places see each other, or no plane explains why not */
    uint32_t *buried; /* a cell, bits: places inside of what stands there */
    uint32_t *alone;  /* a cell, bits: these, and places that no other sees */
    separation *found;
    uint32_t count; /* of found: those of cells first, then further ones */
} separations;

/* Place i of a cell, 0 <= i < SEPARATION_PLACES, even over it: barycentric weights in its triangle. */
void separation_place(const cell_corners *k, uint32_t i, float *b1, float *b2);
/* False: out of memory; there is nothing to free. */
bool separations_find(const separations_input *in, separations *out);
void separations_free(separations *s);
/* Does a place see another? Both on sides of triangles, lifted along their faces. */
bool separation_sees(const photon_rays *rays, vec3 a, vec3 b);

/* In front of what stands on the cell? True of every place where nothing does. */
static inline bool separations_front(const separations *s, uint32_t cell, vec3 p) {
    const separation *apart = s->of[cell] == VIT_NONE ? NULL : s->found + s->of[cell];
    return !apart || vec3_dot(vec3_load(apart->normal), p) > apart->offset;
}

#define SEPARATION_PARTS 4u

/* Which part of the cell the place is in, 0 <= part < SEPARATION_PARTS: the high bit says behind which plane, the low one
 * behind which further one. */
static inline uint32_t separations_part(const separations *s, uint32_t cell, vec3 p) {
    if (s->of[cell] == VIT_NONE)
        return 0;
    const separation *first = s->found + s->of[cell];
    const uint32_t behind = !(vec3_dot(vec3_load(first->normal), p) > first->offset);
    if (first->further[behind] == VIT_NONE)
        return 2 * behind;
    const separation *next = s->found + first->further[behind];
    return 2 * behind + !(vec3_dot(vec3_load(next->normal), p) > next->offset);
}

/* For cells of an edge in metres. m */
static inline float separation_lift(const photon_rays *rays, float edge) {
    return float_max(edge * SEPARATION_LIFT, 2.0f * rays->s->ray_offset);
}

#endif
