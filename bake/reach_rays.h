/* reach_rays.c: what reach.c shoots: rays from sides of triangles and from lights, and which sides they find. */
#ifndef VIT_BAKE_REACH_RAYS_H
#define VIT_BAKE_REACH_RAYS_H

#include "bvh.h"

#define RAY_NOTHING 0xffffffffu /* no side: the ray met nothing in reach */
#define RAY_UNSURE 0xfffffffeu  /* it met something, but grazed it */

typedef struct vec {
    float x, y, z;
} vec;

typedef struct ray_scene {
    struct RTCDeviceTy *device;
    struct RTCSceneTy *scene;
    const geometry *g;
} ray_scene;

/* Rays pass cut-out triangles as if they were not there. False: Embree fails; there is nothing to close. */
bool ray_scene_open(const model *m, const geometry *g, unsigned threads, ray_scene *out);
void ray_scene_close(ray_scene *s);
/* The side that the ray finds within `*distance` metres (unit direction): 2 * triangle, + 1 for the back; RAY_NOTHING, RAY_UNSURE.
 * *distance becomes how far that is, and stays for RAY_NOTHING. */
uint32_t ray_scene_cast(const ray_scene *s, vec origin, vec direction, float *distance);

/* Dimension d (0..3) of point i of a well spread sequence of its own for each `stream`; 0 <= u < 1. */
float sequence(uint32_t stream, uint32_t i, uint32_t d);
double triangle_area(const vit_triangle *t);
vec side_normal(const geometry *g, uint32_t side);
/* A point of the side for 0 <= u, v < 1, g->ray_offset above it. */
vec side_point(const geometry *g, uint32_t side, float u, float v);
/* A direction of a cosine distribution about n. */
vec cosine_direction(vec n, float u, float v);

#endif
