/* check.c: the baker looks at its own picture: some hundred pixels of a few frames of a pack, as the runtime plays them,
 * against the path-traced reference (reference/pixel_probes.h), which has light of all reflections. Nothing depends on time or
 * threads. */
#ifndef VIT_BAKE_CHECK_H
#define VIT_BAKE_CHECK_H

#include "reference/pixel_probes.h"
#include "pack/pipeline.h"

#define CHECK_FRAMES 4u   /* of the path, evenly */
#define CHECK_PIXELS 400u /* of all of them */
#define CHECK_LIMIT 0.05  /* more than that is worth a warning */

/* Pixels and what they should be. */
typedef struct check {
    uint32_t frames[CHECK_FRAMES], frame_count; /* of the scene's path, ascending */
    spot spots[CHECK_PIXELS];                   /* spot.frame: place in `frames` until check_trace() has another pack */
    uint32_t count, paths;                      /* paths per pixel that were traced */
    uint32_t bounces;                           /* of the limited reference */
} check;

/* A ratio, and the standard error that the reference leaves to it. */
typedef struct check_ratio {
    double value, error;
} check_ratio;

/* What a pack's picture is of the reference's. 1 where both are black. */
typedef struct check_found {
    check_ratio flux[3]; /* of all pixels, a channel */
    check_ratio dark;    /* of their darker half, all channels; of pixels that show surfaces in other light than their own */
    double direct, indirect; /* of all pixels, all channels: of each part alone; 1: not looked at */
    double limited;          /* what paths of the check's bounces find of all light, or of the darker half's if that is less */
    double worst;            /* largest distance of flux and dark from 1 beyond their errors */
    double black, white;     /* shares of pixels that show as black; of those that show surfaces, as white */
    double unlit;            /* share of pixels that get no light at all */
    double unhit;            /* share of pixels that show no surface */
    double median;           /* of the brightest channel, radiance times exposure */
} check_found;

/* Chooses frames and pixels of a scene of that size. */
void check_choose(uint32_t frames, uint32_t width, uint32_t height, check *out);
/* Traces the reference for `packed`: of all frames of the path, or of check.frames alone. */
vit_status check_trace(const pipeline *p, const pipeline_packed *packed, check *c, vit_text *why);
/* Plays the pack's frames on the device host and compares. `parts`: direct and indirect light alone, too. */
vit_status check_compare(const pipeline *p, const pipeline_packed *packed, const check *c, bool parts, check_found *out,
                         vit_text *why);

/* The same by a few paths: enough for a mean brightness. */
vit_status check_glance(const pipeline *p, const pipeline_packed *packed, check *c, vit_text *why);
/* The share of the light, and of the darker half's, whichever is less, that paths of so many bounces find: the same paths, a
 * few. */
vit_status check_share(const pipeline *p, const pipeline_packed *packed, const check *c, uint32_t bounces, double *share,
                       vit_text *why);

/* "flux 1.01 0.99 1.00, dark half 1.02". */
void check_text(const check_found *f, char *text, size_t room);
/* What would mend the picture, by the settings that made it. "": nothing that is known. */
void check_cure(const check_found *f, const scene_quality *q, const plan *p, char *text, size_t room);

/* All of it for a finished pack: says what it found in a line, or warns. */
vit_status check_pack(const pipeline *p, const pipeline_packed *packed, vit_text *why);
/* Warns of pictures that are black or white nearly everywhere. */
void check_exposure(const pipeline *p, const pipeline_packed *packed, const check *c, const check_found *f);

#endif
