/* pipeline.c: from a scene to a pack. pipeline_load() makes what does not depend on the quality block, once; pipeline_pack()
 * makes a pack of it for one quality block, size and list of frames, as often as needed. */
#ifndef VIT_BAKE_PIPELINE_H
#define VIT_BAKE_PIPELINE_H

#include "cache/occlusion.h"
#include "geometry/atlas.h"
#include "geometry/bvh.h"
#include "light/photon_guiding.h"
#include "pack/pack_write.h"
#include "pack/planner.h"
#include "radiosity/kept.h"
#include "radiosity/lightmap.h"
#include "radiosity/live.h"
#include "common/progress.h"
#include "geometry/quantise.h"
#include "dark_sides/dark_sides.h"
#include "light/sky.h"
#include "motion/tracks.h"
#include "zones/kept.h"

/* Guides, and what they depend on besides the scene. */
typedef struct pipeline_guiding {
    photon_guiding guiding;
    uint32_t width, height, bounces;
    uint64_t effects;
} pipeline_guiding;

/* Zero, then set `scene` (pipeline_read) and the fields up to `progress`. */
typedef struct pipeline {
    scene scene;
    bool strict;      /* a missing texture is an error */
    bool all_formats; /* golden hashes of RGB565 and RGBA32F frames too */
    unsigned threads; /* 0: all cores; changes no byte */
    uint32_t
        device; /* measures bounds and hashes, as in vit_open_info; changes no byte. VIT_DEVICE_HOST has nothing to compile */
    progress *progress;
    model model;   /* made by pipeline_load() from here on */
    tracks tracks; /* at the scene's own size */
    bvh bvh;
    geometry geometry;
    dark_sides dark_sides;
    atlas atlas;
    environment sky;
    zones_kept *kept;
    baked_kept *kept_baked;
    lightmap_kept kept_lightmap;
    pipeline_guiding guided;     /* of the last pack that guides photons */
    char indirect_why[PLAN_WHY]; /* why scene.quality.indirect is what it is; empty: it is stated */
} pipeline;

typedef struct pipeline_choice {
    scene_quality quality;
    int width, height;      /* pixels */
    const uint32_t *frames; /* frames of the scene's path to bake, ascending; NULL: all */
    uint32_t frame_count;
} pipeline_choice;

/* What follows from the triangles alone. */
typedef struct pipeline_shape {
    model model;
    bvh bvh;
    geometry geometry;
    dark_sides dark_sides;
} pipeline_shape;

/* A pack and what it was made of. */
typedef struct pipeline_packed {
    pipeline_shape coarse; /* with vertices in fewer bits; else empty */
    const model *model;    /* the shape that was packed: the pipeline's, or `coarse` */
    const bvh *bvh;
    const geometry *geometry;
    const dark_sides *dark_sides;
    plan plan;
    tracks tracks; /* of the frames that were chosen */
    cells cells;   /* zones and effective areas; none without them */
    zones_found zones;
    lightmap lightmap;             /* none without the effect LIGHTMAP */
    baked baked;                   /* indirect light; none without the effects BASIS and RADIOSITY */
    live live;                     /* none without the effect RADIOSITY */
    occlusion occlusion;           /* none without the effect OCCLUSION */
    const photon_guiding *guiding; /* the pipeline's; NULL: photons are not guided */
    double guided_gain;            /* how many even paths a guided one stands for, where paths are worth something */
    vit_light_sample *area_lights; /* section EMIT */
    vit_photon *photons;
    uint32_t *met; /* a word per material: 1 where baked photons met it */
    vit_gold *gold;
    pack_sections sections; /* point into this struct and into the pipeline: neither may move or end before */
    double seconds;         /* that it took, or would have taken had nothing been kept of packs before */
    void *bytes;            /* the pack */
    size_t size;
} pipeline_packed;

/* Reads a scene file (.cfg), or makes a scene for a bare mesh. VIT_BAD_INPUT: also if a mesh or sky that it names is not there.
 * On failure nothing is left to free. */
vit_status pipeline_read(const char *path, scene *out, vit_text *why);
vit_status pipeline_load(pipeline *p, vit_text *why);
void pipeline_free(pipeline *p);

/* Puts who makes indirect light instead of "auto" into scene.quality, where there is any (indirect_maker.h), and says why.
 * Where it is not photons, further reflections cost a frame nothing: all count unless the scene states `bounces`. */
vit_status pipeline_settle_indirect(pipeline *p, vit_text *why);

/* What the scene itself says. */
pipeline_choice pipeline_default(const pipeline *p);
/* A chosen frame has the bits that it has in the pack of all frames. On failure nothing is left to free. */
vit_status pipeline_pack(pipeline *p, const pipeline_choice *choice, pipeline_packed *out, vit_text *why);
void pipeline_packed_free(pipeline_packed *packed);

#endif
