/* reference.c: what a frame should look like: a path tracer on Embree with the runtime's camera, lights, materials and
 * geometry.
 *
 * One camera ray a pixel, through its centre, as the runtime's, so that all that differs is the light. Direct light is computed
 * exactly (point and spot lights cast hard shadows); indirect light by paths with a shadow ray to every light at every hit. The
 * first hit's irradiance is about its shading normal, from the front of its geometric side; all reflections are about geometric
 * normals, as photons reflect. Surfaces that emit and the background are seen but light nothing. Dark sides (reach.h) are an
 * approximation of the runtime's and are not made; nor is a view sample's albedo or normal rounded.
 * Radiance times the camera's exposure, as in RGBA32F frames; sums in double. Method and sources: bake/cost/README.md. */
#ifndef VIT_COST_REFERENCE_H
#define VIT_COST_REFERENCE_H

#include "pack_write.h"
#include <signal.h>
#include <stdbool.h>

typedef struct reference_input {
    const pack_sections *sections; /* META, CAMS, LITE, GEOM, ATTR, MATL, TEXR, MIPS, ATLS are read */
    const bool
        *direct_only; /* a light: it gives no indirect light (`photons = false` in the scene file), which records do not tell:
                       * vit_light.path_count is 0 for baked lights too. META.lights flags; NULL: all lights give it */
    uint32_t frame;
    uint32_t every;   /* pixels (every * i + every / 2, every * j + every / 2) of the frame; 1: all */
    uint32_t bounces; /* hits of the limited paths: up to bounces - 1 reflections, as vit_scene.bounces */
    double target;    /* stop when the standard error's NMSE (mean variance / squared mean of the total) is below this, > 0 */
    uint32_t max_samples; /* and at so many paths a pixel in any case (at least REFERENCE_MIN_SAMPLES; rounded up to batches) */
    unsigned threads;  /* 0: all cores, shared with the ranks on this machine; changes no bit, nor does the number of ranks */
    const char *cache; /* folder for finished and unfinished references, NULL: none. One there may have more samples */
    const volatile sig_atomic_t *cancel; /* a signal handler sets it: the work is saved and VIT_FAILED returned; may be NULL */
    void (*progress)(void *user, double fraction, double seconds_left); /* by the thread that called; may be NULL */
    void *user;
} reference_input;

#define REFERENCE_BATCH 16u /* paths of a batch: they share one low-discrepancy set; variance is that between batches */
#define REFERENCE_MIN_SAMPLES 32u

/* Images: 3 doubles (red, green, blue) a pixel of the grid, row by row from the top. */
typedef struct reference {
    uint32_t width, height;   /* of the grid */
    uint32_t samples;         /* paths a pixel */
    double *direct;           /* emission and background included */
    double *limited;          /* indirect light of at most bounces - 1 reflections */
    double *unlimited;        /* indirect light of all reflections (ended by Russian roulette) */
    double *limited_variance; /* of the mean */
    double *unlimited_variance;
    double error;   /* NMSE of direct + limited's standard error */
    double seconds; /* that the paths took on this machine, cached or not */
    uint64_t rays;
} reference;

/* VIT_BAD_INPUT: the frame, grid or limits are out of range. VIT_FAILED: out of memory, Embree fails, the cache cannot be
 * written, cancelled. All ranks of an MPI run (spread.h) call it with the same input and all get the result. */
vit_status reference_render(const reference_input *in, reference *out, vit_text *why);
void reference_free(reference *r);

#endif
