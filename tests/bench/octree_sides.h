/* The sides of the octree's bench: the octree, and the library's BVH kernels at 1, 8 and 16 lanes; each a program of its own
 * with the same options on the same device, casting the same rays from memory, 256 rays a work-group. */
#ifndef VIT_BENCH_OCTREE_SIDES_H
#define VIT_BENCH_OCTREE_SIDES_H

#include "baselines/octree_lab.h"
#include "measure.h"

#define SIDE_GROUP 256u

static const char side_kernels[] =
    "#define BVH_RAYS \\\n"
    "    uint first = (uint)get_global_id(0) * VIT_LANES, n = count[0]; \\\n"
    "    ray_packet r = ray_make(lv3_load_planes(rays, n, first), lv3_load_planes(VIT_PLANE(rays, 3, n), n, first)); \\\n"
    "    lf t = L_LOAD(VIT_PLANE(rays, 6, n) + first); \\\n"
    "    li active = L_GE(t, L_F(0))\n"
    "kernel void bvh_nearest(RAY_SCENE_PARAMETERS, global const float *rays, global const uint *count, global float "
    "*distance,\n"
    "                        global uint *triangle)\n"
    "{\n"
    "    BVH_RAYS;\n"
    "    li found = L_I((int)VIT_NONE);\n"
    "    if (l_any(active))\n"
    "        ray_nearest(RAY_SCENE, &r, active, &t, &found);\n"
    "    L_STORE(t, distance + first);\n"
    "    L_STORE(L_AS_UINT(found), triangle + first);\n"
    "}\n"
    "kernel void bvh_any(RAY_SCENE_PARAMETERS, global const float *rays, global const uint *count, global uint *occluded)\n"
    "{\n"
    "    BVH_RAYS;\n"
    "    li dark = L_I(0);\n"
    "    if (l_any(active))\n"
    "        dark = ray_occluded(RAY_SCENE, &r, active, t);\n"
    "    L_STORE(L_AS_UINT(dark & 1), occluded + first);\n"
    "}\n"
    "#if VIT_COUNT_WORK\n"
    "kernel void bvh_work_of(RAY_SCENE_PARAMETERS, global const float *rays, global const uint *count, global const uint "
    "*any,\n"
    "                        global uint2 *done)\n"
    "{\n"
    "    BVH_RAYS;\n"
    "    li found;\n"
    "    if (any[0])\n"
    "        ray_occluded(RAY_SCENE, &r, active, t);\n"
    "    else\n"
    "        ray_nearest(RAY_SCENE, &r, active, &t, &found);\n"
    "    done[get_global_id(0)] = (uint2)((uint)r.box_tests, (uint)r.triangle_tests);\n"
    "}\n"
    "#endif\n";

enum { CAST_VIEW, CAST_SHADOW, CASTS };

typedef struct side {
    const char *name;
    unsigned lanes;
    bool is_octree;
    lab l;
    cl_mem scene[8], rays[CASTS], count, distance, triangle, occluded;
    cl_uint scene_count;
    cl_kernel kernel[CASTS];
    uint32_t n;
} side;

static inline cl_kernel side_kernel(side *s, const char *name, const cl_mem *more, cl_uint count) {
    cl_int e;
    cl_kernel k = clCreateKernel(s->l.program, name, &e);
    lab_check(e, name);
    for (cl_uint i = 0; i < s->scene_count + count; i++)
        lab_check(clSetKernelArg(k, i, sizeof(cl_mem), i < s->scene_count ? &s->scene[i] : &more[i - s->scene_count]),
                  "clSetKernelArg");
    return k;
}

/* Materials have no holes, so that textures and materials are not looked at. */
static inline void side_bvh_buffers(side *s, const ray_mesh *m) {
    const vit_scene constants = mesh_scene(m);
    const vit_u32 nothing[16] = {0};
    s->scene_count = 8;
    s->scene[0] = lab_buffer(&s->l, &constants, sizeof constants);
    s->scene[1] = lab_buffer(&s->l, m->packed.triangles, m->m.triangles * sizeof(vit_triangle));
    s->scene[2] = lab_buffer(&s->l, m->packed.attributes, m->m.triangles * sizeof(vit_attributes));
    for (int i = 3; i < 7; i++)
        s->scene[i] = lab_buffer(&s->l, nothing, sizeof nothing);
    s->scene[7] = lab_buffer(&s->l, m->tree.nodes, m->tree.node_count * sizeof *m->tree.nodes);
}

/* lanes 0: the octree `o`. */
static inline side side_open(const char *name, unsigned lanes, const ray_mesh *m, const octree *o, uint32_t n,
                             bool count_work) {
    side s = {.name = name, .lanes = lanes ? lanes : 1, .is_octree = lanes == 0, .n = n};
    char *source = s.is_octree ? octree_source("") : NULL;
    s.l = lab_open_with(s.lanes, 0, count_work ? " -DVIT_COUNT_WORK=1" : "", source ? source : side_kernels);
    free(source);
    if (s.is_octree) {
        s.scene_count = OCTREE_BUFFERS;
        octree_buffers(&s.l, o, s.scene);
    } else
        side_bvh_buffers(&s, m);
    s.count = lab_buffer(&s.l, &n, sizeof n);
    s.distance = lab_buffer(&s.l, NULL, (size_t)n * 4);
    s.triangle = lab_buffer(&s.l, NULL, (size_t)n * 4);
    s.occluded = lab_buffer(&s.l, NULL, (size_t)n * 4);
    return s;
}

static inline void side_rays(side *s, int cast, const ray_set *rays) {
    s->rays[cast] = lab_buffer(&s->l, rays->plane, 28 * (size_t)rays->n);
    const cl_mem nearest[] = {s->rays[cast], s->count, s->distance, s->triangle},
                 any[] = {s->rays[cast], s->count, s->occluded};
    s->kernel[cast] = cast == CAST_VIEW ? side_kernel(s, s->is_octree ? "octree_nearest" : "bvh_nearest", nearest, 4)
                                        : side_kernel(s, s->is_octree ? "octree_any" : "bvh_any", any, 3);
}

static inline double side_enqueue(side *s, cl_kernel k) {
    const size_t global = s->n / s->lanes, local = SIDE_GROUP / s->lanes;
    const double began = bench_seconds();
    lab_check(clEnqueueNDRangeKernel(s->l.queue, k, 1, NULL, &global, &local, 0, NULL, NULL), s->name);
    lab_check(clFinish(s->l.queue), "clFinish");
    return (bench_seconds() - began) * 1e3;
}

/* Milliseconds until all rays are done. */
static inline double side_run(side *s, int cast) {
    return side_enqueue(s, s->kernel[cast]);
}

static inline void *side_read(side *s, cl_mem m) {
    void *out = bench_array(s->n, 4);
    lab_read(&s->l, m, out, (size_t)s->n * 4);
    return out;
}

/* Boxes (octants entered; boxes of nodes tested) and triangle tests of all rays; the side was opened to count. */
static inline void side_work(side *s, int cast, const ray_set *rays, double work[2]) {
    const uint32_t any = cast == CAST_SHADOW;
    cl_mem a[] = {lab_buffer(&s->l, rays->plane, 28 * (size_t)rays->n), s->count, lab_buffer(&s->l, &any, sizeof any),
                  lab_buffer(&s->l, NULL, (size_t)s->n * 8)};
    cl_kernel k = side_kernel(s, s->is_octree ? "octree_work_of" : "bvh_work_of", a, 4);
    uint32_t *done = bench_array(s->n, 8);
    side_enqueue(s, k);
    lab_read(&s->l, a[3], done, (size_t)s->n * 8);
    work[0] = work[1] = 0;
    for (uint32_t i = 0; i < s->n / s->lanes; i++)
        for (uint32_t c = 0; c < 2; c++)
            work[c] += done[2 * (size_t)i + c];
    free(done);
    clReleaseKernel(k);
    clReleaseMemObject(a[0]);
    clReleaseMemObject(a[2]);
    clReleaseMemObject(a[3]);
}

static inline void side_close(side *s) {
    const cl_mem own[] = {s->count, s->distance, s->triangle, s->occluded};
    for (cl_uint i = 0; i < s->scene_count; i++)
        clReleaseMemObject(s->scene[i]);
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        clReleaseMemObject(own[i]);
    for (int c = 0; c < CASTS; c++)
        if (s->kernel[c]) {
            clReleaseKernel(s->kernel[c]);
            clReleaseMemObject(s->rays[c]);
        }
    lab_close(&s->l);
}

#endif
