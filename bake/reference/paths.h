/* paths.c: the light that a pixel sees: its view sample, direct light, and paths of indirect light. */
#ifndef VIT_COST_PATHS_H
#define VIT_COST_PATHS_H

#include "reference/light_sampling.h"
#include "reference/reference.h"
#include "reference/specular.h"

/* What a pixel is the mean of. */
typedef enum path_filter {
    PATH_CENTRE, /* one ray */
    PATH_BOX,    /* the pixel */
    PATH_TENT    /* 2 x 2 pixels, by a tent */
} path_filter;
path_filter paths_filter(const vit_scene *s);

/* A frame's scene, ready for rays. */
typedef struct path_scene {
    const vit_scene *meta;
    const vit_camera *camera;
    const vit_light *lights;
    const bool *direct_only; /* may be NULL */
    uint32_t bounces;
    bool face_normals; /* of reference_input */
    path_filter filter;
    bool by_chance; /* some light is found by paths that hit it: of surfaces, or of the sky */
    bool panes;     /* rays to lights may pass thin glass */
    atlas atlas;
    photon_scene scene;
    photon_rays rays;
    light_sampler wide;
} path_scene;

/* Uses the sections in place; `out` must stay where it is until paths_close(). False: Embree fails, or memory; nothing to
 * close. */
bool paths_open(const reference_input *in, unsigned threads, path_scene *out);
void paths_close(path_scene *p);

/* What a ray through the pixel found in the end, and its radiance times exposure without indirect light. */
typedef struct view_sample {
    bool
        random; /* the pixel has several copies, or glass is seen: each path has a view sample of its own; only x and y count */
    bool hit;
    uint32_t x, y;
    path_vertex place;
    double weight[3];                /* that mirrors and glass on the way left */
    double direct[3];                /* emission or background included; without what paths find of area lights and the sky */
    double limited[3], unlimited[3]; /* straight from lights through panes: indirect light, since photons pass these */
} view_sample;

void paths_view(const path_scene *p, uint32_t x, uint32_t y, view_sample *out, uint64_t *rays);

/* Goes on from a mirror or glass that the ray o, d has met after t metres. random, 0..1: less than Fresnel's part is mirrored.
 */
void paths_pass_on(const photon_surface *s, float t, double random, vec3 *o, vec3 *d, double weight[3]);

typedef struct caustics caustics; /* caustics.h */

/* Sums of `count` paths' radiance times exposure. */
typedef struct path_sums {
    double direct[3];    /* what view_sample.direct leaves out */
    double limited[3];   /* indirect light of at most bounces - 1 reflections */
    double unlimited[3]; /* of all, ended by Russian roulette; not computed if only_limited */
} path_sums;

/* Paths first .. first + count - 1 of the sequence that `seed` names (sequence.h), with the photons of `c`, NULL: none. `rays`
 * is added to. */
void paths_trace(const path_scene *p, const caustics *c, const view_sample *v, uint32_t seed, uint32_t first, uint32_t count,
                 bool only_limited, path_sums *out, uint64_t *rays);

#endif
