/* The lobes of kernels/specular.clh, and how paths choose directions from it. */
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
    float exponent, alpha; /* of the lobe, as vit_material */
    bool glossy;           /* it has a lobe */
} path_vertex;

/* cos^m of the angle between l and the mirrored way out: times (m + 2) / (2 pi) the lobe's BRDF, times (m + 1) / (2 pi) the
 * density of directions about it. */
static inline double specular_power(const path_vertex *s, vec3 l) {
    const double c = 2 * (double)vec3_dot(s->normal, l) * (double)vec3_dot(s->normal, s->out) - (double)vec3_dot(l, s->out);
    return c > 0 ? pow(fmin(c, 1), (double)s->exponent) : 0;
}

/* The lobe of microfacets, kernels/specular.clh's specular_at_facets: D V, 1/sr; D of the half vector h; its cosines; how far
 * Fresnel's term has gone to 1. */
typedef struct specular_facets {
    double lobe, d, nh, vh, grazing;
} specular_facets;

static inline specular_facets specular_at_facets(const path_vertex *s, vec3 l) {
    const vec3 n = s->normal, v = s->out;
    const double h[3] = {(double)l.x + (double)v.x, (double)l.y + (double)v.y, (double)l.z + (double)v.z},
                 a2 = (double)s->alpha * (double)s->alpha, length = fmax(sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]), 1e-6);
    specular_facets r = {.nh = ((double)n.x * h[0] + (double)n.y * h[1] + (double)n.z * h[2]) / length,
                         .vh = fmin(((double)v.x * h[0] + (double)v.y * h[1] + (double)v.z * h[2]) / length, 1)};
    const double nl = fmax((double)vec3_dot(n, l), 0), nv = fmax((double)vec3_dot(n, v), 0),
                 smith = nl * sqrt(nv * nv * (1 - a2) + a2) + nv * sqrt(nl * nl * (1 - a2) + a2),
                 q = r.nh * r.nh * (a2 - 1) + 1;
    if (!(r.nh > 0) || !(r.vh > 0))
        return r;
    r.d = a2 / (PI * q * q);
    r.lobe = r.d * 0.5 / fmax(smith, 1e-6);
    r.grazing = pow(1 - r.vh, 5);
    return r;
}

/* Pi times the BRDF. */
static inline void specular_reflectance(const path_vertex *s, vec3 l, double out[3]) {
    const bool facets = s->alpha > 0.0f;
    const specular_facets f = facets ? specular_at_facets(s, l) : (specular_facets){0};
    const double lobe = facets ? PI * f.lobe : specular_power(s, l) * ((double)s->exponent + 2) / 2, left = 1 - f.grazing;
    out[0] = (double)s->albedo.x * left + ((double)s->specular.x * left + f.grazing) * lobe;
    out[1] = (double)s->albedo.y * left + ((double)s->specular.y * left + f.grazing) * lobe;
    out[2] = (double)s->albedo.z * left + ((double)s->specular.z * left + f.grazing) * lobe;
}

/* The part of directions that is drawn from the lobe; the rest is drawn by the cosine. */
static inline double specular_lobe_part(const path_vertex *s) {
    const double lobe = (double)(s->specular.x + s->specular.y + s->specular.z),
                 matt = (double)(s->albedo.x + s->albedo.y + s->albedo.z);
    return s->glossy ? lobe / (lobe + matt) : 0;
}

/* Density of directions drawn from the lobe: Phong's, or mirrored at normals of microfacets that D n.h is the density of. */
static inline double specular_lobe_density(const path_vertex *s, vec3 l) {
    if (!(s->alpha > 0.0f))
        return specular_power(s, l) * ((double)s->exponent + 1) / (2 * PI);
    const specular_facets f = specular_at_facets(s, l);
    return f.d > 0 ? f.d * f.nh / (4 * f.vh) : 0;
}

/* Density with which paths go on to l, 1/sr. */
static inline double specular_density(const path_vertex *s, vec3 l) {
    const double matt = fmax((double)vec3_dot(s->normal, l), 0) / PI;
    if (!s->glossy)
        return matt;
    const double part = specular_lobe_part(s);
    return part * specular_lobe_density(s, l) + (1 - part) * matt;
}

/* A direction of the lobe's density; u: 0..1. */
static inline vec3 specular_lobe_direction(const path_vertex *s, double u, float v) {
    if (s->alpha > 0.0f) {
        const double a2 = (double)s->alpha * (double)s->alpha, c2 = (1 - u) / (1 - u + a2 * u);
        const vec3 h = vec3_about(s->normal, (float)sqrt(c2), (float)sqrt(fmax(a2 * u / (1 - u + a2 * u), 0)), v);
        return vec3_unit(vec3_along(vec3_scale(s->out, -1.0f), h, 2.0f * vec3_dot(s->out, h)));
    }
    const vec3 mirrored = vec3_unit(vec3_along(vec3_scale(s->out, -1.0f), s->normal, 2.0f * vec3_dot(s->normal, s->out)));
    const double c = pow(u, 1 / ((double)s->exponent + 1));
    return vec3_about(mirrored, (float)c, (float)sqrt(fmax(1 - c * c, 0)), v);
}

/* A direction of that density from two numbers of [0, 1). */
static inline vec3 specular_direction(const path_vertex *s, float u, float v) {
    const float part = (float)specular_lobe_part(s);
    if (u < part)
        return specular_lobe_direction(s, (double)(u / part), v);
    if (part > 0.0f)
        u = (u - part) / (1.0f - part);
    return vec3_cosine(s->normal, u, v);
}

#endif
