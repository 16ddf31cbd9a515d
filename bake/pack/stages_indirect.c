/* The stage of baked indirect light: receivers and the basis of lights that move. */
#include "common/fail.h"
#include "light/panes.h"
#include "pack/stages.h"
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

vit_status stage_indirect(bake *b, vit_text *why) {
    const pipeline *p = b->p;
    pipeline_packed *out = b->out;
    vit_scene *c = &out->plan.scene;
    if (!(c->effects & VIT_BIT(BASIS)))
        return VIT_OK;
    photons_light *still = calloc(out->tracks.light_count + 2u, sizeof *still);
    uint32_t *moving = calloc(out->tracks.light_count + 1u, sizeof *moving);
    const photon_scene s = {.triangles = out->geometry->triangles,
                            .attributes = out->geometry->attributes,
                            .triangle_count = out->model->triangles,
                            .materials = out->plan.materials,
                            .atlas = &p->atlas,
                            .ray_offset = out->geometry->ray_offset,
                            .box_pad = c->box_pad,
                            .effects = c->effects};
    photon_rays rays;
    if (!still || !moving) {
        free(still);
        free(moving);
        return out_of_memory(why);
    }
    vit_status status = VIT_OK;
    if (!photon_rays_open(&s, p->threads, &rays))
        status = bake_fail(why, VIT_FAILED, "Embree fails");
    if (status == VIT_OK) {
        baked_input in = {.rays = &rays,
                          .geometry = out->geometry,
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
        in.still_count = sources(b, still, moving, &in.moving_count);
        progress_stage(p->progress, "indirect light");
        status = baked_find(&in, &out->baked, why);
        photon_rays_close(&rays);
    }
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
