/* photon_specular.h: kernels/specular.clh as plain C: where light goes at mirrors and glass, the same operations in the same
 * order.
 */
#ifndef VIT_BAKE_PHOTON_SHINE_H
#define VIT_BAKE_PHOTON_SHINE_H

#include "common/kernel_math.h"
#include <stdbool.h>

/* d mirrored at n, both unit; the ray stays on the side of the unit face normal. */
static inline vec3 specular_mirrored(vec3 d, vec3 n, vec3 face) {
    const vec3 r = vec3_along(d, n, -2.0f * vec3_dot(d, n)), flat = vec3_along(d, face, -2.0f * vec3_dot(d, face));
    return vec3_unit(vec3_dot(r, face) > 0.0f ? r : flat);
}

typedef struct specular_paths {
    vec3 mirrored, refracted; /* unit directions; refracted: only where `mirror` is less than 1 */
    float mirror;             /* Fresnel: the part that is mirrored; 1: total internal reflection */
} specular_paths;

/* Unit direction d meets glass with the unit normals n (shading) and face, both on d's side; back: it comes from the inside. */
static inline specular_paths specular_at_glass(vec3 d, vec3 n, vec3 face, bool back, bool thin, float ior) {
    specular_paths r = {.mirrored = specular_mirrored(d, n, face)};
    const float eta = back && !thin ? ior : 1.0f / ior;
    const float ci = float_min(float_max(-vec3_dot(d, n), 0.0f), 1.0f), st2 = eta * eta * (1.0f - ci * ci);
    const float ct = sqrtf(float_max(1.0f - st2, 0.0f));
    const float rs = (eta * ci - ct) / float_max(eta * ci + ct, 1e-20f),
                rp = (eta * ct - ci) / float_max(eta * ct + ci, 1e-20f);
    const float f = st2 > 1.0f || ci == 0.0f ? 1.0f : float_min(0.5f * (rs * rs + rp * rp), 1.0f);
    r.mirror = thin ? 2.0f * f / (1.0f + f) : f;
    const vec3 bent = vec3_unit(vec3_along(vec3_scale(d, eta), n, fmaf(eta, ci, -ct)));
    r.refracted = thin || vec3_dot(bent, face) >= 0.0f ? d : bent;
    return r;
}

/* What a GGX lobe reflects of light from all about, seen from all about. */
static inline vec3 specular_mean(vec3 specular, float alpha) {
    const float a = fmaf(alpha, fmaf(alpha, fmaf(alpha, fmaf(alpha, -0.77097f, 2.16076f), -1.94118f), 0.00253f), 0.95395f),
                b = fmaf(alpha, fmaf(alpha, fmaf(alpha, fmaf(alpha, 0.08177f, -0.25908f), 0.31687f), -0.18614f), 0.04936f);
    return (vec3){fmaf(specular.x, a, b), fmaf(specular.y, a, b), fmaf(specular.z, a, b)};
}

/* exp(-absorption * distance), a channel. */
static inline vec3 specular_absorbed(vec3 absorption, float distance) {
    return (vec3){power_of_two(float_max(absorption.x * distance * -1.44269504f, -126.0f)),
                  power_of_two(float_max(absorption.y * distance * -1.44269504f, -126.0f)),
                  power_of_two(float_max(absorption.z * distance * -1.44269504f, -126.0f))};
}

#endif
