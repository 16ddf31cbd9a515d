/* kernel_math.h: what kernels/lanes.clh, random.clh and ray.clh compute, as plain C: the same operations in the same order
 * (fmaf where they fuse), so that photons baked here and photons traced while playing are the same photons. */
#ifndef VIT_BAKE_KERNEL_MATH_H
#define VIT_BAKE_KERNEL_MATH_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#define KERNEL_PI 3.14159265358979f
#define KERNEL_INV_PI 0.318309886183791f

typedef struct vec3 {
    float x, y, z;
} vec3;

static inline vec3 vec3_load(const float p[3]) {
    return (vec3){p[0], p[1], p[2]};
}

static inline vec3 vec3_sub(vec3 a, vec3 b) {
    return (vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline vec3 vec3_scale(vec3 a, float s) {
    return (vec3){a.x * s, a.y * s, a.z * s};
}

static inline vec3 vec3_times(vec3 a, vec3 b) {
    return (vec3){a.x * b.x, a.y * b.y, a.z * b.z};
}

/* a + b * s */
static inline vec3 vec3_along(vec3 a, vec3 b, float s) {
    return (vec3){fmaf(b.x, s, a.x), fmaf(b.y, s, a.y), fmaf(b.z, s, a.z)};
}

static inline float vec3_dot(vec3 a, vec3 b) {
    return fmaf(a.z, b.z, fmaf(a.y, b.y, a.x * b.x));
}

static inline vec3 vec3_unit(vec3 a) {
    const float d = vec3_dot(a, a);
    return vec3_scale(a, d > 0.0f ? 1.0f / sqrtf(d) : 0.0f);
}

/* The first of equals, unlike fminf and fmaxf, whose choice between 0 and -0 is open. */
static inline float float_min(float a, float b) {
    return b < a ? b : a;
}

static inline float float_max(float a, float b) {
    return b > a ? b : a;
}

/* Two axes across a unit direction: Duff et al., JCGT 6(1), 2017. */
static inline void vec3_across(vec3 d, vec3 *ax, vec3 *ay) {
    const float s = d.z < 0.0f ? -1.0f : 1.0f;
    const float a = -1.0f / (s + d.z), b = d.x * d.y * a;
    *ax = (vec3){fmaf(s * d.x * d.x, a, 1.0f), s * b, -s * d.x};
    *ay = (vec3){b, fmaf(d.y * d.y, a, s), -d.y};
}

/* sin and cos of 2 pi u, 0 <= u <= 1. */
static inline void sincos_turn(float u, float *s, float *c) {
    const float q = floorf(fmaf(u, 4.0f, 0.5f));
    const float a = fmaf(q, -0.25f, u) * 6.28318530717959f, a2 = a * a;
    const float sa =
        fmaf(a2 * a, fmaf(a2, fmaf(a2, fmaf(a2, 2.75573192e-6f, -1.98412698e-4f), 8.33333333e-3f), -0.166666667f), a);
    const float ca = fmaf(a2, fmaf(a2, fmaf(a2, fmaf(a2, 2.48015873e-5f, -1.38888889e-3f), 4.16666667e-2f), -0.5f), 1.0f);
    const int k = (int)q;
    const float ss = k & 1 ? ca : sa, cc = k & 1 ? sa : ca;
    *s = k & 2 ? -ss : ss;
    *c = (k + 1) & 2 ? -cc : cc;
}

/* The unit direction of cosine c and sine s to the unit vector n, `turn` (0..1) about it. */
static inline vec3 vec3_about(vec3 n, float c, float s, float turn) {
    float sp, cp;
    vec3 ax, ay;
    sincos_turn(turn, &sp, &cp);
    vec3_across(n, &ax, &ay);
    return vec3_unit(vec3_along(vec3_along(vec3_scale(n, c), ax, s * cp), ay, s * sp));
}

/* Cosine-distributed direction about n from two numbers in [0, 1]; ray_cosine() of kernels/ray.clh. */
static inline vec3 vec3_cosine(vec3 n, float a, float b) {
    return vec3_about(n, sqrtf(float_max(1.0f - a, 0.0f)), sqrtf(a), b);
}

/* Point of the disc about `center`, across the unit vector n: square root of the radius, and angle. photon_emission(). */
static inline vec3 vec3_disc(vec3 center, vec3 n, float radius, float u, float v) {
    const float r = sqrtf(u) * radius;
    float s, c;
    vec3 ax, ay;
    sincos_turn(v, &s, &c);
    vec3_across(n, &ax, &ay);
    return vec3_along(vec3_along(center, ax, r * c), ay, r * s);
}

/* The place of direction d in the octahedral square, -1..1; l_octahedral() of kernels/scene.clh. */
static inline void octahedral_place(vec3 d, float *u, float *v) {
    const float s = 1.0f / float_max(fabsf(d.x) + fabsf(d.y) + fabsf(d.z), 1e-30f);
    const float x = d.x * s, y = d.y * s, ax = fabsf(x), ay = fabsf(y);
    *u = !(d.z < 0.0f) ? x : x < 0.0f ? ay - 1.0f : 1.0f - ay;
    *v = !(d.z < 0.0f) ? y : y < 0.0f ? ax - 1.0f : 1.0f - ax;
}

/* 2^x, -126 <= x <= 126; l_exp2() of kernels/lanes.clh. */
static inline float power_of_two(float x) {
    const float k = nearbyintf(x), r = x - k;
    const int32_t bits = ((int32_t)k + 127) << 23;
    float scale, p = fmaf(r, 1.57567294e-4f, 1.34142698e-3f);
    memcpy(&scale, &bits, sizeof scale);
    p = fmaf(r, fmaf(r, fmaf(r, p, 9.61706415e-3f), 5.55027276e-2f), 0.240226552f);
    return fmaf(r, fmaf(r, p, 0.693147242f), 1.0f) * scale;
}

/* A unit normal from 2 x snorm16; l_decode_normal() of kernels/scene.clh. */
static inline vec3 decoded_normal(uint32_t code) {
    const float x = (float)(int16_t)(code & 0xffffu) / 32767.0f, y = (float)(int16_t)(code >> 16) / 32767.0f;
    const float ax = fabsf(x), ay = fabsf(y), z = 1.0f - ax - ay;
    if (!(z < 0.0f))
        return vec3_unit((vec3){x, y, z});
    return vec3_unit((vec3){x < 0.0f ? ay - 1.0f : 1.0f - ay, y < 0.0f ? ax - 1.0f : 1.0f - ax, z});
}

static inline uint32_t pcg(uint32_t v) {
    const uint32_t state = v * 747796405u + 2891336453u;
    const uint32_t word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

/* 24 random bits as a float in [0, 1). */
static inline float unit_float(uint32_t v) {
    return (float)(v >> 8) * 0x1p-24f;
}

/* Point i of a plane lattice, any stretch of which is even over the unit square (Roberts 2018), moved by `shift`: steps of 1 /
 * p and 1 / p^2 with p^3 = p + 1, times 2^32. */
#define LATTICE_U 0xc13fa9a9u
#define LATTICE_V 0x91e10da5u

static inline float lattice_u(uint32_t i, uint32_t shift) {
    return unit_float(i * LATTICE_U + shift);
}

static inline float lattice_v(uint32_t i, uint32_t shift) {
    return unit_float(i * LATTICE_V + shift);
}

/* Every second bit of v, packed. */
static inline uint32_t even_bits(uint32_t v) {
    v &= 0x55555555u;
    v = (v | (v >> 1)) & 0x33333333u;
    v = (v | (v >> 2)) & 0x0f0f0f0fu;
    v = (v | (v >> 4)) & 0x00ff00ffu;
    return (v | (v >> 8)) & 0x0000ffffu;
}

#endif
