#include "common/fail.h"
#include "radiosity/live.h"
#include <stdlib.h>
#include <string.h>

#define MOST_SETS 4096u
#define MORE 1.02 /* times as many words as frames of their own would gather, at most, where frames share a set */

/* Of the frames from `first` on: bits that any of them has. */
static void unite(const vit_u32 *bits, uint32_t first, uint32_t end, size_t words, vit_u32 *out) {
    memset(out, 0, words * sizeof *out);
    for (uint32_t f = first; f < end; f++)
        for (size_t i = 0; i < words; i++)
            out[i] |= bits[f * words + i];
}

static uint64_t gathered_of(const live *l, const vit_u32 *set, size_t words) {
    uint64_t sum = 0;
    for (size_t i = 0; i < words; i++)
        for (vit_u32 left = set[i]; left; left &= left - 1u)
            sum += VIT_GATHER_WORDS(&l->rows[i * 32u + (uint32_t)__builtin_ctz(left)]);
    return sum;
}

/* Words that all frames together gather if `share` of them have one set. */
static uint64_t gathered(const live *l, const vit_u32 *bits, uint32_t frames, uint32_t share, size_t words, vit_u32 *set) {
    uint64_t sum = 0;
    for (uint32_t f = 0; f < frames; f += share) {
        const uint32_t end = frames - f < share ? frames : f + share;
        unite(bits, f, end, words, set);
        sum += gathered_of(l, set, words) * (end - f);
    }
    return sum;
}

/* The largest power of two of frames, or all, that share a set at little cost. */
static uint32_t choose_share(const live *l, const vit_u32 *bits, uint32_t frames, size_t words, vit_u32 *set) {
    const double most = MORE * (double)gathered(l, bits, frames, 1, words, set);
    uint32_t best = 1;
    for (uint32_t share = 2; share / 2 < frames; share *= 2)
        if ((frames - 1) / best >= MOST_SETS || (double)gathered(l, bits, frames, share, words, set) <= most)
            best = share < frames ? share : frames;
        else
            break;
    return best;
}

/* Rows of receivers that no set has lose their words. */
static void drop_rows(live *l, uint32_t receiver_count, const vit_u32 *any) {
    uint32_t end = 0;
    for (uint32_t i = 0; i < receiver_count; i++) {
        vit_gather_row *r = l->rows + i;
        if (any[i / 32] >> i % 32 & 1u)
            memmove(l->words + end, l->words + r->first, VIT_GATHER_WORDS(r) * sizeof *l->words);
        else
            *r = (vit_gather_row){.first = end};
        r->first = end;
        end += VIT_GATHER_WORDS(r);
    }
    l->word_count = end;
}

static uint32_t bits_of(const vit_u32 *bits, size_t words) {
    uint32_t sum = 0;
    for (size_t i = 0; i < words; i++)
        sum += (uint32_t)__builtin_popcount(bits[i]);
    return sum;
}

/* Patches that rows see, whole or by their points. */
static uint32_t patches_seen(const live *l) {
    const uint32_t stride = codec_stride(l->patch_count);
    bool *seen = calloc(l->patch_count + 1u, sizeof *seen);
    uint32_t count = 0;
    for (uint32_t i = 0; seen && i < l->word_count; i++) {
        const uint32_t column = l->words[i] & 0xffffu, patch = column < stride ? column : l->points[column - stride].patch;
        count += !seen[patch];
        seen[patch] = true;
    }
    free(seen);
    return count;
}

vit_status live_look_at_all(live *l, uint32_t receiver_count, uint32_t frames, vit_text *why) {
    l->looked = malloc(receiver_count / 32u * sizeof *l->looked + 1u);
    if (!l->looked)
        return bake_fail(why, VIT_FAILED, "live radiosity: out of memory");
    memset(l->looked, 0xff, receiver_count / 32u * sizeof *l->looked);
    l->looked_frames = frames;
    return VIT_OK;
}

vit_status live_keep(live *l, uint32_t receiver_count, const vit_u32 *bits, uint32_t frames, vit_text *why) {
    const size_t words = receiver_count / 32u;
    vit_u32 *any = malloc((words + 1u) * sizeof *any);
    const uint32_t share = any ? choose_share(l, bits, frames, words, any) : 1, sets = (frames - 1u) / share + 1u;
    vit_u32 *looked = any ? malloc((sets * words + 1u) * sizeof *looked) : NULL;
    if (!looked) {
        free(any);
        return bake_fail(why, VIT_FAILED, "live radiosity: out of memory");
    }
    l->saving = (live_saving){.receivers = receiver_count,
                              .words = l->word_count,
                              .gathered = (double)gathered(l, bits, frames, share, words, any) / frames};
    for (uint32_t i = 0; i < sets; i++) {
        const uint32_t first = i * share, end = frames - first < share ? frames : first + share;
        unite(bits, first, end, words, looked + i * words);
        l->saving.looked_up += (double)bits_of(looked + i * words, words) * (end - first) / frames;
    }
    unite(bits, 0, frames, words, any);
    l->saving.kept = bits_of(any, words);
    drop_rows(l, receiver_count, any);
    l->saving.patches = patches_seen(l);
    free(l->looked);
    free(any);
    l->looked = looked;
    l->looked_frames = share;
    return VIT_OK;
}
