/* bounces.c: light that goes to and fro between patches (Goral and others 1984): S E = sum over h = 1..k of (c F)^h E, with the
 * patches' albedos c, form factors F, and the radiosity E that direct light gives them. */
#ifndef VIT_RADIOSITY_BOUNCES_H
#define VIT_RADIOSITY_BOUNCES_H

#include "radiosity/form_factors.h"

#define BOUNCES_CONVERGED 0u /* as many as it takes until another adds less than 1e-6 of the whole */

typedef struct bounces_input {
    const form_factors *factors;
    const patch_set *patches;
    uint32_t bounces;    /* reflections between patches, or BOUNCES_CONVERGED */
    uint32_t columns;    /* numbers per patch; number i has the colour channel i % 3 */
    const float *direct; /* radiosity that direct light gives each patch, W/m2: patches x columns */
    unsigned threads;    /* 0: all cores; changes no byte */
} bounces_input;

/* radiosity: direct light with that of the reflections added, as large as `direct`. *spectral: an estimate of the largest
 * eigenvalue of c F, of the brightest channel; the series converges below 1. VIT_FAILED: out of memory; VIT_BAD_INPUT: it does
 * not converge. */
vit_status bounces_solve(const bounces_input *in, float *radiosity, double *spectral, vit_text *why);

#endif
