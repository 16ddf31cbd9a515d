#include "geometry/cells.h"
#include "common/fail.h"
#include <stdlib.h>
#include <string.h>

#define MOST_CELLS (1u << 23)
#define MOST_PARTS 255.0f

static uint32_t parts_of(const geometry *g, uint32_t side, float edge) {
    const vit_triangle *t = g->triangles + side / 2;
    const vec3 a = vec3_load(t->v0), b = vec3_load(t->v1), c = vec3_load(t->v2);
    const vec3 e[3] = {vec3_sub(b, a), vec3_sub(c, b), vec3_sub(a, c)};
    const float l2 = float_max(float_max(vec3_dot(e[0], e[0]), vec3_dot(e[1], e[1])), vec3_dot(e[2], e[2]));
    const float longest = sqrtf(l2), square = sqrtf(2.0f * side_area(g, side));
    const float parts =
        ceilf(float_min(longest, float_max(square, longest * 0.5f)) / edge); /* slivers' cells are long, not many */
    return parts >= 1.0f ? (uint32_t)float_min(parts, MOST_PARTS) : 1;       /* an edge may be too long for a float's square */
}

static uint64_t count_cells(const geometry *g, uint32_t sides, const float *edge, float scale) {
    uint64_t count = 0;
    for (uint32_t i = 0; i < sides; i++) {
        const uint64_t parts = parts_of(g, i, edge[i] * scale);
        count += parts * parts;
    }
    return count;
}

vit_status cells_divide(const geometry *g, uint32_t triangles, float (*edge)(void *user, uint32_t side), void *user, cells *out,
                        vit_text *why) {
    const uint32_t sides = 2 * triangles;
    float *edges = malloc(sides * sizeof *edges), scale = 1.0f;
    uint64_t count = 0;
    memset(out, 0, sizeof *out);
    if (edges) {
        for (uint32_t i = 0; i < sides; i++)
            edges[i] = edge(user, i);
        while ((count = count_cells(g, sides, edges, scale)) > MOST_CELLS && count > sides)
            scale *= 1.25f;
        out->sides = malloc(sides * sizeof *out->sides);
        out->cells = calloc(count, sizeof *out->cells);
        out->side_of = malloc(count * sizeof *out->side_of);
    }
    if (!out->sides || !out->cells || !out->side_of || count > VIT_SIDE_CELL) {
        const bool many = count > VIT_SIDE_CELL;
        free(edges);
        cells_free(out);
        return many ? bake_fail(why, VIT_BAD_INPUT, "too many triangles for zones and effective areas: at most 8 million")
                    : bake_fail(why, VIT_FAILED, "out of memory");
    }
    for (uint32_t i = 0; i < sides; i++) {
        /* Without `edges` there are no sides, and this is not reached. NOLINTNEXTLINE(clang-analyzer-core.NullDereference) */
        const uint32_t parts = parts_of(g, i, edges[i] * scale);
        out->sides[i] = parts << VIT_SIDE_PARTS_SHIFT | out->count;
        for (uint32_t k = 0; k < parts * parts; k++)
            out->side_of[out->count++] = i;
    }
    free(edges);
    return VIT_OK;
}

void cells_free(cells *c) {
    free(c->sides);
    free(c->cells);
    free(c->side_of);
    memset(c, 0, sizeof *c);
}

uint32_t cells_at(const cells *c, uint32_t side, float b1, float b2) {
    const int n = (int)(c->sides[side] >> VIT_SIDE_PARTS_SHIFT);
    float x = float_min(float_max(b1, 0.0f), 1.0f) * (float)n, y = float_min(float_max(b2, 0.0f), 1.0f) * (float)n;
    int i = (int)x, j = (int)y;
    i = i < n - 1 ? i : n - 1;
    j = j < n - 1 - i ? j : n - 1 - i;
    x = float_min(x - (float)i, 1.0f);
    y = float_min(y - (float)j, 1.0f);
    const int upper = x + y > 1.0f && i + j < n - 1;
    return (c->sides[side] & VIT_SIDE_CELL) + (uint32_t)(i * (n * 2 - i) + j * 2 + upper);
}

void cells_nodes(uint32_t parts, uint32_t k, uint32_t i[3], uint32_t j[3]) {
    uint32_t row = 0;
    while (k >= 2 * (parts - row) - 1)
        k -= 2 * (parts - row++) - 1;
    const uint32_t upper = k & 1;
    i[0] = row + upper;
    j[0] = k / 2 + upper;
    i[1] = row + 1;
    j[1] = k / 2;
    i[2] = row;
    j[2] = k / 2 + 1;
}

cell_corners cells_within(const cell_corners *t, uint32_t parts, uint32_t k) {
    const float s = 1.0f / (float)parts;
    cell_corners r;
    uint32_t i[3], j[3];
    cells_nodes(parts, k, i, j);
    for (int c = 0; c < 3; c++) {
        const float x = (float)i[c] * s, y = (float)j[c] * s;
        r.b1[c] = t->b1[0] + x * (t->b1[1] - t->b1[0]) + y * (t->b1[2] - t->b1[0]);
        r.b2[c] = t->b2[0] + x * (t->b2[1] - t->b2[0]) + y * (t->b2[2] - t->b2[0]);
    }
    return r;
}

cell_corners cells_corners(const cells *c, uint32_t cell) {
    static const cell_corners whole = {{0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    const vit_u32 side = c->sides[c->side_of[cell]];
    return cells_within(&whole, side >> VIT_SIDE_PARTS_SHIFT, cell - (side & VIT_SIDE_CELL));
}

vec3 side_place(const geometry *g, uint32_t side, float b1, float b2) {
    const vit_triangle *t = g->triangles + side / 2;
    const vec3 p = vec3_scale(vec3_load(t->v0), 1.0f - b1 - b2);
    return vec3_along(vec3_along(p, vec3_load(t->v1), b1), vec3_load(t->v2), b2);
}

vec3 cells_center(const cells *c, const geometry *g, uint32_t cell) {
    const cell_corners k = cells_corners(c, cell);
    return side_place(g, c->side_of[cell], (k.b1[0] + k.b1[1] + k.b1[2]) / 3.0f, (k.b2[0] + k.b2[1] + k.b2[2]) / 3.0f);
}

float cells_area(const cells *c, const geometry *g, uint32_t cell) {
    const uint32_t side = c->side_of[cell], parts = c->sides[side] >> VIT_SIDE_PARTS_SHIFT;
    return side_area(g, side) / (float)(parts * parts);
}

static vec3 normal_of(const geometry *g, uint32_t side, float *length) {
    const vit_triangle *t = g->triangles + side / 2;
    const float m = float_max(fabsf(t->nx), float_max(fabsf(t->ny), fabsf(t->nz))); /* scaled: tiny and huge triangles alike */
    const vec3 n = {t->nx / m, t->ny / m, t->nz / m};
    *length = sqrtf(vec3_dot(n, n)) * m;
    return vec3_unit(n);
}

vec3 side_face(const geometry *g, uint32_t side) {
    float length;
    return vec3_scale(normal_of(g, side, &length), side & 1 ? -1.0f : 1.0f);
}

float side_area(const geometry *g, uint32_t side) {
    float length;
    (void)normal_of(g, side, &length);
    return 0.5f * length;
}

static vec3 decode_normal(vit_u32 code) {
    const float x = (float)(int16_t)(code & 0xffff) / 32767.0f, y = (float)(int16_t)(code >> 16) / 32767.0f;
    const float z = 1.0f - fabsf(x) - fabsf(y);
    if (z >= 0.0f)
        return vec3_unit((vec3){x, y, z});
    return vec3_unit((vec3){copysignf(1.0f - fabsf(y), x), copysignf(1.0f - fabsf(x), y), z});
}

vec3 side_shading(const geometry *g, uint32_t side, float b1, float b2) {
    const vit_attributes *a = g->attributes + side / 2;
    const vec3 face = side_face(g, side);
    vec3 n = vec3_scale(decode_normal(a->normal[0]), 1.0f - b1 - b2);
    n = vec3_unit(vec3_along(vec3_along(n, decode_normal(a->normal[1]), b1), decode_normal(a->normal[2]), b2));
    const float facing = vec3_dot(n, face);
    return facing == 0.0f ? face : vec3_scale(n, facing < 0.0f ? -1.0f : 1.0f);
}

bool side_is_dark(const geometry *g, uint32_t side) {
    return (g->attributes[side / 2].material & (side & 1 ? VIT_SIDE_DARK_BACK : VIT_SIDE_DARK_FRONT)) != 0;
}
