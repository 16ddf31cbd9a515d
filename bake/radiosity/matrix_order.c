#include "radiosity/matrix_order.h"
#include "common/fail.h"
#include "common/parallel.h"
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#define SUMS 16u  /* that a distance is summed in, so that vectors can do it */
#define LOOK 256u /* entries between two looks at whether the row is too far already */
#define GROUP 32u /* rows that a thread takes at a time */

typedef struct nearest {
    float distance;
    uint32_t place; /* among the rows left */
} nearest;

typedef struct search {
    const float *rows; /* what is compared: `width` numbers a row */
    size_t width;
    const uint32_t *left; /* rows that have no place yet */
    uint32_t left_count, from;
    nearest *group;            /* of each group of rows */
    atomic_uint_fast32_t bits; /* of the least distance so far; not negative, so that bits are in the numbers' order */
} search;

static float sum_of(const float s[SUMS]) {
    float all = 0.0f;
    for (uint32_t k = 0; k < SUMS; k++)
        all += s[k];
    return all;
}

/* The distance, or something greater than `most` if it is. */
static float distance(const float *a, const float *b, size_t width, float most) {
    float s[SUMS] = {0};
    for (size_t i = 0; i < width;) {
        const size_t end = width - i < LOOK ? width : i + LOOK;
        for (; i + SUMS <= end; i += SUMS)
            for (uint32_t k = 0; k < SUMS; k++)
                s[k] += fabsf(a[i + k] - b[i + k]);
        for (uint32_t k = 0; i < end; k++, i++)
            s[k] += fabsf(a[i] - b[i]);
        if (sum_of(s) > most)
            break; /* the rest only adds to it */
    }
    return sum_of(s);
}

/* Of equally near rows the first: what other threads find decides how much is looked at, never what is found. */
static void look_at_group(void *user, uint32_t group) {
    search *s = user;
    nearest best = {INFINITY, 0};
    for (uint32_t k = group * GROUP; k < s->left_count && k < (group + 1) * GROUP; k++) {
        const uint32_t known = (uint32_t)atomic_load(&s->bits);
        float most;
        memcpy(&most, &known, sizeof most);
        const float d = distance(s->rows + s->from * s->width, s->rows + s->left[k] * s->width, s->width, most);
        if (!(d < best.distance))
            continue;
        best = (nearest){d, k};
        uint32_t bits;
        memcpy(&bits, &d, sizeof bits);
        for (uint_fast32_t old = atomic_load(&s->bits); bits < old;)
            if (atomic_compare_exchange_weak(&s->bits, &old, bits))
                break;
    }
    s->group[group] = best;
}

/* The chain from row 0 on; order[i]: which row comes i-th. */
static void chain(search *s, uint32_t *left, unsigned threads, uint32_t *order) {
    const uint32_t count = s->left_count;
    s->from = order[0] = 0;
    s->left_count--;
    for (uint32_t i = 0; i < s->left_count; i++)
        left[i] = i + 1;
    for (uint32_t i = 1; i < count; i++) {
        const uint32_t groups = (s->left_count + GROUP - 1) / GROUP;
        nearest best = {INFINITY, 0};
        atomic_store(&s->bits, 0x7f800000u);
        parallel_for(groups > 4 ? threads : 1, groups, look_at_group, s);
        for (uint32_t g = 0; g < groups; g++)
            best = s->group[g].distance < best.distance ? s->group[g] : best;
        s->from = order[i] = left[best.place];
        s->left_count--;
        memmove(left + best.place, left + best.place + 1, (s->left_count - best.place) * sizeof *left);
    }
}

/* Rows, or columns as rows, of the matrix in the order so far: all channels of one side by side. */
static void lay_out(const transfer_matrix *m, const uint32_t *patch_at, bool columns, float *rows) {
    const size_t n = m->count;
    for (size_t i = 0; i < n; i++)
        for (uint32_t c = 0; c < TRANSFER_CHANNELS; c++)
            for (size_t j = 0; j < n; j++)
                rows[(i * TRANSFER_CHANNELS + c) * n + j] =
                    columns ? m->s[c][patch_at[j] * n + patch_at[i]] : m->s[c][patch_at[i] * n + patch_at[j]];
}

vit_status matrix_order_find(const transfer_matrix *m, uint32_t passes, unsigned threads, uint32_t *patch_at, vit_text *why) {
    const size_t n = m->count;
    for (uint32_t i = 0; i < n; i++)
        patch_at[i] = i;
    if (passes == 0 || n == 0)
        return VIT_OK;
    float *rows = malloc(n * n * TRANSFER_CHANNELS * sizeof *rows);
    uint32_t *space = malloc(3 * n * sizeof *space);
    search s = {
        .rows = rows, .width = n * TRANSFER_CHANNELS, .left = space, .group = malloc((n / GROUP + 1) * sizeof *s.group)};
    const bool fine = rows && space && s.group;
    for (uint32_t pass = 0; fine && pass < passes; pass++) {
        uint32_t *order = space + n, *next = space + 2 * n;
        s.left_count = m->count;
        lay_out(m, patch_at, pass % 2 == 1, rows);
        chain(&s, space, threads, order);
        for (size_t i = 0; i < n; i++)
            next[i] = patch_at[order[i]];
        memcpy(patch_at, next, n * sizeof *next);
    }
    free(rows);
    free(space);
    free(s.group);
    return fine ? VIT_OK : bake_fail(why, VIT_FAILED, "order of the transfer matrix: out of memory");
}

vit_status matrix_order_apply(const transfer_matrix *m, const uint32_t *patch_at, transfer_matrix *out, vit_text *why) {
    const size_t n = m->count;
    *out = (transfer_matrix){.count = m->count};
    for (uint32_t c = 0; c < TRANSFER_CHANNELS; c++) {
        out->spectral[c] = m->spectral[c];
        out->s[c] = malloc((n * n + 1) * sizeof *out->s[c]);
        if (!out->s[c]) {
            transfer_matrix_free(out);
            return bake_fail(why, VIT_FAILED, "order of the transfer matrix: out of memory");
        }
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++)
                out->s[c][i * n + j] = m->s[c][patch_at[i] * n + patch_at[j]];
    }
    return VIT_OK;
}
