/* bounces.c: light that goes to and fro between patches (Goral and others 1984): S E = sum over h = 1..k of (c F)^h E, with the
 * patches' albedos c, form factors F, and the radiosity E that direct light gives them. */
#ifndef VIT_RADIOSITY_BOUNCES_H
#define VIT_RADIOSITY_BOUNCES_H

#include "radiosity/form_factors.h"

#define BOUNCES_CONVERGED 0u /* as many as it takes until another adds less than 1e-6 of the whole */

/* Adds reflections. direct: count x columns, radiosity (W/m2) that direct light gives each patch, `columns` numbers each, of
 * which number i has the colour channel i % 3; radiosity: the same with k reflections between patches added. *spectral: an
 * estimate of the largest eigenvalue of c F, of the brightest channel; the series converges below 1. VIT_FAILED: out of memory;
 * VIT_BAD_INPUT: it does not converge. */
vit_status bounces_solve(const form_factors *f, const patch_set *p, uint32_t k, uint32_t columns, const float *direct,
                         float *radiosity, unsigned threads, double *spectral, vit_text *why);

#endif
