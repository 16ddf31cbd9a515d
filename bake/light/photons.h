/* photons.c: photons of still lights, traced once while baking: of points and directions, of surfaces, of the sky. As in
 * kernels/photons.cl: kernels/METHODS.md, "Photon paths". */
#ifndef VIT_BAKE_PHOTONS_H
#define VIT_BAKE_PHOTONS_H

#include "geometry/cells.h"
#include "light/photon_emission.h"

/* `done` runs from 0 to 1. Called by the thread that called photons_bake(). */
typedef void photons_progress_fn(void *user, double done);

typedef struct photons_input {
    const vit_triangle *triangles;
    const vit_attributes *attributes;
    uint32_t triangle_count;
    const vit_material *materials; /* as in the pack */
    const atlas *atlas;
    float ray_offset, box_pad, radius; /* of vit_scene, metres */
    uint64_t effects;                  /* of vit_scene: how textures are filtered, what shines, CAUSTICS */
    uint32_t bounces;                  /* of vit_scene */
    bool sequence;                     /* reflections follow a sequence rather than a hash: the effect SEQUENCE */
    uint32_t first_path;               /* number of the first path: those before it are traced while playing */
    const cells *cells;                /* not NULL: a photon's zone is the index of the cell that it lands in; otherwise 0 */
    const photons_light *lights;       /* still lights */
    uint32_t light_count;
    uint32_t *met;                 /* a word per material, set to 1 where a path meets it; may be NULL */
    photons_progress_fn *progress; /* may be NULL */
    void *user;
} photons_input;

/* Photons of all lights, one light after the other. A light has paths * (bounces - 1) slots, slot k * paths + p for path p's
 * (k + 1)st stored photon; the empty ones are left out, the others keep their order. Paths are numbered on from first_path,
 * so that no two lights share random numbers. The bytes do not depend on `threads` (0: all cores). *out is the caller's to
 * free, NULL if *count is 0. VIT_FAILED: out of memory, or Embree fails. VIT_BAD_INPUT: too many paths. */
vit_status photons_bake(const photons_input *in, unsigned threads, vit_photon **out, uint32_t *count, vit_text *why);

/* Where a path goes at a mirror or glass, u a random number: Fresnel's part of the paths is mirrored. *power and *o follow; t:
 * its way so far, m. */
vec3 photons_specular_bounce(const photon_surface *s, vec3 d, float t, float u, vec3 *o, vec3 *power);

#endif
