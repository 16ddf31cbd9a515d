/* Unidirectional path tracing (Kajiya 1986) with a shadow ray to every light at every hit: the adjoint of kernels/photons.cl,
 * from which it differs in rounding alone. Where photons leave the runtime's scene or lose their power, paths end. */
#include "paths.h"
#include "lights.h"
#include "sequence.h"

#define SURVIVAL 0.95 /* most that Russian roulette lets live, so that paths in white rooms end */

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
    /* An atlas is read only here; its pointers are not const since bake/atlas.c fills them. */
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
                                .atlas = &out->atlas,
                                .ray_offset = meta->ray_offset,
                                .box_pad = meta->box_pad};
    return photon_rays_open(&out->scene, threads, &out->rays);
}

void paths_close(path_scene *p) {
    photon_rays_close(&p->rays);
}

/* Irradiance at p about the unit normal n straight from the lights, W/m2. */
static void irradiance(const path_scene *s, vec3 p, vec3 n, bool indirect, double out[3], uint64_t *rays) {
    out[0] = out[1] = out[2] = 0;
    for (uint32_t i = 0; i < s->meta->lights; i++) {
        const vit_light *light = s->lights + i;
        vec3 l;
        float d;
        if (indirect && s->direct_only && s->direct_only[i])
            continue;
        const float e = light_irradiance(light, p, n, &l, &d);
        if (!(e > 0.0f))
            continue;
        *rays += 1;
        if (photon_rays_occluded(&s->rays, p, l, d))
            continue;
        for (int k = 0; k < 3; k++)
            out[k] += (double)light->intensity[k] * (double)e;
    }
}

/* l_decode_normal() of kernels/scene.clh. */
static vec3 decode_normal(uint32_t code) {
    const float x = (float)(int16_t)(code & 0xffffu) / 32767.0f, y = (float)(int16_t)(code >> 16) / 32767.0f;
    const float ax = fabsf(x), ay = fabsf(y), z = 1.0f - ax - ay;
    const float fx = x < 0.0f ? ay - 1.0f : 1.0f - ay, fy = y < 0.0f ? ax - 1.0f : 1.0f - ax;
    return vec3_unit(z < 0.0f ? (vec3){fx, fy, z} : (vec3){x, y, z});
}

/* The interpolated normal on the side of `face`; surface_at() of kernels/surface.clh. */
static vec3 shading_normal(const vit_attributes *a, const float b[3], vec3 face) {
    const vec3 n0 = decode_normal(a->normal[0]), n1 = decode_normal(a->normal[1]), n2 = decode_normal(a->normal[2]);
    const vec3 n = vec3_unit(vec3_along(vec3_along(vec3_scale(n0, b[0]), n1, b[1]), n2, b[2]));
    const float side = vec3_dot(n, face);
    if (side == 0.0f)
        return face;
    return vec3_scale(n, side < 0.0f ? -1.0f : 1.0f);
}

void paths_view(const path_scene *p, uint32_t x, uint32_t y, view_sample *out, uint64_t *rays) {
    const vit_camera *c = p->camera;
    const vec3 eye = vec3_load(c->eye), right = vec3_load(c->right), down = vec3_load(c->down);
    const vec3 d = vec3_unit(vec3_along(vec3_along(vec3_load(c->corner), right, (float)x + 0.5f), down, (float)y + 0.5f));
    float t = 0.0f;
    *out = (view_sample){.hit = false};
    *rays += 1;
    const uint32_t triangle = photon_rays_nearest(&p->rays, eye, d, &t);
    if (triangle == VIT_NONE) {
        for (int k = 0; k < 3; k++)
            out->direct[k] = (double)p->meta->background[k] * (double)c->exposure;
        return;
    }
    float b[3];
    const float cone = sqrtf(fmaf(right.z, right.z, fmaf(right.y, right.y, right.x * right.x)));
    const photon_surface s = photon_surface_seen(&p->scene, eye, d, t, triangle, cone, b);
    const vit_attributes *a = p->scene.attributes + triangle;
    const float *emission = p->scene.materials[a->material & VIT_MATERIAL_INDEX].emission;
    *out = (view_sample){.hit = true, .position = s.position, .face = s.face, .albedo = s.albedo};
    out->normal = shading_normal(a, b, s.face);
    double e[3];
    irradiance(p, s.position, out->normal, false, e, rays);
    const double albedo[3] = {(double)s.albedo.x, (double)s.albedo.y, (double)s.albedo.z};
    for (int k = 0; k < 3; k++)
        out->direct[k] = ((double)emission[k] + albedo[k] * e[k] / 3.14159265358979323846) * (double)c->exposure;
}

/* Cosine-distributed unit direction about n. */
static vec3 cosine_direction(vec3 n, float u, float v) {
    const float s = sqrtf(u), c = sqrtf(float_max(1.0f - u, 0.0f));
    float sp, cp;
    sincos_turn(v, &sp, &cp);
    vec3 ax, ay;
    vec3_across(n, &ax, &ay);
    return vec3_unit(vec3_along(vec3_along(vec3_scale(n, c), ax, s * cp), ay, s * sp));
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

/* Path i of the sequence. weight: albedos on the way, so that weight * irradiance is the first hit's irradiance by this path
 * (cosine sampling cancels cosines and 1 / pi). */
static void trace(const path_scene *p, const view_sample *v, uint32_t seed, uint32_t i, bool only_limited, path_sums *out,
                  uint64_t *rays) {
    double weight[3] = {1, 1, 1};
    vec3 o = v->position, n = p->face_normals ? v->face : v->normal;
    for (uint32_t hit = 1; hit < p->bounces || !only_limited; hit++) {
        float a, b, t = 0.0f;
        const uint32_t dimension = pcg(seed ^ pcg(hit));
        if (hit >= p->bounces && !survives(weight, pcg(dimension ^ pcg(i + 0x5bd1e995u))))
            return;
        sequence_point(dimension, i, &a, &b);
        const vec3 d = cosine_direction(n, a, b);
        if (hit == 1 && !(vec3_dot(d, v->face) > 0.0f))
            return;
        *rays += 1;
        const uint32_t triangle = photon_rays_nearest(&p->rays, o, d, &t);
        if (triangle == VIT_NONE)
            return;
        const photon_surface s = photon_surface_at(&p->scene, o, d, t, triangle);
        weight[0] *= (double)s.albedo.x;
        weight[1] *= (double)s.albedo.y;
        weight[2] *= (double)s.albedo.z;
        if (!(weight[0] + weight[1] + weight[2] > 0))
            return;
        double e[3];
        irradiance(p, s.position, s.face, true, e, rays);
        for (int k = 0; k < 3; k++) {
            if (hit < p->bounces)
                out->limited[k] += weight[k] * e[k];
            out->unlimited[k] += weight[k] * e[k];
        }
        o = s.position;
        n = s.face;
    }
}

void paths_trace(const path_scene *p, const view_sample *v, uint32_t seed, uint32_t first, uint32_t count, bool only_limited,
                 path_sums *out, uint64_t *rays) {
    path_sums sums = {.limited = {0}};
    *out = sums;
    if (!v->hit)
        return;
    for (uint32_t i = first; i < first + count; i++)
        trace(p, v, seed, i, only_limited, &sums, rays);
    const double albedo[3] = {(double)v->albedo.x, (double)v->albedo.y, (double)v->albedo.z};
    for (int k = 0; k < 3; k++) {
        const double scale = albedo[k] / 3.14159265358979323846 * (double)p->camera->exposure;
        out->limited[k] = scale * sums.limited[k];
        out->unlimited[k] = scale * sums.unlimited[k];
    }
}
