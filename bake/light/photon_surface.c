#include "light/photon_surface.h"
#include "light/photon_specular.h"

/* Signed edge functions of a triangle: weights of its vertices, not normalised; ray_edges() of kernels/ray.clh. */
static void edge_weights(const vit_triangle *t, vec3 origin, vec3 direction, float weight[3]) {
    vec3 across, up;
    vec3_across(direction, &across, &up);
    const float *vertex[3] = {t->v0, t->v1, t->v2};
    float x[3], y[3];
    for (int k = 0; k < 3; k++) {
        const vec3 v = vec3_sub(vec3_load(vertex[k]), origin);
        x[k] = vec3_dot(v, across);
        y[k] = vec3_dot(v, up);
    }
    weight[0] = x[1] * y[2] - y[1] * x[2];
    weight[1] = x[2] * y[0] - y[2] * x[0];
    weight[2] = x[0] * y[1] - y[0] * x[1];
}

/* A coordinate that is not finite, which only an absurd texture mapping gives, becomes 0. */
static float wrap(float x, uint32_t mode) {
    const float half = x * 0.5f, twice = (half - floorf(half)) * 2.0f;
    float r = x - floorf(x);
    if (mode == VIT_WRAP_CLAMP)
        r = float_min(float_max(x, 0.0f), 1.0f);
    else if (mode == VIT_WRAP_MIRROR)
        r = twice > 1.0f ? 2.0f - twice : twice;
    return r >= 0.0f ? r : 0.0f;
}

/* A colour, or the three numbers of a map. */
static vec3 texel_color(const atlas *a, bool map, uint32_t word) {
    const vit_u32 code = a->texels[word];
    const vec3 c = {(float)(code & 1023u), (float)((code >> 10) & 1023u), (float)((code >> 20) & 1023u)};
    const vec3 r = vec3_scale(c, 1.0f / 1023.0f);
    return map ? c : vec3_times(r, r);
}

/* As texture_level() of kernels/texture.clh. */
static int mip_level(uint64_t effects, float footprint2, float doubled_area, float doubled_uv_area, float texels,
                     float *blend) {
    const float covered = footprint2 * fabsf(doubled_uv_area) * texels / float_max(doubled_area, 1e-30f);
    const float clamped = float_max(float_min(covered, 1e30f), 1e-30f);
    int32_t bits;
    memcpy(&bits, &clamped, sizeof bits);
    const int exponent = (bits >> 23) - 127;
    *blend = 0.0f;
    if (!(effects & VIT_BIT(TRILINEAR)))
        return exponent < -1 ? 0 : (exponent + 1) >> 1;
    if (exponent < 0)
        return 0;
    const int32_t mantissa_bits = (bits & 0x7fffff) | 0x3f800000;
    float mantissa;
    memcpy(&mantissa, &mantissa_bits, sizeof mantissa);
    *blend = ((float)(exponent & 1) + (mantissa - 1.0f)) * 0.5f;
    return exponent >> 1;
}

static vec3 nearest_color(const atlas *a, bool map, const vit_mip *mip, float s, float t) {
    const uint32_t x = (uint32_t)(s * (float)mip->width), y = (uint32_t)(t * (float)mip->height);
    return texel_color(
        a, map, mip->offset + (y < mip->height ? y : mip->height - 1) * mip->pitch + (x < mip->width ? x : mip->width - 1));
}

/* s, t: wrapped, 0..1. The gutter holds what lies beyond the image. */
static vec3 bilinear_color(const atlas *a, bool map, const vit_mip *mip, float s, float t) {
    float u = fmaf(s, (float)mip->width, -0.5f), v = fmaf(t, (float)mip->height, -0.5f);
    const float fu = floorf(u), fv = floorf(v);
    const uint32_t word = mip->offset + (uint32_t)(int)fv * mip->pitch + (uint32_t)(int)fu;
    u -= fu;
    v -= fv;
    const vec3 c00 = texel_color(a, map, word), c10 = texel_color(a, map, word + 1);
    const vec3 c01 = texel_color(a, map, word + mip->pitch), c11 = texel_color(a, map, word + mip->pitch + 1);
    const vec3 top = vec3_along(c00, vec3_sub(c10, c00), u), bottom = vec3_along(c01, vec3_sub(c11, c01), u);
    return vec3_along(top, vec3_sub(bottom, top), v);
}

/* Where a ray meets a triangle, as textures are looked up there: barycentric weights, and the footprint's squared width, m2. */
typedef struct texture_place {
    const vit_attributes *at;
    const float *b;
    float footprint2, doubled_area;
} texture_place;

/* As surface_texture() of kernels/surface.clh. */
static vec3 texture_color(const photon_scene *s, uint32_t number, bool map, const texture_place *p) {
    const vit_texture *texture = s->atlas->textures + number;
    const vit_mip *finest = s->atlas->mips + texture->first_mip;
    const float(*uv)[2] = p->at->uv, *b = p->b;
    const float x = fmaf(b[2], uv[2][0], fmaf(b[1], uv[1][0], b[0] * uv[0][0])),
                y = fmaf(b[2], uv[2][1], fmaf(b[1], uv[1][1], b[0] * uv[0][1]));
    const float uv_area = (uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) - (uv[2][0] - uv[0][0]) * (uv[1][1] - uv[0][1]);
    float blend;
    const int level = mip_level(s->effects, p->footprint2, p->doubled_area, uv_area,
                                (float)finest->width * (float)finest->height, &blend),
              coarsest = (int)texture->mip_count - 1;
    const atlas *a = s->atlas;
    const vit_mip *mip = finest + (level < coarsest ? level : coarsest);
    const float u = wrap(x, texture->wrap_u), v = wrap(y, texture->wrap_v);
    if (s->effects & VIT_BIT(NEAREST))
        return nearest_color(a, map, mip, u, v);
    const vec3 c = bilinear_color(a, map, mip, u, v);
    if (!(s->effects & VIT_BIT(TRILINEAR)) || level >= coarsest)
        return c;
    return vec3_along(c, vec3_sub(bilinear_color(a, map, mip + 1, u, v), c), blend);
}

/* Reflectance there. */
static vec3 albedo_at(const photon_scene *s, const texture_place *p) {
    const vit_material *m = s->materials + (p->at->material & VIT_MATERIAL_INDEX);
    const vec3 plain = vec3_load(m->albedo);
    return m->texture == VIT_NONE ? plain : vec3_times(plain, texture_color(s, m->texture, false, p));
}

/* The interpolated normal on the face's side; as in surface_at() of kernels/surface.clh. */
static vec3 normal_at(const vit_attributes *at, const float b[3], vec3 face) {
    if (!(at->material & VIT_TRIANGLE_SMOOTH))
        return face;
    const vec3 n0 = decoded_normal(at->normal[0]), n1 = decoded_normal(at->normal[1]), n2 = decoded_normal(at->normal[2]);
    const vec3 n = vec3_unit(vec3_along(vec3_along(vec3_scale(n0, b[0]), n1, b[1]), n2, b[2]));
    const float side = vec3_dot(n, face);
    return side == 0.0f ? face : vec3_scale(n, side < 0.0f ? -1.0f : 1.0f);
}

/* A vertex's tangent; surface_tangent() of kernels/surface.clh. */
static vec3 tangent_of(vec3 n, uint32_t code) {
    vec3 ax, ay;
    vec3_across(n, &ax, &ay);
    const float turn = (float)((int32_t)code - 1) * (4.0f / VIT_TANGENT_STEPS);
    const float x = turn < 2.0f ? 1.0f - turn : turn - 3.0f, y = 1.0f - fabsf(x);
    return vec3_unit(vec3_along(vec3_scale(ax, x), ay, turn < 2.0f ? y : -y));
}

/* The normal n as a normal map bends it; surface_bent() of kernels/surface.clh. */
static vec3 bent_normal(const photon_scene *s, const texture_place *p, vec3 n, vec3 face) {
    const vit_maps *maps = s->maps ? s->maps + (p->at->material & VIT_MATERIAL_INDEX) : NULL;
    const vit_u32 *word = p->at->tangent;
    const uint32_t mask = (1u << VIT_TANGENT_BITS) - 1,
                   code[3] = {word[0] & mask, word[0] >> 21 | (word[1] & 0x3ffu) << 11, word[1] >> 10 & mask};
    if (!maps || maps->normal == VIT_NONE || code[0] == 0)
        return n;
    vec3 t = {0, 0, 0}, outside = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        const vec3 own = decoded_normal(p->at->normal[k]);
        t = vec3_along(t, tangent_of(own, code[k]), p->b[k]);
        outside = vec3_along(outside, own, p->b[k]);
    }
    t = vec3_along(t, n, -vec3_dot(t, n));
    if (!(vec3_dot(t, t) > 1e-12f))
        return n;
    t = vec3_unit(t);
    const vec3 b = {n.y * t.z - n.z * t.y, n.z * t.x - n.x * t.z, n.x * t.y - n.y * t.x},
               map = texture_color(s, maps->normal, true, p);
    const float step = 2.0f / VIT_MAP_ONE, scale = maps->normal_scale;
    const float x = fmaf(map.x, step, -1.0f) * scale, y = fmaf(map.y, step, -1.0f) * scale, z = fmaf(map.z, step, -1.0f);
    vec3 bent = vec3_scale(n, z);
    bent = vec3_along(bent, t, vec3_dot(outside, n) < 0.0f ? -x : x);
    bent = vec3_unit(vec3_along(bent, b, word[1] & VIT_TANGENT_MIRRORED ? -y : y));
    bent = vec3_unit(vec3_along(bent, face, float_max(VIT_NORMAL_ABOVE - vec3_dot(bent, face), 0.0f)));
    return vec3_dot(bent, bent) > 0.5f ? bent : n;
}

#define SURFACE_GRAZING 0.125f /* as in kernels/surface.clh */

/* As surface_before() of kernels/surface.clh. */
static vec3 surface_before(vec3 origin, vec3 direction, float distance, vec3 face, float cosine, float offset) {
    const float back = float_min(offset / float_max(cosine, SURFACE_GRAZING), distance);
    return vec3_along(vec3_along(origin, direction, distance - back), face, float_max(fmaf(-back, cosine, offset), 0.0f));
}

photon_surface photon_surface_seen(const photon_scene *s, vec3 origin, vec3 direction, float distance, uint32_t triangle,
                                   float cone, float b[3]) {
    const vit_triangle *t = s->triangles + triangle;
    float weight[3];
    edge_weights(t, origin, direction, weight);
    const float sum = weight[0] + weight[1] + weight[2];
    const float b1 = sum == 0.0f ? 0.333333333f : weight[1] / sum, b2 = sum == 0.0f ? 0.333333333f : weight[2] / sum;
    b[0] = 1.0f - b1 - b2;
    b[1] = b1;
    b[2] = b2;
    const vec3 n = {t->nx, t->ny, t->nz};
    const float doubled_area = sqrtf(vec3_dot(n, n)), facing = vec3_dot(n, direction);
    photon_surface r;
    const vit_attributes *at = s->attributes + triangle;
    r.back = facing > 0.0f;
    r.face = vec3_scale(vec3_unit(n), r.back ? -1.0f : 1.0f);
    r.material = s->materials + (at->material & VIT_MATERIAL_INDEX);
    const float cosine = fabsf(facing) / float_max(doubled_area, 1e-30f);
    r.position = surface_before(origin, direction, distance, r.face, cosine, s->ray_offset);
    r.beyond = vec3_along(vec3_along(origin, direction, distance), r.face, -s->ray_offset);
    const float width = cone * distance;
    const texture_place place = {at, b, width * width / float_max(cosine, 0.05f), doubled_area};
    r.albedo = albedo_at(s, &place);
    r.normal = bent_normal(s, &place, normal_at(at, b, r.face), r.face);
    return r;
}

photon_surface photon_surface_at(const photon_scene *s, vec3 origin, vec3 direction, float distance, uint32_t triangle) {
    float b[3];
    return photon_surface_seen(s, origin, direction, distance, triangle, PHOTON_CONE, b);
}

bool photon_opaque_place(const photon_scene *s, uint32_t triangle, const float b[3]) {
    const vit_attributes *at = s->attributes + triangle;
    const vit_material *m = s->materials + (at->material & VIT_MATERIAL_INDEX);
    if (!m->cutout || m->texture == VIT_NONE)
        return true;
    const vit_texture *texture = s->atlas->textures + m->texture;
    const vit_mip *mip = s->atlas->mips + texture->first_mip;
    const float u =
        wrap(fmaf(b[2], at->uv[2][0], fmaf(b[1], at->uv[1][0], b[0] * at->uv[0][0])), texture->wrap_u) * (float)mip->width;
    const float v =
        wrap(fmaf(b[2], at->uv[2][1], fmaf(b[1], at->uv[1][1], b[0] * at->uv[0][1])), texture->wrap_v) * (float)mip->height;
    const uint32_t x = (uint32_t)u < mip->width ? (uint32_t)u : mip->width - 1;
    const uint32_t y = (uint32_t)v < mip->height ? (uint32_t)v : mip->height - 1;
    return s->atlas->texels[mip->offset + y * mip->pitch + x] >> 31;
}

vec3 photon_reflectance(const photon_scene *s, const photon_surface *at) {
    const vit_material *m = at->material;
    vec3 lobe = vec3_load(m->specular);
    if (!(s->effects & VIT_BIT(SPECULAR)) || !(lobe.x + lobe.y + lobe.z > 0.0f))
        return at->albedo;
    if ((s->effects & VIT_BIT(GGX)) && m->alpha > 0.0f)
        lobe = specular_mean(lobe, m->alpha);
    return vec3_along(at->albedo, lobe, 1.0f);
}

bool photon_opaque_at(const photon_scene *s, vec3 origin, vec3 direction, uint32_t triangle) {
    const vit_material *m = s->materials + (s->attributes[triangle].material & VIT_MATERIAL_INDEX);
    if (!m->cutout)
        return true;
    float weight[3];
    edge_weights(s->triangles + triangle, origin, direction, weight);
    const float sum = weight[0] + weight[1] + weight[2], scale = sum == 0.0f ? 0.0f : 1.0f / sum;
    return photon_opaque_place(s, triangle, (const float[]){weight[0] * scale, weight[1] * scale, weight[2] * scale});
}
