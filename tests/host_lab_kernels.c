/* host_lab.h for one instruction set: compiled as runtime/host/kernels.c is, once for each, with another name (HOST_LAB). */
#include "tests/host_lab.h"
#include "runtime/host/opencl_c.h"

_Static_assert(VIT_LANES == HOST_LAB_LANES, "as the header says");

#define X(bit, name, macro, why) static const uint VIT_EFFECT_##macro = 0;
VIT_EFFECTS(X)
#undef X
#define X(macro) static const uint VIT_EFFECT_##macro = 0;
VIT_MODES(X)
#undef X
static const vit_view VIT_VIEW = VIT_VIEW_final;
static const vit_format VIT_FORMAT = VIT_FORMAT_XRGB8888;
#define VIT_WITH(effect) 1
#define VIT_WITH_DENSE 1
#define VIT_COUNT_WORK 0

#include "kernel_list.h"

#define MESH m->scene, m->triangles, m->attributes, m->materials, NULL, NULL, NULL
#define RAYS MESH, m->nodes

static ray_packet packet(const float *rays, uint n, uint first, lf *limit) {
    *limit = L_LOAD(VIT_PLANE(rays, 6, n) + first);
    return ray_make(lv3_load_planes(rays, n, first), lv3_load_planes(VIT_PLANE(rays, 3, n), n, first));
}

static void nearest(const host_lab_mesh *m, const float *rays, uint32_t n, float *distance, uint32_t *triangle,
                    uint32_t *dark) {
    for (uint i = 0; i < n; i += VIT_LANES) {
        lf limit, t;
        ray_packet r = packet(rays, n, i, &limit);
        li found, active = L_GE(limit, L_F(0));
        t = limit;
        ray_nearest(RAYS, &r, active, &t, &found);
        L_STORE(t, distance + i);
        L_STORE(L_AS_UINT(found), triangle + i);
        L_STORE(L_AS_UINT(ray_occluded(RAYS, &r, active, limit)), dark + i);
    }
}

static void nearest_of_all(const host_lab_mesh *m, const float *rays, uint32_t n, float *distance, uint32_t *triangle,
                           uint32_t *dark) {
    for (uint i = 0; i < n; i += VIT_LANES) {
        lf limit;
        ray_packet r = packet(rays, n, i, &limit);
        lf best = limit;
        li found = L_I((int)VIT_NONE), active = L_GE(limit, L_F(0)), any = L_I(0);
        for (uint k = 0; k < m->scene->triangles; k++) {
            lf d = best;
            li hit = ray_triangle(RAYS, &r, k, active, limit, &d);
            any |= hit;
            hit &= L_LT(d, best) | (L_EQ(d, best) & L_EQ(found, L_I((int)VIT_NONE)));
            best = l_sel(hit, d, best);
            found = l_sel_i(hit, L_I((int)k), found);
        }
        L_STORE(best, distance + i);
        L_STORE(L_AS_UINT(found), triangle + i);
        L_STORE(L_AS_UINT(any), dark + i);
    }
}

static void occluded(const host_lab_mesh *m, const float *rays, uint32_t n, uint32_t *dark) {
    for (uint i = 0; i < n; i += VIT_LANES) {
        lf limit;
        ray_packet r = packet(rays, n, i, &limit);
        L_STORE(L_AS_UINT(ray_occluded(RAYS, &r, L_GE(limit, L_F(0)), limit)), dark + i);
    }
}

static void surfaces(const host_lab_mesh *m, const float *rays, const float *distance, const uint32_t *triangle, uint32_t n,
                     float *out) {
    for (uint i = 0; i < n; i += VIT_LANES) {
        lf limit;
        ray_packet r = packet(rays, n, i, &limit);
        li found = L_AS_INT(L_LOAD(triangle + i)), hit = L_NE(found, L_I((int)VIT_NONE));
        surface s = surface_at(MESH, r.o, r.d, l_sel(hit, L_LOAD(distance + i), L_F(1)), hit, found, L_F(0));
        lv3_store_planes(s.position, out, n, i);
        lv3_store_planes(s.face, VIT_PLANE(out, 3, n), n, i);
        lv3_store_planes(s.normal, VIT_PLANE(out, 6, n), n, i);
        lv3_store_planes(s.albedo, VIT_PLANE(out, 9, n), n, i);
    }
}

static void slices(const vit_scene *s, const float *depth, uint32_t n, int32_t *slice) {
    for (uint i = 0; i < n; i += VIT_LANES)
        L_STORE(cluster_slice(s, L_LOAD(depth + i)), slice + i);
}

static void wrap(const float *coordinate, uint32_t mode, uint32_t n, float *wrapped) {
    for (uint i = 0; i < n; i += VIT_LANES)
        L_STORE(texture_wrap(L_LOAD(coordinate + i), mode), wrapped + i);
}

extern const host_lab HOST_LAB;
const host_lab HOST_LAB = {HOST_ISA, nearest, nearest_of_all, occluded, surfaces, slices, wrap};
