/* Embree's boxes are grown so far that its arithmetic, whatever the instruction set, skips none that ours would enter.
 *
 * Let L be the largest coordinate of a vertex, and 16 L that of an origin o. For a plane p of a box, an axis of the ray's
 * direction d and u = 2^-24 L: our (p - o) / d is that of a plane at most 50 u away (three roundings, of p / d, o / d and their
 * difference: 1 + 32 + 17), Embree's that of one at most 129 u away (the inverse within 2^-21.5 of right: 96; as above: 33).
 * With planes 2^-16 L = 256 u further out for Embree than for us, it enters each box no later and leaves it no sooner than we
 * do; our distance of a hit lies between our enter and leave, so no box of a hit at or before the limit is skipped. */
#include "geometry/triangle_rays.h"
#include <stdio.h>

#if VIT_EMBREE == 4
#include <embree4/rtcore.h>
typedef struct RTCRayQueryContext embree_context;
#else
#include <embree3/rtcore.h>
typedef struct RTCIntersectContext embree_context;
#endif

#define SLACK 0x1p-16f /* of L */
#define FAR 16.0f      /* L */
#define TINY 1e-18f    /* a direction component nearer to zero than this counts as this; RAY_TINY of kernels/ray.clh */

#if defined __x86_64__ && defined __GNUC__
#define FUSED_TARGET __attribute__((target("fma")))
#define HAS_FUSED __builtin_cpu_supports("fma")
#else
#define FUSED_TARGET
#define HAS_FUSED false
#endif
#define IN_BOTH static inline __attribute__((always_inline))

/* A ray on its way, as the callbacks see it. */
typedef struct query {
    embree_context context; /* first: Embree hands its address to the callbacks */
    const triangle_rays *r;
    vec3 origin, direction, inverse, start; /* 1 / direction; -origin / direction */
    vec3 across, up;                        /* two axes across the direction */
    triangle_rays_accept *accept;
    const void *user;
    triangle_hit best; /* its distance is the limit while there is none */
} query;

static float inverse(float d) {
    const float a = fabsf(d) < TINY ? TINY : fabsf(d);
    return d < 0.0f ? -1.0f / a : 1.0f / a;
}

IN_BOTH void clip(float v0, float v1, float v2, float pad, float inv, float start, float *enter, float *leave) {
    const float lo = float_min(float_min(v0, v1), v2) - pad, hi = float_max(float_max(v0, v1), v2) + pad;
    const float a = fmaf(lo, inv, start), b = fmaf(hi, inv, start);
    *enter = float_max(*enter, float_min(a, b));
    *leave = float_min(*leave, float_max(a, b));
}

/* ray_triangle_within(): does the ray's line pass through the triangle, edges included? */
IN_BOTH bool within(const query *q, const vit_triangle *t, float weight[3]) {
    const vec3 a = vec3_sub(vec3_load(t->v0), q->origin), b = vec3_sub(vec3_load(t->v1), q->origin),
               c = vec3_sub(vec3_load(t->v2), q->origin);
    const float ax = vec3_dot(a, q->across), ay = vec3_dot(a, q->up), bx = vec3_dot(b, q->across), by = vec3_dot(b, q->up),
                cx = vec3_dot(c, q->across), cy = vec3_dot(c, q->up);
    weight[0] = bx * cy - by * cx;
    weight[1] = cx * ay - cy * ax;
    weight[2] = ax * by - ay * bx;
    return float_min(float_min(weight[0], weight[1]), weight[2]) >= 0.0f ||
           float_max(float_max(weight[0], weight[1]), weight[2]) <= 0.0f;
}

/* ray_triangle_distance(): to the triangle's plane, kept inside its grown box, since next to a grazing ray the plane may be
 * anywhere. Not positive: no hit. */
IN_BOTH float plane_distance(const query *q, const vit_triangle *t) {
    const vec3 n = {t->nx, t->ny, t->nz};
    const float across = vec3_dot(n, q->direction), pad = q->r->pad;
    float enter = 0.0f, leave = 3e38f;
    if (across == 0.0f)
        return 0.0f;
    clip(t->v0[0], t->v1[0], t->v2[0], pad, q->inverse.x, q->start.x, &enter, &leave);
    clip(t->v0[1], t->v1[1], t->v2[1], pad, q->inverse.y, q->start.y, &enter, &leave);
    clip(t->v0[2], t->v1[2], t->v2[2], pad, q->inverse.z, q->start.z, &enter, &leave);
    if (!(enter <= leave))
        return 0.0f;
    return float_min(float_max(vec3_dot(n, vec3_sub(vec3_load(t->v0), q->origin)) / across, enter), leave);
}

/* Takes the triangle for the best hit if it is. Ties go to the smallest index. */
IN_BOTH bool meet(query *q, uint32_t triangle) {
    const vit_triangle *t = q->r->triangles + triangle;
    triangle_hit h = {.triangle = triangle};
    if (!within(q, t, h.weight))
        return false;
    h.distance = plane_distance(q, t);
    if (!(h.distance > 0.0f) || !(h.distance <= q->best.distance) ||
        (h.distance == q->best.distance && triangle > q->best.triangle) || (q->accept && !q->accept(q->user, &h)))
        return false;
    q->best = h;
    return true;
}

/* Embree's callbacks. Single rays: packets of one have the layout of RTCRayHit and RTCRay. */
IN_BOTH void nearest(const struct RTCIntersectFunctionNArguments *f) {
    query *q = (query *)(void *)f->context;
    if (f->valid[0] == -1 && meet(q, f->primID)) {
        struct RTCRayHit *h = (struct RTCRayHit *)(void *)f->rayhit;
        h->ray.tfar = q->best.distance;
        h->hit.geomID = f->geomID;
        h->hit.primID = f->primID;
    }
}

IN_BOTH void any(const struct RTCOccludedFunctionNArguments *f) {
    if (f->valid[0] == -1 && meet((query *)(void *)f->context, f->primID))
        ((struct RTCRay *)(void *)f->ray)->tfar = -INFINITY;
}

FUSED_TARGET static void nearest_fused(const struct RTCIntersectFunctionNArguments *f) {
    nearest(f);
}

FUSED_TARGET static void any_fused(const struct RTCOccludedFunctionNArguments *f) {
    any(f);
}

static void nearest_plain(const struct RTCIntersectFunctionNArguments *f) {
    nearest(f);
}

static void any_plain(const struct RTCOccludedFunctionNArguments *f) {
    any(f);
}

static void bounds(const struct RTCBoundsFunctionArguments *f) {
    const triangle_rays *r = f->geometryUserPtr;
    const vit_triangle *t = r->triangles + f->primID;
    const float more = r->pad + r->slack;
    *f->bounds_o = (struct RTCBounds){.lower_x = float_min(float_min(t->v0[0], t->v1[0]), t->v2[0]) - more,
                                      .lower_y = float_min(float_min(t->v0[1], t->v1[1]), t->v2[1]) - more,
                                      .lower_z = float_min(float_min(t->v0[2], t->v1[2]), t->v2[2]) - more,
                                      .upper_x = float_max(float_max(t->v0[0], t->v1[0]), t->v2[0]) + more,
                                      .upper_y = float_max(float_max(t->v0[1], t->v1[1]), t->v2[1]) + more,
                                      .upper_z = float_max(float_max(t->v0[2], t->v1[2]), t->v2[2]) + more};
}

static query make_query(const triangle_rays *r, vec3 o, vec3 d, float limit, triangle_rays_accept *accept, const void *user) {
    query q = {.r = r,
               .origin = o,
               .direction = d,
               .inverse = {inverse(d.x), inverse(d.y), inverse(d.z)},
               .accept = accept,
               .user = user,
               .best = {.triangle = VIT_NONE, .distance = limit}};
    q.start = (vec3){-o.x * q.inverse.x, -o.y * q.inverse.y, -o.z * q.inverse.z};
    vec3_across(d, &q.across, &q.up);
    return q;
}

static struct RTCRay embree_ray(vec3 o, vec3 d, float limit) {
    return (struct RTCRay){
        .org_x = o.x, .org_y = o.y, .org_z = o.z, .dir_x = d.x, .dir_y = d.y, .dir_z = d.z, .tfar = limit, .mask = ~0u};
}

/* A camera may stand anywhere; from very far all triangles are asked. */
static bool is_far(const triangle_rays *r, vec3 o) {
    return !(fabsf(o.x) <= r->nearest && fabsf(o.y) <= r->nearest && fabsf(o.z) <= r->nearest);
}

static void meet_all(query *q) {
    for (uint32_t i = 0; i < q->r->count; i++)
        meet(q, i);
}

bool triangle_rays_nearest(const triangle_rays *r, vec3 origin, vec3 direction, float limit, triangle_rays_accept *accept,
                           const void *user, triangle_hit *out) {
    query q = make_query(r, origin, direction, limit, accept, user);
    struct RTCRayHit h = {.ray = embree_ray(origin, direction, limit), .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    if (is_far(r, origin)) {
        meet_all(&q);
    } else {
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
    }
    *out = q.best;
    return q.best.triangle != VIT_NONE;
}

FUSED_TARGET static bool meets_fused(query *q, uint32_t triangle) {
    return meet(q, triangle);
}

static bool meets(query *q, uint32_t triangle) {
    return q->r->fused ? meets_fused(q, triangle) : meet(q, triangle);
}

bool triangle_rays_any_likely(const triangle_rays *r, vec3 origin, vec3 direction, float limit, triangle_rays_accept *accept,
                              const void *user, uint32_t *likely) {
    query q = make_query(r, origin, direction, limit, accept, user);
    if (*likely != VIT_NONE && meets(&q, *likely))
        return true;
    struct RTCRay ray = embree_ray(origin, direction, limit);
    if (is_far(r, origin)) {
        meet_all(&q);
    } else {
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
    }
    if (q.best.triangle != VIT_NONE)
        *likely = q.best.triangle;
    return q.best.triangle != VIT_NONE;
}

bool triangle_rays_any(const triangle_rays *r, vec3 origin, vec3 direction, float limit, triangle_rays_accept *accept,
                       const void *user) {
    uint32_t none = VIT_NONE;
    return triangle_rays_any_likely(r, origin, direction, limit, accept, user, &none);
}

static float largest_coordinate(const vit_triangle *triangles, uint32_t count) {
    float most = 0.0f;
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            most = float_max(
                most, float_max(fabsf(triangles[i].v0[k]), float_max(fabsf(triangles[i].v1[k]), fabsf(triangles[i].v2[k]))));
    return most;
}

/* primID is the triangle's index. */
static bool add_triangles(triangle_rays *r) {
    RTCGeometry all = rtcNewGeometry(r->device, RTC_GEOMETRY_TYPE_USER);
    if (!all)
        return false;
    rtcSetGeometryUserPrimitiveCount(all, r->count);
    rtcSetGeometryUserData(all, r);
    rtcSetGeometryBoundsFunction(all, bounds, NULL);
    rtcSetGeometryIntersectFunction(all, r->fused ? nearest_fused : nearest_plain);
    rtcSetGeometryOccludedFunction(all, r->fused ? any_fused : any_plain);
    rtcCommitGeometry(all);
    rtcAttachGeometry(r->scene, all);
    rtcCommitScene(r->scene);
    rtcReleaseGeometry(all);
    return rtcGetDeviceError(r->device) == RTC_ERROR_NONE;
}

bool triangle_rays_open(const vit_triangle *triangles, uint32_t count, float box_pad, unsigned threads, triangle_rays *out) {
    char config[32];
    snprintf(config, sizeof config, "threads=%u", threads);
    const float most = largest_coordinate(triangles, count);
    *out = (triangle_rays){.triangles = triangles,
                           .count = count,
                           .pad = box_pad,
                           .slack = SLACK * most,
                           .nearest = FAR * most,
                           .fused = HAS_FUSED,
                           .device = rtcNewDevice(config)};
    if (!out->device)
        return false;
    out->scene = rtcNewScene(out->device);
    if (out->scene && add_triangles(out))
        return true;
    triangle_rays_close(out);
    return false;
}

void triangle_rays_close(triangle_rays *r) {
    if (r->scene)
        rtcReleaseScene(r->scene);
    if (r->device)
        rtcReleaseDevice(r->device);
    *r = (triangle_rays){0};
}
