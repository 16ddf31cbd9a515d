/* planner.c: which effects the scene calls for, who gets how many photon paths, and the pack's constants. */
#ifndef VIT_BAKE_PLANNER_H
#define VIT_BAKE_PLANNER_H

#include "geometry/atlas.h"
#include "geometry/bvh.h"
#include "light/area_lights.h"
#include "pack/effects.h"
#include "dark_sides/dark_sides.h"
#include "light/sky.h"
#include "motion/tracks.h"

#define PLAN_WHY 320
#define PLAN_ALL_BOUNCES                                                                                                       \
    32u /* quality.bounces that stands for all reflections where light is baked: they cost next to nothing */

typedef struct plan {
    vit_scene scene;                 /* META but for slices and bounds, which bounds.c measures */
    vit_material *materials;         /* model.material_count records */
    vit_maps *maps;                  /* the same */
    uint32_t *baked_paths;           /* a light: paths to bake (still lights), 0 for the others */
    area_lights area;                /* area lights: of these materials, of the geometry and atlas that the plan was made for */
    uint32_t area_paths, sky_paths;  /* of all area lights and of the sky, to bake: they are still */
    float sky_center[3], sky_radius; /* of a sphere round the scene, m */
    double lit_area;                 /* m2 of sides that light can reach */
    double free_path;                /* dark_sides.free_path, m */
    int indirect;                    /* INDIRECT_* that makes indirect light, not AUTO */
    char indirect_why[PLAN_WHY];     /* "auto": why that one; else empty */
    bool lightmap;                   /* the sky's and area lights' matt light is to be baked */
    char lightmap_why[PLAN_WHY];     /* "auto": why it is by rays all the same; else empty */
    uint32_t reflections;            /* of baked indirect light, at most; 0: as many as there are */
    effects_decided effects;
} plan;

typedef struct plan_input {
    const scene *scene;
    const model *model;
    tracks *tracks; /* path_first and path_count of its lights are set */
    const atlas *atlas;
    const bvh *bvh;
    const geometry *geometry;
    const dark_sides *dark_sides;
    const environment *sky;
    unsigned threads; /* 0: all cores; changes no byte */
} plan_input;

/* Photon paths are shared among the lights, the area lights together and the sky in proportion to their mean power, in
 * multiples of 16 (a packet of paths has one light), at least 16 each. */
vit_status plan_make(const plan_input *in, plan *out, vit_text *why);
void plan_free(plan *p);
/* Shares the paths anew by what each of the tracks' lights, all area lights and the sky are worth (photon_guiding.h); sum 1. Of
 * the input scene, tracks, dark_sides and sky count. */
vit_status plan_share(const plan_input *in, const double *worth, plan *p, vit_text *why);

/* What radius "auto" is, m, if a frame stores so many photons (> 0). Until that has been measured the plan assumes all slots.
 */
double plan_radius(const plan *p, double stored);

/* A cluster's buckets hold photons of all zones that any of its samples accepts, a sample's area is that of its own zones:
 * divided by one another they are no irradiance. So quality.effective_area does nothing with both. */
bool plan_leaves_area_out(const scene_quality *q);

#endif
