/* form_factors.c: which share of the light that leaves a patch arrives at which other (Goral and others 1984). Rays leave a
 * patch evenly over its area and by the cosine over directions, a rank-1 lattice (Roberts 2018) each patch: near and touching
 * patches are so integrated over both areas without a case of their own. Mirrors and glass send rays on. */
#ifndef VIT_RADIOSITY_FORM_FACTORS_H
#define VIT_RADIOSITY_FORM_FACTORS_H

#include "radiosity/gather.h"
#include "radiosity/patches.h"

#define FORM_FACTORS_RAYS_MOST (1u << 20)

/* Rows of the matrix, without the zeros. */
typedef struct form_factors {
    uint32_t count;
    size_t *first;  /* count + 1: row i is entries first[i] .. first[i + 1] - 1, columns ascending */
    uint32_t *to;   /* an entry: its column */
    float *factor;  /* F_ij: of what leaves i, the share that arrives at j; of what j radiates, i's irradiance */
    float *open;    /* a row: share that meets no patch: the sky, dark sides, black surfaces */
    double unequal; /* how far A_i F_ij and A_j F_ji were apart before they were made equal: sum of differences over sum */
    double excess;  /* the largest amount by which a row's sum was beyond 1 then */
} form_factors;

typedef struct form_factors_input {
    const photon_rays *rays;
    const geometry *geometry;
    const patch_set *patches;
    uint32_t samples;                          /* rays per patch, 1..FORM_FACTORS_RAYS_MOST */
    unsigned threads;                          /* 0: all cores; changes no byte */
    void (*progress)(void *user, double done); /* may be NULL; by the calling thread */
    void *user;
} form_factors_input;

/* Rows sum to at most 1, and A_i F_ij = A_j F_ji to rounding. VIT_FAILED: out of memory. On failure nothing is left to free. */
vit_status form_factors_find(const form_factors_input *in, form_factors *out, vit_text *why);
void form_factors_free(form_factors *f);

#endif
