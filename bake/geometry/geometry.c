/* Triangles and attributes in the BVH's leaf order, as records.clh lays them out. Plain arithmetic throughout
 * (-ffp-contract=off): the bytes do not depend on compiler or machine. */
#include "geometry/bvh.h"
#include "geometry/tangents.h"
#include "common/fail.h"
#include "common/octahedral.h"
#include "common/triangle.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SNORM_MAX 32767

/* x in the low half, y in the high half of the word. */
static vit_u32 normal_word(const float n[3]) {
    int s[2];
    octahedral_encode(n, SNORM_MAX, s);
    return ((vit_u32)s[0] & 0xffffu) | (vit_u32)s[1] << 16;
}

static void pack_triangle(const model *m, const uint32_t corner[3], vit_triangle *t) {
    memcpy(t->v0, m->position + 3 * (size_t)corner[0], sizeof t->v0);
    memcpy(t->v1, m->position + 3 * (size_t)corner[1], sizeof t->v1);
    memcpy(t->v2, m->position + 3 * (size_t)corner[2], sizeof t->v2);
    float n[3];
    triangle_normal(t->v0, t->v1, t->v2, n);
    t->nx = n[0];
    t->ny = n[1];
    t->nz = n[2];
}

/* Normals that differ from the face's by less than about a milliradian do not count. */
#define FLAT (1.0 - 1e-6)

static bool is_flat(const model *m, const uint32_t corner[3], const vit_triangle *t) {
    const double n[3] = {(double)t->nx, (double)t->ny, (double)t->nz}, length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (size_t i = 0; i < 3; i++) {
        const float *v = m->normal + 3 * (size_t)corner[i];
        if (!(fabs((double)v[0] * n[0] + (double)v[1] * n[1] + (double)v[2] * n[2]) >= FLAT * length))
            return false;
    }
    return true;
}

static void pack_attributes(const model *m, const uint32_t corner[3], uint32_t material, const vit_u32 *normals,
                            const vit_triangle *t, vit_attributes *a) {
    for (size_t i = 0; i < 3; i++) {
        a->normal[i] = normals[corner[i]];
        memcpy(a->uv[i], m->uv + 2 * (size_t)corner[i], sizeof a->uv[i]);
    }
    const bool bent = MODEL_HAS_NORMAL_MAP(&m->materials[material]);
    a->material = material | (is_flat(m, corner, t) && !bent ? 0 : VIT_TRIANGLE_SMOOTH);
}

/* How far rays leave a surface, metres. A computed hit position is wrong by some ulps of the largest coordinate that went into
 * it; 2^-16 of that is 256 ulps, an order above what eye + t * d loses. At least 1e-5 of the diagonal, so that in the gap of
 * nearly touching faces (modelled on a coarse grid) no shadow ray starts: what lies closer than this counts as touching. */
float geometry_ray_offset(const model *m) {
    float largest = 0.0f, lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < 3 * (size_t)m->triangles; i++)
        for (size_t k = 0; k < 3; k++) {
            const float c = m->position[3 * (size_t)m->index[i] + k];
            largest = fabsf(c) > largest ? fabsf(c) : largest; /* fmaxf() is a call, for each of millions */
            lo[k] = c < lo[k] ? c : lo[k];
            hi[k] = c > hi[k] ? c : hi[k];
        }
    const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
    return fmaxf(largest * 0x1p-16f, sqrtf((x * x + y * y) + z * z) * 1e-5f);
}

vit_status geometry_pack(const model *m, const bvh *b, geometry *out, vit_text *why) {
    *out = (geometry){0};
    out->triangles = calloc(m->triangles, sizeof *out->triangles);
    out->attributes = calloc(m->triangles, sizeof *out->attributes);
    vit_u32 *normals = malloc((m->vertices + (size_t)1) * sizeof *normals); /* a vertex: six corners share it, mostly */
    if (!out->triangles || !out->attributes || !normals) {
        geometry_free(out);
        free(normals);
        return bake_fail(why, VIT_FAILED, "geometry: out of memory for %u triangles", m->triangles);
    }
    for (uint32_t i = 0; i < m->vertices; i++)
        normals[i] = normal_word(m->normal + 3 * (size_t)i);
    vit_u32 *tangents; /* of the model's triangles */
    const vit_status status = tangents_pack(m, normals, &tangents, why);
    for (uint32_t i = 0; i < m->triangles && status == VIT_OK; i++) {
        const uint32_t *corner = m->index + 3 * (size_t)b->order[i];
        pack_triangle(m, corner, out->triangles + i);
        pack_attributes(m, corner, m->material[b->order[i]], normals, out->triangles + i, out->attributes + i);
        if (tangents)
            memcpy(out->attributes[i].tangent, tangents + 2 * (size_t)b->order[i], sizeof out->attributes[i].tangent);
    }
    free(normals);
    free(tangents);
    if (status != VIT_OK) {
        geometry_free(out);
        return status;
    }
    out->ray_offset = geometry_ray_offset(m);
    out->box_pad = b->box_pad;
    return VIT_OK;
}

void geometry_free(geometry *g) {
    free(g->triangles);
    free(g->attributes);
    *g = (geometry){0};
}
