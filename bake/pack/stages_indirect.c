/* The stage of baked indirect light: receivers and the basis of lights that move. */
#include "common/fail.h"
#include "light/panes.h"
#include "pack/stages.h"
#include <math.h>
#include <stdlib.h>

/* Sources that stay as they are, and lights that do not. */
static uint32_t sources(const bake *b, photons_light *still, uint32_t *moving, uint32_t *moving_count) {
    const pipeline_packed *out = b->out;
    uint32_t count = 0;
    *moving_count = 0;
    for (uint32_t i = 0; i < out->tracks.light_count; i++) {
        if (out->plan.baked_paths[i] == 0)
            continue;
        if (out->tracks.still[i])
            still[count++] = (photons_light){.light = out->tracks.lights[i]};
        else
            moving[(*moving_count)++] = i;
    }
    if (out->plan.area_paths > 0)
        still[count++] = (photons_light){.area = &out->plan.area};
    if (out->plan.sky_paths > 0)
        still[count++] = stages_sky_source(b->p, out);
    return count;
}

static photon_scene scene_of_pack(const bake *b) {
    const pipeline_packed *out = b->out;
    return (photon_scene){.triangles = out->geometry->triangles,
                          .attributes = out->geometry->attributes,
                          .triangle_count = out->model->triangles,
                          .materials = out->plan.materials,
                          .atlas = &b->p->atlas,
                          .ray_offset = out->geometry->ray_offset,
                          .box_pad = out->plan.scene.box_pad,
                          .effects = out->plan.scene.effects};
}

/* As baked_find(), with rays of its own. */
static vit_status find(const bake *b, const photon_scene *s, baked_input *in, vit_text *why) {
    const pipeline *p = b->p;
    photon_rays rays;
    if (!photon_rays_open(s, p->threads, &rays))
        return bake_fail(why, VIT_FAILED, "Embree fails");
    progress_stage(p->progress, "indirect light");
    in->rays = &rays;
    const double began = progress_now();
    const vit_status status = baked_find(in, &b->out->baked, why);
    b->out->baked.seconds = progress_now() - began;
    photon_rays_close(&rays);
    return status;
}

/* What was baked before, or what is found now and kept for the next pack. */
static vit_status find_or_get(const bake *b, const photon_scene *s, baked_input *in, vit_text *why) {
    const pipeline *p = b->p;
    pipeline_packed *out = b->out;
    const bool own = out->geometry == &p->geometry; /* triangles of another shape are not to be mixed up with these */
    const uint64_t effects = out->plan.scene.effects & ~VIT_BIT(SMALL_SAMPLES);
    if (own && baked_kept_get(p->kept_baked, in, effects, &out->baked))
        return VIT_OK;
    const vit_status status = find(b, s, in, why);
    if (status == VIT_OK && own)
        baked_kept_put(p->kept_baked, in, effects, &out->baked);
    return status;
}

vit_status stage_indirect(bake *b, vit_text *why) {
    const pipeline *p = b->p;
    pipeline_packed *out = b->out;
    vit_scene *c = &out->plan.scene;
    if (!(c->effects & VIT_BIT(BASIS)))
        return VIT_OK;
    photons_light *still = calloc(out->tracks.light_count + 2u, sizeof *still);
    uint32_t *moving = calloc(out->tracks.light_count + 1u, sizeof *moving);
    const photon_scene s = scene_of_pack(b);
    baked_input in = {.geometry = out->geometry,
                      .tracks = &out->tracks,
                      .frames = (uint32_t)b->scene.frames,
                      .width = c->width,
                      .height = c->height,
                      .still = still,
                      .moving = moving,
                      .size = (double)out->plan.sky_radius,
                      .reflections = out->plan.reflections,
                      .spacing = b->scene.quality.receiver_spacing,
                      .error = b->scene.quality.basis_error,
                      .receiver_rays = (uint32_t)b->scene.quality.receiver_rays,
                      .within = c->copies > 1,
                      .panes = b->scene.quality.caustics && panes_there(&s),
                      .threads = p->threads,
                      .progress = stages_step,
                      .user = p->progress};
    if (still && moving)
        in.still_count = sources(b, still, moving, &in.moving_count);
    const double began = progress_now();
    const vit_status status = still && moving ? find_or_get(b, &s, &in, why) : out_of_memory(why);
    out->seconds += fmax(out->baked.seconds - (progress_now() - began), 0);
    free(still);
    free(moving);
    if (status != VIT_OK)
        return status;
    c->receivers = out->baked.receivers.count;
    c->receiver_cells = out->baked.receivers.cell_count;
    c->receiver_splits = out->baked.receivers.split_count;
    c->basis_lights = out->baked.lights;
    c->basis_words = out->baked.basis.word_count;
    c->basis_coefficients = out->baked.basis.coefficient_count;
    return VIT_OK;
}
