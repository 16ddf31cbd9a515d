/* sweep.c: what each setting of a scene costs and how near it comes to the reference. */
#ifndef VIT_COST_SWEEP_H
#define VIT_COST_SWEEP_H

#include "pack/pipeline.h"
#include "report/results.h"
#include <signal.h>

#define SWEEP_FRAMES 7    /* frames of the path that are played, evenly spread, the compared one among them */
#define SWEEP_SETTINGS 96 /* what the tools take if nothing is said: settings, frames timed, paths per pixel */
#define SWEEP_REPEATS 14
#define SWEEP_SAMPLES 4096
#define SWEEP_LEAST_REPEATS 7
#define SWEEP_GRID 60000 /* grid points, at most, if `every` is left open */

struct knob_list;
/* Fills the empty *out; `base`: the scene's own quality block, radius: what it has in the end if it is "auto", m. The first
 * setting is what the others' times are scaled by. On failure nothing is left to close. */
typedef vit_status sweep_list_fn(const void *user, const scene_quality *base, double radius, struct knob_list *out,
                                 vit_text *why);

typedef struct sweep_input {
    pipeline *pipeline;     /* loaded; its device and threads make packs, pictures and counts */
    uint32_t device;        /* that times are measured on */
    const char *knobs;      /* names with commas between; NULL: all */
    uint32_t settings;      /* at most, the default included; >= 1 */
    int64_t frame;          /* of the scene's path, compared with the reference; < 0: the middle one */
    uint32_t every;         /* the grid's spacing, pixels; 0: so that it has at most SWEEP_GRID points */
    uint32_t repeats;       /* frames timed a setting, >= SWEEP_LEAST_REPEATS; 0: times are not measured */
    double reference_error; /* NMSE that the reference's standard error must fall below; 0: a tenth of the smallest error found;
                               a quarter to choose by NMSE */
    uint32_t max_samples;   /* of the reference, paths per pixel */
    const char *cache;      /* reference_input.cache */
    uint32_t frames;        /* of the path that are played, 1 .. SWEEP_FRAMES; 0: SWEEP_FRAMES */
    sweep_list_fn *list;    /* makes the settings; NULL: from the knobs, and by searching */
    const void *list_user;
    double fit_ms;   /* > 0: only what could be the most accurate setting within so many ms is timed; 0: all */
    bool to_choose;  /* for fit_choose() alone: no settings but those that a quality block can hold */
    bool relmse;     /* accurate by total.relmse */
    uint32_t timed;  /* the first so many settings are timed; 0: all */
    bool normals;    /* fills out->normals: a second reference is made */
    uint64_t memory; /* bytes that the packs, and the buffers of what is open at once, may take; 2 settings in any case */
    const volatile sig_atomic_t *cancel;
} sweep_input;

/* Packs every setting, compares it with the reference (all ranks of an MPI run make that one together), counts its work, and
 * times all in turns. Settings that differ in lanes alone must have the default's bits. Under MPI only rank 0 gets settings;
 * the others return VIT_OK with out->count == 0 as soon as the reference is good, and rank 0 times alone: spread_end() has been
 * called by then. VIT_MISMATCH: bits differ that must not. VIT_USAGE: a knob, the frame or `every`. VIT_FAILED: also when
 * cancelled. */
vit_status sweep_run(const sweep_input *in, cost_results *out, vit_text *why);
void sweep_free(cost_results *r);

/* The quality block of a setting. */
vit_status sweep_quality(const cost_setting *s, scene_quality *out, vit_text *why);

#endif
