/* The stage of indirect light at baked places: receivers, and a basis or live radiosity for lights that move. */
#include "common/fail.h"
#include "light/panes.h"
#include "pack/stages.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ALL_REFLECTIONS 1024.0 /* as many times direct light as all of them together can be: transfer_matrix_make() */

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

photon_scene stages_scene(const bake *b) {
    const pipeline_packed *out = b->out;
    return (photon_scene){.triangles = out->geometry->triangles,
                          .attributes = out->geometry->attributes,
                          .triangle_count = out->model->triangles,
                          .materials = out->plan.materials,
                          .maps = VIT_HAS_MAPS(out->plan.scene.effects) ? out->plan.maps : NULL,
                          .atlas = &b->p->atlas,
                          .ray_offset = out->geometry->ray_offset,
                          .box_pad = out->plan.scene.box_pad,
                          .effects = out->plan.scene.effects};
}

/* As baked_find(), with rays of its own. */
static vit_status find(const bake *b, const photon_scene *s, const baked_input *input, vit_text *why) {
    const pipeline *p = b->p;
    photon_rays rays;
    if (!photon_rays_open(s, p->threads, &rays))
        return bake_fail(why, VIT_FAILED, "Embree fails");
    progress_stage(p->progress, "indirect light");
    baked_input in = *input;
    in.rays = &rays;
    const double began = progress_now();
    const vit_status status = baked_find(&in, &b->out->baked, why);
    b->out->baked.seconds = progress_now() - began;
    photon_rays_close(&rays);
    if (status == VIT_OK && b->out->baked.more_rays > 1)
        progress_line(p->progress, false, "light gets about by small gaps: %u rays of each receiver, not receiver_rays = %u",
                      b->out->baked.more_rays * in.receiver_rays, in.receiver_rays);
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

/* Radiosity of any patch by reflections, at most: as much as direct light could be, for each of them. Direct light is at most
 * what it is at the least distance that counts (kernels/direct.cl). */
static float most_reflected(const bake *b, const uint32_t *moving, uint32_t moving_count) {
    const pipeline_packed *out = b->out;
    const double least = (double)out->geometry->ray_offset * 0.0625;
    double most = 0.0;
    for (uint32_t f = 0; f < (uint32_t)b->scene.frames; f++) {
        double sum = 0.0;
        for (uint32_t i = 0; i < moving_count; i++) {
            const vit_light *l = &out->tracks.lights[(size_t)f * out->tracks.light_count + moving[i]];
            const bool even = l->kind == VIT_LIGHT_DIRECTIONAL || l->falloff == VIT_FALLOFF_WINDOW;
            const double power = (double)float_max(float_max(l->intensity[0], l->intensity[1]), l->intensity[2]);
            sum += even ? power : power / (least * least);
        }
        most = sum > most ? sum : most;
    }
    most *= out->plan.reflections == TRANSPORT_CONVERGED ? ALL_REFLECTIONS : out->plan.reflections;
    return most < (double)VIT_MAX_PHOTON ? (float)most : VIT_MAX_PHOTON;
}

/* Of light that is not. */
static vit_status find_live(bake *b, const photon_scene *s, const uint32_t *moving, uint32_t moving_count, vit_text *why) {
    pipeline_packed *out = b->out;
    vit_scene *c = &out->plan.scene;
    const scene_quality *q = &b->scene.quality;
    photon_rays rays;
    if (!photon_rays_open(s, b->p->threads, &rays))
        return bake_fail(why, VIT_FAILED, "Embree fails");
    const live_input in = {.rays = &rays,
                           .geometry = out->geometry,
                           .tracks = &out->tracks,
                           .frames = (uint32_t)b->scene.frames,
                           .width = c->width,
                           .height = c->height,
                           .moving = moving,
                           .moving_count = moving_count,
                           .receivers = out->baked.receivers.receivers,
                           .receiver_count = out->baked.placed,
                           .rows = out->baked.receivers.count,
                           .patches = (uint32_t)q->patches,
                           .points = (uint32_t)q->patch_points,
                           .codec = (uint32_t)q->codec,
                           .receiver_rays = (uint32_t)q->receiver_rays,
                           .reflections = out->plan.reflections,
                           .threads = b->p->threads,
                           .progress = stages_step,
                           .user = b->p->progress};
    progress_stage(b->p->progress, "light between patches");
    const vit_status status = live_find(&in, &out->live, why);
    photon_rays_close(&rays);
    if (status != VIT_OK)
        return status;
    if (out->live.patch_count == 0) { /* nothing reflects: what is still has to do */
        c->effects = (c->effects & ~vit_effects_upon(VIT_BIT(RADIOSITY))) | VIT_BIT(BASIS);
        return VIT_OK;
    }
    if (out->live.each < in.points)
        progress_line(b->p->progress, true, "warning: %u patches have room for %u points each, not for patch_points = %u",
                      out->live.patch_count, out->live.each, in.points);
    c->patches = out->live.patch_count;
    c->patch_points = out->live.point_count;
    c->gather_words = out->live.word_count;
    for (uint32_t i = 0; i < moving_count; i++)
        c->live[moving[i] / 32] |= 1u << moving[i] % 32;
    if (out->live.transfer.count > 0) {
        vit_transfer h;
        memcpy(&h, out->live.transfer.words, sizeof h);
        c->transfer_words = h.words;
        c->transfer_rank = h.rank;
        c->transfer_sums = h.dense_chunks + h.sparse_chunks + (h.rank > 0);
        c->most_reflected = most_reflected(b, moving, moving_count);
    }
    return VIT_OK;
}

/* What META says of what is baked. */
static void count_baked(const baked *b, vit_scene *c) {
    c->receivers = b->receivers.count;
    c->receiver_cells = b->points.count > 0 ? b->points.table.count : b->receivers.cell_count;
    c->point_levels = b->points.levels;
    c->point_step = b->points.step;
    c->point_detail = b->points.detail;
    c->receiver_splits = b->receivers.split_count;
    c->basis_lights = b->lights;
    c->basis_words = b->basis.word_count;
    c->basis_coefficients = b->basis.coefficient_count;
}

vit_status stage_indirect(bake *b, vit_text *why) {
    const pipeline *p = b->p;
    pipeline_packed *out = b->out;
    vit_scene *c = &out->plan.scene;
    const bool is_live = c->effects & VIT_BIT(RADIOSITY);
    if (!is_live && !(c->effects & VIT_BIT(BASIS)))
        return VIT_OK;
    photons_light *still = calloc(out->tracks.light_count + 2u, sizeof *still);
    uint32_t *moving = calloc(out->tracks.light_count + 1u, sizeof *moving), moving_count = 0;
    const photon_scene s = stages_scene(b);
    baked_input in = {.geometry = out->geometry,
                      .tracks = &out->tracks,
                      .frames = (uint32_t)b->scene.frames,
                      .width = c->width,
                      .height = c->height,
                      .still = still,
                      .moving = moving,
                      .live = is_live,
                      .points = c->effects & VIT_BIT(POINTS),
                      .point_spacing = b->scene.quality.point_spacing,
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
        in.still_count = sources(b, still, moving, &moving_count);
    in.moving_count = moving_count;
    const double began = progress_now();
    vit_status status = still && moving ? find_or_get(b, &s, &in, why) : out_of_memory(why);
    out->seconds += fmax(out->baked.seconds - (progress_now() - began), 0);
    if (status == VIT_OK)
        count_baked(&out->baked, c);
    if (status == VIT_OK && is_live)
        status = find_live(b, &s, moving, moving_count, why);
    free(still);
    free(moving);
    return status;
}
