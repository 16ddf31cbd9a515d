/* Embree as the reference for rays: robust mode, one ray at a time, over the packed triangles themselves, so that its primitive
 * numbers are our triangle indices. Embree 3 and 4 differ in names and in how a call gets its context. */
#ifndef VIT_TESTS_EMBREE_REFERENCE_H
#define VIT_TESTS_EMBREE_REFERENCE_H

#include "oracle/exact_ray.h"
#include "ray_lab.h"

#if VIT_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

typedef struct embree {
    RTCDevice device;
    RTCScene scene;
    uint32_t *index;
} embree;

static inline embree embree_open(const ray_mesh *r, enum RTCSceneFlags flags) {
    embree e = {.device = rtcNewDevice(NULL), .index = ray_lab_array(3 * (size_t)r->m.triangles, sizeof(uint32_t))};
    assert_non_null(e.device);
    for (uint32_t i = 0; i < 3 * r->m.triangles; i++)
        e.index[i] = i;
    e.scene = rtcNewScene(e.device);
    rtcSetSceneFlags(e.scene, flags);
    RTCGeometry g = rtcNewGeometry(e.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    /* A record is three times a position and one component of the normal: 16 bytes from vertex to vertex. */
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, r->packed.triangles, 0, 16,
                               3 * (size_t)r->m.triangles);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, e.index, 0, 12, r->m.triangles);
    rtcCommitGeometry(g);
    rtcAttachGeometry(e.scene, g);
    rtcReleaseGeometry(g);
    rtcCommitScene(e.scene);
    assert_int_equal(rtcGetDeviceError(e.device), RTC_ERROR_NONE);
    return e;
}

static inline void embree_close(embree *e) {
    rtcReleaseScene(e->scene);
    rtcReleaseDevice(e->device);
    free(e->index);
}

static inline uint32_t embree_nearest(const embree *e, const float o[3], const float d[3], float limit, float *t) {
    struct RTCRayHit h = {.ray = {.org_x = o[0],
                                  .org_y = o[1],
                                  .org_z = o[2],
                                  .dir_x = d[0],
                                  .dir_y = d[1],
                                  .dir_z = d[2],
                                  .tnear = 0x1p-100f, /* our interval is open at 0 */
                                  .tfar = limit,
                                  .mask = ~0u},
                          .hit = {.primID = RTC_INVALID_GEOMETRY_ID, .geomID = RTC_INVALID_GEOMETRY_ID}};
#if VIT_EMBREE == 4
    rtcIntersect1(e->scene, &h, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(e->scene, &context, &h);
#endif
    *t = h.ray.tfar;
    return h.hit.geomID == RTC_INVALID_GEOMETRY_ID ? VIT_NONE : h.hit.primID;
}

#endif
