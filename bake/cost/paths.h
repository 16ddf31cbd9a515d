/* paths.c: the light that a pixel sees: its view sample, direct light, and paths of indirect light. */
#ifndef VIT_COST_PATHS_H
#define VIT_COST_PATHS_H

#include "photon_rays.h"
#include "reference.h"

/* A frame's scene, ready for rays. */
typedef struct path_scene {
    const vit_scene *meta;
    const vit_camera *camera;
    const vit_light *lights;
    const bool *direct_only; /* may be NULL */
    uint32_t bounces;
    bool face_normals; /* of reference_input */
    atlas atlas;
    photon_scene scene;
    photon_rays rays;
} path_scene;

/* Uses the sections in place; `out` must stay where it is until paths_close(). False: Embree fails; nothing to close. */
bool paths_open(const reference_input *in, unsigned threads, path_scene *out);
void paths_close(path_scene *p);

/* What the pixel's ray found, and its radiance times exposure without indirect light. */
typedef struct view_sample {
    bool hit;
    vec3 position, face, normal; /* metres, off the surface; unit geometric and shading normals of the side that is seen */
    vec3 albedo;
    double direct[3]; /* emission or background included */
} view_sample;

void paths_view(const path_scene *p, uint32_t x, uint32_t y, view_sample *out, uint64_t *rays);

/* Sums of `count` paths' indirect radiance times exposure. */
typedef struct path_sums {
    double limited[3];   /* of at most bounces - 1 reflections */
    double unlimited[3]; /* of all, ended by Russian roulette; not computed if only_limited */
} path_sums;

/* Paths first .. first + count - 1 of the sequence that `seed` names (sequence.h). `rays` is added to. */
void paths_trace(const path_scene *p, const view_sample *v, uint32_t seed, uint32_t first, uint32_t count, bool only_limited,
                 path_sums *out, uint64_t *rays);

#endif
