/* Light sources as kernels/direct.cl has them. */
#ifndef VIT_COST_LIGHTS_H
#define VIT_COST_LIGHTS_H

#include "common/kernel_math.h"
#include "vitrine_pack.h"

/* light_cone() of kernels/direct.cl; l: unit, towards the light. */
static inline float light_cone(const vit_light *light, vec3 l) {
    if (light->kind != VIT_LIGHT_SPOT)
        return 1.0f;
    const float cosine = -vec3_dot(l, vec3_load(light->direction));
    const float a = float_min(float_max(fmaf(cosine, light->spot_scale, light->spot_offset), 0.0f), 1.0f);
    return a * a;
}

/* light_falloff() of kernels/direct.cl: irradiance a unit of intensity, 1/m2. */
static inline float light_falloff(const vit_light *light, float d2) {
    const float q = d2 * light->inv_range2;
    if (light->falloff == VIT_FALLOFF_WINDOW)
        return float_max(1.0f - q, 0.0f);
    return float_max(1.0f - q * q, 0.0f) / d2;
}

/* Irradiance, a unit of intensity, at p about the unit normal n if nothing is between; *l: unit, towards the light, *d metres
 * away. */
static inline float light_irradiance(const vit_light *light, vec3 p, vec3 n, vec3 *l, float *d) {
    if (light->kind == VIT_LIGHT_DIRECTIONAL) {
        *d = 3e38f;
        *l = vec3_scale(vec3_load(light->direction), -1.0f);
        return float_max(vec3_dot(n, *l), 0.0f);
    }
    const vec3 to = vec3_sub(vec3_load(light->position), p);
    const float d2 = float_max(vec3_dot(to, to), 1e-12f);
    *d = sqrtf(d2);
    *l = vec3_scale(to, 1.0f / *d);
    return float_max(vec3_dot(n, *l), 0.0f) * light_cone(light, *l) * light_falloff(light, d2);
}

#endif
