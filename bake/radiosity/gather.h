/* gather.c: where a ray that looks for light ends: behind mirrors and glass, too. */
#ifndef VIT_RADIOSITY_GATHER_H
#define VIT_RADIOSITY_GATHER_H

#include "geometry/cells.h"
#include "light/photon_rays.h"

typedef struct gather_hit {
    uint32_t side; /* VIT_NONE: the sky, or lost between mirrors */
    float b1, b2;
    vec3 direction; /* of the last stretch */
    float weight;   /* what mirrors and glass on the way left, 0..1: mean of the channels */
} gather_hit;

/* photon_is_matt() of a triangle. */
bool gather_is_matt(const photon_scene *s, uint32_t triangle);

/* `chance`: a number whose bits decide between reflection and refraction. */
gather_hit gather(const photon_rays *rays, const geometry *g, vec3 origin, vec3 direction, uint32_t chance);

#endif
