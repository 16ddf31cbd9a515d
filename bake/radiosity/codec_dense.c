/* Codecs that hold every entry: FLOAT32, FLOAT16, LOG8. */
#include "common/parallel.h"
#include "radiosity/codec_parts.h"

#define LEVELS 255u /* of LOG8 besides zero */

typedef struct packing {
    const codec_input *in;
    uint32_t *words;
} packing;

/* Entry (i, j) of the padded matrix. */
static float entry(const codec_input *in, uint32_t channel, uint32_t i, uint32_t j) {
    const transfer_matrix *m = in->matrix;
    return i < m->count && j < m->count ? m->s[channel][(size_t)i * m->count + j] : 0.0f;
}

/* Base of 16-bit codes: the largest entry is the last code. */
static uint32_t base_float16(float most) {
    const uint32_t top = float_bits(most), range = 0xffffu * STEP_FLOAT16;
    return top > range ? top - range : 0;
}

/* Squares of the differences that LOG8 makes with this range. */
static double log8_error(const float *row, uint32_t count, uint32_t base, uint32_t step) {
    double sum = 0.0;
    for (uint32_t j = 0; j < count; j++) {
        const double by = (double)decoded(base, step, encoded(row[j], base, step, LEVELS)) - (double)row[j];
        sum += by * by;
    }
    return sum;
}

/* The range below the row's largest entry for which the squares of errors are least. */
static void log8_range(const float *row, uint32_t count, uint32_t *base, uint32_t *step) {
    float most = 0.0f;
    double least = INFINITY;
    *base = *step = 0;
    for (uint32_t j = 0; j < count; j++)
        most = row[j] > most ? row[j] : most;
    const uint32_t top = float_bits(most);
    for (uint32_t octaves = 6; octaves <= 24 && top > 0; octaves += 3) {
        const uint32_t range = octaves << 23, by = (range < top ? range : top) / LEVELS;
        const double error = by ? log8_error(row, count, top - LEVELS * by, by) : INFINITY;
        if (error < least) {
            least = error;
            *step = by;
            *base = top - LEVELS * by;
        }
    }
}

static void pack_row(const packing *p, uint32_t i, uint32_t c, const float *row, uint32_t columns) {
    const vit_transfer *h = header_of(p->words);
    const uint32_t panel = i / PANEL, r = i % PANEL;
    const uint32_t each = h->codec == VIT_TRANSFER_FLOAT32 ? 1 : h->codec == VIT_TRANSFER_FLOAT16 ? 2 : 4;
    const uint32_t bits = 32 / each;
    uint32_t *scale = p->words + h->scale, base = 0, step = STEP_FLOAT16;
    float most = 0.0f;
    for (uint32_t j = 0; j < columns; j++)
        most = row[j] > most ? row[j] : most;
    if (h->codec == VIT_TRANSFER_FLOAT16)
        scale[(panel * TRANSFER_CHANNELS + c) * PANEL + r] = base = base_float16(most);
    if (h->codec == VIT_TRANSFER_LOG8) {
        log8_range(row, columns, &base, &step);
        scale[((panel * TRANSFER_CHANNELS + c) * 2) * PANEL + r] = base;
        scale[((panel * TRANSFER_CHANNELS + c) * 2 + 1) * PANEL + r] = step;
    }
    for (uint32_t j = 0; j < columns; j++) {
        const uint32_t code = each == 1 ? float_bits(row[j]) : encoded(row[j], base, step, each == 2 ? 0xffff : LEVELS);
        const size_t at = (((size_t)panel * columns + j) / each * TRANSFER_CHANNELS + c) * PANEL + r;
        p->words[h->dense + at] |= code << (j % each * bits);
    }
}

static void pack_panel(void *user, uint32_t panel) {
    const packing *p = user;
    const uint32_t stride = header_of(p->words)->stride;
    float row[VIT_TRANSFER_MOST_PATCHES];
    for (uint32_t i = panel * PANEL; i < (panel + 1) * PANEL; i++)
        for (uint32_t c = 0; c < TRANSFER_CHANNELS; c++) {
            for (uint32_t j = 0; j < stride; j++)
                row[j] = entry(p->in, c, i, j);
            pack_row(p, i, c, row, stride);
        }
}

void codec_encode_dense(const codec_input *in, uint32_t *words) {
    packing p = {in, words};
    parallel_for(in->threads, header_of(words)->stride / PANEL, pack_panel, &p);
}

void codec_dense_row(const uint32_t *words, uint32_t row, uint32_t channel, uint32_t first, uint32_t count, float *out) {
    const vit_transfer *h = header_of(words);
    const uint32_t panel = row / PANEL, r = row % PANEL, *scale = words + h->scale;
    const uint32_t each = h->codec == VIT_TRANSFER_FLOAT32 ? 1 : h->codec == VIT_TRANSFER_FLOAT16 ? 2 : 4;
    const uint32_t of = panel * TRANSFER_CHANNELS + channel, mask = each == 2 ? 0xffff : 0xff;
    const uint32_t base = each == 1 ? 0 : scale[(each == 2 ? of : 2 * of) * PANEL + r];
    const uint32_t step = each == 4 ? scale[(2 * of + 1) * PANEL + r] : STEP_FLOAT16;
    for (uint32_t j = first; j < first + count; j++) {
        const size_t at = (((size_t)panel * h->stride + j) / each * TRANSFER_CHANNELS + channel) * PANEL + r;
        const uint32_t word = words[h->dense + at];
        out[j - first] = each == 1 ? bits_float(word) : decoded(base, step, word >> (j % each * (32 / each)) & mask);
    }
}
