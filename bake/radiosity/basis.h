/* basis.c: irradiance of receivers, as a function of where lights are on their tracks, in a few numbers per receiver. Receivers
 * go in groups; of each group and light the matrix receivers x (positions x channels) is a sum of few products (singular value
 * decomposition), as many as leave a stated error: clustered principal components (Sloan and others 2003; Kristensen and others
 * 2005). The frame interpolates coefficients and adds up; power and colour of lights stay factors. */
#ifndef VIT_RADIOSITY_BASIS_H
#define VIT_RADIOSITY_BASIS_H

#include "motion/tracks.h"

/* Where a light that moves is looked at: frames of its track. */
typedef struct basis_knots {
    uint32_t count;
    uint32_t *frame;        /* a knot: its frame, ascending */
    vit_basis_frame *place; /* a frame of the path: between which knots it is */
    double widest;          /* way between neighbouring knots with frames in between, at most, of the scene's size */
} basis_knots;

/* Does the light differ from frame to frame by more than its power? Knots: 1 if not. size: of the scene, m. VIT_FAILED: out of
 * memory. */
vit_status basis_knots_find(const tracks *t, uint32_t frames, uint32_t light, double size, basis_knots *out, vit_text *why);
void basis_knots_free(basis_knots *k);

typedef struct basis {
    vit_basis_group *groups; /* group x light */
    vit_u32 *words;
    vit_basis_coefficient *coefficients;
    uint32_t group_count, word_count, coefficient_count;
    double left; /* of the squared light, weighted by what is there, that the products leave */
    double mean_rank;
} basis;

typedef struct basis_input {
    const float *irradiance; /* receivers x columns: of light l, knots x 3 from first[l] on */
    uint32_t receivers, columns;
    const uint32_t *first, *knots; /* a light */
    uint32_t lights;
    double error;     /* of the squared light, weighted by what is there, that may be left */
    unsigned threads; /* 0: all cores; changes no byte */
} basis_input;

/* VIT_FAILED: out of memory. */
vit_status basis_make(const basis_input *in, basis *out, vit_text *why);
void basis_free(basis *b);

#endif
