/* bounds.c: runs the whole path on a device and measures what no frame exceeds. Since frames have the same bits on every
 * device, so have the measured bounds. */
#ifndef VIT_BAKE_BOUNDS_H
#define VIT_BAKE_BOUNDS_H

#include "pack/effects.h"
#include "pack/pack_write.h"

typedef void bounds_progress_fn(void *user, const char *stage, double fraction);

typedef struct bounds_input {
    pack_sections *sections;  /* META is `scene`; GOLD is written by the runs */
    vit_scene *scene;         /* slices and bounds are filled in */
    vit_gold *gold;           /* scene->frames records, filled in */
    effects_reached *reached; /* EFFECTS_RECORDS(scene->materials) zeroed records, filled in; NULL: not asked for */
    uint32_t *looked_up;      /* frames x receivers / 32 words, filled in: bits of receivers; NULL: not asked for */
    uint32_t device, threads; /* as in vit_open_info */
    int all_formats;          /* golden hashes of RGB565 and RGBA32F too: two more runs */
    bounds_progress_fn *progress;
    void *user;
} bounds_input;

/* Photons that a frame stores, baked ones included: the mean of a few frames over the path. Needs no bounds. */
vit_status bounds_count_photons(bounds_input *in, double *stored, vit_text *why);

/* First a run without light finds the depth slices in use; then runs with generous bounds, raised until nothing overflows, find
 * the largest hierarchy and lists, and the golden hashes and counts. */
vit_status bounds_measure(bounds_input *in, vit_text *why);

#endif
