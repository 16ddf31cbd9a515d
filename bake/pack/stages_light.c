/* Stages of light: who gets how many photon paths and which of them matter, area lights, photons, their radius, zones. */
#include "light/photons.h"
#include "pack/stages.h"
#include <math.h>
#include <stdlib.h>

#define GUIDED_BY                                                                                                              \
    (VIT_BIT(MIRROR) | VIT_BIT(GLASS) | VIT_BIT(CAUSTICS) | VIT_BIT(SPECULAR) | VIT_BIT(AREA_LIGHTS) | VIT_BIT(SKY_LIGHT))

vit_status stage_plan(bake *b, vit_text *why) {
    pipeline_packed *out = b->out;
    const plan_input in = {.scene = &b->scene,
                           .model = out->model,
                           .tracks = &out->tracks,
                           .atlas = &b->p->atlas,
                           .bvh = out->bvh,
                           .geometry = out->geometry,
                           .dark_sides = out->dark_sides,
                           .sky = &b->p->sky,
                           .threads = b->p->threads};
    return plan_make(&in, &out->plan, why);
}

photons_light stages_sky_source(const pipeline *p, const pipeline_packed *out) {
    const plan *l = &out->plan;
    return (photons_light){
        .light = {.position = {l->sky_center[0], l->sky_center[1], l->sky_center[2]}, .spot_scale = l->sky_radius},
        .paths = l->sky_paths,
        .sky = &p->sky,
        .guide = photon_guiding_of(out->guiding, out->tracks.light_count + 1),
        .around = out->guiding ? out->guiding->around : (vec3){0.0f, 0.0f, 0.0f}};
}

/* Density of guided paths over that of even ones, where they are worth something, on average: of the light's own and of its
 * share of all paths. */
static double photon_guiding_gain(const photon_guiding *g, const pipeline_packed *out) {
    const uint32_t lights = out->tracks.light_count;
    double all = 0, gain = 0;
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t i = 0; i < lights + 2; i++) {
            const uint32_t paths = i == lights       ? out->plan.area_paths
                                   : i == lights + 1 ? out->plan.sky_paths
                                                     : out->plan.baked_paths[i] + out->tracks.lights[i].path_count;
            all += pass == 0 ? (double)paths : 0;
            if (pass == 1 && paths > 0)
                gain += g->worth[i] * (g->worth[i] * all / (double)paths) * (g->guide[i].nodes ? g->guide[i].gain : 1);
        }
    return gain;
}

/* Guides of the scene's lights, and the paths shared by what they are worth. Where nothing is worth anything, photons go
 * evenly. */
vit_status stage_guiding(bake *b, vit_text *why) {
    pipeline *p = b->p;
    pipeline_packed *out = b->out;
    const vit_scene *c = &out->plan.scene;
    pipeline_guiding *kept = &p->guided;
    if (!b->choice->quality.guiding || !(c->effects & VIT_BIT(PHOTONS)))
        return VIT_OK;
    if (kept->guiding.count == 0 || kept->width != c->width || kept->height != c->height || kept->bounces != c->bounces ||
        kept->effects != (c->effects & GUIDED_BY)) {
        bool *gives = calloc(c->lights + 1u, sizeof *gives);
        if (!gives)
            return out_of_memory(why);
        for (uint32_t i = 0; i < c->lights; i++)
            gives[i] = out->plan.baked_paths[i] > 0 || out->tracks.lights[i].path_count > 0;
        const photons_light from_sky = stages_sky_source(p, out);
        const photon_guiding_input in = {.scene = {.triangles = p->geometry.triangles,
                                                   .attributes = p->geometry.attributes,
                                                   .triangle_count = p->model.triangles,
                                                   .materials = out->plan.materials,
                                                   .atlas = &p->atlas,
                                                   .ray_offset = p->geometry.ray_offset,
                                                   .box_pad = p->bvh.box_pad,
                                                   .effects = c->effects},
                                         .tracks = &out->tracks,
                                         .frames = c->frames,
                                         .width = c->width,
                                         .height = c->height,
                                         .bounces = c->bounces,
                                         .gives_photons = gives,
                                         .area = out->plan.area_paths > 0 ? &out->plan.area : NULL,
                                         .sky = out->plan.sky_paths > 0 ? &from_sky : NULL,
                                         .threads = p->threads};
        progress_stage(p->progress, "guides of photons");
        photon_guiding_free(&kept->guiding);
        const vit_status status = photon_guiding_find(&in, &kept->guiding, why);
        free(gives);
        if (status != VIT_OK)
            return status;
        *kept = (pipeline_guiding){kept->guiding, c->width, c->height, c->bounces, c->effects & GUIDED_BY};
    }
    out->guiding = &kept->guiding;
    out->guided_gain = photon_guiding_gain(&kept->guiding, out);
    const plan_input in = {.scene = &b->scene, .tracks = &out->tracks, .dark_sides = out->dark_sides, .sky = &p->sky};
    return plan_share(&in, kept->guiding.worth, &out->plan, why);
}

vit_status stage_photons(bake *b, vit_text *why) {
    const pipeline *p = b->p;
    pipeline_packed *out = b->out;
    photons_light *lights = calloc(out->tracks.light_count + 2u, sizeof *lights);
    uint32_t count = 0;
    vit_status status = VIT_OK;
    const bool photons_too = (out->plan.scene.effects & VIT_BIT(PHOTONS)) != 0;
    if (!out->met)
        out->met = calloc(out->plan.scene.materials, sizeof *out->met);
    if (!lights || !out->met) {
        free(lights);
        return out_of_memory(why);
    }
    for (uint32_t i = 0; photons_too && i < out->tracks.light_count; i++)
        if (out->plan.baked_paths[i] > 0)
            lights[count++] = (photons_light){
                .light = out->tracks.lights[i], .paths = out->plan.baked_paths[i], .guide = photon_guiding_of(out->guiding, i)};
    if (photons_too && out->plan.area_paths > 0)
        lights[count++] = (photons_light){.paths = out->plan.area_paths,
                                          .area = &out->plan.area,
                                          .guide = photon_guiding_of(out->guiding, out->tracks.light_count)};
    if (photons_too && out->plan.sky_paths > 0)
        lights[count++] = stages_sky_source(p, out);
    if (count > 0) {
        progress_stage(p->progress, "photons of still lights");
        photons_input in = {.triangles = out->geometry->triangles,
                            .attributes = out->geometry->attributes,
                            .triangle_count = out->model->triangles,
                            .materials = out->plan.materials,
                            .atlas = &p->atlas,
                            .ray_offset = out->geometry->ray_offset,
                            .box_pad = out->plan.scene.box_pad,
                            .effects = out->plan.scene.effects,
                            .first_path = out->plan.scene.paths,
                            .radius = out->plan.scene.radius,
                            .bounces = out->plan.scene.bounces,
                            .sequence = (out->plan.scene.effects & VIT_BIT(SEQUENCE)) != 0,
                            .cells = out->plan.scene.effects & VIT_BIT(ZONES) && out->cells.count ? &out->cells : NULL,
                            .lights = lights,
                            .light_count = count,
                            .met = out->met,
                            .progress = stages_step,
                            .user = p->progress};
        free(out->photons);
        status = photons_bake(&in, p->threads, &out->photons, &out->plan.scene.baked, why);
        if (status == VIT_OK && in.cells)
            zones_assign(in.cells, out->photons, out->plan.scene.baked);
    }
    free(lights);
    return status;
}

/* "auto" follows the photons that are stored, not the slots there are: many paths may leave the scene. Zones and areas come
 * later: they depend on the radius. So does the cache, for which photons do not ask. */
vit_status stage_radius(bake *b, vit_text *why) {
    double stored;
    bounds_input *in = &b->bounds;
    if (!(b->out->plan.scene.effects & VIT_BIT(PHOTONS)) || b->choice->quality.radius > 0)
        return VIT_OK;
    stages_point(b);
    const uint64_t effects = in->scene->effects;
    in->scene->effects &= ~(VIT_BIT(ZONES) | VIT_BIT(AREA) | vit_effects_upon(VIT_BIT(OCCLUSION)));
    const vit_status status = bounds_count_photons(in, &stored, why);
    in->scene->effects = effects;
    if (status == VIT_OK && stored > 0) {
        b->out->plan.scene.radius = (float)plan_radius(&b->out->plan, stored);
        b->again = true; /* each photon's radius depends on it */
    }
    return status;
}

/* Zones and effective areas, for the radius that the plan has now. */
vit_status stage_zones(bake *b, vit_text *why) {
    const pipeline *p = b->p;
    const pipeline_choice *c = b->choice;
    pipeline_packed *out = b->out;
    if (!(out->plan.scene.effects & (VIT_BIT(ZONES) | VIT_BIT(AREA))))
        return VIT_OK;
    bool *gives = calloc(out->tracks.light_count + 1u, sizeof *gives);
    if (!gives)
        return out_of_memory(why);
    for (uint32_t i = 0; i < out->tracks.light_count; i++)
        gives[i] = out->plan.baked_paths[i] > 0 || out->tracks.lights[i].path_count > 0;
    const photons_light from_sky = stages_sky_source(p, out);
    progress_stage(p->progress, "zones and areas");
    const zones_input in = {.geometry = out->geometry,
                            .triangles = out->model->triangles,
                            .materials = out->plan.materials,
                            .atlas = &p->atlas,
                            .tracks = &out->tracks,
                            .gives_photons = gives,
                            .area_lights = out->plan.area_paths > 0 ? &out->plan.area : NULL,
                            .sky = out->plan.sky_paths > 0 ? &from_sky : NULL,
                            .guiding = out->guiding,
                            .scene = &out->plan.scene,
                            .zones = c->quality.zones,
                            .by_light = c->quality.light_zones,
                            .areas = (out->plan.scene.effects & VIT_BIT(AREA)) != 0,
                            .threads = p->threads,
                            .progress = stages_step,
                            .user = p->progress};
    const bool own = out->geometry == &p->geometry; /* triangles of another shape are not to be mixed up with these */
    const double began = progress_now();
    const vit_status status =
        own ? zones_kept_bake(p->kept, &in, &out->cells, &out->zones, why) : zones_bake(&in, &out->cells, &out->zones, why);
    out->seconds += fmax(out->zones.seconds - (progress_now() - began), 0);
    out->plan.scene.cells = out->cells.count;
    free(gives);
    b->again = c->quality.zones; /* a photon has the zone of the cell where it lands */
    return status;
}

/* The sets of points on area lights and of directions to the sky. */
vit_status stage_area_lights(bake *b, vit_text *why) {
    pipeline_packed *out = b->out;
    const vit_scene *s = &out->plan.scene;
    out->area_lights = malloc(((size_t)s->area_samples + s->sky_samples + 1) * VIT_PATTERNS * sizeof *out->area_lights);
    if (!out->area_lights)
        return out_of_memory(why);
    if (s->area_samples > 0)
        area_lights_near(&out->plan.area, s->area_samples, out->plan.materials);
    const vit_status status =
        s->area_samples > 0 ? area_lights_sets(&out->plan.area, s->area_samples, out->area_lights, why) : VIT_OK;
    if (s->sky_samples > 0)
        sky_sets(&b->p->sky, s->sky_samples, out->area_lights + (size_t)VIT_PATTERNS * s->area_samples);
    return status;
}
