/* The matrix as a picture of three channels in BC1 blocks of 4 x 4 (Shcherbakov 2017): of the entries that are not kept apart,
 * the logarithm, shifted and scaled to 1..255. Colours between a block's two are not rounded to whole numbers: they are thirds.
 */
#include "common/parallel.h"
#include "radiosity/codec_parts.h"

#include <stb/stb_dxt.h>

#define OCTAVES 36u /* of the picture: the source adds 25 to natural logarithms */
#define LEVELS 255u
#define LEAST_BITS (1u << 24) /* of the smallest entry that the picture can tell from zero */

typedef struct picture {
    const codec_input *in;
    const uint8_t *keep;
    uint32_t *words;
} picture;

/* Bits of the smallest and the largest entry of the picture. */
static void find_range(const codec_input *in, const uint8_t *keep, uint32_t *low, uint32_t *high) {
    const size_t n = in->matrix->count;
    *low = BITS_MOST;
    *high = 0;
    for (uint32_t c = 0; c < TRANSFER_CHANNELS; c++)
        for (size_t i = 0; i < n * n; i++) {
            const uint32_t bits = float_bits(in->matrix->s[c][i]);
            if (keep[i] || bits == 0)
                continue;
            *low = bits < *low ? bits : *low;
            *high = bits > *high ? bits : *high;
        }
    const uint32_t range = OCTAVES << 23, floor_bits = *high > range + LEAST_BITS ? *high - range : LEAST_BITS;
    *low = *low > floor_bits ? *low : floor_bits;
}

/* A pixel, 0..255 each; false: the entry is kept apart, or beyond the matrix. */
static bool pixel(const picture *p, uint32_t i, uint32_t j, uint8_t rgb[3]) {
    const vit_transfer *h = header_of(p->words);
    const size_t n = h->patches;
    memset(rgb, 0, 3);
    if (i >= n || j >= n || p->keep[i * n + j])
        return false;
    for (uint32_t c = 0; c < 3; c++)
        rgb[c] = (uint8_t)encoded(p->in->matrix->s[c][i * n + j], h->base, 3 * h->step, LEVELS);
    return true;
}

/* Entries that the picture does not hold get their block's mean: nobody looks at them. */
static void block_of(const picture *p, uint32_t i, uint32_t j, uint8_t rgba[64]) {
    uint32_t sum[3] = {0}, count = 0;
    bool seen[16];
    for (uint32_t t = 0; t < 16; t++) {
        seen[t] = pixel(p, i + t / 4, j + t % 4, rgba + 4 * t);
        rgba[4 * t + 3] = 255;
        count += seen[t];
        for (uint32_t c = 0; c < 3 && seen[t]; c++)
            sum[c] += rgba[4 * t + c];
    }
    for (uint32_t t = 0; t < 16; t++)
        for (uint32_t c = 0; c < 3 && !seen[t]; c++)
            rgba[4 * t + c] = (uint8_t)(count ? (sum[c] + count / 2) / count : 0);
}

static void pack_panel(void *user, uint32_t panel) {
    const picture *p = user;
    const vit_transfer *h = header_of(p->words);
    for (uint32_t j = 0; j < h->stride; j += 4) {
        uint32_t *to = p->words + h->dense + ((size_t)panel * (h->stride / 4) + j / 4) * 8;
        for (uint32_t b = 0; b < 4; b++) {
            uint8_t rgba[64], code[8];
            block_of(p, panel * PANEL + 4 * b, j, rgba);
            stb_compress_dxt_block(code, rgba, 0, STB_DXT_HIGHQUAL);
            for (uint32_t k = 0; k < 2; k++)
                to[4 * k + b] = code[4 * k] | (uint32_t)code[4 * k + 1] << 8 | (uint32_t)code[4 * k + 2] << 16 |
                                (uint32_t)code[4 * k + 3] << 24;
        }
    }
}

void codec_encode_bc1(const codec_input *in, const kept_entries *kept, uint32_t *words) {
    vit_transfer *h = (vit_transfer *)(void *)words;
    picture p = {in, kept->keep, words};
    uint32_t low, high;
    find_range(in, kept->keep, &low, &high);
    if (high >= low) {
        h->step = (high - low) / (3 * (LEVELS - 1)) + 1;
        h->base = high - 3 * LEVELS * h->step;
    }
    parallel_for(in->threads, h->stride / PANEL, pack_panel, &p);
}

/* A channel of a 565 colour as 0..255. */
static uint32_t channel_of(uint32_t colour, uint32_t c) {
    const uint32_t bits = c == 1 ? 6 : 5, v = colour >> (c == 0 ? 11 : c == 1 ? 5 : 0) & ((1u << bits) - 1);
    return v << (8 - bits) | v >> (2 * bits - 8);
}

void codec_bc1_row(const uint32_t *words, uint32_t row, uint32_t channel, uint32_t first, uint32_t count, float *out) {
    const vit_transfer *h = header_of(words);
    const uint32_t *panel = words + h->dense + (size_t)(row / PANEL) * (h->stride / 4) * 8, b = row % PANEL / 4;
    for (uint32_t j = first; j < first + count; j++) {
        static const uint32_t of_second[4] = {0, 3, 1, 2};
        const uint32_t colours = panel[j / 4 * 8 + b], w = of_second[panel[j / 4 * 8 + 4 + b] >> (row % 4 * 8 + j % 4 * 2) & 3];
        const uint32_t thirds = channel_of(colours & 0xffff, channel) * (3 - w) + channel_of(colours >> 16, channel) * w;
        out[j - first] = decoded(h->base, h->step, thirds);
    }
}
