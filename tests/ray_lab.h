/* Rays in the laboratory: meshes, their BVH, and the kernels' ray_nearest and ray_occluded over arrays of rays. */
#ifndef VIT_TESTS_RAY_LAB_H
#define VIT_TESTS_RAY_LAB_H

#include "geometry/bvh.h"
#include "kernel_lab.h"
#include <math.h>

#define RAY_FAR 3e38f
#define RAY_NOT_CAST -1.0f /* as a limit: the lane is inactive */

/* nearest_and_any: planes of origin, direction and limit in, nearest hit and occlusion out.
 * nearest_of_all: the same nearest hit without a tree, triangle after triangle. */
static const char ray_lab_kernels[] =
    "kernel void nearest_and_any(RAY_SCENE_PARAMETERS, global const float *rays, global const uint *count, global float "
    "*distance,\n"
    "                            global uint *triangle, global uint *occluded)\n"
    "{\n"
    "    uint first = (uint)get_global_id(0) * VIT_LANES, n = count[0];\n"
    "    ray_packet r = ray_make(lv3_load_planes(rays, n, first), lv3_load_planes(VIT_PLANE(rays, 3, n), n, first));\n"
    "    lf limit = L_LOAD(VIT_PLANE(rays, 6, n) + first), t = limit;\n"
    "    li found, active = L_GE(limit, (lf)0);\n"
    "    ray_nearest(RAY_SCENE, &r, active, &t, &found);\n"
    "    L_STORE(t, distance + first);\n"
    "    L_STORE(L_AS_UINT(found), triangle + first);\n"
    "    L_STORE(L_AS_UINT(ray_occluded(RAY_SCENE, &r, active, limit)), occluded + first);\n"
    "}\n"
    "kernel void nearest_of_all(RAY_SCENE_PARAMETERS, global const float *rays, global const uint *count, global float "
    "*distance,\n"
    "                           global uint *triangle, global uint *occluded)\n"
    "{\n"
    "    uint first = (uint)get_global_id(0) * VIT_LANES, n = count[0];\n"
    "    ray_packet r = ray_make(lv3_load_planes(rays, n, first), lv3_load_planes(VIT_PLANE(rays, 3, n), n, first));\n"
    "    lf limit = L_LOAD(VIT_PLANE(rays, 6, n) + first), best = limit;\n"
    "    li found = (li)(int)VIT_NONE, active = L_GE(limit, (lf)0), dark = (li)0;\n"
    "    for (uint i = 0; i < scene->triangles; i++) {\n"
    "        lf d = best;\n"
    "        li hit = ray_triangle(RAY_SCENE, &r, i, active, limit, &d);\n"
    "        dark |= hit;\n"
    "        hit &= L_LT(d, best) | (L_EQ(d, best) & L_EQ(found, (li)(int)VIT_NONE));\n"
    "        best = l_sel(hit, d, best);\n"
    "        found = l_sel_i(hit, (li)(int)i, found);\n"
    "    }\n"
    "    L_STORE(best, distance + first);\n"
    "    L_STORE(L_AS_UINT(found), triangle + first);\n"
    "    L_STORE(L_AS_UINT(dark), occluded + first);\n"
    "}\n";

static inline void *ray_lab_array(size_t count, size_t size) {
    void *p = calloc(count ? count : 1, size);
    assert_non_null(p);
    return p;
}

/* A mesh and what the baker makes of it. */
typedef struct ray_mesh {
    model m;
    bvh tree;
    geometry packed;
} ray_mesh;

static inline void mesh_reserve(ray_mesh *r, uint32_t vertices, uint32_t triangles) {
    *r = (ray_mesh){0};
    r->m.position = ray_lab_array(3 * (size_t)vertices, sizeof(float));
    r->m.normal = ray_lab_array(3 * (size_t)vertices, sizeof(float));
    r->m.uv = ray_lab_array(2 * (size_t)vertices, sizeof(float));
    r->m.index = ray_lab_array(3 * (size_t)triangles, sizeof(uint32_t));
    r->m.material = ray_lab_array(triangles, sizeof(uint32_t));
    r->m.materials = ray_lab_array(1, sizeof(model_material));
    r->m.material_count = 1;
}

static inline uint32_t mesh_vertex(ray_mesh *r, float x, float y, float z) {
    float *p = r->m.position + 3 * (size_t)r->m.vertices;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    return r->m.vertices++;
}

static inline void mesh_triangle(ray_mesh *r, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *i = r->m.index + 3 * (size_t)r->m.triangles++;
    i[0] = a;
    i[1] = b;
    i[2] = c;
}

/* The six faces of the cube -1..1 as n x n squares each; every vertex is place(x, y, z), so shared ones have equal bits. */
typedef void mesh_place_fn(float p[3]);

static inline void mesh_cube(ray_mesh *r, int n, mesh_place_fn *place) {
    const uint32_t side = (uint32_t)(n + 1);
    mesh_reserve(r, 6 * side * side, 12 * (uint32_t)(n * n));
    for (int face = 0; face < 6; face++) {
        const uint32_t first = r->m.vertices;
        for (int j = 0; j <= n; j++)
            for (int i = 0; i <= n; i++) {
                float p[3];
                p[face % 3] = face < 3 ? -1.0f : 1.0f;
                p[(face + 1) % 3] = (float)(2 * i - n) / (float)n;
                p[(face + 2) % 3] = (float)(2 * j - n) / (float)n;
                place(p);
                mesh_vertex(r, p[0], p[1], p[2]);
            }
        for (uint32_t j = 0; j < (uint32_t)n; j++)
            for (uint32_t i = 0; i < (uint32_t)n; i++) {
                const uint32_t a = first + j * side + i, b = a + 1, c = a + side, d = c + 1;
                mesh_triangle(r, a, b, (i ^ j) & 1u ? c : d);
                mesh_triangle(r, (i ^ j) & 1u ? b : a, d, c);
            }
    }
}

/* Closed meshes about (3, -2, 5), as places for mesh_cube(). */
static inline void place_ball(float p[3]) {
    const double x = (double)p[0], y = (double)p[1], z = (double)p[2], r = 10 / sqrt(x * x + y * y + z * z);
    p[0] = (float)(x * r + 3);
    p[1] = (float)(y * r - 2);
    p[2] = (float)(z * r + 5);
}

static inline void place_box(float p[3]) {
    p[0] = p[0] * 7.3f + 3;
    p[1] = p[1] * 4.1f - 2;
    p[2] = p[2] * 9.7f + 5;
}

/* Spikes that hide one another; the centre sees all of it. */
static inline void place_crumpled(float p[3]) {
    const double x = (double)p[0], y = (double)p[1], z = (double)p[2], l = sqrt(x * x + y * y + z * z);
    const double r = (8 + 3 * sin(57 * x / l) * sin(61 * y / l + 1) * sin(53 * z / l + 2)) / l;
    p[0] = (float)(x * r + 3);
    p[1] = (float)(y * r - 2);
    p[2] = (float)(z * r + 5);
}

static inline void mesh_bake(ray_mesh *r) {
    vit_text why;
    if (bvh_build(&r->m, 0, &r->tree, &why) != VIT_OK || geometry_pack(&r->m, &r->tree, &r->packed, &why) != VIT_OK)
        fail_msg("%s", why.text);
}

static inline void mesh_free(ray_mesh *r) {
    geometry_free(&r->packed);
    bvh_free(&r->tree);
    model_free(&r->m);
}

static inline vit_scene mesh_scene(const ray_mesh *r) {
    return (vit_scene){.triangles = r->m.triangles, .nodes = r->tree.node_count, .box_pad = r->tree.box_pad};
}

/* Planes of n values each: origin, direction, limit. n is a multiple of 16. */
typedef struct ray_set {
    uint32_t n;
    float *plane; /* 7 n */
} ray_set;

typedef struct ray_hits {
    uint32_t n;
    float *distance;
    uint32_t *triangle, *occluded;
} ray_hits;

static inline ray_set rays_new(uint32_t n) {
    assert_int_equal(n % 16, 0);
    return (ray_set){n, ray_lab_array(7 * (size_t)n, sizeof(float))};
}

static inline void rays_set(ray_set *s, uint32_t i, const float origin[3], const float direction[3], float limit) {
    for (uint32_t k = 0; k < 3; k++) {
        s->plane[(size_t)k * s->n + i] = origin[k];
        s->plane[(size_t)(3 + k) * s->n + i] = direction[k];
    }
    s->plane[(size_t)6 * s->n + i] = limit;
}

static inline void rays_get(const ray_set *s, uint32_t i, float origin[3], float direction[3]) {
    for (uint32_t k = 0; k < 3; k++) {
        origin[k] = s->plane[(size_t)k * s->n + i];
        direction[k] = s->plane[(size_t)(3 + k) * s->n + i];
    }
}

static inline float *rays_limit(const ray_set *s) {
    return s->plane + (size_t)6 * s->n;
}

static inline void hits_free(ray_hits *h) {
    free(h->distance);
    free(h->triangle);
    free(h->occluded);
    *h = (ray_hits){0};
}

/* Casts the rays with one of the kernels above through `nodes` over the mesh's triangles. */
static inline ray_hits rays_cast_through(lab *l, const char *kernel, unsigned lanes, const ray_mesh *r,
                                         const vit_bvh_node *nodes, uint32_t node_count, const ray_set *s) {
    const vit_scene constants = mesh_scene(r);
    const vit_u32 nothing[16] = {0};
    const size_t t = r->m.triangles, bytes = (size_t)s->n * 4;
    cl_mem none = lab_buffer(l, nothing, sizeof nothing);
    cl_mem a[] = {lab_buffer(l, &constants, sizeof constants),
                  lab_buffer(l, r->packed.triangles, t * sizeof(vit_triangle)),
                  lab_buffer(l, r->packed.attributes, t * sizeof(vit_attributes)),
                  none,
                  none,
                  none,
                  none,
                  lab_buffer(l, nodes, node_count * sizeof *nodes),
                  lab_buffer(l, s->plane, 7 * bytes),
                  lab_buffer(l, &s->n, sizeof s->n),
                  lab_buffer(l, NULL, bytes),
                  lab_buffer(l, NULL, bytes),
                  lab_buffer(l, NULL, bytes)};
    ray_hits h = {s->n, ray_lab_array(s->n, 4), ray_lab_array(s->n, 4), ray_lab_array(s->n, 4)};
    lab_run(l, kernel, s->n / lanes, a, sizeof a / sizeof *a);
    lab_read(l, a[10], h.distance, bytes);
    lab_read(l, a[11], h.triangle, bytes);
    lab_read(l, a[12], h.occluded, bytes);
    for (size_t i = 0; i < sizeof a / sizeof *a; i++)
        if (a[i] != none)
            clReleaseMemObject(a[i]);
    clReleaseMemObject(none);
    return h;
}

static inline ray_hits rays_cast(lab *l, unsigned lanes, const ray_mesh *r, const ray_set *s) {
    return rays_cast_through(l, "nearest_and_any", lanes, r, r->tree.nodes, r->tree.node_count, s);
}

/* Every bit of both: distances, triangles, occlusion. */
static inline void hits_equal(const ray_hits *a, const ray_hits *b) {
    assert_int_equal(a->n, b->n);
    for (uint32_t i = 0; i < a->n; i++)
        if (memcmp(a->distance + i, b->distance + i, 4) != 0 || a->triangle[i] != b->triangle[i] ||
            a->occluded[i] != b->occluded[i])
            fail_msg("ray %u: triangle %u at %a, occluded %u, against triangle %u at %a, occluded %u", i, a->triangle[i],
                     (double)a->distance[i], a->occluded[i], b->triangle[i], (double)b->distance[i], b->occluded[i]);
}

static inline void unit_float(float v[3]) {
    const double l = sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2]);
    for (int k = 0; k < 3; k++)
        v[k] = (float)((double)v[k] / l);
}

static inline void random_direction(uint64_t *state, float d[3]) {
    float l2;
    do {
        l2 = 0;
        for (int k = 0; k < 3; k++) {
            d[k] = 2.0f * lab_uniform(state) - 1.0f;
            l2 += d[k] * d[k];
        }
    } while (l2 > 1.0f || l2 < 1e-4f);
    unit_float(d);
}

#endif
