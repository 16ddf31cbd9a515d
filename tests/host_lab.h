/* Kernel functions compiled as C, as the device `host` has them, called on plain arrays: no OpenCL, nothing compiled at start.
 * What ray_lab.h does on a device, for catalogues of millions of rays. Eight lanes, the best instruction set that the machine
 * runs; neither changes a bit (tests/golden/test_same_bits.c). */
#ifndef VIT_TESTS_HOST_LAB_H
#define VIT_TESTS_HOST_LAB_H

#include "vitrine_pack.h"

#include <stddef.h>

#define HOST_LAB_LANES 8u

/* A mesh as rays see it; materials have no holes. */
typedef struct host_lab_mesh {
    const vit_scene *scene; /* triangles, box_pad; for surfaces ray_offset too */
    const vit_triangle *triangles;
    const vit_attributes *attributes;
    const vit_material *materials;
    const vit_bvh_node *nodes;
} host_lab_mesh;

/* Kernel functions that bake/ has as C, too, but for srgb and choose, which tests have in double: X(name, floats in, floats
 * out); words are passed as the bits of floats. */
#define HOST_LAB_FUNCTIONS(X)                                                                                                  \
    X(pcg, 1, 1)                                                                                                               \
    X(unit_float, 1, 1)                                                                                                        \
    X(even_bits, 1, 1)                                                                                                         \
    X(sincos, 1, 2)                                                                                                            \
    X(exp2, 1, 1)                                                                                                              \
    X(unit, 3, 3)                                                                                                              \
    X(basis, 3, 6)                                                                                                             \
    X(cosine, 5, 3)                                                                                                            \
    X(place, 3, 2)                                                                                                             \
    X(normal, 1, 3)                                                                                                            \
    X(srgb, 1, 1)                                                                                                              \
    X(choose, 4, 1)                                                                                                            \
    X(cone, 3, 1)                                                                                                              \
    X(falloff, 1, 1)                                                                                                           \
    X(left, 1, 1)                                                                                                              \
    X(way, 6, 5)                                                                                                               \
    X(emission, 1, 9)                                                                                                          \
    X(sky, 3, 3)                                                                                                               \
    X(lobe, 10, 1)                                                                                                             \
    X(mirrored, 9, 3)                                                                                                          \
    X(glass, 12, 7)                                                                                                            \
    X(absorbed, 2, 1)                                                                                                          \
    X(mean, 4, 3)

typedef enum host_lab_function {
#define X(name, in, out) HOST_LAB_##name,
    HOST_LAB_FUNCTIONS(X)
#undef X
        HOST_LAB_FUNCTION_COUNT
} host_lab_function;

/* What these functions look at besides numbers. */
typedef struct host_lab_given {
    const vit_scene *scene; /* ray_offset, sky_size */
    const vit_light *light;
    const vit_sky_texel *sky;
} host_lab_given;

/* What baked irradiance is made of, as in the sections. */
typedef struct host_lab_received {
    const vit_scene *scene; /* lights, receivers, basis_lights */
    const vit_light *lights;
    const vit_basis_group *groups;
    const vit_u32 *words;
    const vit_basis_coefficient *coefficients;
    const vit_basis_frame *frames;
    const vit_receiver *receivers;
    const vit_u32 *sides;
    const vit_receiver_cell *cells;
    const vit_receiver_split *splits;
} host_lab_received;

/* n is a multiple of HOST_LAB_LANES. Planes of n floats one after another: a ray is origin, unit direction, limit (negative:
 * not cast), 7 planes; a surface is position off the surface, unit face normal, unit shading normal, reflectance, 12 planes. */
typedef struct host_lab {
    const char *isa; /* as in runtime/host/programs.c */
    /* Nearest hit and whether anything is hit; *_of_all: triangle after triangle, without a tree. */
    void (*nearest)(const host_lab_mesh *m, const float *rays, uint32_t n, float *distance, uint32_t *triangle,
                    uint32_t *occluded);
    void (*nearest_of_all)(const host_lab_mesh *m, const float *rays, uint32_t n, float *distance, uint32_t *triangle,
                           uint32_t *occluded);
    /* Whether anything is hit, alone. */
    void (*occluded)(const host_lab_mesh *m, const float *rays, uint32_t n, uint32_t *occluded);
    /* What the rays find at hits; no textures. */
    void (*surfaces)(const host_lab_mesh *m, const float *rays, const float *distance, const uint32_t *triangle, uint32_t n,
                     float *surface);
    /* Depth slices of view depths, m, counted from scene->slice_first. */
    void (*slices)(const vit_scene *s, const float *depth, uint32_t n, int32_t *slice);
    /* Wrapped texture coordinates, 0..1; mode: VIT_WRAP_*. */
    void (*wrap)(const float *coordinate, uint32_t mode, uint32_t n, float *wrapped);
    /* One of HOST_LAB_FUNCTIONS; planes of n floats in and out. */
    void (*call)(host_lab_function f, const host_lab_given *given, const float *in, uint32_t n, float *out);
    /* The pass relight: four floats a receiver, of which the last is left as it is. */
    void (*relight)(const host_lab_received *r, uint32_t frame, float *relit);
    /* What places get of `light`, four floats a receiver: planes of position, b1, b2; triangle, VIT_NONE for none; back: -1. */
    void (*receive)(const host_lab_received *r, const float *light, const float *places, const uint32_t *triangle,
                    const int32_t *back, uint32_t n, float *irradiance);
    /* Barycentric weights b1, b2 of what rays find at hits, two planes, and whether it is the back: -1. */
    void (*weights)(const host_lab_mesh *m, const float *rays, const float *distance, const uint32_t *triangle, uint32_t n,
                    float *b1_b2, int32_t *back);
    /* Open parts, 0..1, that a cache says of places: planes of position, unit normal, distance from the eye (negative: no
     * place, 1). s: cache_* of it. counts: the buffer cache_counts, or NULL: baked. */
    void (*open)(const vit_scene *s, const vit_cache_cell *cells, const uint32_t *counts, const float *places, uint32_t n,
                 float *open);
    /* cache_irradiance() there, of receivers of 4 floats each: 3 planes of n. */
    void (*point)(const vit_scene *s, const vit_cache_cell *cells, const float *receivers, const float *places, uint32_t n,
                  float *irradiance);
    /* The product with a coded transfer matrix, of kernels/transfer_product.clh, which has the layout of what is between. */
    void (*transfer)(const vit_transfer *code, const float *x, float *projected, float *mixed, float *sums, float *y);
} host_lab;

/* The best for this machine; there is always one. */
const host_lab *host_lab_find(void);

#endif
