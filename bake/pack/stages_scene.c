/* Stages of the scene: what does not depend on the quality block, and the shape in fewer bits where that asks for it. */
#include "geometry/area_light_plane.h"
#include "geometry/glass_inset.h"
#include "geometry/recentre.h"
#include "import/import_frame.h"
#include "import/light_units.h"
#include "light/lights_in_surfaces.h"
#include "pack/stages.h"
#include <math.h>
#include <stdlib.h>

#define COARSE 0x1p-16 /* of the scene's size: coarser floats in its files are worth a warning */

static void warn(void *user, const char *line) {
    progress_line(user, true, "warning: %s", line);
}

/* What of MTL's highlights is not what the file's letter says. */
static void say_highlights(const model *m, progress *p) {
    if (m->default_highlights > 0)
        progress_line(
            p, false,
            "the highlights of %llu materials are what exporters write unasked (%s): matt ('specular' gives them one)",
            (unsigned long long)m->default_highlights, m->default_highlight);
    if (m->principled > 0)
        progress_line(p, false,
                      "the highlights of %llu materials (Ks 0.5, "
                      "Ka grey) are Blender's Principled shader: 4 %% reflection at that level, or metal",
                      (unsigned long long)m->principled);
}

/* Imports the meshes; if they lie far from the origin, moves the scene there and imports them again. */
vit_status stage_import(pipeline *p, vit_text *why) {
    double origin[3];
    progress_stage(p->progress, "import");
    vit_status status = model_import(&p->scene, p->strict, warn, p->progress, &p->model, why);
    if (status == VIT_OK && scene_is_far(&p->model, origin)) {
        progress_line(p->progress, false, "the scene lies far from the origin: moved by (%g, %g, %g)", -origin[0], -origin[1],
                      -origin[2]);
        scene_move(&p->scene, origin);
        model_free(&p->model);
        status = model_import(&p->scene, p->strict, NULL, NULL, &p->model, why);
    }
    if (status != VIT_OK)
        return status;
    say_highlights(&p->model, p->progress);
    frames_say(&p->scene, &p->model, p->progress);
    double size = 0.0;
    for (int k = 0; k < 3; k++)
        size = fmax(size, p->model.hi[k] - p->model.lo[k]);
    if (p->model.step > COARSE * size)
        progress_line(p->progress, true,
                      "warning: positions in the mesh files are %.2g m apart, 1 / %.0f of the scene: numbers far from 0",
                      p->model.step, size / p->model.step);
    return VIT_OK;
}

vit_status stage_tracks(pipeline *p, vit_text *why) {
    const vit_status status = tracks_evaluate(&p->scene, &p->model, &p->tracks, why);
    if (status == VIT_OK)
        light_units_say(&p->scene, &p->model, p->progress);
    return status;
}

/* Area lights in the very plane of a ceiling come out of it. */
vit_status stage_area_light_planes(pipeline *p, vit_text *why) {
    const float ray_offset = geometry_ray_offset(&p->model);
    uint32_t moved;
    if (!area_light_plane(&p->model, p->tracks.cameras, (uint32_t)p->scene.frames, ray_offset, &moved))
        return out_of_memory(why);
    if (moved > 0)
        progress_line(p->progress, false,
                      "%u triangles that emit lie in the plane of others: moved by %.2g m to the camera's side", moved,
                      AREA_LIGHT_PLANE * (double)ray_offset);
    return VIT_OK;
}

static vit_status draw_glass_in(model *m, vit_text *why) {
    return glass_inset(m, geometry_ray_offset(m)) ? VIT_OK : out_of_memory(why);
}

vit_status stage_glass_inset(pipeline *p, vit_text *why) {
    return draw_glass_in(&p->model, why);
}

/* BVH, triangles and dark sides of the model. */
static vit_status make_shape(const pipeline *p, const model *m, bvh *b, geometry *g, dark_sides *r, vit_text *why) {
    progress_stage(p->progress, "BVH");
    vit_status status = bvh_build(m, p->threads, b, why);
    if (status == VIT_OK)
        status = geometry_pack(m, b, g, why);
    if (status != VIT_OK)
        return status;
    progress_stage(p->progress, "sides that light can reach");
    const dark_sides_input in = {.model = m,
                                 .tracks = &p->tracks,
                                 .frames = (uint32_t)p->scene.frames,
                                 .sky_light = p->scene.sky.light,
                                 .threads = p->threads,
                                 .progress = stages_step,
                                 .user = p->progress};
    return dark_sides_find(&in, g, r, why);
}

vit_status stage_shape(pipeline *p, vit_text *why) {
    return make_shape(p, &p->model, &p->bvh, &p->geometry, &p->dark_sides, why);
}

/* A warning for each light that lies in a surface. */
vit_status stage_light_places(pipeline *p, vit_text *why) {
    const uint32_t lights = p->tracks.light_count;
    const float offset = p->geometry.ray_offset;
    bool any = false;
    for (uint32_t i = 0; i < lights; i++)
        any = any || p->tracks.lights[i].kind != VIT_LIGHT_DIRECTIONAL;
    if (!any)
        return VIT_OK;
    light_in_surface *found = calloc(lights + 1u, sizeof *found);
    triangle_rays rays;
    if (!found || !triangle_rays_open(p->geometry.triangles, p->model.triangles, p->bvh.box_pad, p->threads, &rays)) {
        free(found);
        return out_of_memory(why);
    }
    lights_in_surfaces(&p->tracks, (uint32_t)p->scene.frames, &rays, offset, found);
    triangle_rays_close(&rays);
    for (uint32_t i = 0; i < lights; i++)
        if (found[i].frames > 0)
            progress_line(
                p->progress, true,
                "warning: light %u lies in a surface in %u of %d frames, the first of them %u: which side it lights is "
                "chance there; move it by more than %.2g m",
                i + 1, found[i].frames, p->scene.frames, found[i].first, (double)offset);
    free(found);
    return VIT_OK;
}

vit_status stage_atlas(pipeline *p, vit_text *why) {
    progress_stage(p->progress, "atlas");
    return atlas_pack(&p->model, &p->atlas, why);
}

vit_status stage_sky(pipeline *p, vit_text *why) {
    const scene_sky *s = &p->scene.sky;
    sky_constant(p->scene.background, &p->sky);
    if (!s->image[0])
        return VIT_OK;
    progress_stage(p->progress, "sky");
    return sky_load(s->image, s->scale, s->rotate, &p->sky, why);
}

/* The pipeline's shape, or one of its own where the quality asks for fewer bits. */
vit_status stage_choose_shape(bake *b, vit_text *why) {
    const pipeline *p = b->p;
    const scene_quality *q = &b->choice->quality;
    pipeline_packed *out = b->out;
    out->model = &p->model;
    out->bvh = &p->bvh;
    out->geometry = &p->geometry;
    out->dark_sides = &p->dark_sides;
    if (q->vertex_bits != 16 && q->normal_bits != 8)
        return VIT_OK;
    pipeline_shape *c = &out->coarse;
    vit_status status = model_quantise(&p->model, q->vertex_bits, q->normal_bits, &c->model, why);
    if (status == VIT_OK && q->vertex_bits == 16) /* on the grid faces may be in one place again */
        status = draw_glass_in(&c->model, why);
    if (status != VIT_OK)
        return status;
    out->model = &c->model;
    out->bvh = &c->bvh;
    out->geometry = &c->geometry;
    out->dark_sides = &c->dark_sides;
    return make_shape(p, &c->model, &c->bvh, &c->geometry, &c->dark_sides, why);
}
