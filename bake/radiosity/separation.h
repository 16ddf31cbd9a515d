/* separation.c: a plane between the places of a flat cell that something standing on it hides from each other, as a thin wall
 * on a floor that goes on beneath it. Light must not be averaged across such a plane. */
#ifndef VIT_RADIOSITY_SEPARATION_H
#define VIT_RADIOSITY_SEPARATION_H

#include "geometry/cells.h"
#include "light/photon_rays.h"

#define SEPARATION_PLACES 19u /* of a cell that look at each other */

typedef struct separation {
    float normal[3], offset; /* places p with normal . p > offset are in front */
    uint32_t places;         /* bits: places of the cell in front */
    uint32_t alone;          /* bits: places that no other place sees, as inside of what stands there */
} separation;

/* Place i of a cell, 0 <= i < SEPARATION_PLACES, even over it: barycentric weights in its triangle. */
void separation_place(const cell_corners *k, uint32_t i, float *b1, float *b2);
/* False: all places see each other, `lift` metres above the surface, or no plane explains why not; then all are in front. */
bool separation_find(const photon_rays *rays, const geometry *g, uint32_t side, const cell_corners *k, float lift,
                     separation *out);
/* Does a place see another? Both on sides of triangles, lifted along their faces. */
bool separation_sees(const photon_rays *rays, vec3 a, vec3 b);

static inline bool separation_front(const float normal[3], float offset, vec3 p) {
    return vec3_dot(vec3_load(normal), p) > offset;
}

#endif
