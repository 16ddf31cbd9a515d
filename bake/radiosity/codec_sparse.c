/* Entries that are kept apart, in slices of 16 rows of about the same number of entries (sliced ELLPACK: Kreutzer 2014), so
 * that lanes read neighbouring words. */
#include "common/parallel.h"
#include "radiosity/codec_parts.h"
#include <math.h>
#include <stdlib.h>

#define STEP_KEPT(channel) (1u << ((channel) == 2 ? 18 : 17))
#define MOST_KEPT(channel) ((channel) == 2 ? 1023u : 2047u)
#define SHIFT_KEPT(channel) (11 * (channel))

/* ---- which ---- */

/* What an entry does to reflected light. BC1 goes by the largest channel alone, as its source does. */
static float worth(const codec_input *in, const float *root, uint32_t i, uint32_t j) {
    const transfer_matrix *m = in->matrix;
    const size_t at = (size_t)i * m->count + j;
    const float r = m->s[0][at], g = m->s[1][at], b = m->s[2][at];
    if (in->codec != VIT_TRANSFER_BC1)
        return (r + g + b) * root[i] / root[j];
    const float rg = r > g ? r : g;
    return rg > b ? rg : b;
}

float codec_share_left(const codec_input *in, const kept_entries *kept, uint32_t i, uint32_t j) {
    return kept->keep[(size_t)i * in->matrix->count + j] ? kept->half / worth(in, kept->root, i, j) : 1.0f;
}

/* The greatest worth from which on at most `*count` entries are; *count becomes what is left for those just below it. Worths by
 * their upper and then their lower half. */
static uint32_t threshold(const codec_input *in, const float *root, uint64_t *count, uint64_t *histogram) {
    const uint32_t n = in->matrix->count;
    uint32_t upper = 0;
    for (int half = 0; half < 2; half++) {
        memset(histogram, 0, 65536 * sizeof *histogram);
        for (uint32_t i = 0; i < n; i++)
            for (uint32_t j = 0; j < n; j++) {
                const uint32_t w = float_bits(worth(in, root, i, j));
                if (half == 0)
                    histogram[w >> 16]++;
                else if (w >> 16 == upper)
                    histogram[w & 0xffff]++;
            }
        uint32_t bin = 65535;
        for (; bin > 0 && histogram[bin] <= *count; bin--)
            *count -= histogram[bin];
        if (half == 1)
            return upper << 16 | bin;
        upper = bin;
    }
    return 0;
}

bool codec_choose(const codec_input *in, double share, kept_entries *out) {
    const uint32_t n = in->matrix->count;
    uint64_t count = (uint64_t)floor(share * (double)n * (double)n);
    uint64_t *histogram = malloc(65536 * sizeof *histogram);
    *out = (kept_entries){.keep = calloc((size_t)n * n + 1, 1), .root = malloc(n * sizeof *out->root)};
    const bool fine = histogram && out->keep && out->root;
    for (uint32_t i = 0; fine && i < n; i++)
        out->root[i] = in->area && in->area[i] > 0.0f ? sqrtf(in->area[i]) : 1.0f;
    if (fine) {
        const uint32_t least = threshold(in, out->root, &count, histogram);
        out->half = 0.5f * bits_float(least);
        for (uint32_t i = 0; i < n; i++)
            for (uint32_t j = 0; j < n; j++) {
                const uint32_t w = float_bits(worth(in, out->root, i, j));
                const bool tie = w == least && w > 0 && count > 0;
                out->keep[(size_t)i * n + j] = w > least || tie;
                count -= tie;
            }
    }
    free(histogram);
    return fine;
}

void kept_entries_free(kept_entries *kept) {
    free(kept->keep);
    free(kept->root);
    *kept = (kept_entries){0};
}

/* ---- where ---- */

typedef struct row_count {
    uint32_t row, count;
} row_count;

static int by_count(const void *a, const void *b) {
    const row_count *x = a, *y = b;
    if (x->count != y->count)
        return x->count < y->count ? 1 : -1;
    return x->row < y->row ? -1 : x->row > y->row;
}

bool codec_sparse_shape(uint32_t codec, uint32_t patches, const uint8_t *keep, sparse_shape *out) {
    const uint32_t stride = codec_stride(patches);
    row_count *rows = calloc(stride, sizeof *rows);
    *out = (sparse_shape){.place = malloc(stride * sizeof *out->place), .slots = malloc(stride / PANEL * sizeof *out->slots)};
    const bool fine = rows && out->place && out->slots;
    for (uint32_t i = 0; fine && i < stride; i++) {
        rows[i].row = i;
        for (uint32_t j = 0; i < patches && j < patches; j++)
            rows[i].count += keep[(size_t)i * patches + j];
    }
    if (fine)
        qsort(rows, stride, sizeof *rows, by_count);
    for (uint32_t i = 0; fine && i < stride; i++) {
        out->place[rows[i].row] = i;
        if (i % PANEL == 0) {
            out->slots[i / PANEL] = rows[i].count;
            out->words += (uint64_t)(rows[i].count + 1) / 2 * VIT_TRANSFER_PAIR(codec);
        }
    }
    out->chunks = fine ? (rows[0].count + VIT_TRANSFER_CHUNK - 1) / VIT_TRANSFER_CHUNK : 0;
    free(rows);
    return fine;
}

/* Words of slot `slot` of place r of a panel: its column, and the first of its values. */
typedef struct slot_at {
    size_t column, value;
} slot_at;

static slot_at slot_of(uint32_t codec, uint32_t slot, uint32_t r) {
    const size_t pair = slot / 2 * (size_t)VIT_TRANSFER_PAIR(codec);
    const size_t values = (VIT_TRANSFER_PAIR(codec) - PANEL) / 2;
    return (slot_at){pair + r, pair + PANEL + slot % 2 * values + r};
}

typedef struct writing {
    const codec_input *in;
    const kept_entries *kept;
    const uint32_t *row_at; /* of a place */
    uint32_t *words;
} writing;

static void write_bases(const writing *w, uint32_t place, uint32_t row, uint32_t base[TRANSFER_CHANNELS]) {
    const vit_transfer *h = header_of(w->words);
    const uint32_t n = h->patches;
    for (uint32_t c = 0; c < TRANSFER_CHANNELS; c++) {
        float most = 0.0f;
        for (uint32_t j = 0; row < n && j < n; j++) {
            const float s = w->in->matrix->s[c][(size_t)row * n + j] * (1.0f - codec_share_left(w->in, w->kept, row, j));
            most = s > most ? s : most;
        }
        const uint32_t top = float_bits(most), range = MOST_KEPT(c) * STEP_KEPT(c);
        base[c] = top > range ? top - range : 0;
        w->words[h->scale + (place / PANEL * TRANSFER_CHANNELS + c) * PANEL + place % PANEL] = base[c];
    }
}

static void write_place(void *user, uint32_t place) {
    const writing *w = user;
    const vit_transfer *h = header_of(w->words);
    const uint32_t n = h->patches, row = w->row_at[place], r = place % PANEL;
    uint32_t *to = w->words + w->words[h->panels + 2 * (place / PANEL)], slot = 0, base[TRANSFER_CHANNELS] = {0};
    if (h->codec == VIT_TRANSFER_SPARSE_LOW_RANK)
        write_bases(w, place, row, base);
    for (uint32_t j = 0; row < n && j < n; j++) {
        if (!w->kept->keep[(size_t)row * n + j])
            continue;
        const slot_at at = slot_of(h->codec, slot, r);
        /* Two rows never share a word. */
        to[at.column] |= j << (slot % 2 * 16);
        slot++;
        for (uint32_t c = 0; c < TRANSFER_CHANNELS; c++) {
            const float s = w->in->matrix->s[c][(size_t)row * n + j];
            float picture;
            if (h->codec == VIT_TRANSFER_SPARSE_LOW_RANK) {
                const float above = s * (1.0f - codec_share_left(w->in, w->kept, row, j));
                to[at.value] |= encoded(above, base[c], STEP_KEPT(c), MOST_KEPT(c)) << SHIFT_KEPT(c);
                continue;
            }
            codec_bc1_row(w->words, row, c, j, 1, &picture);
            to[at.value + (size_t)c * PANEL] = float_bits(s - picture);
        }
    }
}

void codec_encode_sparse(const codec_input *in, const kept_entries *kept, const sparse_shape *shape, uint32_t *words) {
    const vit_transfer *h = header_of(words);
    uint32_t *row_at = words + h->places, first = h->sparse; /* turned round when all is written */
    for (uint32_t i = 0; i < h->stride; i++)
        row_at[shape->place[i]] = i;
    for (uint32_t p = 0; p < h->stride / PANEL; p++) {
        words[h->panels + 2 * p] = first;
        words[h->panels + 2 * p + 1] = shape->slots[p];
        first += (shape->slots[p] + 1) / 2 * VIT_TRANSFER_PAIR(h->codec);
    }
    writing w = {in, kept, row_at, words};
    parallel_for(in->threads, h->stride, write_place, &w);
    memcpy(row_at, shape->place, h->stride * sizeof *row_at);
}

/* ---- reading ---- */

/* Column and value of a slot. */
static float kept(const uint32_t *words, uint32_t place, uint32_t slot, uint32_t channel, uint32_t *column) {
    const vit_transfer *h = header_of(words);
    const uint32_t panel = place / PANEL, r = place % PANEL;
    const uint32_t *from = words + words[h->panels + 2 * panel];
    const slot_at at = slot_of(h->codec, slot, r);
    *column = from[at.column] >> (slot % 2 * 16) & 0xffff;
    if (h->codec == VIT_TRANSFER_BC1)
        return bits_float(from[at.value + (size_t)channel * PANEL]);
    const uint32_t base = words[h->scale + (panel * TRANSFER_CHANNELS + channel) * PANEL + r];
    return decoded(base, STEP_KEPT(channel), from[at.value] >> SHIFT_KEPT(channel) & MOST_KEPT(channel));
}

static uint32_t slots_at(const uint32_t *words, uint32_t place) {
    return words[header_of(words)->panels + 2 * (place / PANEL) + 1];
}

float codec_sparse_sum(const uint32_t *words, uint32_t row, uint32_t channel, uint32_t chunk, const float *x) {
    const uint32_t place = words[header_of(words)->places + row], slots = slots_at(words, place);
    float sum[2] = {0.0f, 0.0f}; /* of even and odd slots */
    for (uint32_t k = chunk * VIT_TRANSFER_CHUNK; k < slots && k < (chunk + 1) * VIT_TRANSFER_CHUNK; k++) {
        uint32_t column;
        const float s = kept(words, place, k, channel, &column);
        sum[k % 2] = fmaf(s, x[4 * (size_t)column], sum[k % 2]);
    }
    return sum[0] + sum[1];
}

void codec_sparse_row(const uint32_t *words, uint32_t row, uint32_t channel, float *out) {
    const vit_transfer *h = header_of(words);
    const uint32_t place = words[h->places + row], slots = slots_at(words, place);
    for (uint32_t k = 0; k < slots; k++) {
        uint32_t column;
        const float s = kept(words, place, k, channel, &column);
        if (column < h->patches)
            out[column] += s;
    }
}
