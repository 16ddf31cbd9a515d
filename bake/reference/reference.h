/* reference.c: what a frame should look like: a path tracer on Embree with the runtime's camera, lights, materials and
 * geometry.
 *
 * One camera ray a pixel, through its centre, as the runtime's, so that all that differs is the light; in a pack with several
 * copies a pixel rays of the whole filter. Mirrors and glass on their way, and on that of light, are followed to the end.
 * Direct light of points, spots and directions is computed exactly (they cast hard shadows), that of surfaces and the sky as
 * paths find it; indirect light by paths with a shadow ray to every light at every hit. The first hit's irradiance is about its
 * shading normal, from the front of its geometric side; all reflections are about geometric normals, as photons reflect, but
 * mirrors' and glass's. Phong lobes reflect all light by their BRDF. Ambient light is added at view samples. Dark sides
 * (dark_sides.h) are an approximation of the runtime's and are not made; nor is a view sample's albedo or normal rounded.
 * Radiance times the camera's exposure, as in RGBA32F frames; sums in double. Method and sources: bake/reference/README.md. */
#ifndef VIT_COST_REFERENCE_H
#define VIT_COST_REFERENCE_H

#include "pack/pack_write.h"
#include <signal.h>
#include <stdbool.h>

typedef struct reference_input {
    const pack_sections *sections; /* META, CAMS, LITE, GEOM, ATTR, MATL, MAPS, TEXR, MIPS, ATLS are read */
    const bool
        *direct_only; /* a light: it gives no indirect light (`photons = false` in the scene file), which records do not tell:
                       * vit_light.path_count is 0 for baked lights too. META.lights flags; NULL: all lights give it */
    uint32_t frame;
    uint32_t every;   /* pixels (every * i + every / 2, every * j + every / 2) of the frame; 1: all */
    uint32_t bounces; /* hits of the limited paths: up to bounces - 1 reflections, as vit_scene.bounces */
    double target;    /* stop when the standard error's NMSE (mean variance / squared mean of the total) is below this, > 0 */
    uint32_t max_samples; /* and at so many paths per pixel in any case; whole rounds, 1 .. REFERENCE_MOST */
    bool face_normals; /* the first hit's irradiance, but that of small lights' direct light, is about its geometric normal too,
                        * as photons count it; independent random numbers, so that the two pictures' errors are */
    unsigned threads;  /* 0: all cores, shared with the ranks on this machine; changes no bit, nor does the number of ranks */
    const char *cache; /* folder for finished and unfinished references, NULL: none. One there may have more samples */
    const volatile sig_atomic_t *cancel; /* a signal handler sets it: the work is saved and VIT_FAILED returned; may be NULL */
    void (*progress)(void *user, double fraction, double seconds_left); /* by the thread that called; may be NULL */
    void *user;
} reference_input;

/* A pixel has so many low-discrepancy sequences, independent of each other: variance is that between their means, with one
 * degree of freedom less. Each round adds a few paths to each. */
#define REFERENCE_SEQUENCES 4u
#define REFERENCE_ROUND 16u       /* paths per pixel and round */
#define REFERENCE_MOST (1u << 18) /* paths per pixel, at most */

typedef struct reference {
    uint32_t width, height;  /* of the grid */
    uint32_t samples;        /* paths per pixel */
    double *direct;          /* emission, background and ambient light included */
    double *limited;         /* indirect light of at most bounces - 1 reflections */
    double *unlimited;       /* indirect light of all reflections (ended by Russian roulette) */
    double *direct_variance; /* of the mean; 0 where nothing of it is left to chance */
    double *limited_variance;
    double *unlimited_variance;
    double error;   /* NMSE of direct + limited's standard error */
    double seconds; /* that the paths took on this machine, cached or not */
    uint64_t rays;
} reference;

/* VIT_BAD_INPUT: the frame, grid or limits are out of range. VIT_FAILED: out of memory, Embree fails, the cache cannot be
 * written, cancelled. All ranks of an MPI run (spread.h) call it with the same input and all get the result. */
vit_status reference_render(const reference_input *in, reference *out, vit_text *why);
void reference_free(reference *r);

/* reference_time.c: how long the same path tracer takes for one path a pixel of the whole frame (camera ray, direct light, one
 * limited path), on all `threads` of this rank alone, so that the error of a time can be compared with the runtime's. Open it
 * once and take frames in turn with what it is compared with; each has random numbers of its own. */
typedef struct reference_timer reference_timer;
typedef struct reference_timing {
    double ms;           /* of a frame, scene building not included */
    double nmse, relmse; /* of direct + limited at one path a pixel, against `truth`, on its grid; they fall as 1 / paths */
    uint64_t rays;       /* of that frame */
} reference_timing;

/* `truth`: of the same input; both must stay until reference_timer_close(). */
vit_status reference_timer_open(const reference_input *in, const reference *truth, reference_timer **out, vit_text *why);
reference_timing reference_timer_frame(reference_timer *t);
void reference_timer_close(reference_timer *t);
/* All in one: the median of `frames` frames' times and rays, the means of their errors. */
vit_status reference_time(const reference_input *in, const reference *truth, uint32_t frames, reference_timing *out,
                          vit_text *why);

#endif
