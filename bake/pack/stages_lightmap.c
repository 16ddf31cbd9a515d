/* The stage of baked direct light: of the sky and of area lights. */
#include "common/fail.h"
#include "pack/stages.h"
#include <math.h>
#include <stdio.h>

#define MOST_BY_RAYS 0.02f /* of what is seen */

static vit_status find(const bake *b, const photon_scene *s, const lightmap_input *input, vit_text *why) {
    const pipeline *p = b->p;
    photon_rays rays;
    if (!photon_rays_open(s, p->threads, &rays))
        return bake_fail(why, VIT_FAILED, "Embree fails");
    progress_stage(p->progress, "light of the sky and of area lights");
    lightmap_input in = *input;
    in.rays = &rays;
    const double began = progress_now();
    const vit_status status = lightmap_find(&in, &b->out->lightmap, why);
    b->out->lightmap.seconds = progress_now() - began;
    photon_rays_close(&rays);
    return status;
}

/* With "auto", is too much left to rays? A place of these takes as many as VIT_PATTERNS others would without a lightmap. */
static bool is_given_up(const bake *b, const receivers *r) {
    plan *p = &b->out->plan;
    if (b->scene.quality.lightmap != LIGHTMAP_AUTO || r->unknown_share <= MOST_BY_RAYS)
        return false;
    (void)snprintf(p->lightmap_why, sizeof p->lightmap_why, "%.1f %% of what is seen would be left to rays, more than %.0f %%",
                   100.0 * (double)r->unknown_share, 100.0 * (double)MOST_BY_RAYS);
    return true;
}

vit_status stage_lightmap(bake *b, vit_text *why) {
    pipeline *p = b->p;
    pipeline_packed *out = b->out;
    vit_scene *c = &out->plan.scene;
    if (!out->plan.lightmap)
        return VIT_OK;
    const bool own = out->geometry == &p->geometry; /* triangles of another shape are not to be mixed up with these */
    const photon_scene s = stages_scene(b);
    const lightmap_input in = {.geometry = out->geometry,
                               .tracks = &out->tracks,
                               .frames = (uint32_t)b->scene.frames,
                               .width = c->width,
                               .height = c->height,
                               .area = c->effects & VIT_BIT(AREA_LIGHTS) ? &out->plan.area : NULL,
                               .sky = c->effects & VIT_BIT(SKY_LIGHT) ? &p->sky : NULL,
                               .size = (double)out->plan.sky_radius,
                               .spacing = b->scene.quality.lightmap_spacing,
                               .error = b->scene.quality.lightmap_error,
                               .within = c->copies > 1,
                               .threads = p->threads,
                               .progress = stages_step,
                               .user = p->progress};
    const double began = progress_now();
    if (!own || !lightmap_kept_get(&p->kept_lightmap, &in, &out->lightmap)) {
        const vit_status status = find(b, &s, &in, why);
        if (status != VIT_OK)
            return status;
        if (own)
            lightmap_kept_put(&p->kept_lightmap, &in, &out->lightmap);
    }
    out->seconds += fmax(out->lightmap.seconds - (progress_now() - began), 0);
    const receivers *r = &out->lightmap.receivers;
    if (r->count == 0 || is_given_up(b, r)) { /* no surface takes light, or light changes too much everywhere */
        lightmap_free(&out->lightmap);
        return VIT_OK;
    }
    c->map_cells = r->cell_count;
    c->map_splits = r->split_count;
    c->map_receivers = r->count;
    c->effects |= VIT_BIT(LIGHTMAP) | (r->unknown > 0 ? VIT_BIT(LIGHTMAP_RAYS) : 0);
    return VIT_OK;
}
