/* The rays that a frame casts, made on the host by the kernels' own arithmetic, in the order of its view samples: tile by tile,
 * and in a tile in blocks of 4 x 4 pixels, so that a packet of 16 is a block for both sides. */
#ifndef VIT_BENCH_VIEW_RAYS_H
#define VIT_BENCH_VIEW_RAYS_H

#include "embree_packets.h"

typedef struct vec3 {
    float x, y, z;
} vec3;

static inline vec3 vec3_of(const float v[3]) {
    return (vec3){v[0], v[1], v[2]};
}

static inline float vec3_dot(vec3 a, vec3 b) {
    return fmaf(a.z, b.z, fmaf(a.y, b.y, a.x * b.x));
}

static inline vec3 vec3_scale(vec3 a, float s) {
    return (vec3){a.x * s, a.y * s, a.z * s};
}

static inline vec3 vec3_along(vec3 a, vec3 b, float s) {
    return (vec3){fmaf(b.x, s, a.x), fmaf(b.y, s, a.y), fmaf(b.z, s, a.z)};
}

static inline vec3 vec3_unit(vec3 a) {
    const float d = vec3_dot(a, a);
    return vec3_scale(a, d > 0 ? 1.0f / sqrtf(d) : 0);
}

static inline ray_planes rays_new(uint32_t n) {
    return (ray_planes){n, bench_array((size_t)n * 7, sizeof(float))};
}

static inline void rays_free(ray_planes *r) {
    free(r->value);
    *r = (ray_planes){0};
}

static inline void rays_set(ray_planes *r, uint32_t i, vec3 o, vec3 d, float limit) {
    const float v[] = {o.x, o.y, o.z, d.x, d.y, d.z, limit};
    for (uint32_t k = 0; k < 7; k++)
        ray_plane(r, k)[i] = v[k];
}

/* Pixel of a view sample: scene.clh. */
static inline void sample_pixel(const vit_scene *s, uint32_t sample, uint32_t *x, uint32_t *y) {
    const uint32_t per_tile = s->tile * s->tile, tile = sample / per_tile, in_tile = sample % per_tile, block = in_tile / 16;
    *x = tile % s->tiles_x * s->tile + block % (s->tile / 4) * 4 + in_tile % 4;
    *y = tile / s->tiles_x * s->tile + block / (s->tile / 4) * 4 + in_tile / 4 % 4;
}

/* One ray a pixel; padding has none. Returns the number of rays. */
static inline uint32_t rays_of_camera(const vit_scene *s, const vit_camera *c, ray_planes *out) {
    uint32_t count = 0;
    *out = rays_new(s->samples);
    for (uint32_t i = 0; i < s->samples; i++) {
        uint32_t x, y;
        sample_pixel(s, i, &x, &y);
        const bool inside = x < s->width && y < s->height;
        const vec3 across = vec3_along(vec3_of(c->corner), vec3_of(c->right), (float)x + 0.5f);
        rays_set(out, i, vec3_of(c->eye), vec3_unit(vec3_along(across, vec3_of(c->down), (float)y + 0.5f)),
                 inside ? 3e38f : -1.0f);
        count += inside;
    }
    return count;
}

/* Octahedral normal: l_decode_normal in scene.clh. */
static inline vec3 normal_decode(uint32_t code) {
    const float x = (float)(int16_t)(code & 0xffffu) / 32767.0f, y = (float)(int16_t)(code >> 16) / 32767.0f;
    const float ax = fabsf(x), ay = fabsf(y), z = 1.0f - ax - ay;
    if (z >= 0)
        return vec3_unit((vec3){x, y, z});
    return vec3_unit((vec3){x < 0 ? ay - 1.0f : 1.0f - ay, y < 0 ? ax - 1.0f : 1.0f - ax, z});
}

/* One ray from each view sample that faces the light (a point light without a range) to it, as direct.cl casts them. */
static inline uint32_t rays_to_light(const vit_scene *s, const vit_light *light, const uint32_t *triangle,
                                     const float *position, const uint32_t *normal, ray_planes *out) {
    const size_t n = s->samples;
    uint32_t count = 0;
    *out = rays_new(s->samples);
    for (uint32_t i = 0; i < s->samples; i++) {
        const vec3 p = {position[i], position[n + i], position[2 * n + i]};
        const vec3 to = {light->position[0] - p.x, light->position[1] - p.y, light->position[2] - p.z};
        const float d = sqrtf(fmaxf(vec3_dot(to, to), 1e-12f));
        const vec3 l = vec3_scale(to, 1.0f / d);
        const bool lit = triangle[i] != VIT_NONE && vec3_dot(normal_decode(normal[i]), l) > 0;
        rays_set(out, i, p, l, lit ? d : -1.0f);
        count += lit;
    }
    return count;
}

#endif
