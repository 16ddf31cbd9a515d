/* What the codecs share: where a code's parts are, and numbers as codes of floats' bits. */
#ifndef VIT_RADIOSITY_CODEC_PARTS_H
#define VIT_RADIOSITY_CODEC_PARTS_H

#include "radiosity/codec.h"
#include "vitrine_pack.h"

#include <string.h>

#define PANEL VIT_TRANSFER_ROWS
#define HEADER_WORDS (sizeof(vit_transfer) / sizeof(vit_u32))
#define STEP_FLOAT16 (1u << 12)
#define BITS_MOST 0x7f7fffffu /* of a finite float */

static inline uint32_t float_bits(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline float bits_float(uint32_t bits) {
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* The number of a code, as transfer_product.clh has it. */
static inline float decoded(uint32_t base, uint32_t step, uint32_t code) {
    return code ? bits_float(base + code * step) : 0.0f;
}

/* The code 1..most of a number > 0 nearest to its bits, or 0 where the number is nearer to zero than to that of code 1. */
static inline uint32_t encoded(float x, uint32_t base, uint32_t step, uint32_t most) {
    const float least = bits_float(base + step);
    if (!(x > 0.5f * least) || step == 0)
        return 0;
    const int64_t above = (int64_t)float_bits(x) - (int32_t)base + step / 2;
    const int64_t code = above > 0 ? above / step : 0;
    return code < 1 ? 1 : code > most ? most : (uint32_t)code;
}

static inline const vit_transfer *header_of(const uint32_t *words) {
    return (const vit_transfer *)(const void *)words;
}

/* ---- a file each ---- */

/* Codes of the dense part (codec_dense.c): scale, dense. */
void codec_encode_dense(const codec_input *in, uint32_t *words);
/* Of columns first .. first + count - 1 of a row; the part's alone. */
void codec_dense_row(const uint32_t *words, uint32_t row, uint32_t channel, uint32_t first, uint32_t count, float *out);

/* Which entries are kept apart: n x n. Of a kept entry the part of low rank gets `half` over what it does to reflected light,
 * so that it is not torn by holes, nor pulled by peaks: singular values are shrunk alike in robust principal components. */
typedef struct kept_entries {
    uint8_t *keep;
    float *root; /* of a patch's area */
    float half;  /* of what the least of them does */
} kept_entries;

/* codec_bc1.c: a picture that has nothing to say of kept entries. */
void codec_encode_bc1(const codec_input *in, const kept_entries *kept, uint32_t *words);
void codec_bc1_row(const uint32_t *words, uint32_t row, uint32_t channel, uint32_t first, uint32_t count, float *out);

/* codec_sparse.c: entries kept apart. Chooses `share` of them, the largest in what they do to reflected light; false: out of
 * memory. */
bool codec_choose(const codec_input *in, double share, kept_entries *out);
void kept_entries_free(kept_entries *kept);
/* The share of an entry that is left to the part of low rank: 1 if it is not kept. */
float codec_share_left(const codec_input *in, const kept_entries *kept, uint32_t i, uint32_t j);
typedef struct sparse_shape {
    uint32_t *place; /* a row's; stride */
    uint32_t *slots; /* of a panel of places */
    uint64_t words;
    uint32_t chunks;
} sparse_shape;
bool codec_sparse_shape(uint32_t codec, uint32_t patches, const uint8_t *keep, sparse_shape *out);
/* Writes panels, places, sparse, and base where codes need it. BC1: what the picture lacks. */
void codec_encode_sparse(const codec_input *in, const kept_entries *kept, const sparse_shape *shape, uint32_t *words);
/* Sum over chunk `chunk` of a row's sparse entries times every fourth of x, and the entries added to a row. */
float codec_sparse_sum(const uint32_t *words, uint32_t row, uint32_t channel, uint32_t chunk, const float *x);
void codec_sparse_row(const uint32_t *words, uint32_t row, uint32_t channel, float *out);

/* codec_low_rank.c: what is not kept. */
vit_status codec_encode_low_rank(const codec_input *in, const kept_entries *kept, const sparse_shape *shape, uint32_t *words,
                                 vit_text *why);
/* What `left` is multiplied by: rank numbers a channel. */
void codec_low_rank_mixed(const uint32_t *words, const float *x, float *mixed);
float codec_low_rank_sum(const uint32_t *words, uint32_t row, uint32_t channel, const float *mixed);
/* The part added to a row of `patches` numbers. */
void codec_low_rank_row(const uint32_t *words, uint32_t row, uint32_t channel, float *out);

#endif
