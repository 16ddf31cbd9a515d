/* Triangles and attributes in the BVH's leaf order, as records.clh lays them out. Plain float arithmetic throughout
 * (-ffp-contract=off): the bytes do not depend on compiler or machine. */
#include "bvh.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SNORM_MAX 32767

/* Octahedral normals (Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors"): x in the low
 * half, y in the high half of the word, both snorm16 in -32767..32767. Decoded, in float and in this order, as
 *     x = sx / 32767;  y = sy / 32767;  z = (1 - |x|) - |y|
 *     if z < 0:  x, y = (1 - |y|) * sign(x), (1 - |x|) * sign(y)        (with the old x and y; the sign of 0 is +)
 *     l = sqrt((x * x + y * y) + z * z);  normal = (x / l, y / l, z / l)
 * The encoder tries the four roundings and keeps the nearest: the error is below 5e-5 radians (test_geometry.c measures it). */
static void octahedral_decode(int sx, int sy, float n[3]) {
    const float x = (float)sx / (float)SNORM_MAX, y = (float)sy / (float)SNORM_MAX;
    const float z = (1.0f - fabsf(x)) - fabsf(y);
    const bool lower = z < 0.0f;
    const float fx = lower ? (1.0f - fabsf(y)) * (x < 0.0f ? -1.0f : 1.0f) : x;
    const float fy = lower ? (1.0f - fabsf(x)) * (y < 0.0f ? -1.0f : 1.0f) : y;
    const float l = sqrtf((fx * fx + fy * fy) + z * z);
    n[0] = fx / l;
    n[1] = fy / l;
    n[2] = z / l;
}

static int clamp_snorm(int s) {
    return s < -SNORM_MAX ? -SNORM_MAX : s > SNORM_MAX ? SNORM_MAX : s;
}

static vit_u32 octahedral_encode(const float n[3]) {
    const float sum = (fabsf(n[0]) + fabsf(n[1])) + fabsf(n[2]);
    if (!(sum > 0.0f))
        return 0; /* decodes to +z; the model promises unit normals */
    float x = n[0] / sum, y = n[1] / sum;
    if (n[2] < 0.0f) {
        const float fx = (1.0f - fabsf(y)) * (x < 0.0f ? -1.0f : 1.0f);
        y = (1.0f - fabsf(x)) * (y < 0.0f ? -1.0f : 1.0f);
        x = fx;
    }
    const int x0 = (int)floorf(x * (float)SNORM_MAX), y0 = (int)floorf(y * (float)SNORM_MAX);
    double best = 9.0;
    vit_u32 word = 0;
    for (int i = 0; i < 4; i++) {
        const int sx = clamp_snorm(x0 + (i & 1)), sy = clamp_snorm(y0 + (i >> 1));
        float d[3];
        octahedral_decode(sx, sy, d);
        const double ex = (double)d[0] - (double)n[0], ey = (double)d[1] - (double)n[1], ez = (double)d[2] - (double)n[2];
        const double error = ex * ex + ey * ey + ez * ez;
        if (error < best) {
            best = error;
            word = ((vit_u32)sx & 0xffffu) | (vit_u32)sy << 16;
        }
    }
    return word;
}

static void pack_triangle(const model *m, const uint32_t corner[3], vit_triangle *t) {
    memcpy(t->v0, m->position + 3 * (size_t)corner[0], sizeof t->v0);
    memcpy(t->v1, m->position + 3 * (size_t)corner[1], sizeof t->v1);
    memcpy(t->v2, m->position + 3 * (size_t)corner[2], sizeof t->v2);
    const float a[3] = {t->v1[0] - t->v0[0], t->v1[1] - t->v0[1], t->v1[2] - t->v0[2]};
    const float b[3] = {t->v2[0] - t->v0[0], t->v2[1] - t->v0[1], t->v2[2] - t->v0[2]};
    t->nx = a[1] * b[2] - a[2] * b[1];
    t->ny = a[2] * b[0] - a[0] * b[2];
    t->nz = a[0] * b[1] - a[1] * b[0];
}

static void pack_attributes(const model *m, const uint32_t corner[3], uint32_t material, vit_attributes *a) {
    for (size_t i = 0; i < 3; i++) {
        a->normal[i] = octahedral_encode(m->normal + 3 * (size_t)corner[i]);
        memcpy(a->uv[i], m->uv + 2 * (size_t)corner[i], sizeof a->uv[i]);
    }
    a->material = material;
}

/* How far rays leave a surface, metres. A computed hit position is wrong by some ulps of the largest coordinate that went into
 * it; 2^-16 of that is 256 ulps, an order above what eye + t * d loses. At least 1e-5 of the diagonal, so that in the gap of
 * nearly touching faces (modelled on a coarse grid) no shadow ray starts: what lies closer than this counts as touching. */
static float ray_offset(const model *m) {
    float largest = 0.0f, lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < 3 * (size_t)m->triangles; i++)
        for (size_t k = 0; k < 3; k++) {
            const float c = m->position[3 * (size_t)m->index[i] + k];
            largest = fmaxf(largest, fabsf(c));
            lo[k] = fminf(lo[k], c);
            hi[k] = fmaxf(hi[k], c);
        }
    const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
    return fmaxf(largest * 0x1p-16f, sqrtf((x * x + y * y) + z * z) * 1e-5f);
}

vit_status geometry_pack(const model *m, const bvh *b, geometry *out, vit_text *why) {
    *out = (geometry){0};
    out->triangles = calloc(m->triangles, sizeof *out->triangles);
    out->attributes = calloc(m->triangles, sizeof *out->attributes);
    if (!out->triangles || !out->attributes) {
        geometry_free(out);
        snprintf(why->text, sizeof why->text, "geometry: out of memory for %u triangles", m->triangles);
        return VIT_FAILED;
    }
    for (uint32_t i = 0; i < m->triangles; i++) {
        const uint32_t *corner = m->index + 3 * (size_t)b->order[i];
        pack_triangle(m, corner, out->triangles + i);
        pack_attributes(m, corner, m->material[b->order[i]], out->attributes + i);
    }
    out->ray_offset = ray_offset(m);
    return VIT_OK;
}

void geometry_free(geometry *g) {
    free(g->triangles);
    free(g->attributes);
    *g = (geometry){0};
}
