/* dark_sides.c: sides of triangles that light does not reach, directly or after any number of reflections: insides of walls,
 * touching faces. And, found with the same rays, how far light goes from side to side. */
#ifndef VIT_BAKE_REACH_H
#define VIT_BAKE_REACH_H

#include "geometry/bvh.h"
#include "motion/tracks.h"

/* A side is dark if its irradiance, averaged over the path, with surfaces that reflect DARK_SIDES_ALBEDO, stays below
 * DARK_SIDES_THRESHOLD of the mean over all sides, and, if a frame of the path sees it, below DARK_SIDES_VIEW of the brightest
 * light in that frame but for a tenth of it: a dim room is not dark if it fills the picture. Not zero: real models have cracks,
 * and through cracks a little light gets everywhere. */
#define DARK_SIDES_ALBEDO 0.8f
#define DARK_SIDES_THRESHOLD 1e-4f
#define DARK_SIDES_VIEW 1e-3f

typedef struct dark_sides {
    double area;                  /* m2, both sides of all triangles but those of mirrors and glass */
    double dark_front, dark_back; /* m2 of sides flagged dark */
    double free_path;             /* metres light goes from side to side, on average; 0: it finds none */
    uint32_t dark_sides;
    uint64_t rays;
    double seconds;
} dark_sides;

/* `done` runs from 0 to 1. Called by the thread that called dark_sides_find(). */
typedef void dark_sides_progress_fn(void *user, double done);

typedef struct dark_sides_input {
    const model *model;
    const tracks *tracks; /* lights of `frames` frames */
    uint32_t frames;
    bool sky_light;                   /* light comes from all round, too */
    unsigned threads;                 /* 0: all cores; changes no byte */
    dark_sides_progress_fn *progress; /* may be NULL */
    void *user;
} dark_sides_input;

/* Sets VIT_SIDE_DARK_FRONT and VIT_SIDE_DARK_BACK in g->attributes[].material for the lights of the frames, the model's area
 * lights and the sky. Without any light or matt surface nothing is flagged. VIT_FAILED: out of memory, or Embree fails. */
vit_status dark_sides_find(const dark_sides_input *in, geometry *g, dark_sides *out, vit_text *why);

#endif
