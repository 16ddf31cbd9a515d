#include "geometry/quantise.h"
#include "common/fail.h"
#include "common/triangle.h"
#include "common/octahedral.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 65535, SNORM8 = 127 };

static void *copy(const void *from, size_t count, size_t size) {
    void *to = calloc(count ? count : 1, size);
    return to ? memcpy(to, from, count * size) : NULL;
}

static void snap_positions(model *m) {
    for (size_t i = 0; i < 3 * (size_t)m->vertices; i++) {
        const double lo = m->lo[i % 3], step = (m->hi[i % 3] - lo) / STEPS;
        if (step > 0)
            m->position[i] = (float)(lo + step * round(((double)m->position[i] - lo) / step));
    }
}

static void snap_normals(model *m) {
    for (size_t i = 0; i < m->vertices; i++) {
        int code[2];
        octahedral_encode(m->normal + 3 * i, SNORM8, code);
        octahedral_decode(code, SNORM8, m->normal + 3 * i);
    }
}

static bool has_area(const model *m, const uint32_t *corner) {
    float n[3];
    triangle_normal(m->position + 3 * (size_t)corner[0], m->position + 3 * (size_t)corner[1],
                    m->position + 3 * (size_t)corner[2], n);
    return n[0] != 0 || n[1] != 0 || n[2] != 0;
}

static void drop_degenerate(model *m) {
    uint32_t kept = 0;
    for (uint32_t t = 0; t < m->triangles; t++) {
        const uint32_t *corner = m->index + 3 * (size_t)t;
        if (!has_area(m, corner)) {
            m->materials[m->material[t]].triangles--;
            m->degenerate++;
            continue;
        }
        memmove(m->index + 3 * (size_t)kept, corner, 3 * sizeof *corner);
        m->material[kept++] = m->material[t];
    }
    m->triangles = kept;
}

vit_status model_quantise(const model *m, int vertex_bits, int normal_bits, model *out, vit_text *why) {
    *out = *m;
    out->position = copy(m->position, 3 * (size_t)m->vertices, sizeof *m->position);
    out->normal = copy(m->normal, 3 * (size_t)m->vertices, sizeof *m->normal);
    out->index = copy(m->index, 3 * (size_t)m->triangles, sizeof *m->index);
    out->material = copy(m->material, m->triangles, sizeof *m->material);
    out->materials = copy(m->materials, (size_t)m->material_count, sizeof *m->materials);
    if (!out->position || !out->normal || !out->index || !out->material || !out->materials) {
        model_quantise_free(out);
        return bake_fail(why, VIT_FAILED, "out of memory");
    }
    if (vertex_bits == 16) {
        snap_positions(out);
        drop_degenerate(out);
    }
    if (normal_bits == 8)
        snap_normals(out);
    if (out->triangles > 0)
        return VIT_OK;
    model_quantise_free(out);
    return bake_fail(why, VIT_BAD_INPUT, "quality.vertex_bits: with 16 bits no triangle has an area");
}

void model_quantise_free(model *m) {
    free(m->position);
    free(m->normal);
    free(m->index);
    free(m->material);
    free(m->materials);
    *m = (model){0};
}
