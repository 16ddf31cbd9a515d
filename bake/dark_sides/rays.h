/* dark_sides/rays.c: what dark_sides.c shoots: rays from sides of triangles and from lights, and which sides they find. */
#ifndef VIT_BAKE_REACH_RAYS_H
#define VIT_BAKE_REACH_RAYS_H

#include "geometry/bvh.h"
#include "geometry/triangle_rays.h"

#define RAY_NOTHING 0xffffffffu /* no side: the ray met nothing in reach */
#define RAY_UNSURE 0xfffffffeu  /* it met something, but grazed it */

typedef struct vec {
    float x, y, z;
} vec;

typedef struct ray_scene {
    triangle_rays rays;
    const geometry *g;
    const model *m;
    bool holes; /* some of it is cut out */
    bool matt;  /* all of it: what a ray finds first is where it ends */
} ray_scene;

/* What all rays of a side begin with. */
typedef struct ray_side {
    vec corner, along[2]; /* of the triangle within the inset, g->ray_offset above the side */
    vec normal;           /* unit */
    uint32_t shift[4];    /* of the side's own sequence */
} ray_side;

/* Rays pass cut-out triangles as if they were not there. False: Embree fails; there is nothing to close. */
bool ray_scene_open(const model *m, const geometry *g, unsigned threads, ray_scene *out);
void ray_scene_close(ray_scene *s);
/* The side that the ray finds within `*distance` metres (unit direction): 2 * triangle, + 1 for the back; RAY_NOTHING,
 * RAY_UNSURE. *distance becomes how far that is, and stays for RAY_NOTHING. */
uint32_t ray_scene_cast(const ray_scene *s, vec origin, vec direction, float *distance);

/* The same for light: mirrors and glass send it on, `chance` deciding where glass may do either, and the matt side that is
 * found in the end counts; *distance is the whole way. RAY_UNSURE, too, if there is no end to it. */
uint32_t ray_scene_follow(const ray_scene *s, vec origin, vec direction, uint32_t chance, float *distance);
/* Does light get from p to what lies `distance` metres along the unit direction? Glass lets it pass. */
bool ray_scene_passes(const ray_scene *s, vec p, vec direction, float distance);
/* Is the side covered by another face where p, a side_point(), stands before it? Of faces in one place the first is not. */
bool ray_scene_covered(const ray_scene *s, uint32_t side, vec p);

/* Dimension d (0..3) of point i of a well spread sequence of its own for each `stream`; 0 <= u < 1. */
float sequence(uint32_t stream, uint32_t i, uint32_t d);
double triangle_area(const vit_triangle *t);
vec side_normal(const geometry *g, uint32_t side);
ray_side side_of(const geometry *g, uint32_t side);
/* sequence() of the side as stream. */
float side_sequence(const ray_side *s, uint32_t i, uint32_t d);
const model_material *side_material(const model *m, const geometry *g, uint32_t side);
bool material_lights(const model_material *m); /* its triangles are area lights */
/* A point of the side for 0 <= u, v < 1, g->ray_offset above it. */
vec side_point(const ray_side *s, float u, float v);
/* x and y along axes across the unit vector n (Duff et al. 2017), z along it. */
vec direction_about(vec n, float x, float y, float z);
/* A direction of a cosine distribution about n. */
vec cosine_direction(vec n, float u, float v);

#endif
