#include "pack/planner.h"
#include "common/pi.h"
#include "common/fail.h"
#include "pack/copies.h"
#include "pack/indirect_maker.h"
#include "common/strict_math.h"
#include "radiosity/transport.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PACKET 16u
#define PLAN_BY_POWER                                                                                                          \
    0.2 /* of the paths are shared by power where the lights' worth is known: what was not found to matter may still */

/* The radius if it is "auto": so much of the mean way of light from side to side, where errors of the estimate, leaks and lost
 * edges among them, are least or nearly so in rooms and in buildings (tests/bench/LOG.md, "The automatic radius"). But the disc
 * of the radius is to hold, on average, no fewer photons than make a mottled estimate, and no more than make it smooth: with
 * ever more photons the radius goes to 0. */
#define AUTO_OF_WAY 0.2
#define AUTO_LEAST_PHOTONS 4.0
#define AUTO_MOST_PHOTONS 150.0

static bool gives_photons(const scene *s, uint32_t light) {
    return s->automatic || s->lights[light].photons;
}

/* Mean power over the path, W / 2 pi, summed over channels: what a light's share of the paths follows. */
static double mean_power(const tracks *t, uint32_t frames, uint32_t light) {
    double sum = 0;
    for (uint32_t f = 0; f < frames; f++) {
        const vit_light *l = &t->lights[(size_t)f * t->light_count + light];
        const double disc = 0.5 * (double)l->spot_scale * (double)l->spot_scale; /* pi R^2 where others have 2 pi (1 - cos) */
        sum += ((double)l->intensity[0] + (double)l->intensity[1] + (double)l->intensity[2]) *
               (l->kind == VIT_LIGHT_DIRECTIONAL ? disc : 1.0 - (double)l->cos_outer);
    }
    return sum / frames;
}

static double sum_of(const double c[3]) {
    return c[0] + c[1] + c[2];
}

/* Paths of a light of so much power; worth: its share of what is seen, NULL: not known. */
static uint32_t share(const scene *s, double power, double total, const double *worth) {
    const double even = power / total, part = worth ? (1 - PLAN_BY_POWER) * *worth + PLAN_BY_POWER * even : even;
    return power > 0 ? (uint32_t)ceil(s->quality.photons * part / PACKET) * PACKET : 0;
}

/* Nobody gets paths where no surface could store a photon. */
static vit_status share_paths(const plan_input *in, const double *worth, plan *p, vit_text *why) {
    const scene *s = in->scene;
    tracks *t = in->tracks;
    const double area = sum_of(p->area.flux) / (2.0 * PI);
    const double above = s->sky.light ? 0.5 * sum_of(in->sky->irradiance) * (double)p->sky_radius * (double)p->sky_radius : 0;
    double total = area + above;
    uint32_t first = 0;
    for (uint32_t i = 0; i < t->light_count; i++)
        total += gives_photons(s, i) ? mean_power(t, (uint32_t)s->frames, i) : 0;
    if (s->quality.photons == 0 || s->quality.bounces < 2 || !(total > 0) || !(in->dark_sides->area > 0))
        return VIT_OK;
    p->area_paths = share(s, area, total, worth ? worth + t->light_count : NULL);
    p->sky_paths = share(s, above, total, worth ? worth + t->light_count + 1 : NULL);
    for (uint32_t i = 0; i < t->light_count; i++) {
        uint32_t paths =
            share(s, gives_photons(s, i) ? mean_power(t, (uint32_t)s->frames, i) : 0, total, worth ? worth + i : NULL);
        if (paths == 0)
            continue;
        if (t->still[i]) {
            p->baked_paths[i] = paths;
            continue;
        }
        for (uint32_t f = 0; f < (uint32_t)s->frames; f++) {
            vit_light *l = &t->lights[(size_t)f * t->light_count + i];
            l->path_first = first;
            l->path_count = paths;
        }
        first += paths;
    }
    p->scene.paths = first;
    if (first > 1000000) {
        return bake_fail(why, VIT_BAD_INPUT, "quality.photons: at most 1000000 paths in all, with %u lights got %u",
                         t->light_count, first);
    }
    return VIT_OK;
}

static bool is_positive(const float c[3]) {
    return c[0] > 0 || c[1] > 0 || c[2] > 0;
}

static void plan_materials(const model *m, const atlas *a, plan *p) {
    for (int i = 0; i < m->material_count; i++) {
        const model_material *from = &m->materials[i];
        vit_material *to = &p->materials[i];
        memcpy(to->albedo, from->albedo, sizeof to->albedo);
        memcpy(to->emission, from->emission, sizeof to->emission);
        to->texture = a->material_texture ? a->material_texture[i] : VIT_NONE;
        to->cutout = from->cutoff > 0 && to->texture != VIT_NONE;
        memcpy(to->specular, from->specular, sizeof to->specular);
        memcpy(to->absorption, from->absorption, sizeof to->absorption);
        to->kind = from->kind;
        to->exponent = from->exponent;
        to->alpha = from->lobe_alpha;
        to->ior = from->ior;
        to->lights = from->area_light && is_positive(from->emission);
    }
}

/* What is left out by the quality is not there. */
static void plan_maps(const scene *s, const model *m, const atlas *a, plan *p) {
    for (int i = 0; i < m->material_count; i++) {
        const bool bent = s->quality.normal_maps && a->material_normal && a->material_normal[i] != VIT_NONE;
        p->maps[i] = (vit_maps){.normal = bent ? a->material_normal[i] : VIT_NONE,
                                .normal_scale = bent ? m->materials[i].normal_scale : 1.0f};
    }
}

static uint64_t effects_of_lights(const scene *s, const tracks *t) {
    uint64_t e = t->light_count > 0 ? VIT_BIT(LIGHTS) : 0;
    for (size_t i = 0; i < (size_t)s->frames * t->light_count; i++) {
        const vit_light *l = &t->lights[i];
        if (l->kind == VIT_LIGHT_SPOT)
            e |= VIT_BIT(SPOT);
        if (l->kind == VIT_LIGHT_DIRECTIONAL)
            e |= VIT_BIT(DIRECTIONAL);
        if (l->inv_range2 > 0 || l->falloff == VIT_FALLOFF_WINDOW)
            e |= VIT_BIT(RANGE);
    }
    return e;
}

static uint64_t effects_of_materials(const scene *s, const model *m, const plan *p) {
    static const uint64_t filters[] = {[FILTER_NEAREST] = VIT_BIT(NEAREST), [FILTER_TRILINEAR] = VIT_BIT(TRILINEAR)};
    uint64_t e = 0;
    for (int i = 0; i < m->material_count; i++)
        if (m->materials[i].triangles > 0)
            e |= effects_of_material(&p->materials[i], &p->maps[i]) &
                 ~(VIT_BIT(CAUSTICS) | VIT_BIT(AREA_LIGHTS) | VIT_BIT(GLOSS)); /* which need more: plan_effects() */
    return e & VIT_BIT(TEXTURES) ? e | filters[s->quality.texture_filter] : e;
}

/* 0: no light gives photons. */
static uint64_t effects_of_photons(const scene *s, const plan *p) {
    bool baked = p->area_paths > 0 || p->sky_paths > 0;
    for (uint32_t i = 0; i < p->scene.lights; i++)
        baked |= p->baked_paths[i] > 0;
    if (p->scene.paths == 0 && !baked)
        return 0;
    const scene_quality *q = &s->quality;
    uint64_t e = VIT_BIT(PHOTONS) | (q->buckets ? VIT_BIT(BUCKETS) : VIT_BIT(LIST));
    e |= p->scene.paths > 0 ? VIT_BIT(TRACED) : 0;
    e |= q->buckets && q->raw ? VIT_BIT(RAW_BUCKETS) : 0;
    e |= q->flattened ? VIT_BIT(FLATTENED) : 0;
    e |= q->normal_keys ? VIT_BIT(NORMAL_KEYS) : 0;
    e |= q->zones ? VIT_BIT(ZONES) : 0;
    e |= q->effective_area && !plan_leaves_area_out(q) ? VIT_BIT(AREA) : 0;
    e |= q->bounce_sequence ? VIT_BIT(SEQUENCE) : 0;
    return e;
}

/* Receivers get their light from what would give photons. */
static uint64_t effects_of_basis(const scene *s, const tracks *t, const plan *p) {
    uint64_t e = effects_of_photons(s, p) ? VIT_BIT(BASIS) : 0;
    for (uint32_t i = 0; i < t->light_count && e; i++)
        e |= t->lights[i].path_count > 0 ? VIT_BIT(RELIGHT) : 0; /* of lights that move alone */
    return e & VIT_BIT(BASIS) && s->quality.basis_receivers == RECEIVERS_POINTS ? e | VIT_BIT(POINTS) : e;
}

/* What is still needs no more than receivers. */
static uint64_t effects_of_radiosity(const scene *s, const tracks *t, const plan *p) {
    const uint64_t e = effects_of_basis(s, t, p);
    if (!(e & VIT_BIT(RELIGHT)))
        return e & ~VIT_BIT(POINTS);
    const uint64_t coded = s->quality.codec == VIT_TRANSFER_SPARSE_LOW_RANK ? VIT_BIT(LOW_RANK) : 0;
    return VIT_BIT(RADIOSITY) | (s->quality.bounces > 2 ? VIT_BIT(TRANSFER) | coded : 0);
}

/* What makes indirect light, and what any maker of it calls for. */
static uint64_t effects_of_indirect(const scene *s, const tracks *t, const plan *p) {
    uint64_t e = p->indirect == INDIRECT_BASIS       ? effects_of_basis(s, t, p)
                 : p->indirect == INDIRECT_RADIOSITY ? effects_of_radiosity(s, t, p)
                                                     : effects_of_photons(s, p);
    if (e == 0)
        return 0;
    e |= VIT_BIT(INDIRECT);
    if (e & (VIT_BIT(BASIS) | VIT_BIT(RADIOSITY))) /* so cheap that every sample has its own */
        return e;
    e |= s->quality.indirect_samples > 1 ? VIT_BIT(SPARSE) : 0;
    e |= s->quality.indirect_samples == 16 ? VIT_BIT(SPARSE_16) : 0;
    return e;
}

static uint64_t plan_area_lights(const scene *s, const environment *sky, plan *p) {
    vit_scene *c = &p->scene;
    c->sky_size = sky->size;
    if (p->area.count > 0)
        c->area_samples = (uint32_t)s->quality.light_samples;
    if (s->sky.light && sum_of(sky->irradiance) > 0)
        c->sky_samples = (uint32_t)s->quality.sky_samples;
    return (c->sky_size ? VIT_BIT(SKY_IMAGE) : 0) | (c->area_samples ? VIT_BIT(AREA_LIGHTS) : 0) |
           (c->sky_samples ? VIT_BIT(SKY_LIGHT) : 0);
}

/* kernels/METHODS.md, "Clusters" (16): slices as deep as they are wide. */
static float slice_scale(const scene *s, const tracks *t) {
    double rows = (double)s->height / s->quality.tile;
    return (float)(0.69314718055994531 / strict_log(1.0 + 2.0 * t->tan_half_fov / rows));
}

/* The grid of small view samples: cubes over the box of the model, with room for what rays leave surfaces by. */
static void plan_grid(const model *m, vit_scene *c) {
    double extent = 0;
    for (int k = 0; k < 3; k++)
        extent = fmax(extent, m->hi[k] - m->lo[k]);
    const double margin = 4.0 * (double)c->ray_offset + extent * 0x1p-14, step = (extent + 2.0 * margin) / 65535.0;
    for (int k = 0; k < 3; k++)
        c->grid_low[k] = (float)(m->lo[k] - margin);
    c->grid_step = (float)step;
}

/* Area that light can reach, m2 (a side counts for itself). */
static double lit_area(const dark_sides *r) {
    double lit = r->area - r->dark_front - r->dark_back;
    return lit > 0 ? lit : r->area;
}

/* Is there a photon path of any light? */
static bool has_paths(const tracks *t, const plan *p) {
    bool some = p->scene.paths > 0 || p->area_paths > 0 || p->sky_paths > 0;
    for (uint32_t i = 0; i < t->light_count; i++)
        some = some || p->baked_paths[i] > 0;
    return some;
}

/* The pack's constants. */
static void plan_constants(const plan_input *in, vit_scene *c) {
    const scene *s = in->scene;
    const atlas *a = in->atlas;
    c->width = (uint32_t)s->width;
    c->height = (uint32_t)s->height;
    c->frames = (uint32_t)s->frames;
    c->fps = (float)s->fps;
    c->tile = (uint32_t)s->quality.tile;
    c->triangles = in->model->triangles;
    c->nodes = in->bvh->node_count;
    c->materials = (uint32_t)in->model->material_count;
    c->textures = a->texture_count;
    c->mips = a->mip_count;
    c->texels = a->texel_count;
    c->lights = in->tracks->light_count;
    c->bounces = (uint32_t)s->quality.bounces;
    c->ray_offset = in->geometry->ray_offset;
    c->box_pad = in->bvh->box_pad;
    c->slice_near = (float)in->tracks->near;
    c->slice_scale = slice_scale(s, in->tracks);
    c->slice_count = 4096;
    for (int k = 0; k < 3; k++) {
        c->background[k] = (float)s->background[k];
        c->ambient[k] = (float)s->ambient[k];
    }
    c->copies = (uint32_t)s->quality.antialias;
    if (c->copies > 1)
        c->contrast = (float)s->quality.antialias_contrast;
    copies_place(c->copies, s->quality.tent, c->offset);
}

/* Area lights, and who gets how many photon paths. */
static vit_status plan_lights(const plan_input *in, plan *p, vit_text *why) {
    const model *m = in->model;
    const photon_scene lit = {.triangles = in->geometry->triangles,
                              .attributes = in->geometry->attributes,
                              .triangle_count = m->triangles,
                              .materials = p->materials,
                              .atlas = in->atlas,
                              .ray_offset = in->geometry->ray_offset,
                              .box_pad = in->bvh->box_pad};
    sky_sphere(m->lo, m->hi, p->sky_center, &p->sky_radius);
    const vit_status status =
        area_lights_find(&lit, in->tracks->cameras, (uint32_t)in->scene->frames, in->threads, &p->area, why);
    return status == VIT_OK ? share_paths(in, NULL, p, why) : status;
}

/* Lights that would have photon paths give receivers their light: who they are is all that is left of the paths. */
static void plan_receivers(const plan_input *in, plan *p) {
    const uint32_t lights = in->tracks->light_count;
    for (uint32_t i = 0; i < lights; i++)
        p->baked_paths[i] += in->tracks->lights[i].path_count;
    for (size_t i = 0; i < (size_t)in->scene->frames * lights; i++)
        in->tracks->lights[i].path_first = in->tracks->lights[i].path_count = 0;
    p->scene.paths = 0;
    const uint32_t bounces = (uint32_t)in->scene->quality.bounces;
    p->reflections = bounces < PLAN_ALL_BOUNCES ? bounces - 1u : TRANSPORT_CONVERGED;
}

/* Effects that the scene calls for, then what `effects` of the scene file says of them. */
static vit_status plan_effects(const plan_input *in, plan *p, vit_text *why) {
    const scene *s = in->scene;
    vit_scene *c = &p->scene;
    c->effects = effects_of_lights(s, in->tracks) | effects_of_materials(s, in->model, p);
    const vit_status status = indirect_maker_choose(in, p, why);
    if (status != VIT_OK)
        return status;
    c->effects |= effects_of_indirect(s, in->tracks, p);
    if ((c->effects & VIT_BIT(GGX)) && s->quality.gloss_rays > 0 && !(c->effects & (VIT_BIT(PHOTONS) | VIT_BIT(POINTS)))) {
        c->effects |= VIT_BIT(GLOSS); /* photons and points say nothing of places that no view sample sees */
        c->gloss_rays = (uint32_t)s->quality.gloss_rays;
    }
    c->effects |= is_positive(c->ambient) ? VIT_BIT(AMBIENT) : 0;
    c->effects |= is_positive(c->ambient) && s->ambient_radius > 0 ? VIT_BIT(OCCLUSION) : 0;
    c->effects |= c->effects & VIT_BIT(OCCLUSION) && s->quality.cache == CACHE_PROGRESSIVE ? VIT_BIT(LIVE_CACHE) : 0;
    c->effects |= c->copies > 1 ? VIT_BIT(ANTIALIAS) : 0;
    if (c->effects & (VIT_BIT(MIRROR) | VIT_BIT(GLASS))) {
        c->chain = (uint32_t)s->quality.specular_depth;
        c->effects |= s->quality.caustics && (c->effects & VIT_BIT(PHOTONS)) ? VIT_BIT(CAUSTICS) : 0;
    }
    c->effects |= plan_area_lights(s, in->sky, p);
    if (s->quality.sample_bits == 16) {
        c->effects |= VIT_BIT(SMALL_SAMPLES);
        plan_grid(in->model, c);
    }
    for (uint32_t i = 0; i < in->model->triangles; i++)
        if (in->geometry->attributes[i].material & VIT_TRIANGLE_SMOOTH)
            c->effects |= VIT_BIT(SMOOTH);
    if (in->dark_sides->dark_sides > 0)
        c->effects |= VIT_BIT(DARK_SIDES);
    effects_force(s, c, &p->effects);
    p->lightmap = s->quality.lightmap != LIGHTMAP_RAYS && c->effects & (VIT_BIT(AREA_LIGHTS) | VIT_BIT(SKY_LIGHT));
    if (p->lightmap && s->quality.lightmap == LIGHTMAP_AUTO && c->effects & VIT_BIT(NORMAL_MAPS) &&
        c->effects & VIT_BIT(AREA_LIGHTS)) { /* the sky's light comes from everywhere, and so it does less harm there */
        p->lightmap = false;
        (void)snprintf(p->lightmap_why, sizeof p->lightmap_why, "normal maps hardly show in baked light of area lights");
    }
    p->area_paths = c->effects & VIT_BIT(AREA_LIGHTS) ? p->area_paths : 0;
    p->sky_paths = c->effects & VIT_BIT(SKY_LIGHT) ? p->sky_paths : 0;
    if (!has_paths(in->tracks, p)) /* its sources were left out */
        effects_drop(c, vit_indirect_makers());
    if (c->effects & (VIT_BIT(BASIS) | VIT_BIT(RADIOSITY)))
        plan_receivers(in, p);
    return VIT_OK;
}

/* The photons' radius, as long as nobody has counted them. */
static void plan_photons(const plan_input *in, plan *p) {
    const scene_quality *q = &in->scene->quality;
    if (!(p->scene.effects & VIT_BIT(PHOTONS)))
        return;
    p->lit_area = lit_area(in->dark_sides);
    p->free_path = in->dark_sides->free_path;
    const double slots = (double)q->photons * (q->bounces - 1);
    p->scene.radius = (float)(q->radius > 0 ? q->radius : plan_radius(p, slots));
    p->scene.flatten = q->flattened ? (float)q->flatten : 0.0f;
}

vit_status plan_make(const plan_input *in, plan *out, vit_text *why) {
    memset(out, 0, sizeof *out);
    out->materials = calloc((size_t)in->model->material_count, sizeof *out->materials);
    out->baked_paths = calloc(in->tracks->light_count + 1u, sizeof *out->baked_paths);
    out->maps = calloc((size_t)in->model->material_count, sizeof *out->maps);
    if (!out->materials || !out->maps || !out->baked_paths) {
        plan_free(out);
        return bake_fail(why, VIT_FAILED, "out of memory");
    }
    plan_materials(in->model, in->atlas, out);
    plan_maps(in->scene, in->model, in->atlas, out);
    plan_constants(in, &out->scene);
    vit_status status = plan_lights(in, out, why);
    if (status == VIT_OK)
        status = plan_effects(in, out, why);
    if (status == VIT_OK)
        plan_photons(in, out);
    else
        plan_free(out);
    return status;
}

vit_status plan_share(const plan_input *in, const double *worth, plan *p, vit_text *why) {
    const vit_status status = share_paths(in, worth, p, why);
    p->area_paths = p->scene.effects & VIT_BIT(AREA_LIGHTS) ? p->area_paths : 0;
    p->sky_paths = p->scene.effects & VIT_BIT(SKY_LIGHT) ? p->sky_paths : 0;
    return status;
}

double plan_radius(const plan *p, double stored) {
    const double of_one = sqrt(p->lit_area / (PI * stored)); /* its disc holds one photon on average */
    const double radius =
        fmin(fmax(AUTO_OF_WAY * p->free_path, sqrt(AUTO_LEAST_PHOTONS) * of_one), sqrt(AUTO_MOST_PHOTONS) * of_one);
    int exponent;
    const double fraction =
        frexp(radius, &exponent); /* to 12 bits: rays' lengths may differ in their last bits from processor to processor */
    return ldexp(floor(fraction * 4096 + 0.5) / 4096, exponent);
}

bool plan_leaves_area_out(const scene_quality *q) {
    return q->effective_area && q->buckets && q->zones;
}

void plan_free(plan *p) {
    free(p->materials);
    free(p->maps);
    free(p->baked_paths);
    area_lights_free(&p->area);
    memset(p, 0, sizeof *p);
}
