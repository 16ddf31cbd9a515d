/* codec.c: transfer matrices as few bytes, from which the product with the patches' light is computed directly. The layout is
 * vit_transfer's (transfer_code.clh). */
#ifndef VIT_RADIOSITY_CODEC_H
#define VIT_RADIOSITY_CODEC_H

#include "radiosity/transfer_matrix.h"

#define CODEC_KEEP_BC1 0.04                                /* of the entries, that are kept exactly (Shcherbakov 2017) */
#define CODEC_KEEP 0.06                                    /* that are kept beside the part of low rank */
#define CODEC_RANK(patches) ((patches) < 2048 ? 48u : 64u) /* of that part */

typedef struct codec_input {
    const transfer_matrix *matrix;
    const float *area; /* count: what a row's error weighs; NULL: all the same */
    uint32_t codec;    /* VIT_TRANSFER_* */
    double keep;       /* BC1, SPARSE_LOW_RANK: share of the entries that is kept apart; 0: none, < 0: as above */
    uint32_t rank;     /* SPARSE_LOW_RANK: a multiple of 16, or 0 for CODEC_RANK(); at most VIT_TRANSFER_MOST_RANK */
    unsigned threads;  /* 0: all cores; changes no byte */
} codec_input;

/* A coded matrix in the baker's byte order. */
typedef struct coded {
    uint32_t *words; /* vit_transfer and what follows it */
    size_t count;
} coded;

/* VIT_BAD_INPUT: there is no such codec, or the matrix has more patches or the code more words than it can hold. VIT_FAILED:
 * out of memory. On failure nothing is left to free. */
vit_status codec_encode(const codec_input *in, coded *out, vit_text *why);
void coded_free(coded *c);
/* Rows and columns of a code. */
static inline uint32_t codec_stride(uint32_t patches) {
    return (patches + VIT_TRANSFER_ROWS - 1) / VIT_TRANSFER_ROWS * VIT_TRANSFER_ROWS;
}
/* Below, words are a good code: vit_transfer_check() of vitrine_pack.h. */
/* Row `row` of a channel: `patches` floats. */
void codec_row(const uint32_t *words, uint32_t row, uint32_t channel, float *out);
/* y = S x, in the order of operations that transfer_product.clh states, to the bit; y may be a little below 0. x: four numbers
 * a column, the last of them not looked at, 0 from column `patches` on; y: a plane a channel; both for `stride` patches.
 * VIT_FAILED: out of memory. */
vit_status codec_product(const uint32_t *words, const float *x, float *y, unsigned threads, vit_text *why);

/* How wrong a code is. */
typedef struct codec_errors {
    double bytes;
    double mean, most, sum; /* of the differences of entries, all channels */
    double light;           /* of S E for the given E: root of the sum of squares, by area, over that of S E itself */
} codec_errors;

/* lights: `count` times E, each 3 numbers a patch. VIT_FAILED: out of memory. */
vit_status codec_judge(const codec_input *in, const coded *c, const float *lights, uint32_t count, codec_errors *out,
                       vit_text *why);

#endif
