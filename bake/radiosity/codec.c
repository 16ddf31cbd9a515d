#include "common/fail.h"
#include "common/parallel.h"
#include "radiosity/codec_parts.h"
#include <math.h>
#include <stdlib.h>

static bool is_sparse(uint32_t codec) {
    return codec == VIT_TRANSFER_BC1 || codec == VIT_TRANSFER_SPARSE_LOW_RANK;
}

/* ---- encoding ---- */

/* Room for all parts, the header in it. */
static vit_status begin(const codec_input *in, uint32_t rank, const sparse_shape *shape, coded *out, vit_text *why) {
    vit_transfer h;
    if (!vit_transfer_lay_out(in->codec, in->matrix->count, rank, shape->words, &h))
        return bake_fail(why, VIT_BAD_INPUT, "a transfer matrix of %u patches is too large to be coded", in->matrix->count);
    h.sparse_chunks = shape->chunks;
    out->words = calloc(h.words, sizeof *out->words);
    if (!out->words)
        return bake_fail(why, VIT_FAILED, "coded transfer matrix: out of memory");
    out->count = h.words;
    memcpy(out->words, &h, sizeof h);
    return VIT_OK;
}

static vit_status encode_sparse(const codec_input *in, coded *out, vit_text *why) {
    const uint32_t n = in->matrix->count, rank = in->codec == VIT_TRANSFER_BC1 ? 0 : in->rank ? in->rank : CODEC_RANK(n);
    const double usual = in->codec == VIT_TRANSFER_BC1 ? CODEC_KEEP_BC1 : CODEC_KEEP;
    kept_entries kept = {0};
    sparse_shape shape = {0};
    vit_status status = VIT_OK;
    if (!codec_choose(in, in->keep < 0.0 ? usual : in->keep, &kept) || !codec_sparse_shape(in->codec, n, kept.keep, &shape))
        status = bake_fail(why, VIT_FAILED, "coded transfer matrix: out of memory");
    else
        status = begin(in, rank, &shape, out, why);
    if (status == VIT_OK) {
        if (in->codec == VIT_TRANSFER_BC1)
            codec_encode_bc1(in, &kept, out->words);
        codec_encode_sparse(in, &kept, &shape, out->words);
        if (rank)
            status = codec_encode_low_rank(in, &kept, &shape, out->words, why);
    }
    kept_entries_free(&kept);
    free(shape.place);
    free(shape.slots);
    return status;
}

static vit_status encode_dense(const codec_input *in, coded *out, vit_text *why) {
    const sparse_shape none = {0};
    const vit_status status = begin(in, 0, &none, out, why);
    if (status == VIT_OK)
        codec_encode_dense(in, out->words);
    return status;
}

vit_status codec_encode(const codec_input *in, coded *out, vit_text *why) {
    const uint32_t n = in->matrix->count;
    *out = (coded){0};
    if (in->codec >= VIT_TRANSFER_COUNT)
        return bake_fail(why, VIT_BAD_INPUT, "there is no codec %u of transfer matrices", in->codec);
    if (n == 0 || n > VIT_TRANSFER_MOST_PATCHES)
        return bake_fail(why, VIT_BAD_INPUT, "a transfer matrix of %u patches: there must be 1 to %u", n,
                         VIT_TRANSFER_MOST_PATCHES);
    if (in->rank % PANEL != 0 || in->rank > VIT_TRANSFER_MOST_RANK || !(in->keep <= 1.0))
        return bake_fail(why, VIT_BAD_INPUT, "a part of rank %u and a share of %g kept", in->rank, in->keep);
    const vit_status status = is_sparse(in->codec) ? encode_sparse(in, out, why) : encode_dense(in, out, why);
    if (status != VIT_OK)
        coded_free(out);
    return status;
}

void coded_free(coded *c) {
    free(c->words);
    *c = (coded){0};
}

/* ---- reading ---- */

static void dense_row(const uint32_t *words, uint32_t row, uint32_t channel, uint32_t first, uint32_t count, float *out) {
    if (header_of(words)->codec == VIT_TRANSFER_BC1)
        codec_bc1_row(words, row, channel, first, count, out);
    else
        codec_dense_row(words, row, channel, first, count, out);
}

/* ---- the product ---- */

typedef struct product {
    const uint32_t *words;
    const float *x;
    float *y, *mixed;
} product;

static float row_sum(const product *p, uint32_t row, uint32_t channel) {
    const vit_transfer *h = header_of(p->words);
    const float *x = p->x + channel;
    float all = 0.0f;
    for (uint32_t k = 0; k < h->dense_chunks; k++) {
        const uint32_t first = k * VIT_TRANSFER_CHUNK, left = h->stride - first;
        const uint32_t count = left < VIT_TRANSFER_CHUNK ? left : VIT_TRANSFER_CHUNK;
        float s[VIT_TRANSFER_CHUNK], sum = 0.0f;
        dense_row(p->words, row, channel, first, count, s);
        for (uint32_t j = 0; j < count; j++)
            sum = fmaf(s[j], x[4 * (size_t)(first + j)], sum);
        all += sum;
    }
    for (uint32_t k = 0; k < h->sparse_chunks; k++)
        all += codec_sparse_sum(p->words, row, channel, k, x);
    if (h->rank)
        all += codec_low_rank_sum(p->words, row, channel, p->mixed + (size_t)channel * h->rank);
    return all;
}

static void product_row(void *user, uint32_t row) {
    const product *p = user;
    const vit_transfer *h = header_of(p->words);
    for (uint32_t c = 0; c < TRANSFER_CHANNELS; c++)
        p->y[(size_t)c * h->stride + row] = row < h->patches ? row_sum(p, row, c) : 0.0f;
}

vit_status codec_product(const uint32_t *words, const float *x, float *y, unsigned threads, vit_text *why) {
    const vit_transfer *h = header_of(words);
    product p = {words, x, y, malloc((TRANSFER_CHANNELS * (size_t)h->rank + 1) * sizeof *p.mixed)};
    if (!p.mixed)
        return bake_fail(why, VIT_FAILED, "product with the transfer matrix: out of memory");
    if (h->rank)
        codec_low_rank_mixed(words, x, p.mixed);
    parallel_for(threads, h->stride, product_row, &p);
    free(p.mixed);
    return VIT_OK;
}

void codec_row(const uint32_t *words, uint32_t row, uint32_t channel, float *out) {
    const vit_transfer *h = header_of(words);
    memset(out, 0, h->patches * sizeof *out);
    if (h->dense_chunks)
        dense_row(words, row, channel, 0, h->patches, out);
    if (h->sparse_chunks)
        codec_sparse_row(words, row, channel, out);
    if (h->rank)
        codec_low_rank_row(words, row, channel, out);
}
