/* reference.c: what a frame should look like: a path tracer on Embree with the runtime's camera, lights, materials and geometry.
 *
 * One camera ray a pixel, through its centre, as the runtime's, so that all that differs is the light. Direct light is computed
 * exactly (point and spot lights cast hard shadows); indirect light by paths with a shadow ray to every light at every hit. The
 * first hit's irradiance is about its shading normal; all reflections are about geometric normals, as photons reflect.
 * Radiance times the camera's exposure, as in RGBA32F frames; sums in double. */
#ifndef VIT_COST_REFERENCE_H
#define VIT_COST_REFERENCE_H

#include "pack_write.h"

typedef struct reference_input {
    const pack_sections *sections; /* META, CAMS, LITE, GEOM, ATTR, MATL, TEXR, MIPS, ATLS are read */
    uint32_t frame;
    uint32_t every;            /* pixels (every * i + every / 2, every * j + every / 2) of the frame; 1: all */
    uint32_t bounces;          /* hits of the limited paths: up to bounces - 1 reflections, as vit_scene.bounces */
    double target;             /* stop when the standard error's NMSE (mean variance / squared mean of the total) is below this, > 0 */
    uint32_t max_samples;      /* and at so many paths a pixel in any case */
    unsigned threads;          /* 0: all cores; changes no bit, nor does the number of MPI ranks */
    const char *cache;         /* folder for finished and unfinished references, NULL: none */
    void (*progress)(void *user, double fraction, double seconds_left);
    void *user;
} reference_input;

/* Images: 3 doubles (red, green, blue) a pixel of the grid, row by row from the top. */
typedef struct reference {
    uint32_t width, height;    /* of the grid */
    uint32_t samples;          /* paths a pixel */
    double *direct;            /* emission and background included */
    double *limited;           /* indirect light of at most bounces - 1 reflections */
    double *unlimited;         /* indirect light of all reflections (ended by Russian roulette) */
    double *limited_variance;  /* of the mean */
    double *unlimited_variance;
    double error;              /* NMSE of direct + limited's standard error */
    double seconds;            /* that the paths took on this machine, cached or not */
    uint64_t rays;
} reference;

/* VIT_FAILED: out of memory, Embree fails, the cache cannot be written. All ranks of an MPI run call it and all get the result. */
vit_status reference_render(const reference_input *in, reference *out, vit_text *why);
void reference_free(reference *r);

#endif
