/* area_lights.c: area lights, the sides of triangles that emit and light others: points on them, for view samples and for
 * photons.
 */
#ifndef VIT_BAKE_EMITTERS_H
#define VIT_BAKE_EMITTERS_H

#include "light/photon_surface.h"

/* Both sides of a triangle shine alike, but for those that light cannot reach (VIT_SIDE_DARK_*), from where none could leave,
 * or that are covered. Points are dense in proportion to radiance, summed over channels, times how open the side lies. */
typedef struct area_lights {
    photon_scene scene;
    uint32_t count; /* sides */
    uint32_t *side; /* 2 * triangle, + 1 for the back, ascending */
    double *sum;    /* weights of sides 0 .. i; points are spread evenly along it */
    uint8_t *step;  /* weight of a side a unit of power: 2^-step */
    double flux[3]; /* of all sides together, W a channel */
    double area;    /* m2 */
} area_lights;

/* The triangles whose materials have `lights` and emission, but for sides that light only each other where none of the cameras
 * looks, as insides of closed bodies. *s is copied, what it points to is used in place. Without any *out is empty. The result
 * does not depend on `threads` (0: all cores). VIT_FAILED: out of memory, or Embree fails. */
vit_status area_lights_find(const photon_scene *s, const vit_camera *cameras, uint32_t frames, unsigned threads,
                            area_lights *out, vit_text *why);
void area_lights_free(area_lights *e);

typedef struct area_light_point {
    vec3 position, normal; /* moved off the side by ray_offset; unit normal of the side */
    vec3 power;            /* radiance / density of points, W/sr; 0 where the material is cut out */
    float area;            /* 1 / density, m2 */
    uint32_t triangle;
} area_light_point;

/* The point for 0 < x, y < 1: even over the unit square gives the density. Not for an empty set. */
area_light_point area_lights_point(const area_lights *e, double x, double y);

/* area_light_point.area of points on the side, 2 * triangle, + 1 for the back; 0: it lights nothing. */
float area_lights_spread(const area_lights *e, uint32_t side);

/* How near to each material that shines `samples` points per set are too far apart: as near as the radius of twice the disc
 * that the point of its side of fewest stands for. Before area_lights_sets(); `materials` are e->scene's, near2 0. */
void area_lights_near(const area_lights *e, uint32_t samples, vit_material *materials);

/* VIT_PATTERNS sets of `samples` points, section EMIT's first part. VIT_FAILED: out of memory. */
vit_status area_lights_sets(const area_lights *e, uint32_t samples, vit_light_sample *out, vit_text *why);

#endif
