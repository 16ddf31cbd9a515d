/* Columns of S are independent systems: blocks of them are solved side by side, each by one thread in a fixed order, in two
 * arrays that stay in the cache. k reflections by Horner's scheme: X <- F^C + F^C X, k - 1 times, from X = F^C. All of them by
 * Gauss and Seidel's iteration of the same equation, in place. */
#include "radiosity/transfer_matrix.h"
#include "common/fail.h"
#include "common/parallel.h"
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 64u /* columns of a block: two of 4096 rows are 2 MiB */
#define MOST_BOUNCES 4096u
#define LEAST 1e-6f   /* of a block's largest entry in a row, that a sweep adds */
#define STEPS 128     /* of the power iteration; a number halves at most in one */
#define TOO_NEAR 1e-3 /* to 1: the series would need more than MOST_BOUNCES reflections */

/* As the program is loaded; before that AddressSanitizer is not ready for any function. */
#if defined __x86_64__ && defined __GNUC__ && !defined __clang__ && !defined __SANITIZE_ADDRESS__
#define WIDE_VECTORS __attribute__((target_clones("avx2", "default")))
#else
#define WIDE_VECTORS
#endif

typedef struct making {
    const transfer_matrix_input *in;
    float *albedo; /* count, of the channel at hand */
    float *to;     /* n x n */
    uint32_t channel;
    atomic_bool failed, endless;
} making;

/* (F X) of one row: `sum` is a row of the block. Four terms are added at a time, in their order, so that sums stay in registers
 * meanwhile; wider vectors change no bit. */
WIDE_VECTORS static void gather_row(const form_factors *f, uint32_t i, const float *x, float *restrict sum) {
    const size_t end = f->first[i + 1];
    size_t k = f->first[i];
    memset(sum, 0, WIDTH * sizeof *sum);
    for (; k + 4 <= end; k += 4) {
        const float *a = x + (size_t)f->to[k] * WIDTH, *b = x + (size_t)f->to[k + 1] * WIDTH,
                    *c = x + (size_t)f->to[k + 2] * WIDTH, *d = x + (size_t)f->to[k + 3] * WIDTH, *factor = f->factor + k;
        for (uint32_t n = 0; n < WIDTH; n++)
            sum[n] = (((sum[n] + factor[0] * a[n]) + factor[1] * b[n]) + factor[2] * c[n]) + factor[3] * d[n];
    }
    for (; k < end; k++) {
        const float *a = x + (size_t)f->to[k] * WIDTH;
        for (uint32_t n = 0; n < WIDTH; n++)
            sum[n] += f->factor[k] * a[n];
    }
}

/* The block's columns of F. */
static void load(const form_factors *f, uint32_t first, uint32_t i, float own[WIDTH]) {
    size_t low = f->first[i], high = f->first[i + 1];
    memset(own, 0, WIDTH * sizeof *own);
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (f->to[middle] < first)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < f->first[i + 1] && f->to[low] < first + WIDTH; low++)
        own[f->to[low] - first] = f->factor[low];
}

/* One reflection more: to = F^C + F^C from. `from` may be `to`, and NULL is zero. The most that a row changed by, of its size.
 */
static float reflect(const making *m, uint32_t first, const float *from, float *to) {
    const form_factors *f = m->in->factors;
    float most = 0.0f;
    for (uint32_t i = 0; i < f->count; i++) {
        float own[WIDTH], sum[WIDTH] = {0}, *row = to + (size_t)i * WIDTH, change = 0.0f, size = 0.0f;
        load(f, first, i, own);
        if (from)
            gather_row(f, i, from, sum);
        for (uint32_t c = 0; c < WIDTH; c++) {
            const float now = m->albedo[i] * (own[c] + sum[c]), by = now - row[c];
            change = by > change ? by : change;
            size = now > size ? now : size;
            row[c] = now;
        }
        most = size > 0.0f && change / size > most ? change / size : most;
    }
    return most;
}

static void solve_block(void *user, uint32_t block, uint64_t *sum) {
    making *m = user;
    const uint32_t n = m->in->factors->count, first = block * WIDTH, width = n - first < WIDTH ? n - first : WIDTH;
    float *one = calloc((size_t)n * WIDTH, sizeof *one), *other = calloc((size_t)n * WIDTH, sizeof *other);
    (void)sum;
    if (one && other) {
        uint32_t h = 1;
        float change = reflect(m, first, NULL, one);
        if (m->in->bounces == TRANSFER_CONVERGED) {
            for (; h < MOST_BOUNCES && change > LEAST; h++)
                change = reflect(m, first, one, one);
            if (change > LEAST)
                atomic_store(&m->endless, true);
        }
        for (; m->in->bounces != TRANSFER_CONVERGED && h < m->in->bounces; h++) {
            (void)reflect(m, first, one, other);
            float *last = one;
            one = other;
            other = last;
        }
        for (uint32_t i = 0; i < n; i++)
            memcpy(m->to + (size_t)i * n + first, one + (size_t)i * WIDTH, width * sizeof *one);
    } else {
        atomic_store(&m->failed, true);
    }
    free(one);
    free(other);
}

/* The least upper bound of Collatz and Wielandt, max (F^C x)_i / x_i, over positive vectors that the power iteration makes. It
 * iterates (1 + F^C) / 2, whose bounds never rise and which light that only goes to and fro cannot keep from settling. */
static double spectral_bound(const form_factors *f, const float *albedo, double *x, double *next) {
    double bound = 0.0;
    for (uint32_t i = 0; i < f->count; i++)
        x[i] = 1.0;
    for (int turn = 0; turn < STEPS; turn++) {
        double most = 0.0, largest = 0.0;
        for (uint32_t i = 0; i < f->count; i++) {
            double sum = 0.0;
            for (size_t k = f->first[i]; k < f->first[i + 1]; k++)
                sum += (double)f->factor[k] * x[f->to[k]];
            sum *= (double)albedo[i];
            most = sum / x[i] > most ? sum / x[i] : most;
            next[i] = 0.5 * (x[i] + sum);
            largest = next[i] > largest ? next[i] : largest;
        }
        bound = turn == 0 || most < bound ? most : bound;
        for (uint32_t i = 0; i < f->count; i++)
            x[i] = next[i] / largest;
    }
    return bound;
}

static void step(making *m, double done) {
    if (m->in->progress)
        m->in->progress(m->in->user, (m->channel + done) / TRANSFER_CHANNELS);
}

static void block_done(void *user, double done) {
    step(user, done);
}

/* An earlier channel in which all patches have the same albedo, as grey ones do, has the same matrix. */
static bool take_from_earlier(const making *m, transfer_matrix *out) {
    const patch_set *p = m->in->patches;
    const uint32_t n = m->in->factors->count, c = m->channel;
    for (uint32_t from = 0; from < c; from++) {
        uint32_t i = 0;
        while (i < n && p->patch[i].albedo[from] == p->patch[i].albedo[c])
            i++;
        if (i < n)
            continue;
        memcpy(out->s[c], out->s[from], (size_t)n * n * sizeof *out->s[c]);
        out->spectral[c] = out->spectral[from];
        return true;
    }
    return false;
}

static vit_status make_channel(making *m, transfer_matrix *out, vit_text *why) {
    const form_factors *f = m->in->factors;
    const uint32_t n = f->count, c = m->channel;
    double *space = malloc((2 * (size_t)n + 1) * sizeof *space);
    uint64_t none = 0;
    m->to = out->s[c];
    if (!space)
        return bake_fail(why, VIT_FAILED, "transfer matrix: out of memory");
    for (uint32_t i = 0; i < n; i++)
        m->albedo[i] = m->in->patches->patch[i].albedo[c];
    out->spectral[c] = spectral_bound(f, m->albedo, space, space + n);
    free(space);
    if (m->in->bounces == TRANSFER_CONVERGED && out->spectral[c] > 1.0 - TOO_NEAR)
        return bake_fail(
            why, VIT_BAD_INPUT,
            "light between surfaces does not die out: each reflection leaves up to %.4g of it; state how many count",
            out->spectral[c]);
    const parallel_work work = {.run = solve_block,
                                .done = block_done,
                                .user = m,
                                .step = 1,
                                .count = (n + WIDTH - 1) / WIDTH,
                                .threads = m->in->threads};
    (void)parallel_run(&work, &none);
    if (atomic_load(&m->failed))
        return bake_fail(why, VIT_FAILED, "transfer matrix: out of memory");
    if (atomic_load(&m->endless))
        return bake_fail(why, VIT_BAD_INPUT, "light between surfaces does not die out in %u reflections; state how many count",
                         MOST_BOUNCES);
    return VIT_OK;
}

vit_status transfer_matrix_make(const transfer_matrix_input *in, transfer_matrix *out, vit_text *why) {
    const size_t n = in->factors->count;
    making m = {.in = in, .albedo = malloc((n + 1) * sizeof *m.albedo)};
    vit_status status = VIT_OK;
    *out = (transfer_matrix){.count = in->factors->count};
    for (uint32_t c = 0; c < TRANSFER_CHANNELS; c++)
        out->s[c] = malloc((n * n + 1) * sizeof *out->s[c]);
    if (!m.albedo || !out->s[0] || !out->s[1] || !out->s[2])
        status = bake_fail(why, VIT_FAILED, "transfer matrix: out of memory");
    for (; m.channel < TRANSFER_CHANNELS && status == VIT_OK; m.channel++)
        if (!take_from_earlier(&m, out))
            status = make_channel(&m, out, why);
    free(m.albedo);
    if (status != VIT_OK)
        transfer_matrix_free(out);
    return status;
}

void transfer_matrix_free(transfer_matrix *m) {
    for (uint32_t c = 0; c < TRANSFER_CHANNELS; c++)
        free(m->s[c]);
    *m = (transfer_matrix){0};
}
