/* photon_emission.c: how photons leave lights, and the other way round: which of a light's numbers send a photon to a place. */
#ifndef VIT_BAKE_PHOTON_EMISSION_H
#define VIT_BAKE_PHOTON_EMISSION_H

#include "light/area_lights.h"
#include "light/photon_rays.h"
#include "light/sky.h"

#define PHOTONS_MAX_PATHS (1u << 20) /* of one light: the emission's integer arithmetic */

/* A light, or all area lights together, or the sky. */
typedef struct photons_light {
    vit_light light;         /* its record, the same in all frames; path_first and path_count do not count */
    uint32_t paths;          /* 1..PHOTONS_MAX_PATHS; 0: none */
    const area_lights *area; /* not NULL: the area lights, and `light` does not count */
    const environment *sky;  /* not NULL: the sky; of `light` position and spot_scale count: middle and radius, m, of a sphere
                        round the scene */
    const struct guiding_tree *guide; /* where its paths start and how they first reflect (guiding_tree.h); NULL: evenly */
    vec3 around; /* of the sky, guided: the place that positions across its directions are counted from, so that a window is in
                    one place from all of them */
} photons_light;

/* A photon as it leaves a light. */
typedef struct emission {
    vec3 origin, direction, power; /* W */
    float bounce[2];               /* guided: the numbers of its first hit */
} emission;

/* Path i of the light; `number`: the path's number among all lights'. */
emission photon_leave(const photon_rays *rays, const photons_light *l, uint32_t i, uint32_t number);
/* How many numbers in [0, 1) choose a path's start: 2, or 4 where a place and a direction are both to be chosen. */
uint32_t photon_emission_numbers(const photons_light *l);

/* Light that comes straight to a place, and the numbers by which photon_leave() sends photons that way. */
typedef struct arrival {
    vec3 direction;  /* unit, to the light */
    vec3 irradiance; /* W/m2 of a surface that faces it, if nothing is between; 0: there is none */
    float distance;  /* m */
    float at[4];
} arrival;

/* x, y: random numbers that choose a place of area lights, a direction to the sky. */
arrival photon_arrival(const photon_rays *rays, const photons_light *l, vec3 p, double x, double y);

/* The numbers by which vec3_cosine() gives the unit direction d. */
void photon_cosine_numbers(vec3 n, vec3 d, float *a, float *b);

#endif
