/* The stages of a bake in their order, once for the scene and once for each pack of it. A photon's disc depends on the radius
 * and its zone on the cell where it lands, and radius "auto" and zones on photons: these go round again after either. */
#include "common/file_trouble.h"
#include "common/fail.h"
#include "pack/stages.h"
#include <stdlib.h>
#include <string.h>

static vit_status (*const scene_stages[])(pipeline *p, vit_text *why) = {
    stage_import, stage_tracks, stage_area_light_planes, stage_glass_inset, stage_shape, stage_light_places,
    stage_atlas,  stage_sky,
};

static const struct {
    vit_status (*run)(bake *b, vit_text *why);
    bool again; /* only if the stage before asks for it */
} pack_stages[] = {
    {stage_choose_shape, false}, {stage_plan, false},     {stage_guiding, false},  {stage_area_lights, false},
    {stage_photons, false},      {stage_radius, false},   {stage_photons, true},   {stage_zones, false},
    {stage_photons, true},       {stage_indirect, false}, {stage_lightmap, false}, {stage_cache, false},
    {stage_frames, false},       {stage_bounds, false},   {stage_assemble, false},
};

vit_status out_of_memory(vit_text *why) {
    return bake_fail(why, VIT_FAILED, "out of memory");
}

void stages_step(void *user, double fraction) {
    progress_step(user, fraction);
}

static vit_status file_fails(const scene *s, int line, const char *what, const char *file, const char *trouble, vit_text *why) {
    return bake_fail_plain(why, VIT_BAD_INPUT, "%.200s:%d: %s '%.200s' %s", s->path, line, what, file, trouble);
}

/* What a scene file names can be opened: known before the first of it is imported. A missing texture is a matter of --strict.
 */
static vit_status files_are_there(const scene *s, vit_text *why) {
    for (int i = 0; i < s->mesh_count; i++) {
        const char *trouble = file_trouble(s->meshes[i].file);
        if (trouble)
            return file_fails(s, s->meshes[i].line, "mesh", s->meshes[i].file, trouble, why);
    }
    const char *trouble = s->sky.image[0] ? file_trouble(s->sky.image) : NULL;
    return trouble ? file_fails(s, s->sky.line, "sky", s->sky.image, trouble, why) : VIT_OK;
}

vit_status pipeline_read(const char *path, scene *out, vit_text *why) {
    const char *dot = strrchr(path, '.');
    if (!dot || strcmp(dot, ".cfg") != 0)
        return scene_for_mesh(path, out, why);
    vit_status status = scene_read(path, out, why);
    if (status == VIT_OK && (status = files_are_there(out, why)) != VIT_OK)
        scene_free(out);
    return status;
}

vit_status pipeline_load(pipeline *p, vit_text *why) {
    p->kept = calloc(1, sizeof *p->kept);
    p->kept_baked = calloc(1, sizeof *p->kept_baked);
    vit_status status = p->kept && p->kept_baked ? VIT_OK : out_of_memory(why);
    for (size_t i = 0; i < sizeof scene_stages / sizeof *scene_stages && status == VIT_OK; i++)
        status = scene_stages[i](p, why);
    return status;
}

void pipeline_free(pipeline *p) {
    if (p->kept)
        zones_kept_free(p->kept);
    free(p->kept);
    if (p->kept_baked)
        baked_kept_free(p->kept_baked);
    free(p->kept_baked);
    lightmap_kept_free(&p->kept_lightmap);
    photon_guiding_free(&p->guided.guiding);
    sky_free(&p->sky);
    atlas_free(&p->atlas);
    geometry_free(&p->geometry);
    bvh_free(&p->bvh);
    tracks_free(&p->tracks);
    model_free(&p->model);
    scene_free(&p->scene);
}

pipeline_choice pipeline_default(const pipeline *p) {
    return (pipeline_choice){.quality = p->scene.quality, .width = p->scene.width, .height = p->scene.height};
}

static vit_status settle_maker(pipeline *p, vit_text *why) {
    const pipeline_choice choice = pipeline_default(p);
    pipeline_packed packed = {0};
    bake b = {.p = p, .choice = &choice, .scene = p->scene, .out = &packed};
    if (p->scene.quality.indirect != INDIRECT_AUTO)
        return VIT_OK;
    vit_status status = tracks_evaluate(&b.scene, &p->model, &packed.tracks, why);
    if (status == VIT_OK)
        status = stage_choose_shape(&b, why);
    if (status == VIT_OK)
        status = stage_plan(&b, why);
    if (status == VIT_OK && packed.plan.scene.effects & VIT_BIT(INDIRECT)) {
        p->scene.quality.indirect = packed.plan.indirect;
        memcpy(p->indirect_why, packed.plan.indirect_why, sizeof p->indirect_why);
    }
    pipeline_packed_free(&packed);
    return status;
}

vit_status pipeline_settle_indirect(pipeline *p, vit_text *why) {
    const vit_status status = settle_maker(p, why);
    scene_quality *q = &p->scene.quality;
    if (q->indirect != INDIRECT_AUTO && q->indirect != INDIRECT_PHOTONS && !(p->scene.quality_kept & SETTING_BIT(bounces)))
        q->bounces = PLAN_ALL_BOUNCES;
    return status;
}

vit_status pipeline_pack(pipeline *p, const pipeline_choice *choice, pipeline_packed *out, vit_text *why) {
    bake b = {.p = p, .choice = choice, .scene = p->scene, .out = out};
    const double began = progress_now();
    memset(out, 0, sizeof *out);
    b.scene.quality = choice->quality;
    b.scene.width = choice->width;
    b.scene.height = choice->height;
    out->gold = calloc((size_t)b.scene.frames + 1, sizeof *out->gold);
    vit_status status = out->gold ? tracks_evaluate(&b.scene, &p->model, &out->tracks, why) : out_of_memory(why);
    for (size_t i = 0; i < sizeof pack_stages / sizeof *pack_stages && status == VIT_OK; i++) {
        if (pack_stages[i].again && !b.again)
            continue;
        b.again = false;
        status = pack_stages[i].run(&b, why);
    }
    progress_end(p->progress);
    out->seconds += progress_now() - began;
    if (status != VIT_OK)
        pipeline_packed_free(out);
    return status;
}

void pipeline_packed_free(pipeline_packed *packed) {
    free(packed->bytes);
    free(packed->gold);
    free(packed->photons);
    free(packed->met);
    free(packed->area_lights);
    cells_free(&packed->cells);
    lightmap_free(&packed->lightmap);
    baked_free(&packed->baked);
    live_free(&packed->live);
    occlusion_free(&packed->occlusion);
    plan_free(&packed->plan);
    geometry_free(&packed->coarse.geometry);
    bvh_free(&packed->coarse.bvh);
    model_quantise_free(&packed->coarse.model);
    tracks_free(&packed->tracks);
    memset(packed, 0, sizeof *packed);
}
