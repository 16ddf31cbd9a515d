/* The Phong lobe of kernels/specular.clh, and how paths choose directions from it. */
#ifndef VIT_COST_SHINE_H
#define VIT_COST_SHINE_H

#include "light/photon_specular.h"
#include "common/pi.h"
#include "vitrine_pack.h"
#include <stdbool.h>

/* A matt or glossy place of a path. */
typedef struct path_vertex {
    vec3 position, face, normal; /* metres, off the surface; unit geometric normal, unit normal that light is reflected about */
    vec3 out;                    /* unit direction that light leaves in */
    vec3 albedo, specular;
    float exponent;
    bool glossy; /* it has a lobe */
} path_vertex;

/* cos^m of the angle between l and the mirrored way out: times (m + 2) / (2 pi) the lobe's BRDF, times (m + 1) / (2 pi) the
 * density of directions about it. */
static inline double specular_power(const path_vertex *s, vec3 l) {
    const double c = 2 * (double)vec3_dot(s->normal, l) * (double)vec3_dot(s->normal, s->out) - (double)vec3_dot(l, s->out);
    return c > 0 ? pow(fmin(c, 1), (double)s->exponent) : 0;
}

/* Pi times the BRDF. */
static inline void specular_reflectance(const path_vertex *s, vec3 l, double out[3]) {
    const double lobe = specular_power(s, l) * ((double)s->exponent + 2) / 2;
    out[0] = (double)s->albedo.x + (double)s->specular.x * lobe;
    out[1] = (double)s->albedo.y + (double)s->specular.y * lobe;
    out[2] = (double)s->albedo.z + (double)s->specular.z * lobe;
}

/* The part of directions that is drawn from the lobe; the rest is drawn by the cosine. */
static inline double specular_lobe_part(const path_vertex *s) {
    const double lobe = (double)(s->specular.x + s->specular.y + s->specular.z),
                 matt = (double)(s->albedo.x + s->albedo.y + s->albedo.z);
    return s->glossy ? lobe / (lobe + matt) : 0;
}

/* Density with which paths go on to l, 1/sr. */
static inline double specular_density(const path_vertex *s, vec3 l) {
    const double matt = fmax((double)vec3_dot(s->normal, l), 0) / PI;
    if (!s->glossy)
        return matt;
    const double part = specular_lobe_part(s);
    return part * specular_power(s, l) * ((double)s->exponent + 1) / (2 * PI) + (1 - part) * matt;
}

/* A direction of that density from two numbers of [0, 1). */
static inline vec3 specular_direction(const path_vertex *s, float u, float v) {
    const float part = (float)specular_lobe_part(s);
    if (u < part) {
        const vec3 mirrored = vec3_unit(vec3_along(vec3_scale(s->out, -1.0f), s->normal, 2.0f * vec3_dot(s->normal, s->out)));
        const double c = pow((double)(u / part), 1 / ((double)s->exponent + 1));
        return vec3_about(mirrored, (float)c, (float)sqrt(fmax(1 - c * c, 0)), v);
    }
    if (part > 0.0f)
        u = (u - part) / (1.0f - part);
    return vec3_cosine(s->normal, u, v);
}

#endif
