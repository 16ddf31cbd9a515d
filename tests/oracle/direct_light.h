/* Direct light by its definition, in double: a light's irradiance in closed form, and whether anything is in its way. */
#ifndef VIT_TESTS_DIRECT_LIGHT_H
#define VIT_TESTS_DIRECT_LIGHT_H

#include "exact_ray.h"
#include "view_sample.h"

/* What shadows depend on. */
typedef struct oracle_blockers {
    const vit_scene *s;
    vit_triangle *triangles;
    vit_attributes *attributes;
    vit_material *materials;
    vit_texture *textures; /* these three only with textures */
    vit_mip *mips;
    uint32_t *texels;
} oracle_blockers;

/* Irradiance at p on a surface of unit normal n, a unit of the light's intensity, if nothing is in the way: 1/m2. */
static inline double oracle_light(const vit_light *l, const double p[3], const double n[3]) {
    double to[3], axis[3], cone = 1;
    for (int k = 0; k < 3; k++) {
        to[k] = (double)l->position[k] - p[k];
        axis[k] = (double)l->direction[k];
    }
    const double d2 = oracle_dot(to, to), d = sqrt(d2), q = d2 * (double)l->inv_range2;
    if (l->kind == VIT_LIGHT_SPOT)
        cone = fmin(fmax(-oracle_dot(to, axis) / d * (double)l->spot_scale + (double)l->spot_offset, 0), 1);
    const double falloff = l->falloff == VIT_FALLOFF_WINDOW ? fmax(1 - q, 0) : fmax(1 - q * q, 0) / d2;
    return fmax(oracle_dot(to, n) / d, 0) * cone * cone * falloff;
}

static inline double oracle_wrap(double x, uint32_t mode) {
    const double turn = x / 2 - floor(x / 2);
    return mode == VIT_WRAP_CLAMP ? fmin(fmax(x, 0), 1) : mode == VIT_WRAP_MIRROR ? 1 - fabs(1 - 2 * turn) : x - floor(x);
}

typedef enum oracle_verdict { ORACLE_FREE, ORACLE_BLOCKED, ORACLE_DOUBTFUL } oracle_verdict;

/* Alpha of the texel at o + t d; doubtful where another one within a thousandth of a texel has another. */
static inline oracle_verdict oracle_cutout(const oracle_blockers *b, uint32_t index, const float o[3], const float d[3],
                                           double t) {
    const vit_triangle *g = b->triangles + index;
    const vit_attributes *a = b->attributes + index;
    const vit_texture *texture = b->textures + b->materials[a->material & VIT_MATERIAL_INDEX].texture;
    const vit_mip *mip = b->mips + texture->first_mip;
    double x[3], y[3], z[3], uv[2];
    for (int k = 0; k < 3; k++) {
        x[k] = (double)g->v1[k] - (double)g->v0[k];
        y[k] = (double)g->v2[k] - (double)g->v0[k];
        z[k] = (double)o[k] + t * (double)d[k] - (double)g->v0[k];
    }
    const double xx = oracle_dot(x, x), xy = oracle_dot(x, y), yy = oracle_dot(y, y), xz = oracle_dot(x, z),
                 yz = oracle_dot(y, z);
    const double b1 = (xz * yy - yz * xy) / (xx * yy - xy * xy), b2 = (yz * xx - xz * xy) / (xx * yy - xy * xy);
    for (int k = 0; k < 2; k++) {
        const double at = (1 - b1 - b2) * (double)a->uv[0][k] + b1 * (double)a->uv[1][k] + b2 * (double)a->uv[2][k];
        uv[k] = oracle_wrap(at, k ? texture->wrap_v : texture->wrap_u) * (k ? mip->height : mip->width);
    }
    uint32_t opaque = 0; /* of the four places around; the gutter is outside */
    for (int k = 0; k < 4; k++) {
        const double u = uv[0] + (k & 1 ? 1e-3 : -1e-3), v = uv[1] + (k & 2 ? 1e-3 : -1e-3);
        const uint32_t column = (uint32_t)fmin(fmax(u, 0), mip->width - 1), line = (uint32_t)fmin(fmax(v, 0), mip->height - 1);
        opaque += b->texels[mip->offset + line * mip->pitch + column] >> 31;
    }
    return opaque == 4 ? ORACLE_BLOCKED : opaque == 0 ? ORACLE_FREE : ORACLE_DOUBTFUL;
}

/* Is anything between o and o + d? Doubtful if a triangle's edge is within `margin` metres of the ray and no other one blocks
 * it, or an end of the ray of a triangle's plane. */
static inline oracle_verdict oracle_shadow(const oracle_blockers *b, const float o[3], const float d[3], double margin) {
    oracle_verdict all = ORACLE_FREE;
    const double length = sqrt((double)d[0] * (double)d[0] + (double)d[1] * (double)d[1] + (double)d[2] * (double)d[2]);
    for (uint32_t i = 0; i < b->s->triangles; i++) {
        const exact_hit h = exact_cast(b->triangles + i, o, d);
        const double least = margin / length;
        if ((!h.inside && h.edge > margin) || h.t < -least || h.t > 1 + least)
            continue;
        oracle_verdict v = h.edge > margin && h.t > least && h.t < 1 - least ? ORACLE_BLOCKED : ORACLE_DOUBTFUL;
        if (v == ORACLE_BLOCKED && b->materials[b->attributes[i].material & VIT_MATERIAL_INDEX].cutout)
            v = oracle_cutout(b, i, o, d, h.t);
        if (v == ORACLE_BLOCKED)
            return v;
        all = v == ORACLE_DOUBTFUL ? v : all;
    }
    return all;
}

#endif
