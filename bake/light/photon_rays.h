/* photon_rays.c: nearest and any hits as kernels/ray.clh finds them, holes of cut-out materials and all. */
#ifndef VIT_BAKE_PHOTON_RAYS_H
#define VIT_BAKE_PHOTON_RAYS_H

#include "light/photon_surface.h"
#include "geometry/triangle_rays.h"

typedef struct photon_rays {
    const photon_scene *s;
    triangle_rays rays;
    bool cutouts; /* materials have holes */
} photon_rays;

/* False: Embree fails; there is nothing to close. Triangles and attributes of `s` are used in place. */
bool photon_rays_open(const photon_scene *s, unsigned threads, photon_rays *out);
void photon_rays_close(photon_rays *r);
/* Nearest opaque hit: its triangle and the distance in metres along the unit direction; VIT_NONE if there is none. Any number
 * of threads at once. The answer is a function of ray and triangles alone: of equally near triangles it is the first. */
uint32_t photon_rays_nearest(const photon_rays *r, vec3 origin, vec3 direction, float *distance);
/* Is the place of `triangle` from which p was moved by ray_offset along the unit normal n covered by another face: one that
 * lies between the two, or in the same place and before it in the pack, so that this one is not seen there? */
bool photon_rays_covered(const photon_rays *r, uint32_t triangle, vec3 p, vec3 n);
/* Is there an opaque hit within `distance` metres along the unit direction? Any number of threads at once. */
bool photon_rays_occluded(const photon_rays *r, vec3 origin, vec3 direction, float distance);
/* The same; likely: as in triangle_rays_any_likely(). */
bool photon_rays_occluded_likely(const photon_rays *r, vec3 origin, vec3 direction, float distance, uint32_t *likely);

#endif
