#include "common/fail.h"
#include "common/parallel.h"
#include "radiosity/codec_parts.h"
#include <math.h>
#include <stdlib.h>

static bool is_sparse(uint32_t codec) {
    return codec == VIT_TRANSFER_BC1 || codec == VIT_TRANSFER_SPARSE_LOW_RANK;
}

static uint64_t dense_words(uint32_t codec, uint64_t stride) {
    switch (codec) {
    case VIT_TRANSFER_FLOAT32:
        return stride * stride * TRANSFER_CHANNELS;
    case VIT_TRANSFER_FLOAT16:
        return stride * stride / 2 * TRANSFER_CHANNELS;
    case VIT_TRANSFER_LOG8:
        return stride * stride / 4 * TRANSFER_CHANNELS;
    case VIT_TRANSFER_BC1:
        return stride * stride / 8;
    default:
        return 0;
    }
}

static uint64_t scale_words(uint32_t codec, uint64_t stride) {
    const uint64_t numbers = codec == VIT_TRANSFER_LOG8                                               ? 2
                             : codec == VIT_TRANSFER_FLOAT16 || codec == VIT_TRANSFER_SPARSE_LOW_RANK ? 1
                                                                                                      : 0;
    return numbers * stride * TRANSFER_CHANNELS;
}

bool codec_lay_out(uint32_t codec, uint32_t patches, uint32_t rank, uint64_t sparse_words, vit_transfer *out) {
    const uint64_t stride = codec_stride(patches), panels = is_sparse(codec) ? stride / PANEL : 0;
    *out = (vit_transfer){.codec = codec, .patches = patches, .stride = (uint32_t)stride, .rank = rank};
    out->dense_chunks = dense_words(codec, stride) ? (uint32_t)((stride + VIT_TRANSFER_CHUNK - 1) / VIT_TRANSFER_CHUNK) : 0;
    struct {
        vit_u32 *first;
        uint64_t words;
    } parts[] = {
        {&out->scale, scale_words(codec, stride)},
        {&out->dense, dense_words(codec, stride)},
        {&out->panels, 2 * panels},
        {&out->places, panels * PANEL},
        {&out->sparse, sparse_words},
        {&out->left, stride * rank / 2},
        {&out->left_scale, rank ? stride * TRANSFER_CHANNELS : 0},
        {&out->right, stride * rank / 2},
        {&out->right_scale, rank ? stride : 0},
        {&out->mix, (uint64_t)rank * rank * TRANSFER_CHANNELS},
    };
    uint64_t at = HEADER_WORDS;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        *parts[i].first = (vit_u32)at;
        at += parts[i].words;
        if (at > UINT32_MAX)
            return false;
    }
    out->words = (vit_u32)at;
    return true;
}

/* ---- encoding ---- */

/* Room for all parts, the header in it. */
static vit_status begin(const codec_input *in, uint32_t rank, const sparse_shape *shape, coded *out, vit_text *why) {
    vit_transfer h;
    if (!codec_lay_out(in->codec, in->matrix->count, rank, shape->words, &h))
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
    if (n == 0 || n > CODEC_PATCHES_MOST)
        return bake_fail(why, VIT_BAD_INPUT, "a transfer matrix of %u patches: there must be 1 to %u", n, CODEC_PATCHES_MOST);
    if (in->rank % PANEL != 0 || in->rank > CODEC_RANK_MOST || !(in->keep <= 1.0))
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

/* Codes 1..most of base and step are finite and not negative. */
static bool good_codes(uint32_t base, uint32_t step, uint32_t most) {
    const int64_t least = (int64_t)(int32_t)base + step, last = (int64_t)(int32_t)base + (int64_t)step * most;
    return least >= 0 && last <= BITS_MOST;
}

static bool good_scale(const vit_transfer *h, const uint32_t *words) {
    const uint32_t *scale = words + h->scale, rows = h->stride * TRANSFER_CHANNELS;
    if (h->codec == VIT_TRANSFER_BC1)
        return good_codes(h->base, h->step, 765);
    for (uint32_t i = 0; i < rows && h->codec == VIT_TRANSFER_FLOAT16; i++)
        if (!good_codes(scale[i], STEP_FLOAT16, 0xffff))
            return false;
    for (uint32_t i = 0; i < rows && h->codec == VIT_TRANSFER_LOG8; i++)
        if (!good_codes(scale[i / PANEL * 2 * PANEL + i % PANEL], scale[i / PANEL * 2 * PANEL + PANEL + i % PANEL], 255))
            return false;
    for (uint32_t i = 0; i < rows && h->codec == VIT_TRANSFER_SPARSE_LOW_RANK; i++)
        if (!good_codes(scale[i], 1u << 17, 2047) || !good_codes(scale[i], 1u << 18, 1023))
            return false;
    return true;
}

static bool good_floats(const uint32_t *bits, uint64_t count) {
    for (uint64_t i = 0; i < count; i++)
        if ((bits[i] & 0x7fffffffu) > BITS_MOST)
            return false;
    return true;
}

vit_status codec_check(const uint32_t *words, size_t count, vit_text *why) {
    vit_transfer h, right;
    if (count < HEADER_WORDS)
        return bake_fail(why, VIT_BAD_INPUT, "coded transfer matrix: %zu words are no header", count);
    memcpy(&h, words, sizeof h);
    if (h.codec >= VIT_TRANSFER_COUNT || h.patches == 0 || h.patches > CODEC_PATCHES_MOST || h.rank > CODEC_RANK_MOST ||
        h.rank % PANEL != 0 || (h.rank != 0 && h.codec != VIT_TRANSFER_SPARSE_LOW_RANK) || h.left < h.sparse)
        return bake_fail(why, VIT_BAD_INPUT, "coded transfer matrix: codec %u, %u patches, rank %u", h.codec, h.patches,
                         h.rank);
    const bool fits = codec_lay_out(h.codec, h.patches, h.rank, is_sparse(h.codec) ? h.left - h.sparse : 0, &right);
    right.sparse_chunks = h.sparse_chunks;
    right.base = h.base;
    right.step = h.step;
    if (!fits || h.words != count || memcmp(&h, &right, sizeof h) != 0)
        return bake_fail(why, VIT_BAD_INPUT, "coded transfer matrix: its parts are not where they belong in %zu words", count);
    if (is_sparse(h.codec) ? !codec_sparse_good(words) : h.sparse_chunks != 0)
        return bake_fail(why, VIT_BAD_INPUT, "coded transfer matrix: an entry kept apart has no place in it");
    if (!good_scale(&h, words) || !good_floats(words + h.left_scale, h.rank ? h.right - h.left_scale : 0) ||
        !good_floats(words + h.right_scale, h.words - h.right_scale) ||
        (h.codec == VIT_TRANSFER_FLOAT32 && !good_floats(words + h.dense, h.panels - h.dense)))
        return bake_fail(why, VIT_BAD_INPUT, "coded transfer matrix: a number that is not finite");
    return VIT_OK;
}

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
