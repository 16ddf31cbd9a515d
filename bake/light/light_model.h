/* light_model.h: point, spot and directional lights as kernels/direct.cl and kernels/photons.cl have them, the same operations
 * in the same order, for the baker and the reference (tests/numeric/test_shared_functions.c holds them to the kernels). */
#ifndef VIT_BAKE_LIGHT_MODEL_H
#define VIT_BAKE_LIGHT_MODEL_H

#include "common/kernel_math.h"
#include "vitrine_pack.h"

/* Fraction of a light's intensity that goes into direction -l; l: unit, towards the light. light_cone(). */
static inline float light_cone(const vit_light *light, vec3 l) {
    if (light->kind != VIT_LIGHT_SPOT)
        return 1.0f;
    const float cosine = -vec3_dot(l, vec3_load(light->direction));
    const float a = float_min(float_max(fmaf(cosine, light->spot_scale, light->spot_offset), 0.0f), 1.0f);
    return a * a;
}

/* What a range leaves of a photon's power at squared distance d2: exactly 1 without a range. light_left(). */
static inline float light_left(const vit_light *light, float d2) {
    const float q = d2 * light->inv_range2;
    if (light->falloff == VIT_FALLOFF_WINDOW)
        return float_max(1.0f - q, 0.0f) * d2;
    return float_max(1.0f - q * q, 0.0f);
}

/* Irradiance per unit of intensity on a surface that faces the light, 1/m2. light_falloff(). */
static inline float light_falloff(const vit_light *light, float d2) {
    if (light->falloff == VIT_FALLOFF_WINDOW)
        return float_max(1.0f - d2 * light->inv_range2, 0.0f);
    return light_left(light, d2) / d2;
}

/* The least squared distance to a light that counts, m2: it follows the scene's size. lit_way(). */
static inline float light_least2(float ray_offset) {
    const float least = ray_offset * 0.0625f;
    return least * least;
}

/* Irradiance per unit of intensity at p about the unit normal n if nothing is between; *l: unit, towards the light, *d metres
 * away. lit_way(). */
static inline float light_irradiance(const vit_light *light, float ray_offset, vec3 p, vec3 n, vec3 *l, float *d) {
    if (light->kind == VIT_LIGHT_DIRECTIONAL) {
        *d = 3e38f;
        *l = vec3_scale(vec3_load(light->direction), -1.0f);
        return float_max(vec3_dot(n, *l), 0.0f);
    }
    const vec3 to = vec3_sub(vec3_load(light->position), p);
    const float d2 = float_max(vec3_dot(to, to), light_least2(ray_offset));
    *d = sqrtf(d2);
    *l = vec3_scale(to, 1.0f / *d);
    return float_max(vec3_dot(n, *l), 0.0f) * light_cone(light, *l) * light_falloff(light, d2);
}

/* Where a photon starts, *origin, and its unit direction, from two numbers in [0, 1): even over the cone cos >= cos_outer, or
 * over a directional light's disc. *weight: light_cone() there. photon_emission(). */
static inline vec3 light_emission(const vit_light *light, float u, float v, vec3 *origin, float *weight) {
    *origin = vec3_load(light->position);
    *weight = 1.0f;
    if (light->kind == VIT_LIGHT_DIRECTIONAL) {
        const vec3 along = vec3_load(light->direction);
        *origin = vec3_disc(*origin, along, light->spot_scale, u, v);
        return along;
    }
    const float c = fmaf(u, light->cos_outer - 1.0f, 1.0f), s = sqrtf(float_max(1.0f - c * c, 0.0f));
    const vec3 axis = light->kind == VIT_LIGHT_SPOT ? vec3_load(light->direction) : (vec3){0.0f, 1.0f, 0.0f};
    const vec3 d = vec3_about(axis, c, s, v);
    *weight = light_cone(light, vec3_scale(d, -1.0f));
    return d;
}

/* Solid angle, sr, or of a directional light area of the disc, m2, that photons start in. photon_paths(). */
static inline float light_whole(const vit_light *light) {
    if (light->kind == VIT_LIGHT_DIRECTIONAL)
        return KERNEL_PI * light->spot_scale * light->spot_scale;
    return 2.0f * KERNEL_PI * (1.0f - light->cos_outer);
}

#endif
