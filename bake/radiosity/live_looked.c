#include "common/fail.h"
#include "radiosity/baked.h"
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

static uint32_t bits_of(const vit_u32 *bits, size_t words) {
    uint32_t sum = 0;
    for (size_t i = 0; i < words; i++)
        sum += (uint32_t)__builtin_popcount(bits[i]);
    return sum;
}

static void see(const live *l, uint32_t column, bool *seen, uint32_t *count) {
    const uint32_t stride = codec_stride(l->patch_count), patch = column < stride ? column : l->points[column - stride].patch;
    *count += !seen[patch];
    seen[patch] = true;
}

/* Patches that rows see, whole or by their points. */
static uint32_t patches_seen(const live *l, uint32_t rows) {
    bool *seen = calloc(l->patch_count + 1u, sizeof *seen);
    uint32_t count = 0;
    for (uint32_t i = 0; seen && i < rows; i++) {
        const vit_gather_row *r = l->rows + i;
        const vit_u32 *ones = l->words + r->first, *weighted = ones + (r->ones + 1u) / 2u;
        for (uint32_t k = 0; k < r->ones; k++)
            see(l, ones[k / 2u] >> k % 2u * 16u & 0xffffu, seen, &count);
        for (uint32_t k = 0; k < r->weighted; k++)
            see(l, weighted[k] & 0xffffu, seen, &count);
    }
    free(seen);
    return count;
}

/* Receivers that some frame looks up, in the order that they had, with all that there is of them. */
typedef struct kept {
    uint32_t *number; /* of each receiver; 0 of those that go */
    vit_gather_row *rows;
    vit_receiver *still;
    vit_u32 *looked; /* sets x count / 32 */
    uint32_t count;  /* a multiple of VIT_BASIS_GROUP */
} kept;

static bool keep(const live *l, const baked *b, const vit_u32 *any, const vit_u32 *looked, uint32_t sets, kept *out) {
    const uint32_t before = b->receivers.count, words = before / 32u;
    const uint32_t groups = (bits_of(any, words) + VIT_BASIS_GROUP - 1u) / VIT_BASIS_GROUP;
    out->count = (groups ? groups : 1u) * VIT_BASIS_GROUP;
    out->number = calloc(before + 1u, sizeof *out->number);
    out->rows = calloc(out->count, sizeof *out->rows);
    out->still = calloc(out->count, sizeof *out->still);
    out->looked = calloc((size_t)sets * (out->count / 32u), sizeof *out->looked);
    if (!out->number || !out->rows || !out->still || !out->looked)
        return false;
    uint32_t next = 0;
    for (uint32_t i = 0; i < before; i++) {
        if (!(any[i / 32u] >> i % 32u & 1u))
            continue;
        for (uint32_t k = 0; k < sets; k++)
            out->looked[(size_t)k * (out->count / 32u) + next / 32u] |= (looked[(size_t)k * words + i / 32u] >> i % 32u & 1u)
                                                                        << next % 32u;
        out->rows[next] = l->rows[i];
        out->still[next] = b->still[i];
        out->number[i] = next++;
    }
    return true;
}

/* Their words move together. */
static void keep_words(live *l) {
    uint32_t end = 0;
    for (uint32_t i = 0; i < l->row_count; i++) {
        vit_gather_row *r = l->rows + i;
        memmove(l->words + end, l->words + r->first, VIT_GATHER_WORDS(r) * sizeof *l->words);
        r->first = end;
        end += VIT_GATHER_WORDS(r);
    }
    l->word_count = end;
}

static void renumber(const uint32_t *number, vit_u32 three[3]) {
    for (int k = 0; k < 3; k++)
        three[k] = number[three[k]];
}

/* Cells that no frame looks up may have any receivers. */
static void take(live *l, baked *b, const kept *k) {
    receivers *r = &b->receivers;
    for (uint32_t i = 0; i < r->cell_count; i++)
        if (!VIT_RECEIVER_IS_DIVIDED(r->cells[i].split))
            renumber(k->number, r->cells[i].receiver);
    for (uint32_t i = 0; i < r->split_count; i++)
        renumber(k->number, r->splits[i].receiver);
    free(l->rows);
    free(b->still);
    free(l->looked);
    l->rows = k->rows;
    l->row_count = k->count;
    l->looked = k->looked;
    b->still = k->still;
    r->count = k->count;
    keep_words(l);
}

vit_status live_look_at_all(live *l, uint32_t receiver_count, uint32_t frames, vit_text *why) {
    l->looked = malloc(receiver_count / 32u * sizeof *l->looked + 1u);
    if (!l->looked)
        return bake_fail(why, VIT_FAILED, "live radiosity: out of memory");
    memset(l->looked, 0xff, receiver_count / 32u * sizeof *l->looked);
    l->looked_frames = frames;
    return VIT_OK;
}

vit_status live_keep(live *l, baked *b, const vit_u32 *bits, uint32_t frames, vit_text *why) {
    const uint32_t before = b->receivers.count;
    const size_t words = before / 32u;
    kept k = {0};
    vit_u32 *any = malloc((words + 1u) * sizeof *any);
    const uint32_t share = any ? choose_share(l, bits, frames, words, any) : 1, sets = (frames - 1u) / share + 1u;
    vit_u32 *looked = any ? malloc((sets * words + 1u) * sizeof *looked) : NULL;
    bool fine = looked != NULL;
    if (fine) {
        l->saving = (live_saving){.receivers = before,
                                  .words = l->word_count,
                                  .gathered = (double)gathered(l, bits, frames, share, words, any) / frames};
        for (uint32_t i = 0; i < sets; i++) {
            const uint32_t first = i * share, end = frames - first < share ? frames : first + share;
            unite(bits, first, end, words, looked + i * words);
            l->saving.looked_up += (double)bits_of(looked + i * words, words) * (end - first) / frames;
        }
        unite(bits, 0, frames, words, any);
        l->saving.kept = bits_of(any, words);
        fine = keep(l, b, any, looked, sets, &k);
    }
    if (fine) {
        take(l, b, &k);
        l->saving.patches = patches_seen(l, l->row_count);
        l->looked_frames = share;
    } else {
        free(k.rows);
        free(k.still);
        free(k.looked);
    }
    free(k.number);
    free(looked);
    free(any);
    return fine ? VIT_OK : bake_fail(why, VIT_FAILED, "live radiosity: out of memory");
}
