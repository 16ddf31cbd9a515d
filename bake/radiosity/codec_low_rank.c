/* What is not kept apart as a product of low rank, the same two factors for all channels: S_c = diag(a_c) L M_c
 * R^T. Their ranges are found by random vectors and powers of the matrix (Halko 2011), of entries weighed by what they do to
 * reflected light: an error of row i counts by its area A_i, and light leaves column j in proportion to A_j, so that it is
 * sqrt(A_i) S_ij / sqrt(A_j) whose squares are to be small. */
#include "common/fail.h"
#include "common/kernel_math.h"
#include "common/parallel.h"
#include "radiosity/codec_parts.h"
#include <stdlib.h>

#define POWERS 3    /* of the matrix times its transpose */
#define COLUMNS 32u /* that a thread takes at a time, of the transpose */
#define LANES 16u
#define LARGEST 32767.0f

typedef struct factoring {
    const codec_input *in;
    const kept_entries *kept;
    uint32_t n, rank;
    float *tint;                 /* 3 n: a row's channel over its grey, 0 if it is black */
    float *rest;                 /* n x n: grey of what is not kept, weighed */
    float *left, *right, *image; /* n x rank each */
    const float *from;
    float *to;
    uint32_t channel;
} factoring;

/* A row of a channel without its tint, weighed, less what is kept; channel 3: the sum of all three. */
static void row_left(const factoring *f, uint32_t i, uint32_t channel, float *out) {
    const size_t n = f->n;
    for (size_t j = 0; j < n; j++)
        out[j] = 0.0f;
    for (uint32_t c = channel < 3 ? channel : 0; c < (channel < 3 ? channel + 1 : 3); c++) {
        const float tint = f->tint[c * n + i], by = tint > 0.0f ? f->kept->root[i] / tint : 0.0f;
        for (uint32_t j = 0; j < n; j++)
            out[j] += f->in->matrix->s[c][i * n + j] * codec_share_left(f->in, f->kept, i, j) * by / f->kept->root[j];
    }
}

static void find_tint(void *user, uint32_t i) {
    factoring *f = user;
    const size_t n = f->n;
    double sum[3] = {0};
    for (uint32_t c = 0; c < 3; c++)
        for (size_t j = 0; j < n; j++)
            sum[c] += (double)f->in->matrix->s[c][i * n + j];
    const double grey = (sum[0] + sum[1] + sum[2]) / 3.0;
    for (uint32_t c = 0; c < 3; c++)
        f->tint[c * n + i] = grey > 0.0 ? (float)(sum[c] / grey) : 0.0f;
    row_left(f, i, 3, f->rest + i * n);
}

static void add_scaled(float *to, const float *from, float by, uint32_t rank) {
    for (uint32_t k = 0; k < rank; k += LANES)
        for (uint32_t l = 0; l < LANES; l++)
            to[k + l] += by * from[k + l];
}

/* to = rest from, a row. */
static void times(void *user, uint32_t i) {
    const factoring *f = user;
    float *to = f->to + (size_t)i * f->rank;
    memset(to, 0, f->rank * sizeof *to);
    for (uint32_t j = 0; j < f->n; j++)
        add_scaled(to, f->from + (size_t)j * f->rank, f->rest[(size_t)i * f->n + j], f->rank);
}

/* to = rest^T from, some rows. */
static void transposed_times(void *user, uint32_t block) {
    const factoring *f = user;
    const uint32_t first = block * COLUMNS, end = f->n - first < COLUMNS ? f->n : first + COLUMNS;
    memset(f->to + (size_t)first * f->rank, 0, (size_t)(end - first) * f->rank * sizeof *f->to);
    for (uint32_t i = 0; i < f->n; i++)
        for (uint32_t j = first; j < end; j++)
            add_scaled(f->to + (size_t)j * f->rank, f->from + (size_t)i * f->rank, f->rest[(size_t)i * f->n + j], f->rank);
}

/* image = (a channel of what is not kept) right, a row. */
static void times_channel(void *user, uint32_t i) {
    const factoring *f = user;
    float row[VIT_TRANSFER_MOST_PATCHES], *to = f->image + (size_t)i * f->rank;
    row_left(f, i, f->channel, row);
    memset(to, 0, f->rank * sizeof *to);
    for (uint32_t j = 0; j < f->n; j++)
        add_scaled(to, f->right + (size_t)j * f->rank, row[j], f->rank);
}

static double column_product(const float *x, uint32_t n, uint32_t rank, uint32_t a, uint32_t b) {
    double sum = 0.0;
    for (size_t i = 0; i < n; i++)
        sum += (double)x[i * rank + a] * (double)x[i * rank + b];
    return sum;
}

/* Columns orthonormal (Gram and Schmidt, twice); those that the others hold already become 0. */
static void make_orthonormal(float *x, uint32_t n, uint32_t rank) {
    for (uint32_t k = 0; k < rank; k++) {
        const double before = column_product(x, n, rank, k, k);
        for (uint32_t m = 0; m < 2 * k; m++) {
            const double by = column_product(x, n, rank, m % k, k);
            for (size_t i = 0; i < n; i++)
                x[i * rank + k] = (float)((double)x[i * rank + k] - by * (double)x[i * rank + m % k]);
        }
        const double after = column_product(x, n, rank, k, k);
        const double scale = after > 1e-10 * before && after > 0.0 ? 1.0 / sqrt(after) : 0.0;
        for (size_t i = 0; i < n; i++)
            x[i * rank + k] = (float)((double)x[i * rank + k] * scale);
    }
}

static void find_factors(factoring *f) {
    const unsigned threads = f->in->threads;
    const uint32_t blocks = (f->n + COLUMNS - 1) / COLUMNS;
    parallel_for(threads, f->n, find_tint, f);
    for (size_t i = 0; i < (size_t)f->n * f->rank; i++)
        f->right[i] = pcg((uint32_t)i) >> 31 ? 1.0f : -1.0f;
    for (int power = 0; power <= POWERS; power++) {
        f->from = f->right;
        f->to = f->left;
        parallel_for(threads, f->n, times, f);
        make_orthonormal(f->left, f->n, f->rank);
        f->from = f->left;
        f->to = f->right;
        parallel_for(threads, blocks, transposed_times, f);
        make_orthonormal(f->right, f->n, f->rank);
    }
}

/* ---- writing ---- */

/* The numbers of a row as 16-bit ones; returns what they are to be multiplied by. */
static float quantised(const float *row, uint32_t rank, int32_t *out) {
    float most = 0.0f;
    for (uint32_t k = 0; k < rank; k++)
        most = fabsf(row[k]) > most ? fabsf(row[k]) : most;
    for (uint32_t k = 0; k < rank; k++)
        out[k] = most > 0.0f ? (int32_t)nearbyintf(row[k] / most * LARGEST) : 0;
    return most / LARGEST;
}

static void write_sides(const factoring *f, const sparse_shape *shape, uint32_t *words) {
    const vit_transfer *h = header_of(words);
    int32_t q[VIT_TRANSFER_MOST_RANK];
    for (uint32_t i = 0; i < f->n; i++) {
        const uint32_t place = shape->place[i], panel = place / PANEL, r = place % PANEL;
        float scale = quantised(f->left + (size_t)i * f->rank, f->rank, q);
        for (uint32_t k = 0; k < f->rank; k++)
            words[h->left + ((size_t)panel * f->rank / 2 + k / 2) * PANEL + r] |= ((uint32_t)q[k] & 0xffff) << (k % 2 * 16);
        for (uint32_t c = 0; c < 3; c++)
            words[h->left_scale + (panel * 3 + c) * PANEL + r] = float_bits(scale / f->kept->root[i] * f->tint[c * f->n + i]);
        scale = quantised(f->right + (size_t)i * f->rank, f->rank, q);
        for (uint32_t k = 0; k < f->rank; k++)
            words[h->right + ((size_t)(k / 16) * h->stride / 2 + i / 2) * 16 + k % 16] |= ((uint32_t)q[k] & 0xffff)
                                                                                          << (i % 2 * 16);
        words[h->right_scale + i] = float_bits(scale * f->kept->root[i]);
    }
}

/* mix_c = left^T (a channel of what is not kept) right. */
static void write_mix(factoring *f, uint32_t *words) {
    const uint32_t rank = f->rank;
    for (f->channel = 0; f->channel < 3; f->channel++) {
        uint32_t *to = words + header_of(words)->mix + f->channel * rank * rank;
        parallel_for(f->in->threads, f->n, times_channel, f);
        for (uint32_t a = 0; a < rank; a++)
            for (uint32_t b = 0; b < rank; b++) {
                double sum = 0.0;
                for (size_t i = 0; i < f->n; i++)
                    sum += (double)f->left[i * rank + a] * (double)f->image[i * rank + b];
                to[b * rank + a] = float_bits((float)sum);
            }
    }
}

vit_status codec_encode_low_rank(const codec_input *in, const kept_entries *kept, const sparse_shape *shape, uint32_t *words,
                                 vit_text *why) {
    const size_t n = in->matrix->count, rank = header_of(words)->rank;
    factoring f = {.in = in,
                   .kept = kept,
                   .n = in->matrix->count,
                   .rank = header_of(words)->rank,
                   .tint = malloc(3 * n * sizeof(float)),
                   .rest = malloc(n * n * sizeof(float)),
                   .left = malloc(n * rank * sizeof(float)),
                   .right = malloc(n * rank * sizeof(float)),
                   .image = malloc(n * rank * sizeof(float))};
    const bool fine = f.tint && f.rest && f.left && f.right && f.image;
    if (fine) {
        find_factors(&f);
        write_sides(&f, shape, words);
        write_mix(&f, words);
    }
    free(f.tint);
    free(f.rest);
    free(f.left);
    free(f.right);
    free(f.image);
    return fine ? VIT_OK : bake_fail(why, VIT_FAILED, "coded transfer matrix: out of memory");
}

/* ---- reading ---- */

static float left_at(const uint32_t *words, uint32_t place, uint32_t k) {
    const vit_transfer *h = header_of(words);
    const uint32_t word = words[h->left + ((size_t)(place / PANEL) * h->rank / 2 + k / 2) * PANEL + place % PANEL];
    return (float)(int16_t)(word >> (k % 2 * 16) & 0xffff);
}

static float right_at(const uint32_t *words, uint32_t column, uint32_t k) {
    const vit_transfer *h = header_of(words);
    const uint32_t word = words[h->right + ((size_t)(k / 16) * h->stride / 2 + column / 2) * 16 + k % 16];
    return (float)(int16_t)(word >> (column % 2 * 16) & 0xffff);
}

void codec_low_rank_mixed(const uint32_t *words, const float *x, float *mixed) {
    const vit_transfer *h = header_of(words);
    for (uint32_t c = 0; c < 3; c++) {
        float z[VIT_TRANSFER_MOST_RANK];
        for (uint32_t k = 0; k < h->rank; k++) {
            z[k] = 0.0f;
            for (uint32_t first = 0; first < h->stride; first += VIT_TRANSFER_CHUNK) {
                float sum = 0.0f;
                for (uint32_t j = first; j < h->stride && j < first + VIT_TRANSFER_CHUNK; j++)
                    sum = fmaf(right_at(words, j, k), bits_float(words[h->right_scale + j]) * x[4 * (size_t)j + c], sum);
                z[k] += sum;
            }
        }
        for (uint32_t k = 0; k < h->rank; k++) {
            float sum = 0.0f;
            for (uint32_t m = 0; m < h->rank; m++)
                sum = fmaf(bits_float(words[h->mix + (c * h->rank + m) * h->rank + k]), z[m], sum);
            mixed[c * h->rank + k] = sum;
        }
    }
}

float codec_low_rank_sum(const uint32_t *words, uint32_t row, uint32_t channel, const float *mixed) {
    const vit_transfer *h = header_of(words);
    const uint32_t place = words[h->places + row];
    float sum = 0.0f;
    for (uint32_t k = 0; k < h->rank; k++)
        sum = fmaf(left_at(words, place, k), mixed[k], sum);
    return sum * bits_float(words[h->left_scale + (place / PANEL * 3 + channel) * PANEL + place % PANEL]);
}

void codec_low_rank_row(const uint32_t *words, uint32_t row, uint32_t channel, float *out) {
    const vit_transfer *h = header_of(words);
    const uint32_t place = words[h->places + row], rank = h->rank;
    const double scale = (double)bits_float(words[h->left_scale + (place / PANEL * 3 + channel) * PANEL + place % PANEL]);
    double mixed[VIT_TRANSFER_MOST_RANK] = {0};
    for (uint32_t m = 0; m < rank; m++)
        for (uint32_t k = 0; k < rank; k++)
            mixed[m] += (double)bits_float(words[h->mix + (channel * rank + m) * rank + k]) * (double)left_at(words, place, k);
    for (uint32_t j = 0; j < h->patches; j++) {
        double sum = 0.0;
        for (uint32_t m = 0; m < rank; m++)
            sum += mixed[m] * (double)right_at(words, j, m);
        out[j] = (float)((double)out[j] + sum * scale * (double)bits_float(words[h->right_scale + j]));
    }
}
