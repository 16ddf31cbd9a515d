/* triangle_rays.c: which triangles a ray hits, and where, by the arithmetic of kernels/ray.clh: the same answer on every
 * machine, and watertight. Embree only proposes: it says whose boxes the ray passes. Its own triangle test gives other answers
 * with every instruction set where rays meet edges and corners, and these become bytes of a pack. */
#ifndef VIT_BAKE_TRIANGLE_RAYS_H
#define VIT_BAKE_TRIANGLE_RAYS_H

#include "common/kernel_math.h"
#include "vitrine_pack.h"

#include <stdbool.h>

typedef struct triangle_rays {
    const vit_triangle *triangles;
    uint32_t count;
    float pad;     /* by which triangles' boxes are grown: vit_scene.box_pad, metres */
    float slack;   /* by which they are grown for Embree besides, metres */
    float nearest; /* origins with a coordinate greater than this are too far out for Embree's boxes, metres */
    bool fused;    /* the machine has fused multiply-add: the same answers sooner */
    struct RTCDeviceTy *device;
    struct RTCSceneTy *scene;
} triangle_rays;

typedef struct triangle_hit {
    uint32_t triangle;
    float distance;  /* metres along the unit direction */
    float weight[3]; /* of the corners, not normalised: all of one sign, or 0 */
} triangle_hit;

/* Does a hit count? Called only for hits that would be the answer. */
typedef bool triangle_rays_accept(const void *user, const triangle_hit *hit);

/* False: Embree fails; there is nothing to close. `triangles` are used in place. */
bool triangle_rays_open(const vit_triangle *triangles, uint32_t count, float box_pad, unsigned threads, triangle_rays *out);
void triangle_rays_close(triangle_rays *r);
/* The nearest hit that counts within (0, limit] metres along the unit direction, of equally near triangles the first; false:
 * there is none. accept may be NULL: all count. Any number of threads at once. */
bool triangle_rays_nearest(const triangle_rays *r, vec3 origin, vec3 direction, float limit, triangle_rays_accept *accept,
                           const void *user, triangle_hit *out);
/* Is there one? */
bool triangle_rays_any(const triangle_rays *r, vec3 origin, vec3 direction, float limit, triangle_rays_accept *accept,
                       const void *user);
/* The same, sooner where one triangle stops many rays: *likely is asked first, and becomes the one that stopped this ray, if
 * one did; VIT_NONE: none is known. */
bool triangle_rays_any_likely(const triangle_rays *r, vec3 origin, vec3 direction, float limit, triangle_rays_accept *accept,
                              const void *user, uint32_t *likely);

#endif
