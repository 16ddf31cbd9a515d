#include "photon_rays.h"
#include <stdio.h>

#if VIT_EMBREE == 4
#include <embree4/rtcore.h>
typedef struct RTCRayQueryContext embree_context;
#else
#include <embree3/rtcore.h>
typedef struct RTCIntersectContext embree_context;
#endif

#define ONE_PLACE 0x1p-6f /* of ray_offset: faces so close lie in one place, and the first of them is seen */
#define TINY 1e-18f       /* a direction component nearer to zero than this counts as this; RAY_TINY of kernels/ray.clh */

/* One ray on its way, as the filter below sees it. */
typedef struct query {
    embree_context context; /* first: Embree hands its address to the filter */
    const photon_scene *s;
    vec3 origin, direction;
    float nearest; /* Embree's distance of the hit so far */
    uint32_t triangle;
    uint32_t covered; /* VIT_NONE, or a triangle that is not there itself: only what covers it counts (photon_rays_covered()) */
} query;

static float inverse(float d) {
    const float a = fabsf(d) < TINY ? TINY : fabsf(d);
    return d < 0.0f ? -1.0f / a : 1.0f / a;
}

static void clip(float v0, float v1, float v2, float pad, float o, float d, float *enter, float *leave) {
    const float inv = inverse(d), oinv = -o * inv;
    const float lo = float_min(float_min(v0, v1), v2) - pad, hi = float_max(float_max(v0, v1), v2) + pad;
    const float a = fmaf(lo, inv, oinv), b = fmaf(hi, inv, oinv);
    *enter = float_max(*enter, float_min(a, b));
    *leave = float_min(*leave, float_max(a, b));
}

/* The distance of ray_triangle() of kernels/ray.clh: to the triangle's plane, kept inside its grown box, since next to a
 * grazing ray the plane may be anywhere. */
static float plane_distance(const photon_scene *s, vec3 o, vec3 d, uint32_t triangle) {
    const vit_triangle *t = s->triangles + triangle;
    const vec3 n = {t->nx, t->ny, t->nz};
    const float across = vec3_dot(n, d), pad = s->box_pad;
    float enter = 0.0f, leave = 3e38f;
    clip(t->v0[0], t->v1[0], t->v2[0], pad, o.x, d.x, &enter, &leave);
    clip(t->v0[1], t->v1[1], t->v2[1], pad, o.y, d.y, &enter, &leave);
    clip(t->v0[2], t->v1[2], t->v2[2], pad, o.z, d.z, &enter, &leave);
    if (across == 0.0f)
        return enter;
    return float_min(float_max(vec3_dot(n, vec3_sub(vec3_load(t->v0), o)) / across, enter), leave);
}

/* Is what lies at distance t before `triangle`'s place, from where the ray comes, seen instead of it? */
static bool covers(const query *q, uint32_t triangle, float t) {
    const float own = q->s->ray_offset;
    return triangle < q->covered ? t < own * (1.0f + ONE_PLACE) : triangle > q->covered && t < own * (1.0f - ONE_PLACE);
}

/* Decides for Embree whether a hit at or before the nearest one counts. Ties go to the smallest index: which of two faces in
 * one place Embree meets first depends on its tree, and that on the number of threads. */
static void accept_hit(const struct RTCFilterFunctionNArguments *f) {
    query *q = (query *)(void *)f->context;
    const struct RTCRay *ray = (const struct RTCRay *)(const void *)f->ray; /* single rays: packets of one have this layout */
    const struct RTCHit *hit = (const struct RTCHit *)(const void *)f->hit;
    const uint32_t triangle = hit->primID;
    const bool further = ray->tfar > q->nearest || (!(ray->tfar < q->nearest) && triangle > q->triangle);
    if (f->valid[0] != -1)
        return;
    const float t = plane_distance(q->s, q->origin, q->direction, triangle);
    if (further || !(t > 0.0f) || (q->covered != VIT_NONE && !covers(q, triangle, t)) ||
        !photon_opaque_at(q->s, q->origin, q->direction, triangle)) {
        f->valid[0] = 0;
        return;
    }
    q->nearest = ray->tfar;
    q->triangle = triangle;
}

static uint32_t nearest(const photon_rays *r, uint32_t covered, vec3 origin, vec3 direction, float *distance) {
    query q = {
        .s = r->s, .origin = origin, .direction = direction, .nearest = INFINITY, .triangle = VIT_NONE, .covered = covered};
    struct RTCRayHit h = {.ray = {.org_x = origin.x,
                                  .org_y = origin.y,
                                  .org_z = origin.z,
                                  .dir_x = direction.x,
                                  .dir_y = direction.y,
                                  .dir_z = direction.z,
                                  .tfar = INFINITY,
                                  .mask = ~0u},
                          .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
#if VIT_EMBREE == 4
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    rtcInitRayQueryContext(&q.context);
    arguments.context = &q.context;
    rtcIntersect1(r->scene, &h, &arguments);
#else
    rtcInitIntersectContext(&q.context);
    rtcIntersect1(r->scene, &q.context, &h);
#endif
    if (q.triangle != VIT_NONE)
        *distance = plane_distance(r->s, origin, direction, q.triangle);
    return q.triangle;
}

uint32_t photon_rays_nearest(const photon_rays *r, vec3 origin, vec3 direction, float *distance) {
    return nearest(r, VIT_NONE, origin, direction, distance);
}

bool photon_rays_covered(const photon_rays *r, uint32_t triangle, vec3 p, vec3 n) {
    float t;
    return nearest(r, triangle, p, vec3_scale(n, -1.0f), &t) != VIT_NONE;
}

/* For any hit: does this one count? Called only in scenes with cut-outs. */
static void accept_blocker(const struct RTCFilterFunctionNArguments *f) {
    const query *q = (const query *)(const void *)f->context;
    const struct RTCHit *hit = (const struct RTCHit *)(const void *)f->hit;
    if (f->valid[0] == -1 && !photon_opaque_at(q->s, q->origin, q->direction, hit->primID))
        f->valid[0] = 0;
}

/* Hits count from t > 0 on, as in ray_triangle(): a point on an edge lies in two surfaces, and neither shadows it. */
bool photon_rays_occluded(const photon_rays *r, vec3 origin, vec3 direction, float distance) {
    query q = {.s = r->s, .origin = origin, .direction = direction};
    struct RTCRay ray = {.org_x = origin.x,
                         .org_y = origin.y,
                         .org_z = origin.z,
                         .dir_x = direction.x,
                         .dir_y = direction.y,
                         .dir_z = direction.z,
                         .tnear = 0x1p-100f,
                         .tfar = distance,
                         .mask = ~0u};
#if VIT_EMBREE == 4
    struct RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    rtcInitRayQueryContext(&q.context);
    arguments.context = &q.context;
    rtcOccluded1(r->scene, &ray, &arguments);
#else
    rtcInitIntersectContext(&q.context);
    rtcOccluded1(r->scene, &q.context, &ray);
#endif
    return ray.tfar < 0.0f;
}

static bool has_cutouts(const photon_scene *s) {
    for (uint32_t i = 0; i < s->triangle_count; i++)
        if (s->materials[s->attributes[i].material & VIT_MATERIAL_INDEX].cutout)
            return true;
    return false;
}

/* primID is the triangle's index. The vertices lie 16 bytes apart in vit_triangle. */
static bool add_triangles(photon_rays *r) {
    const uint32_t triangles = r->s->triangle_count;
    RTCGeometry mesh = rtcNewGeometry(r->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, r->s->triangles, 0, sizeof(vit_triangle) / 3,
                               3 * (size_t)triangles);
    uint32_t *index = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof *index, triangles);
    for (size_t i = 0; index && i < 3 * (size_t)triangles; i++)
        index[i] = (uint32_t)i;
    if (index) {
        rtcSetGeometryIntersectFilterFunction(mesh, accept_hit);
        if (has_cutouts(r->s))
            rtcSetGeometryOccludedFilterFunction(mesh, accept_blocker);
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(r->scene, mesh);
        rtcCommitScene(r->scene);
    }
    rtcReleaseGeometry(mesh);
    return index && rtcGetDeviceError(r->device) == RTC_ERROR_NONE;
}

bool photon_rays_open(const photon_scene *s, unsigned threads, photon_rays *out) {
    char config[32];
    snprintf(config, sizeof config, "threads=%u", threads);
    *out = (photon_rays){.s = s, .device = rtcNewDevice(config)};
    if (!out->device)
        return false;
    out->scene = rtcNewScene(out->device);
    if (out->scene)
        rtcSetSceneFlags(out->scene, RTC_SCENE_FLAG_ROBUST);
    if (out->scene && add_triangles(out))
        return true;
    photon_rays_close(out);
    return false;
}

void photon_rays_close(photon_rays *r) {
    if (r->scene)
        rtcReleaseScene(r->scene);
    if (r->device)
        rtcReleaseDevice(r->device);
    *r = (photon_rays){0};
}
