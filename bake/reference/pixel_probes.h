/* pixel_probes.c: the reference (reference.h) at single pixels of several frames of one scene, until sums over them are known
 * well enough. */
#ifndef VIT_COST_SPOTS_H
#define VIT_COST_SPOTS_H

#include "reference/reference.h"

/* A pixel and what it should be: radiance times exposure, direct and indirect light. */
typedef struct spot {
    uint32_t frame, x, y;
    bool hit;                               /* a surface is seen; true too where it is not the same for all paths */
    double all[REFERENCE_SEQUENCES][3];     /* with all reflections; means of the paths of one sequence each, independent */
    double limited[REFERENCE_SEQUENCES][3]; /* with at most bounces - 1 reflections, of the same paths */
    double direct[3];                       /* mean of all paths */
    double variance[3];                     /* of the mean of `all` over the sequences; 3 degrees of freedom */
} spot;

typedef struct spots_input {
    const pack_sections *sections; /* as reference_input */
    const bool *direct_only;
    uint32_t bounces;
    double error; /* enough: the standard error of the sum over the spots and of that over their darker half, over these sums */
    uint32_t most;    /* paths a spot, whole rounds of REFERENCE_ROUND; doubled from the first round on until `error` is held */
    unsigned threads; /* 0: all cores; changes no bit */
    void (*progress)(void *user, double fraction); /* may be NULL */
    void *user;
} spots_input;

/* spots: `frame` (ascending), x and y are set. *paths: paths a spot that were traced. VIT_FAILED: out of memory, or Embree
 * fails. */
vit_status spots_render(const spots_input *in, spot *spots, uint32_t count, uint32_t *paths, vit_text *why);

/* Mean of `all` over the sequences, summed over the channels. */
double spot_brightness(const spot *s);

#endif
