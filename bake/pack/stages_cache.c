/* The stage of the world-space cache: ambient light that surfaces keep from each other. */
#include "common/fail.h"
#include "pack/stages.h"
#include <math.h>

vit_status stage_cache(bake *b, vit_text *why) {
    const pipeline *p = b->p;
    pipeline_packed *out = b->out;
    vit_scene *c = &out->plan.scene;
    if (!(c->effects & VIT_BIT(OCCLUSION)))
        return VIT_OK;
    const photon_scene s = stages_scene(b);
    photon_rays rays;
    if (!photon_rays_open(&s, p->threads, &rays))
        return bake_fail(why, VIT_FAILED, "Embree fails");
    const occlusion_input in = {.seen = {.rays = &rays,
                                         .tracks = &out->tracks,
                                         .frames = (uint32_t)b->scene.frames,
                                         .width = c->width,
                                         .height = c->height,
                                         .threads = p->threads,
                                         .progress = stages_step,
                                         .user = p->progress},
                                .live = c->effects & VIT_BIT(LIVE_CACHE),
                                .radius = b->scene.ambient_radius,
                                .spacing = b->scene.quality.cache_spacing,
                                .error = b->scene.quality.cache_error};
    progress_stage(p->progress, "ambient light");
    const vit_status status = occlusion_find(&in, &out->occlusion, why);
    photon_rays_close(&rays);
    if (status != VIT_OK)
        return status;
    const occlusion *o = &out->occlusion;
    c->cache_cells = o->table.count;
    c->cache_probes = o->table.longest > 0 ? o->table.longest : 1;
    c->cache_levels = o->levels;
    c->ambient_radius = (float)b->scene.ambient_radius;
    c->cache_step = o->step;
    c->cache_detail = o->detail;
    if (in.live) {
        c->cache_error = (float)in.error;
        progress_line(
            p->progress, false,
            "ambient light: %u cells of %u levels, %u of them parted by walls, %u bytes (longest look-up %u, %u dropped)",
            o->cells, o->levels, o->parted, (unsigned)(o->table.count * sizeof *o->table.records), c->cache_probes,
            o->table.dropped);
        return VIT_OK;
    }
    progress_line(p->progress, false,
                  "ambient light: %u points in %u cells of %u levels, %u of them parted by walls, %u bytes "
                  "(longest look-up %u, %u dropped), %u places x %u rays, off by %.3f of all light",
                  o->points, o->cells, o->levels, o->parted, (unsigned)(o->table.count * sizeof *o->table.records),
                  c->cache_probes, o->table.dropped, o->places, o->rays, o->off);
    return VIT_OK;
}
