/* The stages of a bake, in the order in which pipeline.c calls them, and what they share. Private to bake/pack. */
#ifndef VIT_PACK_STAGES_H
#define VIT_PACK_STAGES_H

#include "pack/bounds.h"
#include "pack/pipeline.h"

/* A pack on its way. */
typedef struct bake {
    pipeline *p;
    const pipeline_choice *choice;
    scene scene; /* the pipeline's with the choice's quality and size; borrows its lists */
    pipeline_packed *out;
    bounds_input bounds; /* of `out` */
    bool again;          /* photons are to be traced again for what has just changed */
} bake;

/* Of the scene alone, once: stages_scene.c. */
vit_status stage_import(pipeline *p, vit_text *why);
vit_status stage_tracks(pipeline *p, vit_text *why);
vit_status stage_area_light_planes(pipeline *p, vit_text *why);
vit_status stage_glass_inset(pipeline *p, vit_text *why);
vit_status stage_shape(pipeline *p, vit_text *why);
vit_status stage_light_places(pipeline *p, vit_text *why);
vit_status stage_atlas(pipeline *p, vit_text *why);
vit_status stage_sky(pipeline *p, vit_text *why);

/* Of one pack. stages_scene.c: the shape in fewer bits. */
vit_status stage_choose_shape(bake *b, vit_text *why);
/* stages_light.c. */
vit_status stage_plan(bake *b, vit_text *why);
vit_status stage_guiding(bake *b, vit_text *why);
vit_status stage_area_lights(bake *b, vit_text *why);
vit_status stage_photons(bake *b, vit_text *why);
vit_status stage_radius(bake *b, vit_text *why);
vit_status stage_zones(bake *b, vit_text *why);
/* stages_indirect.c. */
vit_status stage_indirect(bake *b, vit_text *why);
/* stages_cache.c. */
vit_status stage_cache(bake *b, vit_text *why);
/* stages_lightmap.c. */
vit_status stage_lightmap(bake *b, vit_text *why);
/* stages_bounds.c. */
vit_status stage_frames(bake *b, vit_text *why);
vit_status stage_bounds(bake *b, vit_text *why);
vit_status stage_assemble(bake *b, vit_text *why);

/* What rays of the baker meet: the pack's triangles, materials and textures. */
photon_scene stages_scene(const bake *b);
/* The sky as a source of light for photons and receivers. */
photons_light stages_sky_source(const pipeline *p, const pipeline_packed *out);
/* Points out->sections and b->bounds at what there is by now. */
void stages_point(bake *b);
vit_status out_of_memory(vit_text *why);
void stages_step(void *user, double fraction); /* user: a progress */

#endif
