/* Tangent spaces as MikkTSpace has them. Vertices are one if position, normal and texture coordinates are equal. Triangles that
 * meet in an edge of such vertices, and whose texture coordinates turn the same way, share their tangents there: the mean of
 * each triangle's direction in which u grows and v stays, square to the vertex normal, weighted by its angle at the vertex. A
 * triangle without area in texture coordinates has no direction of its own: it takes part in what its neighbours have. */
#include "geometry/tangents.h"
#include "common/fail.h"
#include "common/kernel_math.h"
#include "common/pi.h"
#include "common/strict_math.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ALONE UINT32_MAX

/* An edge from vertex to vertex, the smaller one first. */
typedef struct edge {
    uint32_t low, high;
    uint32_t corner;  /* 3 * triangle + the corner that it begins at, in the triangle's order */
    uint32_t falling; /* 1: it begins at the higher one */
} edge;

typedef struct spaces {
    const model *m;
    uint32_t count;      /* triangles with a normal map */
    uint32_t *triangle;  /* of the model */
    uint32_t *vertex;    /* a corner: the first of the model's vertices that are the same */
    uint32_t *neighbour; /* a corner: of the edge that begins there, the neighbour's corner at which it begins, or ALONE */
    uint32_t *group;     /* a corner: a union of corners; its root leads to itself */
    int8_t *turn;        /* a triangle: sign of its area in texture coordinates; 0: none, and no neighbour's */
    bool *own;           /* a triangle: it has such an area itself */
    double (*sum)[3];    /* a group's root */
} spaces;

static bool has_map(const model *m, uint32_t triangle) {
    return MODEL_HAS_NORMAL_MAP(&m->materials[m->material[triangle]]);
}

static void vertex_key(const model *m, uint32_t v, float key[8]) {
    memcpy(key, m->position + 3 * (size_t)v, 3 * sizeof *key);
    memcpy(key + 3, m->normal + 3 * (size_t)v, 3 * sizeof *key);
    memcpy(key + 6, m->uv + 2 * (size_t)v, 2 * sizeof *key);
    for (int k = 0; k < 8; k++)
        key[k] += 0.0f; /* -0 is 0 */
}

/* Finds the first of all equal vertices for each corner. table: of `size` entries, a power of two, ALONE so far. */
static void weld(spaces *s, uint32_t *table, size_t size) {
    for (size_t c = 0; c < 3 * (size_t)s->count; c++) {
        const uint32_t v = s->m->index[3 * (size_t)s->triangle[c / 3] + c % 3];
        float key[8], other[8];
        uint32_t hash = 0;
        vertex_key(s->m, v, key);
        for (int k = 0; k < 8; k++) {
            uint32_t bits;
            memcpy(&bits, key + k, sizeof bits);
            hash = pcg(hash ^ bits);
        }
        size_t at = hash & (size - 1);
        for (; table[at] != ALONE; at = (at + 1) & (size - 1)) {
            vertex_key(s->m, table[at], other);
            if (memcmp(key, other, sizeof key) == 0)
                break;
        }
        if (table[at] == ALONE)
            table[at] = v;
        s->vertex[c] = table[at];
    }
}

static int edge_order(const void *a, const void *b) {
    const edge *x = a, *y = b;
    if (x->low != y->low)
        return x->low < y->low ? -1 : 1;
    if (x->high != y->high)
        return x->high < y->high ? -1 : 1;
    if (x->falling != y->falling)
        return x->falling < y->falling ? -1 : 1;
    return x->corner < y->corner ? -1 : x->corner > y->corner;
}

static void pair(spaces *s, const edge *a, const edge *b) {
    s->neighbour[a->corner] = b->corner;
    s->neighbour[b->corner] = a->corner;
}

/* Where several triangles meet in an edge, the first one of either direction meets the first of the other, and so on. */
static void meet(spaces *s, edge *edges) {
    const size_t count = 3 * (size_t)s->count;
    for (size_t c = 0; c < count; c++) {
        const uint32_t a = s->vertex[c], b = s->vertex[c % 3 == 2 ? c - 2 : c + 1];
        edges[c] = (edge){.low = a < b ? a : b, .high = a < b ? b : a, .corner = (uint32_t)c, .falling = a > b};
        s->neighbour[c] = ALONE;
    }
    qsort(edges, count, sizeof *edges, edge_order);
    for (size_t first = 0, end; first < count; first = end) {
        size_t falling = first;
        for (end = first; end < count && edges[end].low == edges[first].low && edges[end].high == edges[first].high; end++)
            falling += !edges[end].falling;
        for (size_t i = first, k = falling; i < falling && k < end; i++, k++)
            pair(s, &edges[i], &edges[k]);
    }
}

static double uv_area(const spaces *s, uint32_t t) {
    const uint32_t *v = s->m->index + 3 * (size_t)s->triangle[t];
    const float *a = s->m->uv + 2 * (size_t)v[0], *b = s->m->uv + 2 * (size_t)v[1], *c = s->m->uv + 2 * (size_t)v[2];
    return ((double)b[0] - (double)a[0]) * ((double)c[1] - (double)a[1]) -
           ((double)b[1] - (double)a[1]) * ((double)c[0] - (double)a[0]);
}

/* Triangles without an area of their own turn as the first neighbour does. queue: room for all triangles. */
static void find_turns(spaces *s, uint32_t *queue) {
    uint32_t first = 0, last = 0;
    for (uint32_t t = 0; t < s->count; t++) {
        const double area = uv_area(s, t);
        s->turn[t] = (int8_t)(area > 0.0 ? 1 : area < 0.0 ? -1 : 0);
        s->own[t] = s->turn[t] != 0;
        if (s->own[t])
            queue[last++] = t;
    }
    while (first < last) {
        const uint32_t t = queue[first++];
        for (int k = 0; k < 3; k++) {
            const uint32_t other = s->neighbour[3 * (size_t)t + (size_t)k];
            if (other == ALONE || s->turn[other / 3] != 0)
                continue;
            s->turn[other / 3] = s->turn[t];
            queue[last++] = other / 3;
        }
    }
}

static uint32_t root_of(uint32_t *group, uint32_t c) {
    while (group[c] != c) {
        group[c] = group[group[c]];
        c = group[c];
    }
    return c;
}

/* The smaller number is the root. */
static void unite(uint32_t *group, uint32_t a, uint32_t b) {
    const uint32_t x = root_of(group, a), y = root_of(group, b);
    group[x < y ? y : x] = x < y ? x : y;
}

static uint32_t next_corner(uint32_t c) {
    return c % 3 == 2 ? c - 2 : c + 1;
}

static void find_groups(spaces *s) {
    const uint32_t corners = 3 * s->count;
    for (uint32_t c = 0; c < corners; c++)
        s->group[c] = c;
    for (uint32_t c = 0; c < corners; c++) {
        const uint32_t other = s->neighbour[c];
        if (other == ALONE || s->turn[c / 3] != s->turn[other / 3])
            continue;
        unite(s->group, c, next_corner(other)); /* the other's edge goes the other way */
        unite(s->group, next_corner(c), other);
    }
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* v square to the unit vector n, unit; 0 if nothing is left. */
static void across(const double v[3], const double n[3], double out[3]) {
    const double along = dot(v, n);
    for (int k = 0; k < 3; k++)
        out[k] = v[k] - along * n[k];
    const double length = sqrt(dot(out, out));
    for (int k = 0; k < 3; k++)
        out[k] = length > 1e-30 ? out[k] / length : 0.0;
}

static void load(const float *p, double out[3]) {
    for (int k = 0; k < 3; k++)
        out[k] = (double)p[k];
}

static void between(const model *m, uint32_t from, uint32_t to, double out[3]) {
    for (size_t k = 0; k < 3; k++)
        out[k] = (double)m->position[3 * (size_t)to + k] - (double)m->position[3 * (size_t)from + k];
}

/* Angle of two unit vectors. */
static double angle(const double a[3], const double b[3]) {
    const double c = fmin(fmax(dot(a, b), -1.0), 1.0);
    return 1.0 + c > 0.0 ? 2.0 * strict_atan(sqrt((1.0 - c) / (1.0 + c))) : PI;
}

/* Direction in which u grows and v stays on triangle t, of any length. */
static void along_u(const spaces *s, uint32_t t, double out[3]) {
    const uint32_t *v = s->m->index + 3 * (size_t)s->triangle[t];
    const float *uv = s->m->uv;
    const double t1 = (double)uv[2 * (size_t)v[1] + 1] - (double)uv[2 * (size_t)v[0] + 1],
                 t2 = (double)uv[2 * (size_t)v[2] + 1] - (double)uv[2 * (size_t)v[0] + 1];
    double d1[3], d2[3];
    between(s->m, v[0], v[1], d1);
    between(s->m, v[0], v[2], d2);
    for (int k = 0; k < 3; k++)
        out[k] = s->turn[t] * (t2 * d1[k] - t1 * d2[k]);
}

static void add_triangle(spaces *s, uint32_t t) {
    const uint32_t *v = s->m->index + 3 * (size_t)s->triangle[t];
    double u[3];
    along_u(s, t, u);
    for (uint32_t k = 0; k < 3; k++) {
        double n[3], own[3], before[3], after[3];
        load(s->m->normal + 3 * (size_t)v[k], n);
        between(s->m, v[k], v[(k + 2) % 3], before);
        between(s->m, v[k], v[(k + 1) % 3], after);
        across(u, n, own);
        across(before, n, before);
        across(after, n, after);
        const double weight = angle(before, after);
        double *sum = s->sum[root_of(s->group, 3 * t + k)];
        for (int i = 0; i < 3; i++)
            sum[i] += weight * own[i];
    }
}

/* 1 + the turn of the tangent about the normal as it is stored. */
static uint32_t tangent_code(const double tangent[3], vit_u32 normal) {
    vec3 ax, ay;
    vec3_across(decoded_normal(normal), &ax, &ay);
    double x = tangent[0] * (double)ax.x + tangent[1] * (double)ax.y + tangent[2] * (double)ax.z,
           y = tangent[0] * (double)ay.x + tangent[1] * (double)ay.y + tangent[2] * (double)ay.z;
    const double size = fabs(x) + fabs(y);
    x = size > 0.0 ? x / size : 1.0;
    const uint32_t steps = (uint32_t)((y < 0.0 ? 3.0 + x : 1.0 - x) * (VIT_TANGENT_STEPS / 4.0) + 0.5);
    return 1 + (steps < VIT_TANGENT_STEPS ? steps : 0);
}

static void write_words(const spaces *s, const vit_u32 *normals, vit_u32 *words) {
    for (uint32_t t = 0; t < s->count; t++) {
        const uint32_t *v = s->m->index + 3 * (size_t)s->triangle[t];
        uint64_t both = 0;
        if (s->turn[t] == 0)
            continue;
        for (uint32_t k = 0; k < 3; k++)
            both |= (uint64_t)tangent_code(s->sum[root_of(s->group, 3 * t + k)], normals[v[k]]) << (VIT_TANGENT_BITS * k);
        /* v goes down the picture, a map's y up: normal x tangent where coordinates turn clockwise. */
        words[2 * (size_t)s->triangle[t]] = (vit_u32)both;
        words[2 * (size_t)s->triangle[t] + 1] = (vit_u32)(both >> 32) | (s->turn[t] > 0 ? VIT_TANGENT_MIRRORED : 0);
    }
}

static void find(spaces *s, uint32_t *table, size_t size, edge *edges) {
    weld(s, table, size);
    meet(s, edges);
    find_turns(s, s->group); /* whose room is free until then */
    find_groups(s);
    for (uint32_t t = 0; t < s->count; t++)
        if (s->own[t])
            add_triangle(s, t);
}

static void spaces_free(spaces *s) {
    free(s->triangle);
    free(s->vertex);
    free(s->neighbour);
    free(s->group);
    free(s->turn);
    free(s->own);
    free(s->sum);
}

vit_status tangents_pack(const model *m, const vit_u32 *normals, vit_u32 **words, vit_text *why) {
    spaces s = {.m = m};
    size_t size = 1;
    *words = NULL;
    for (uint32_t t = 0; t < m->triangles; t++)
        s.count += has_map(m, t);
    if (s.count == 0)
        return VIT_OK;
    const size_t corners = 3 * (size_t)s.count;
    while (size < 2 * corners)
        size *= 2;
    s.triangle = calloc(s.count, sizeof *s.triangle);
    s.vertex = malloc(corners * sizeof *s.vertex);
    s.neighbour = malloc(corners * sizeof *s.neighbour);
    s.group = malloc(corners * sizeof *s.group);
    s.turn = malloc(s.count);
    s.own = malloc(s.count * sizeof *s.own);
    s.sum = calloc(corners, sizeof *s.sum);
    uint32_t *table = malloc(size * sizeof *table);
    edge *edges = malloc(corners * sizeof *edges);
    *words = calloc(m->triangles, 2 * sizeof **words);
    const bool fine = s.triangle && s.vertex && s.neighbour && s.group && s.turn && s.own && s.sum && table && edges && *words;
    if (fine) {
        memset(table, 0xff, size * sizeof *table); /* ALONE */
        uint32_t at = 0;
        for (uint32_t t = 0; t < m->triangles; t++)
            if (has_map(m, t))
                s.triangle[at++] = t;
        find(&s, table, size, edges);
        write_words(&s, normals, *words);
    } else {
        free(*words);
        *words = NULL;
    }
    free(table);
    free(edges);
    spaces_free(&s);
    return fine ? VIT_OK : bake_fail(why, VIT_FAILED, "geometry: out of memory for the tangents of %u triangles", s.count);
}
