/* reach_rays.c: what reach.c shoots: batches of rays from sides of triangles, and what they find. */
#ifndef VIT_BAKE_REACH_RAYS_H
#define VIT_BAKE_REACH_RAYS_H

#include "bvh.h"

#define RAY_BATCH 16
#define RAY_NOTHING 0xffffffffu /* the ray left the scene, or grazed what it hit */

typedef struct vec {
    float x, y, z;
} vec;

/* A side is 2 * triangle, + 1 for the back. */
typedef struct ray_batch {
    uint32_t count;            /* 1..RAY_BATCH */
    vec origin[RAY_BATCH], direction[RAY_BATCH];
    float reach[RAY_BATCH];    /* metres along the direction, INFINITY for all the way */
    uint32_t side[RAY_BATCH];  /* found; RAY_NOTHING if none */
    bool hit[RAY_BATCH];       /* anything at all in reach */
} ray_batch;

typedef struct ray_scene {
    struct RTCDeviceTy *device;
    struct RTCSceneTy *scene;
    const geometry *g;
} ray_scene;

/* Rays pass cut-out triangles as if they were not there. False: Embree fails; there is nothing to close. */
bool ray_scene_open(const model *m, const geometry *g, unsigned threads, ray_scene *out);
void ray_scene_close(ray_scene *s);
void ray_scene_cast(const ray_scene *s, ray_batch *b);

/* Dimension d (0..3) of point i of a well spread sequence of its own for each `stream`; 0 <= u < 1. */
float sequence(uint32_t stream, uint32_t i, uint32_t d);
double triangle_area(const vit_triangle *t);
vec side_normal(const geometry *g, uint32_t side);
/* A point of the side for 0 <= u, v < 1, g->ray_offset above it. */
vec side_point(const geometry *g, uint32_t side, float u, float v);
/* A direction of a cosine distribution about n. */
vec cosine_direction(vec n, float u, float v);

#endif
