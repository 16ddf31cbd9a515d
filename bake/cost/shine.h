/* Mirrors, glass and the Phong lobe as kernels/shine.clh has them, and how paths choose directions from the lobe. */
#ifndef VIT_COST_SHINE_H
#define VIT_COST_SHINE_H

#include "photon_math.h"
#include "vitrine_pack.h"
#include <stdbool.h>

#define SHINE_PI 3.14159265358979323846

/* shine_mirrored() of kernels/shine.clh: d mirrored at n, both unit; the ray stays on the side of the unit face normal. */
static inline vec3 shine_mirrored(vec3 d, vec3 n, vec3 face) {
    const vec3 r = vec3_along(d, n, -2.0f * vec3_dot(d, n));
    return vec3_unit(vec3_dot(r, face) > 0.0f ? r : vec3_along(d, face, -2.0f * vec3_dot(d, face)));
}

/* shine_at_glass() of kernels/shine.clh: the part of the light that is mirrored (Fresnel; 1: total internal reflection), and where
 * the rest goes. Unit direction d meets glass with the unit normals n and face on its side; back: from the inside. Thin panes: all
 * mirror images of both surfaces together, and straight on. */
static inline double shine_at_glass(const vit_material *m, vec3 d, vec3 n, vec3 face, bool back, vec3 *refracted) {
    const bool thin = m->kind == VIT_THIN_GLASS;
    const double eta = back && !thin ? (double)m->ior : 1 / (double)m->ior;
    const double ci = fmin(fmax(-(double)vec3_dot(d, n), 0), 1), st2 = eta * eta * (1 - ci * ci);
    *refracted = d;
    if (st2 > 1 || !(ci > 0))
        return 1;
    const double ct = sqrt(1 - st2), rs = (eta * ci - ct) / (eta * ci + ct), rp = (eta * ct - ci) / (eta * ct + ci);
    const double f = fmin(0.5 * (rs * rs + rp * rp), 1);
    if (thin)
        return 2 * f / (1 + f);
    const vec3 bent = vec3_unit(vec3_along(vec3_scale(d, (float)eta), n, (float)(eta * ci - ct)));
    if (vec3_dot(bent, face) < 0.0f) /* else a bent shading normal would send it back to its own side */
        *refracted = bent;
    return f;
}

/* A matt or glossy place of a path. */
typedef struct shine_place {
    vec3 position, face, normal; /* metres, off the surface; unit geometric normal, unit normal that light is reflected about */
    vec3 out;                    /* unit direction that light leaves in */
    vec3 albedo, specular;
    float exponent;
    bool glossy; /* it has a lobe */
} shine_place;

/* cos^m of the angle between l and the mirrored way out: times (m + 2) / (2 pi) the lobe's BRDF, times (m + 1) / (2 pi) the density
 * of directions about it. */
static inline double shine_power(const shine_place *s, vec3 l) {
    const double c = 2 * (double)vec3_dot(s->normal, l) * (double)vec3_dot(s->normal, s->out) - (double)vec3_dot(l, s->out);
    return c > 0 ? pow(fmin(c, 1), (double)s->exponent) : 0;
}

/* Pi times the BRDF. */
static inline void shine_reflectance(const shine_place *s, vec3 l, double out[3]) {
    const double lobe = shine_power(s, l) * ((double)s->exponent + 2) / 2;
    out[0] = (double)s->albedo.x + (double)s->specular.x * lobe;
    out[1] = (double)s->albedo.y + (double)s->specular.y * lobe;
    out[2] = (double)s->albedo.z + (double)s->specular.z * lobe;
}

/* The part of directions that is drawn from the lobe; the rest is drawn by the cosine. */
static inline double shine_lobe_part(const shine_place *s) {
    const double lobe = (double)(s->specular.x + s->specular.y + s->specular.z),
                 matt = (double)(s->albedo.x + s->albedo.y + s->albedo.z);
    return s->glossy ? lobe / (lobe + matt) : 0;
}

/* Density with which paths go on to l, 1/sr. */
static inline double shine_density(const shine_place *s, vec3 l) {
    const double matt = fmax((double)vec3_dot(s->normal, l), 0) / SHINE_PI;
    if (!s->glossy)
        return matt;
    const double part = shine_lobe_part(s);
    return part * shine_power(s, l) * ((double)s->exponent + 1) / (2 * SHINE_PI) + (1 - part) * matt;
}

/* Unit direction whose cosine to n is c; turn: 0..1, about n. */
static inline vec3 shine_about(vec3 n, float c, float s, float turn) {
    float sp, cp;
    sincos_turn(turn, &sp, &cp);
    vec3 ax, ay;
    vec3_across(n, &ax, &ay);
    return vec3_unit(vec3_along(vec3_along(vec3_scale(n, c), ax, s * cp), ay, s * sp));
}

/* A direction of that density from two numbers of [0, 1). */
static inline vec3 shine_direction(const shine_place *s, float u, float v) {
    const float part = (float)shine_lobe_part(s);
    if (u < part) {
        const vec3 mirrored = vec3_unit(vec3_along(vec3_scale(s->out, -1.0f), s->normal, 2.0f * vec3_dot(s->normal, s->out)));
        const double c = pow((double)(u / part), 1 / ((double)s->exponent + 1));
        return shine_about(mirrored, (float)c, (float)sqrt(fmax(1 - c * c, 0)), v);
    }
    if (part > 0.0f)
        u = (u - part) / (1.0f - part);
    return shine_about(s->normal, sqrtf(float_max(1.0f - u, 0.0f)), sqrtf(u), v);
}

#endif
