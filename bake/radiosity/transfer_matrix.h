/* transfer_matrix.c: k reflections as one matrix per colour channel (Shcherbakov 2017): S_c = sum over h = 1..k of (F^C)^h,
 * with F^C_ij = c_i F_ij. S_c times the radiosity that direct light gives the patches is the radiosity that reflections add. */
#ifndef VIT_RADIOSITY_TRANSFER_MATRIX_H
#define VIT_RADIOSITY_TRANSFER_MATRIX_H

#include "radiosity/form_factors.h"

#define TRANSFER_CONVERGED 0u /* as many reflections as it takes until another adds less than 1e-6 of an entry's row */
#define TRANSFER_CHANNELS 3u

typedef struct transfer_matrix {
    uint32_t count;              /* n patches */
    float *s[TRANSFER_CHANNELS]; /* n x n each, row after row: s[c][i n + j] is what of j's radiosity ends up as i's; >= 0 */
    double spectral[TRANSFER_CHANNELS]; /* an upper bound of the largest eigenvalue of F^C, close to it */
} transfer_matrix;

typedef struct transfer_matrix_input {
    const form_factors *factors;
    const patch_set *patches;                  /* albedos */
    uint32_t bounces;                          /* reflections, or TRANSFER_CONVERGED */
    unsigned threads;                          /* 0: all cores; changes no byte */
    void (*progress)(void *user, double done); /* may be NULL; by the calling thread */
    void *user;
} transfer_matrix_input;

/* Takes 12 n^2 bytes, and time in proportion to n times the number of form factors. VIT_BAD_INPUT: TRANSFER_CONVERGED is asked
 * of a series that does not converge, or takes more than 4096 reflections to. VIT_FAILED: out of memory. On failure nothing is
 * left to free. */
vit_status transfer_matrix_make(const transfer_matrix_input *in, transfer_matrix *out, vit_text *why);
void transfer_matrix_free(transfer_matrix *m);

#endif
