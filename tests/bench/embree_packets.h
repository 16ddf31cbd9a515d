/* The rival: Embree's packets of 16 over the same triangles and rays, on as many threads as the OpenCL device uses. Rays come
 * from planes in memory and results go back there; only that and the casting are timed. */
#ifndef VIT_BENCH_EMBREE_PACKETS_H
#define VIT_BENCH_EMBREE_PACKETS_H

#include "measure.h"
#include "vitrine_pack.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>

#if VIT_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#define PACKET 16u
#define CHUNK 64u /* packets that a thread takes at once: a tile of 32 x 32 pixels */
#define MAX_THREADS 256

/* Planes of n values each: origin, unit direction, distance up to which hits count; < 0: no ray. n is a multiple of 16. */
typedef struct ray_planes {
    uint32_t n;
    float *value; /* 7 n */
} ray_planes;

static inline float *ray_plane(const ray_planes *r, uint32_t k) {
    return r->value + (size_t)k * r->n;
}

typedef struct rival_scene {
    RTCDevice device;
    RTCScene scene;
} rival_scene;

/* Over the pack's triangles, so that primitive numbers are our triangle indices. */
static inline rival_scene rival_open(const vit_triangle *triangles, uint32_t count, enum RTCSceneFlags flags) {
    rival_scene e = {.device = rtcNewDevice(NULL)};
    if (!e.device)
        bench_fail("Embree makes no device");
    e.scene = rtcNewScene(e.device);
    rtcSetSceneBuildQuality(e.scene, RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(e.scene, flags);
    RTCGeometry g = rtcNewGeometry(e.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    uint32_t *index = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, count);
    if (!index)
        bench_fail("Embree is out of memory");
    for (uint32_t i = 0; i < 3 * count; i++)
        index[i] = i;
    /* A record is three times a position and one component of the normal: 16 bytes from vertex to vertex. */
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, triangles, 0, 16, 3 * (size_t)count);
    rtcCommitGeometry(g);
    rtcAttachGeometry(e.scene, g);
    rtcReleaseGeometry(g);
    rtcCommitScene(e.scene);
    if (rtcGetDeviceError(e.device) != RTC_ERROR_NONE)
        bench_fail("Embree builds no scene");
    return e;
}

static inline void rival_close(rival_scene *e) {
    rtcReleaseScene(e->scene);
    rtcReleaseDevice(e->device);
}

/* One pass over all rays: nearest hits into t and triangle, or occlusion into occluded. */
typedef struct rival_job {
    RTCScene scene;
    const ray_planes *rays;
    float *t;           /* NULL: occlusion */
    uint32_t *triangle; /* VIT_NONE: no hit */
    uint32_t *occluded; /* 0 or 1 */
} rival_job;

/* The ray part that varies; mask, time and flags stay. Returns whether any ray is one. */
static inline bool rival_fill(struct RTCRay16 *ray, int *valid, const ray_planes *r, uint32_t first) {
    const size_t bytes = PACKET * sizeof(float);
    int any = 0;
    memcpy(ray->org_x, ray_plane(r, 0) + first, bytes);
    memcpy(ray->org_y, ray_plane(r, 1) + first, bytes);
    memcpy(ray->org_z, ray_plane(r, 2) + first, bytes);
    memcpy(ray->dir_x, ray_plane(r, 3) + first, bytes);
    memcpy(ray->dir_y, ray_plane(r, 4) + first, bytes);
    memcpy(ray->dir_z, ray_plane(r, 5) + first, bytes);
    memcpy(ray->tfar, ray_plane(r, 6) + first, bytes);
    for (uint32_t i = 0; i < PACKET; i++) {
        valid[i] = ray->tfar[i] >= 0 ? -1 : 0;
        any |= valid[i];
    }
    return any != 0;
}

#if VIT_EMBREE == 4
typedef struct rival_context {
    struct RTCIntersectArguments nearest;
    struct RTCOccludedArguments any;
} rival_context;

static inline rival_context rival_coherent(void) {
    rival_context c;
    rtcInitIntersectArguments(&c.nearest);
    rtcInitOccludedArguments(&c.any);
    c.nearest.flags = c.any.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    return c;
}
#define RIVAL_NEAREST(valid, scene, context, hit) rtcIntersect16(valid, scene, hit, &(context)->nearest)
#define RIVAL_ANY(valid, scene, context, ray) rtcOccluded16(valid, scene, ray, &(context)->any)
#else
typedef struct RTCIntersectContext rival_context;

static inline rival_context rival_coherent(void) {
    rival_context c;
    rtcInitIntersectContext(&c);
    c.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return c;
}
#define RIVAL_NEAREST(valid, scene, context, hit) rtcIntersect16(valid, scene, context, hit)
#define RIVAL_ANY(valid, scene, context, ray) rtcOccluded16(valid, scene, context, ray)
#endif

static inline void rival_ray_constants(struct RTCRay16 *ray) {
    memset(ray, 0, sizeof *ray);
    for (uint32_t i = 0; i < PACKET; i++)
        ray->mask[i] = ~0u;
}

static inline void rival_nearest(const rival_job *job, uint32_t first, uint32_t end) {
    _Alignas(64) struct RTCRayHit16 h;
    _Alignas(64) int valid[PACKET];
    rival_context context = rival_coherent();
    memset(&h, 0, sizeof h);
    rival_ray_constants(&h.ray);
    for (uint32_t p = first; p < end; p += PACKET) {
        memset(h.hit.geomID, 0xff, sizeof h.hit.geomID);
        memset(h.hit.primID, 0xff, sizeof h.hit.primID); /* VIT_NONE where nothing is hit */
        if (rival_fill(&h.ray, valid, job->rays, p))
            RIVAL_NEAREST(valid, job->scene, &context, &h);
        memcpy(job->t + p, h.ray.tfar, sizeof h.ray.tfar);
        memcpy(job->triangle + p, h.hit.primID, sizeof h.hit.primID);
    }
}

static inline void rival_any(const rival_job *job, uint32_t first, uint32_t end) {
    _Alignas(64) struct RTCRay16 ray;
    _Alignas(64) int valid[PACKET];
    rival_context context = rival_coherent();
    rival_ray_constants(&ray);
    for (uint32_t p = first; p < end; p += PACKET) {
        const bool any = rival_fill(&ray, valid, job->rays, p);
        if (any)
            RIVAL_ANY(valid, job->scene, &context, &ray);
        for (uint32_t i = 0; i < PACKET; i++) /* a hit sets tfar to minus infinity */
            job->occluded[p + i] = any && valid[i] && ray.tfar[i] < 0;
    }
}

/* Threads that wait between jobs, so that starting them is not timed. The caller is one of them. */
typedef struct thread_pool {
    pthread_t thread[MAX_THREADS];
    uint32_t threads;
    pthread_barrier_t begin, end;
    const rival_job *job; /* NULL: done */
    atomic_uint next;     /* ray that the next chunk begins with */
} thread_pool;

static inline void pool_work(thread_pool *pool) {
    const rival_job *job = pool->job;
    const uint32_t n = job->rays->n, step = CHUNK * PACKET;
    for (uint32_t first; (first = atomic_fetch_add(&pool->next, step)) < n;) {
        const uint32_t end = first + step < n ? first + step : n;
        if (job->t)
            rival_nearest(job, first, end);
        else
            rival_any(job, first, end);
    }
}

static inline void *pool_thread(void *user) {
    thread_pool *pool = user;
    for (;;) {
        pthread_barrier_wait(&pool->begin);
        if (!pool->job)
            return NULL;
        pool_work(pool);
        pthread_barrier_wait(&pool->end);
    }
}

static inline void pool_open(thread_pool *pool, uint32_t threads) {
    *pool = (thread_pool){.threads = threads < 1 ? 1 : threads < MAX_THREADS ? threads : MAX_THREADS};
    pthread_barrier_init(&pool->begin, NULL, pool->threads);
    pthread_barrier_init(&pool->end, NULL, pool->threads);
    for (uint32_t i = 1; i < pool->threads; i++)
        if (pthread_create(&pool->thread[i], NULL, pool_thread, pool) != 0)
            bench_fail("a thread cannot be made");
}

static inline void pool_close(thread_pool *pool) {
    pool->job = NULL;
    pthread_barrier_wait(&pool->begin);
    for (uint32_t i = 1; i < pool->threads; i++)
        pthread_join(pool->thread[i], NULL);
    pthread_barrier_destroy(&pool->begin);
    pthread_barrier_destroy(&pool->end);
}

/* Milliseconds of the job. */
static inline double pool_run(thread_pool *pool, const rival_job *job) {
    pool->job = job;
    atomic_store(&pool->next, 0);
    const double began = bench_seconds();
    pthread_barrier_wait(&pool->begin);
    pool_work(pool);
    pthread_barrier_wait(&pool->end);
    return (bench_seconds() - began) * 1e3;
}

#endif
