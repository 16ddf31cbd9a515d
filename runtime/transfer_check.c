/* transfer_check.c: where the parts of a coded transfer matrix are, and whether words are one. Baker and loader share it. */
#include "byte_order.h"
#include "fail.h"
#include "vitrine_pack.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#define CHANNELS 3u
#define PANEL VIT_TRANSFER_ROWS
#define HEADER_WORDS (sizeof(vit_transfer) / sizeof(vit_u32))
#define BITS_MOST 0x7f7fffffu /* of a finite float */
_Static_assert(VIT_TRANSFER_MOST_PATCHES % PANEL == 0, "places are 16 bits");

static bool is_sparse(vit_u32 codec) {
    return codec == VIT_TRANSFER_BC1 || codec == VIT_TRANSFER_SPARSE_LOW_RANK;
}

static uint64_t dense_words(vit_u32 codec, uint64_t stride) {
    switch (codec) {
    case VIT_TRANSFER_FLOAT32:
        return stride * stride * CHANNELS;
    case VIT_TRANSFER_FLOAT16:
        return stride * stride / 2 * CHANNELS;
    case VIT_TRANSFER_LOG8:
        return stride * stride / 4 * CHANNELS;
    case VIT_TRANSFER_BC1:
        return stride * stride / 8;
    default:
        return 0;
    }
}

static uint64_t scale_words(vit_u32 codec, uint64_t stride) {
    const uint64_t numbers = codec == VIT_TRANSFER_LOG8                                               ? 2
                             : codec == VIT_TRANSFER_FLOAT16 || codec == VIT_TRANSFER_SPARSE_LOW_RANK ? 1
                                                                                                      : 0;
    return numbers * stride * CHANNELS;
}

int vit_transfer_lay_out(vit_u32 codec, vit_u32 patches, vit_u32 rank, uint64_t sparse_words, vit_transfer *out) {
    const uint64_t stride = ((uint64_t)patches + PANEL - 1) / PANEL * PANEL, panels = is_sparse(codec) ? stride / PANEL : 0;
    *out = (vit_transfer){.codec = codec, .patches = patches, .stride = (vit_u32)stride, .rank = rank};
    out->dense_chunks = dense_words(codec, stride) ? (vit_u32)((stride + VIT_TRANSFER_CHUNK - 1) / VIT_TRANSFER_CHUNK) : 0;
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
        {&out->left_scale, rank ? stride * CHANNELS : 0},
        {&out->right, stride * rank / 2},
        {&out->right_scale, rank ? stride : 0},
        {&out->mix, (uint64_t)rank * rank * CHANNELS},
    };
    uint64_t at = HEADER_WORDS;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        *parts[i].first = (vit_u32)at;
        at += parts[i].words;
        if (at > UINT32_MAX)
            return 0;
    }
    out->words = (vit_u32)at;
    return 1;
}

static vit_u32 word_at(const vit_u32 *words, uint64_t i) {
    return *VIT_RECORD(vit_u32, words, i);
}

/* Codes 1..most of base and step are finite and not negative. */
static bool good_codes(vit_u32 base, vit_u32 step, vit_u32 most) {
    const int64_t least = (int64_t)(int32_t)base + step, last = (int64_t)(int32_t)base + (int64_t)step * most;
    return least >= 0 && last <= BITS_MOST;
}

static bool good_scale(const vit_transfer *h, const vit_u32 *words) {
    const vit_u32 rows = h->stride * CHANNELS;
    if (h->codec == VIT_TRANSFER_BC1)
        return good_codes(h->base, h->step, 765);
    for (vit_u32 i = 0; i < rows; i++) {
        const vit_u32 log8 = h->scale + i / PANEL * 2 * PANEL + i % PANEL; /* base; the step is a panel's rows behind it */
        const bool good = h->codec == VIT_TRANSFER_FLOAT16 ? good_codes(word_at(words, h->scale + i), 1u << 12, 0xffff)
                          : h->codec == VIT_TRANSFER_LOG8  ? good_codes(word_at(words, log8), word_at(words, log8 + PANEL), 255)
                          : h->codec == VIT_TRANSFER_SPARSE_LOW_RANK
                              ? good_codes(word_at(words, h->scale + i), 1u << 17, 2047) &&
                                    good_codes(word_at(words, h->scale + i), 1u << 18, 1023)
                              : true;
        if (!good)
            return false;
    }
    return true;
}

static bool good_floats(const vit_u32 *words, uint64_t first, uint64_t end) {
    for (uint64_t i = first; i < end; i++)
        if ((word_at(words, i) & 0x7fffffffu) > BITS_MOST)
            return false;
    return true;
}

/* Two slots of a panel, from word `at` on. */
static bool good_pair(const vit_transfer *h, const vit_u32 *words, uint64_t at) {
    for (vit_u32 k = 0; k < VIT_TRANSFER_PAIR(h->codec); k++) {
        const vit_u32 word = word_at(words, at + k);
        if (k < PANEL ? (word & 0xffff) >= h->stride || word >> 16 >= h->stride
                      : h->codec == VIT_TRANSFER_BC1 && (word & 0x7fffffffu) > BITS_MOST)
            return false;
    }
    return true;
}

static bool good_sparse(const vit_transfer *h, const vit_u32 *words) {
    uint64_t first = h->sparse;
    vit_u32 most = 0;
    for (vit_u32 i = 0; i < h->stride; i++)
        if (word_at(words, h->places + i) >= h->stride)
            return false;
    for (vit_u32 p = 0; p < h->stride / PANEL; p++) {
        const vit_u32 slots = word_at(words, h->panels + 2 * p + 1), pair = VIT_TRANSFER_PAIR(h->codec);
        const uint64_t size = ((uint64_t)slots + 1) / 2 * pair;
        if (slots > h->stride || word_at(words, h->panels + 2 * p) != first || size > h->left - first)
            return false;
        for (uint64_t at = first; at < first + size; at += pair)
            if (!good_pair(h, words, at))
                return false;
        first += size;
        most = slots > most ? slots : most;
    }
    return first == h->left && h->sparse_chunks == (most + VIT_TRANSFER_CHUNK - 1) / VIT_TRANSFER_CHUNK;
}

vit_status vit_transfer_check(const vit_u32 *words, size_t count, vit_text *why) {
    vit_transfer right;
    if (count < HEADER_WORDS)
        return vit_fail(why, VIT_BAD_INPUT, "coded transfer matrix: %zu words are no header", count);
    const vit_transfer h = *VIT_RECORD(vit_transfer, (const vit_transfer *)(const void *)words, 0);
    if (h.codec >= VIT_TRANSFER_COUNT || h.patches == 0 || h.patches > VIT_TRANSFER_MOST_PATCHES ||
        h.rank > VIT_TRANSFER_MOST_RANK || h.rank % PANEL != 0 || (h.rank != 0 && h.codec != VIT_TRANSFER_SPARSE_LOW_RANK) ||
        h.left < h.sparse)
        return vit_fail(why, VIT_BAD_INPUT, "coded transfer matrix: codec %u, %u patches, rank %u", h.codec, h.patches, h.rank);
    const int fits = vit_transfer_lay_out(h.codec, h.patches, h.rank, is_sparse(h.codec) ? h.left - h.sparse : 0, &right);
    right.sparse_chunks = h.sparse_chunks;
    right.base = h.base;
    right.step = h.step;
    if (!fits || h.words != count || memcmp(&h, &right, sizeof h) != 0)
        return vit_fail(why, VIT_BAD_INPUT, "coded transfer matrix: its parts are not where they belong in %zu words", count);
    if (is_sparse(h.codec) ? !good_sparse(&h, words) : h.sparse_chunks != 0)
        return vit_fail(why, VIT_BAD_INPUT, "coded transfer matrix: an entry kept apart has no place in it");
    if (!good_scale(&h, words) ||
        (h.rank != 0 && (!good_floats(words, h.left_scale, h.right) || !good_floats(words, h.right_scale, h.words))) ||
        (h.codec == VIT_TRANSFER_FLOAT32 && !good_floats(words, h.dense, h.panels)))
        return vit_fail(why, VIT_BAD_INPUT, "coded transfer matrix: a number that is not finite");
    return VIT_OK;
}
