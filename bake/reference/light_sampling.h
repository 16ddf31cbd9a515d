/* light_sampling.c: surfaces and a sky that light the scene: points on them, directions to them, and with which density these
 * are drawn, so that light found by looking for it and light found by chance can be weighed against each other (multiple
 * importance sampling, Veach and Guibas 1995, with the balance heuristic). */
#ifndef VIT_COST_WIDE_LIGHTS_H
#define VIT_COST_WIDE_LIGHTS_H

#include "light/photon_rays.h"

typedef struct light_sampler {
    const photon_scene *scene;
    const float *background; /* W/(m2 sr) */
    /* Area lights: triangles, the sum of area times luminance up to each one's end, and for all of the scene's triangles the
     * density of points, 1/m2. NULL: none. */
    uint32_t *triangles;
    double *ends, *density;
    uint32_t count;
    /* The sky's picture; NULL: it is the background. With sky_lights it lights the scene, and has sums of texels' shares up to
     * each one's end, row by row, and of the rows. */
    const vit_sky_texel *sky;
    uint32_t sky_size;
    bool sky_lights;
    double *sky_rows, *sky_texels;
} light_sampler;

/* `sky`: section SKYT. False: out of memory; there is nothing to close. The scene's records are used in place. */
bool light_sampler_open(const vit_scene *meta, const photon_scene *s, const vit_sky_texel *sky, light_sampler *out);
void light_sampler_close(light_sampler *e);

/* Radiance of the sky in the unit direction d, W/(m2 sr). */
void light_sampler_sky(const light_sampler *e, vec3 d, double radiance[3]);
/* Does the triangle light others? */
bool light_sampler_has(const light_sampler *e, uint32_t triangle);

/* What a place sees of a light: radiance from the unit direction `to`, whose density among the directions drawn is 1/sr. */
typedef struct light_sampler_point {
    vec3 to;
    float distance; /* m, of a shadow ray */
    double radiance[3];
    double density;
} light_sampler_point;

/* A point of the area lights as seen from p; u, v: 0..1. False: it is cut out there. */
bool light_sampler_area_point(const light_sampler *e, vec3 p, double u, double v, light_sampler_point *out);
/* A direction to the sky. False: the sky has no picture, or a black one; chance finds a constant sky soon enough. */
bool light_sampler_sky_point(const light_sampler *e, double u, double v, light_sampler_point *out);
/* Density of a direction that found the triangle `distance` metres away, or the sky: 0 if it is not drawn. */
double light_sampler_area_density(const light_sampler *e, uint32_t triangle, vec3 d, float distance);
double light_sampler_sky_density(const light_sampler *e, vec3 d);

#endif
