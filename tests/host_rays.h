/* Meshes and rays of ray_lab.h, cast on the host (host_lab.h). */
#ifndef VIT_TESTS_HOST_RAYS_H
#define VIT_TESTS_HOST_RAYS_H

#include "host_lab.h"
#include "ray_lab.h"

static const vit_material host_grey = {.albedo = {0.5f, 0.5f, 0.5f}, .texture = VIT_NONE, .exponent = 1, .ior = 1};

/* `constants` is filled, and must live as long as the result. */
static inline host_lab_mesh host_mesh(const ray_mesh *r, vit_scene *constants) {
    *constants = mesh_scene(r);
    constants->ray_offset = r->packed.ray_offset;
    return (host_lab_mesh){constants, r->packed.triangles, r->packed.attributes, &host_grey, r->tree.nodes};
}

static inline ray_hits host_hits(uint32_t n) {
    return (ray_hits){n, ray_lab_array(n, 4), ray_lab_array(n, 4), ray_lab_array(n, 4)};
}

static inline ray_hits host_cast(const host_lab_mesh *m, const ray_set *s) {
    ray_hits h = host_hits(s->n);
    host_lab_find()->nearest(m, s->plane, s->n, h.distance, h.triangle, h.occluded);
    return h;
}

static inline ray_hits host_cast_at_all(const host_lab_mesh *m, const ray_set *s) {
    ray_hits h = host_hits(s->n);
    host_lab_find()->nearest_of_all(m, s->plane, s->n, h.distance, h.triangle, h.occluded);
    return h;
}

/* Rays whose answers differ in any bit. */
static inline uint32_t hits_apart(const ray_hits *a, const ray_hits *b) {
    uint32_t apart = 0;
    assert_int_equal(a->n, b->n);
    for (uint32_t i = 0; i < a->n; i++)
        apart += memcmp(a->distance + i, b->distance + i, 4) != 0 || a->triangle[i] != b->triangle[i] ||
                 a->occluded[i] != b->occluded[i];
    return apart;
}

/* Rays that find no way to the mesh, or for which the two kinds of rays do not agree. */
static inline uint32_t hits_leaks(const ray_hits *h) {
    uint32_t leaks = 0;
    for (uint32_t i = 0; i < h->n; i++)
        leaks += h->triangle[i] == VIT_NONE || h->occluded[i] == 0;
    return leaks;
}

/* A point of a triangle's plane from weights of the second and third vertex, rounded. */
static inline void triangle_point(const vit_triangle *t, float b1, float b2, float p[3]) {
    for (int k = 0; k < 3; k++)
        p[k] = t->v0[k] + b1 * (t->v1[k] - t->v0[k]) + b2 * (t->v2[k] - t->v0[k]);
}

/* Weights of a vertex, of a place on an edge, or of anywhere within, in turns. */
static inline void triangle_place(uint64_t *state, uint32_t turn, float *b1, float *b2) {
    float a = lab_uniform(state), b = lab_uniform(state);
    if (a + b > 1) {
        a = 1 - a;
        b = 1 - b;
    }
    if (turn % 4 == 0)
        a = b = 0;
    if (turn % 4 == 1)
        b = 0;
    if (turn % 4 == 2) {
        a = 0.5f;
        b = 0.5f;
    }
    *b1 = a;
    *b2 = b;
}

#endif
