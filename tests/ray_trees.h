/* Boxes that share planes, edges and whole faces, and trees that nobody would build: what the nearest hit must not depend on.
 */
#ifndef VIT_TESTS_RAY_TREES_H
#define VIT_TESTS_RAY_TREES_H

#include "ray_lab.h"

/* Boxes on whole numbers, -8..8, every fourth one twice; triangles in random order. */
static inline void make_lattice(ray_mesh *r, uint32_t boxes) {
    static const uint32_t quad[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    uint64_t state = 11;
    mesh_reserve(r, 8 * boxes, 12 * boxes);
    for (uint32_t b = 0; b < boxes; b++) {
        int lo[3], hi[3];
        for (int k = 0; k < 3; k++) {
            lo[k] = (int)(lab_random(&state) % 13) - 8;
            hi[k] = lo[k] + 1 + (int)(lab_random(&state) % 4);
        }
        const uint32_t first = b % 4 == 3 ? r->m.vertices - 8 : r->m.vertices;
        for (int i = 0; i < 8 && b % 4 != 3; i++)
            mesh_vertex(r, (float)(i & 1 ? hi[0] : lo[0]), (float)(i & 2 ? hi[1] : lo[1]), (float)(i & 4 ? hi[2] : lo[2]));
        for (int f = 0; f < 6; f++) {
            mesh_triangle(r, first + quad[f][0], first + quad[f][1], first + quad[f][2]);
            mesh_triangle(r, first + quad[f][0], first + quad[f][2], first + quad[f][3]);
        }
    }
    for (uint32_t i = r->m.triangles; i > 1; i--) {
        const uint32_t j = (uint32_t)(lab_random(&state) % i);
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t swapped = r->m.index[3 * (i - 1) + k];
            r->m.index[3 * (i - 1) + k] = r->m.index[3 * j + k];
            r->m.index[3 * j + k] = swapped;
        }
    }
}

/* The same boxes turned, so that nothing is exact any more. */
static inline void turn(ray_mesh *r) {
    static const double m[3][3] = {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}};
    for (uint32_t i = 0; i < r->m.vertices; i++) {
        float *p = r->m.position + 3 * (size_t)i;
        const double q[3] = {(double)p[0], (double)p[1], (double)p[2]};
        for (int k = 0; k < 3; k++)
            p[k] = (float)(m[k][0] * q[0] + m[k][1] * q[1] + m[k][2] * q[2]);
    }
}

static inline float nth_min(const vit_triangle *t, int k) {
    return fminf(t->v0[k], fminf(t->v1[k], t->v2[k]));
}

static inline float nth_max(const vit_triangle *t, int k) {
    return fmaxf(t->v0[k], fmaxf(t->v1[k], t->v2[k]));
}

/* A tree over the index range first .. last, cut anywhere, in leaves of 1 to 8. */
typedef struct odd_tree {
    const ray_mesh *r;
    vit_bvh_node *nodes;
    uint32_t count;
    uint64_t state;
} odd_tree;

static inline vit_u32 odd_subtree(odd_tree *o, uint32_t first, uint32_t last, float lo[3], float hi[3]) {
    const uint32_t n = last - first + 1;
    if (n <= 1 + lab_random(&o->state) % VIT_LEAF_MAX) {
        for (int k = 0; k < 3; k++) {
            lo[k] = 3e38f;
            hi[k] = -3e38f;
            for (uint32_t i = first; i <= last; i++) {
                lo[k] = fminf(lo[k], nth_min(o->r->packed.triangles + i, k) - o->r->tree.box_pad);
                hi[k] = fmaxf(hi[k], nth_max(o->r->packed.triangles + i, k) + o->r->tree.box_pad);
            }
        }
        return VIT_LEAF_BIT | (n - 1) << VIT_LEAF_SHIFT | first;
    }
    const uint32_t self = o->count++, cut = first + n / 4 + (uint32_t)(lab_random(&o->state) % (n / 2));
    float b[4][3];
    const bool swap = lab_random(&o->state) & 1;
    const vit_u32 left = odd_subtree(o, first, cut, b[0], b[1]), right = odd_subtree(o, cut + 1, last, b[2], b[3]);
    vit_bvh_node *node = o->nodes + self;
    node->child0 = swap ? right : left;
    node->child1 = swap ? left : right;
    for (int k = 0; k < 3; k++) {
        node->lo0[k] = b[swap ? 2 : 0][k];
        node->hi0[k] = b[swap ? 3 : 1][k];
        node->lo1[k] = b[swap ? 0 : 2][k];
        node->hi1[k] = b[swap ? 1 : 3][k];
        lo[k] = fminf(b[0][k], b[2][k]);
        hi[k] = fmaxf(b[1][k], b[3][k]);
    }
    return self;
}

static inline odd_tree make_odd_tree(const ray_mesh *r, uint64_t seed) {
    odd_tree o = {r, ray_lab_array(r->m.triangles, sizeof(vit_bvh_node)), 0, seed};
    float lo[3], hi[3];
    assert_int_equal(odd_subtree(&o, 0, r->m.triangles - 1, lo, hi), 0);
    return o;
}

/* Rays in the plane of a triangle, up to roundings: from beyond one of its vertices to a point on the opposite edge, or along
 * an edge. The distance is then 0 / 0 but for roundings, and only its clamping to the triangle's box keeps it from being
 * anything. */
static inline ray_set rays_in_planes(const ray_mesh *r, uint32_t count) {
    ray_set s = rays_new(count);
    uint64_t state = 17;
    for (uint32_t i = 0; i < s.n; i++) {
        const vit_triangle *t = r->packed.triangles + lab_random(&state) % r->m.triangles;
        const float along = i % 3 ? lab_uniform(&state) : (float)(i % 2), back = 6 * lab_uniform(&state);
        float o[3], d[3];
        for (int k = 0; k < 3; k++)
            d[k] = t->v1[k] + along * (t->v2[k] - t->v1[k]) - t->v0[k];
        unit_float(d);
        for (int k = 0; k < 3; k++)
            o[k] = t->v0[k] - back * d[k];
        rays_set(&s, i, o, d, i % 5 == 0 ? 5.0f : RAY_FAR);
    }
    return s;
}

#endif
