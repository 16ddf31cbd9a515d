/* lights_in_surfaces.c: lights of no extent that lie in a surface, where rounding decides which of its sides they light. */
#ifndef VIT_LIGHT_LIGHTS_IN_SURFACES_H
#define VIT_LIGHT_LIGHTS_IN_SURFACES_H

#include "geometry/triangle_rays.h"
#include "motion/tracks.h"

typedef struct light_in_surface {
    uint32_t frames; /* how many; 0: it lies in none */
    uint32_t first;  /* of them */
} light_in_surface;

/* Point and spot lights that shine, nearer than `ray_offset` metres to a triangle of `rays`; `frames` of the path. found: a
 * light each. */
void lights_in_surfaces(const tracks *t, uint32_t frames, const triangle_rays *rays, float ray_offset, light_in_surface *found);

#endif
