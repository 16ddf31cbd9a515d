/* occlusion.c: ambient light that surfaces keep from each other, at the points of a world-space cache. kernels/METHODS.md,
 * "World-space cache". */
#ifndef VIT_CACHE_OCCLUSION_H
#define VIT_CACHE_OCCLUSION_H

#include "cache/sights.h"
#include "cache/table.h"

typedef struct occlusion_input {
    cache_sights_input seen;
    double radius;  /* rays end there, m */
    double spacing; /* between points on the picture, pixels */
    bool live;      /* cells alone: frames fill them */
    double error;   /* standard deviation of a point's value by the rays' chance, about */
} occlusion_input;

typedef struct occlusion {
    cache_table table;                    /* section CACH */
    uint32_t levels;                      /* of detail */
    float step, detail;                   /* vit_scene.cache_step, cache_detail */
    uint32_t parted;                      /* cells, by walls */
    uint32_t cells, points, places, rays; /* points that something is known at; places asked, with so many rays each */
    double off;                           /* root of the mean square of the error at places that were asked and not used */
    double seconds;                       /* that it took */
} occlusion;

/* VIT_FAILED: out of memory, or more cells than a table may hold. */
vit_status occlusion_find(const occlusion_input *in, occlusion *out, vit_text *why);
void occlusion_free(occlusion *o);

#endif
