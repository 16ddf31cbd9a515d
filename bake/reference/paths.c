/* Unidirectional path tracing (Kajiya 1986) with a shadow ray to every light at every hit: in scenes of matt surfaces and small
 * lights the adjoint of kernels/photons.cl, from which it differs in rounding alone. Where photons leave the runtime's scene or
 * lose their power, paths end.
 *
 * Small lights (points, spots, directions) are found by shadow rays alone, area lights and the sky both by these and by chance
 * (light_sampling.h), through mirrors and glass by chance alone. Radiance inside glass is basic radiance (divided by the
 * squared index), which no refraction changes. Small lights' light by mirrors and glass are photons (caustics.h). */
#include "reference/paths.h"
#include "reference/caustics.h"
#include "light/light_model.h"
#include "reference/sequence.h"

#define SURVIVAL 0.95 /* most that Russian roulette lets live, so that paths in white rooms end */
#define CHAIN 64u     /* mirrors and glass on the way of a view ray, at most */

/* Dimensions beside a hit's own. */
enum {
    OF_AREA = 0x243f6a88,
    OF_SKY = 0x13198a2e,
    OF_GLASS = 0x03707344,
    OF_PIXEL = 0x299f31d0,
    OF_AMBIENT = 0x082efa98,
    OF_CHAIN = 0x10000
};

static bool has_panes(const path_scene *p) {
    for (uint32_t i = 0; i < p->meta->triangles; i++)
        if (p->scene.materials[p->scene.attributes[i].material & VIT_MATERIAL_INDEX].kind == VIT_THIN_GLASS)
            return true;
    return false;
}

path_filter paths_filter(const vit_scene *s) {
    path_filter f = s->copies > 1 ? PATH_BOX : PATH_CENTRE;
    for (uint32_t i = 0; i < s->copies && i < VIT_MAX_COPIES && f == PATH_BOX; i++)
        if (fabsf(s->offset[i][0]) > 0.5f || fabsf(s->offset[i][1]) > 0.5f)
            f = PATH_TENT;
    return f;
}

bool paths_open(const reference_input *in, unsigned threads, path_scene *out) {
    const void *const *data = in->sections->data;
    const vit_scene *meta = data[VIT_SECTION_META];
    *out = (path_scene){.meta = meta,
                        .camera = (const vit_camera *)data[VIT_SECTION_CAMS] + in->frame,
                        .direct_only = in->direct_only,
                        .bounces = in->bounces,
                        .face_normals = in->face_normals};
    if (meta->lights > 0)
        out->lights = (const vit_light *)data[VIT_SECTION_LITE] + (size_t)in->frame * meta->lights;
    /* An atlas is read only here; its pointers are not const since bake/geometry/atlas.c fills them. */
    out->atlas = (atlas){.texels = (vit_u32 *)(uintptr_t)data[VIT_SECTION_ATLS],
                         .texel_count = meta->texels,
                         .textures = (vit_texture *)(uintptr_t)data[VIT_SECTION_TEXR],
                         .texture_count = meta->textures,
                         .mips = (vit_mip *)(uintptr_t)data[VIT_SECTION_MIPS],
                         .mip_count = meta->mips};
    out->scene = (photon_scene){.triangles = data[VIT_SECTION_GEOM],
                                .attributes = data[VIT_SECTION_ATTR],
                                .triangle_count = meta->triangles,
                                .materials = data[VIT_SECTION_MATL],
                                .maps = VIT_HAS_MAPS(meta->effects) ? data[VIT_SECTION_MAPS] : NULL,
                                .atlas = &out->atlas,
                                .ray_offset = meta->ray_offset,
                                .box_pad = meta->box_pad};
    out->filter = paths_filter(meta);
    out->panes = meta->lights > 0 && has_panes(out);
    if (!light_sampler_open(meta, &out->scene, data[VIT_SECTION_SKYT], &out->wide))
        return false;
    out->by_chance = out->wide.count > 0 || out->wide.sky_lights;
    if (photon_rays_open(&out->scene, threads, &out->rays))
        return true;
    light_sampler_close(&out->wide);
    return false;
}

void paths_close(path_scene *p) {
    photon_rays_close(&p->rays);
    light_sampler_close(&p->wide);
}

/* Light straight from the small lights that a place reflects: Pi times radiance where it has a lobe, else irradiance. */
typedef struct small_lights {
    double open[3];                  /* with nothing in between */
    double limited[3], unlimited[3]; /* through panes: at most `most`, and any number */
} small_lights;

/* Passes the panes between o and what is `distance` metres along d. Returns how many there are, and at `part` what they let
 * through; -1: something else is in the way. */
static int pass_panes(const path_scene *s, vec3 o, vec3 d, float distance, double part[3], uint64_t *rays) {
    part[0] = part[1] = part[2] = 1;
    for (int panes = 0; panes < (int)CHAIN; panes++) {
        float t = 0.0f;
        *rays += 1;
        const uint32_t triangle = photon_rays_nearest(&s->rays, o, d, &t);
        if (triangle == VIT_NONE || t > distance)
            return panes;
        const photon_surface f = photon_surface_at(&s->scene, o, d, t, triangle);
        if (f.material->kind != VIT_THIN_GLASS)
            return -1;
        const specular_paths way = specular_at_glass(d, f.normal, f.face, false, true, f.material->ior);
        for (int k = 0; k < 3; k++)
            part[k] *= (1 - (double)way.mirror) * (double)f.material->specular[k];
        o = f.beyond;
        distance -= t;
    }
    return -1;
}

/* `indirect`: without lights that give no indirect light. most: panes that limited light may pass. */
static void look_at_lights(const path_scene *s, const path_vertex *place, vec3 n, bool indirect, int most, small_lights *out,
                           uint64_t *rays) {
    *out = (small_lights){.open = {0}};
    for (uint32_t i = 0; i < s->meta->lights; i++) {
        const vit_light *light = s->lights + i;
        vec3 l;
        float d;
        double part[3], reflected[3] = {1, 1, 1};
        int panes = 0;
        if (indirect && s->direct_only && s->direct_only[i])
            continue;
        const float e = light_irradiance(light, s->meta->ray_offset, place->position, n, &l, &d);
        if (!(e > 0.0f) || !(vec3_dot(place->face, l) > 0.0f))
            continue;
        *rays += 1;
        if (photon_rays_occluded(&s->rays, place->position, l, d)) {
            panes = s->panes ? pass_panes(s, place->position, l, d, part, rays) : -1;
            if (panes <= 0 || (s->direct_only && s->direct_only[i]))
                continue;
        }
        if (place->glossy)
            specular_reflectance(place, l, reflected);
        for (int k = 0; k < 3; k++) {
            const double light_here = (double)light->intensity[k] * (double)e * reflected[k];
            if (panes == 0)
                out->open[k] += light_here;
            else {
                out->limited[k] += panes <= most ? light_here * part[k] : 0;
                out->unlimited[k] += light_here * part[k];
            }
        }
    }
}

/* What light that has come to a matt or glossy surface along -d does there. */
static path_vertex place_of(const photon_surface *s, vec3 normal, vec3 d) {
    path_vertex r = {.position = s->position,
                     .face = s->face,
                     .normal = normal,
                     .out = vec3_scale(d, -1.0f),
                     .albedo = s->albedo,
                     .specular = vec3_load(s->material->specular),
                     .exponent = s->material->exponent,
                     .alpha = s->material->alpha};
    r.glossy = r.specular.x + r.specular.y + r.specular.z > 0.0f;
    return r;
}

void paths_pass_on(const photon_surface *s, float t, double random, vec3 *o, vec3 *d, double weight[3]) {
    const vit_material *m = s->material;
    const bool inside = m->kind == VIT_GLASS && s->back;
    const specular_paths way = specular_at_glass(*d, s->normal, s->face, s->back, m->kind == VIT_THIN_GLASS, m->ior);
    const bool through = m->kind != VIT_MIRROR && random >= (double)way.mirror;
    *d = through ? way.refracted : way.mirrored;
    *o = through ? s->beyond : s->position;
    for (int k = 0; k < 3; k++)
        weight[k] *= (through || m->kind == VIT_MIRROR ? (double)m->specular[k] : 1) *
                     (inside ? exp(-(double)m->absorption[k] * (double)t) : 1);
}

/* The view sample of the ray through the point (fx, fy) of the frame, pixels; path: of the sequence that `seed` names, or NULL:
 * the same for all paths, and where it meets glass it is `random`. */
static void look(const path_scene *p, float fx, float fy, const uint32_t *path, uint32_t seed, view_sample *out,
                 uint64_t *rays) {
    const vit_camera *c = p->camera;
    const vec3 right = vec3_load(c->right);
    /* Where paths are spread over the pixel, they filter textures themselves. */
    const float cone =
        p->filter == PATH_CENTRE ? sqrtf(fmaf(right.z, right.z, fmaf(right.y, right.y, right.x * right.x))) : 0.0f;
    /* 1. The ray through the point. */
    vec3 o = vec3_load(c->eye), d = vec3_unit(vec3_along(vec3_along(vec3_load(c->corner), right, fx), vec3_load(c->down), fy));
    float way = 0.0f;
    for (uint32_t event = 0; event <= CHAIN; event++) {
        float t = 0.0f, b[3], u = 0.0f, unused;
        *rays += 1;
        const uint32_t triangle = photon_rays_nearest(&p->rays, o, d, &t);
        if (triangle == VIT_NONE) { /* 2. It ends in the sky, */
            double radiance[3];
            light_sampler_sky(&p->wide, d, radiance);
            for (int k = 0; k < 3; k++)
                out->direct[k] += out->weight[k] * radiance[k] * (double)c->exposure;
            return;
        }
        way += t;
        /* The footprint goes on widening behind a mirror as if it were flat. */
        const photon_surface s = photon_surface_seen(&p->scene, o, d, t, triangle, event ? cone * (way / t) : cone, b);
        const vit_material *m = s.material;
        if (m->kind == VIT_MATTE) { /* 3. or on a matt surface, the view sample, with its direct light, */
            out->hit = true;
            out->place = place_of(&s, s.normal, d);
            const path_vertex *q = &out->place;
            const double albedo[3] = {(double)q->albedo.x, (double)q->albedo.y, (double)q->albedo.z};
            small_lights e;
            look_at_lights(p, q, q->normal, false, (int)p->bounces - 1, &e, rays);
            for (int k = 0; k < 3; k++) {
                const double factor = (q->glossy ? 1 : albedo[k]), all = albedo[k] + (double)m->specular[k];
                const double ambient = p->meta->ambient_radius > 0.0f ? 0 : all * (double)p->meta->ambient[k];
                const double own = (double)m->emission[k] + factor * e.open[k] / PI + ambient;
                out->direct[k] += out->weight[k] * own * (double)c->exposure;
                out->limited[k] = out->weight[k] * factor * e.limited[k] / PI * (double)c->exposure;
                out->unlimited[k] = out->weight[k] * factor * e.unlimited[k] / PI * (double)c->exposure;
            }
            if (p->face_normals)
                out->place.normal = q->face;
            return;
        }
        if (m->kind != VIT_MIRROR && !path) { /* 4. or at glass, where each path has a view sample of its own; */
            *out = (view_sample){.random = true, .x = out->x, .y = out->y};
            return;
        }
        /* 5. or goes on. */
        if (path)
            sequence_point(pcg(seed ^ pcg(OF_CHAIN + event)), *path, &u, &unused);
        for (int k = 0; k < 3; k++)
            out->direct[k] += out->weight[k] * (double)m->emission[k] * (double)c->exposure;
        paths_pass_on(&s, t, (double)u, &o, &d, out->weight);
    }
}

void paths_view(const path_scene *p, uint32_t x, uint32_t y, view_sample *out, uint64_t *rays) {
    *out = (view_sample){.random = p->filter != PATH_CENTRE, .x = x, .y = y, .weight = {1, 1, 1}};
    if (!out->random)
        look(p, (float)x + 0.5f, (float)y + 0.5f, NULL, 0, out, rays);
}

/* A number of 0..1 as a place under a tent from -1 to 1. */
static float tent(float u) {
    return u < 0.5f ? sqrtf(2.0f * u) - 1.0f : 1.0f - sqrtf(2.0f - 2.0f * u);
}

/* The view sample of one path. */
static void look_at_random(const path_scene *p, const view_sample *v, uint32_t seed, uint32_t i, view_sample *out,
                           uint64_t *rays) {
    float fx = 0.5f, fy = 0.5f;
    if (p->filter != PATH_CENTRE) {
        sequence_point(pcg(seed ^ OF_PIXEL), i, &fx, &fy);
        if (p->filter == PATH_TENT) {
            fx = tent(fx) + 0.5f;
            fy = tent(fy) + 0.5f;
        }
    }
    *out = (view_sample){.x = v->x, .y = v->y, .weight = {1, 1, 1}};
    look(p, (float)v->x + fx, (float)v->y + fy, &i, seed, out, rays);
}

/* Ends the path or gives what lives the ended paths' share. False: ended. */
static bool survives(double weight[3], uint32_t random) {
    double q = weight[0] > weight[1] ? weight[0] : weight[1];
    q = q > weight[2] ? q : weight[2];
    q = q < SURVIVAL ? q : SURVIVAL;
    if (!((double)random * 0x1p-32 < q))
        return false;
    for (int k = 0; k < 3; k++)
        weight[k] /= q;
    return true;
}

/* A path on its way. Its sums are Pi times radiance over the view sample's albedo, or over 1 if that has a lobe, so that at
 * matt surfaces weight * irradiance is their contribution: cosine sampling cancels cosines and 1 / Pi. */
typedef struct walk {
    const path_scene *p;
    const caustics *caustics; /* may be NULL */
    uint64_t *rays;
    path_sums *out;
    path_vertex at; /* the last matt or glossy surface; its albedo, unless it is glossy, is in the weight */
    double weight[3];
    double density; /* of the direction taken from there; 0: a mirror or glass came after, beyond which lights are found by
                       chance */
} walk;

/* Light that the path's place gets through mirrors and glass. */
static void add_passed(const walk *w, const double limited[3], const double all[3]) {
    for (int k = 0; k < 3; k++) {
        w->out->limited[k] += w->weight[k] * limited[k];
        w->out->unlimited[k] += w->weight[k] * all[k];
    }
}

static void add_caustics(const walk *w, uint32_t hit) {
    double limited[3], all[3];
    caustics_gather(w->caustics, &w->at, (int)w->p->bounces - 1 - (int)hit, limited, all);
    add_passed(w, limited, all);
}

/* Light that took `between` reflections after the one that lit the path's place. */
static void add(const walk *w, uint32_t between, const double light[3]) {
    for (int k = 0; k < 3; k++) {
        if (between == 0)
            w->out->direct[k] += w->weight[k] * light[k];
        else {
            if (between < w->p->bounces)
                w->out->limited[k] += w->weight[k] * light[k];
            w->out->unlimited[k] += w->weight[k] * light[k];
        }
    }
}

/* Radiance from direction d that chance has found; density: with which looking for it would have. */
static void add_found(const walk *w, uint32_t between, const double radiance[3], double density) {
    const double share = w->density > 0 ? w->density / (w->density + density) : 1;
    const double light[3] = {PI * share * radiance[0], PI * share * radiance[1], PI * share * radiance[2]};
    add(w, between, light);
}

static void add_point(const walk *w, uint32_t between, const light_sampler_point *e) {
    const double cosine = (double)vec3_dot(w->at.normal, e->to);
    double reflected[3] = {1, 1, 1};
    if (!(cosine > 0) || !(vec3_dot(w->at.face, e->to) > 0.0f))
        return;
    *w->rays += 1;
    if (photon_rays_occluded(&w->p->rays, w->at.position, e->to, e->distance))
        return;
    if (w->at.glossy)
        specular_reflectance(&w->at, e->to, reflected);
    const double share = cosine / (e->density + specular_density(&w->at, e->to));
    for (int k = 0; k < 3; k++)
        reflected[k] *= share * e->radiance[k];
    add(w, between, reflected);
}

/* Looks for a point of the area lights and of the sky. */
static void look_at_wide(const walk *w, uint32_t between, uint32_t dimension, uint32_t i) {
    const light_sampler *e = &w->p->wide;
    light_sampler_point found;
    double u, v;
    if (e->count > 0) {
        sequence_fine(pcg(dimension ^ OF_AREA), i, &u, &v);
        if (light_sampler_area_point(e, w->at.position, u, v, &found))
            add_point(w, between, &found);
    }
    if (e->sky_rows) {
        sequence_fine(pcg(dimension ^ OF_SKY), i, &u, &v);
        if (light_sampler_sky_point(e, u, v, &found))
            add_point(w, between, &found);
    }
}

/* Ambient light, where surfaces keep it from each other: from one direction. */
static void add_ambient(const walk *w, uint32_t dimension, uint32_t i) {
    const path_vertex *s = &w->at;
    const float radius = w->p->meta->ambient_radius;
    const double all[3] = {(double)s->albedo.x + (double)s->specular.x, (double)s->albedo.y + (double)s->specular.y,
                           (double)s->albedo.z + (double)s->specular.z};
    float a, b;
    if (!(radius > 0.0f))
        return;
    sequence_point(pcg(dimension ^ OF_AMBIENT), i, &a, &b);
    const vec3 d = vec3_cosine(s->normal, a, b);
    if (!(vec3_dot(d, s->face) > 0.0f))
        return;
    *w->rays += 1;
    if (!photon_rays_occluded(&w->p->rays, s->position, d, radius))
        for (int k = 0; k < 3; k++)
            w->out->direct[k] += PI * (s->glossy ? all[k] : 1) * (double)w->p->meta->ambient[k];
}

/* Draws the direction in which the path goes on from w->at. False: it ends, under the surface. */
static bool scatter(walk *w, bool first, float u, float v, vec3 *d) {
    const path_vertex *s = &w->at;
    *d = specular_direction(s, u, v);
    if ((first || s->glossy) && !(vec3_dot(*d, s->face) > 0.0f))
        return false;
    if (w->p->by_chance || s->glossy)
        w->density = specular_density(s, *d);
    if (s->glossy) {
        double reflected[3];
        const double cosine = (double)vec3_dot(s->normal, *d);
        specular_reflectance(s, *d, reflected);
        if (!(cosine > 0) || !(w->density > 0))
            return false;
        for (int k = 0; k < 3; k++)
            w->weight[k] *= reflected[k] * cosine / (PI * w->density);
    }
    return true;
}

/* The path meets a matt or glossy surface at its hit number `hit`. False: it ends, black. */
static bool meet(walk *w, const photon_surface *s, vec3 d, uint32_t hit) {
    w->at = place_of(s, s->face, d);
    if (!w->at.glossy) {
        w->weight[0] *= (double)s->albedo.x;
        w->weight[1] *= (double)s->albedo.y;
        w->weight[2] *= (double)s->albedo.z;
    }
    if (!(w->weight[0] + w->weight[1] + w->weight[2] > 0))
        return false;
    small_lights e;
    look_at_lights(w->p, &w->at, s->face, true, (int)w->p->bounces - 1 - (int)hit, &e, w->rays);
    add(w, hit, e.open);
    if (w->p->panes)
        add_passed(w, e.limited, e.unlimited);
    if (w->caustics)
        add_caustics(w, hit);
    return true;
}

/* Path i of the sequence. */
static void trace(const path_scene *p, const caustics *c, const view_sample *v, uint32_t seed, uint32_t i, bool only_limited,
                  path_sums *out, uint64_t *rays) {
    walk w = {.p = p, .caustics = c, .rays = rays, .out = out, .at = v->place, .weight = {1, 1, 1}};
    const uint32_t most = p->by_chance ? p->bounces : p->bounces - 1; /* hits of limited paths: chance needs one more */
    bool passing = false;                                             /* on from a mirror or glass, along d */
    vec3 o = v->place.position, d = {0, 0, 0};
    if (p->by_chance)
        look_at_wide(&w, 0, pcg(seed ^ pcg(0)), i);
    add_ambient(&w, pcg(seed ^ pcg(0)), i);
    if (c)
        add_caustics(&w, 0);
    for (uint32_t hit = 1; hit <= most || !only_limited; hit++) {
        float a, b, t = 0.0f;
        const uint32_t dimension = pcg(seed ^ pcg(hit));
        if (hit > most && !survives(w.weight, pcg(dimension ^ pcg(i + 0x5bd1e995u))))
            return;
        if (!passing) {
            sequence_point(dimension, i, &a, &b);
            if (!scatter(&w, hit == 1, a, b, &d))
                return;
        }
        *rays += 1;
        const uint32_t triangle = photon_rays_nearest(&p->rays, o, d, &t);
        if (triangle == VIT_NONE) {
            double radiance[3];
            if (!p->wide.sky_lights)
                return;
            light_sampler_sky(&p->wide, d, radiance);
            add_found(&w, hit - 1, radiance, light_sampler_sky_density(&p->wide, d));
            return;
        }
        const photon_surface s = photon_surface_at(&p->scene, o, d, t, triangle);
        if (light_sampler_has(&p->wide, triangle)) {
            const double radiance[3] = {(double)s.material->emission[0], (double)s.material->emission[1],
                                        (double)s.material->emission[2]};
            add_found(&w, hit - 1, radiance, light_sampler_area_density(&p->wide, triangle, d, t));
        }
        passing = s.material->kind != VIT_MATTE;
        if (passing) {
            sequence_point(pcg(dimension ^ OF_GLASS), i, &a, &b);
            paths_pass_on(&s, t, (double)a, &o, &d, w.weight);
            w.density = 0;
            continue;
        }
        if (!meet(&w, &s, d, hit))
            return;
        if (p->by_chance)
            look_at_wide(&w, hit, dimension, i);
        o = s.position;
    }
}

/* Adds paths' sums as the view sample reflects them. */
static void reflect(const path_scene *p, const view_sample *v, const path_sums *sums, path_sums *out) {
    const path_vertex *s = &v->place;
    const double albedo[3] = {(double)s->albedo.x, (double)s->albedo.y, (double)s->albedo.z};
    for (int k = 0; k < 3; k++) {
        const double scale = v->weight[k] * (s->glossy ? 1 : albedo[k]) / PI * (double)p->camera->exposure;
        out->direct[k] += scale * sums->direct[k];
        out->limited[k] += scale * sums->limited[k];
        out->unlimited[k] += scale * sums->unlimited[k];
    }
}

/* Adds what `count` view samples see without paths: v->direct is counted by itself, unless it is random. */
static void add_view(const view_sample *v, double count, bool random, path_sums *out) {
    for (int k = 0; k < 3; k++) {
        out->direct[k] += random ? v->direct[k] : 0;
        out->limited[k] += count * v->limited[k];
        out->unlimited[k] += count * v->unlimited[k];
    }
}

void paths_trace(const path_scene *p, const caustics *c, const view_sample *v, uint32_t seed, uint32_t first, uint32_t count,
                 bool only_limited, path_sums *out, uint64_t *rays) {
    path_sums sums = {.limited = {0}};
    *out = sums;
    for (uint32_t i = first; i < first + count && v->random; i++) {
        view_sample own;
        look_at_random(p, v, seed, i, &own, rays);
        sums = (path_sums){.limited = {0}};
        if (own.hit)
            trace(p, c, &own, seed, i, only_limited, &sums, rays);
        reflect(p, &own, &sums, out);
        add_view(&own, 1, true, out);
    }
    if (v->random || !v->hit)
        return;
    for (uint32_t i = first; i < first + count; i++)
        trace(p, c, v, seed, i, only_limited, &sums, rays);
    reflect(p, v, &sums, out);
    add_view(v, count, false, out);
}
