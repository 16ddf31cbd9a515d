#include "radiosity/form_factors.h"
#include "common/fail.h"
#include "common/parallel.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SWEEPS 64        /* at most, that bring the rows' sums back to what rays have found */
#define NEAR_ENOUGH 1e-6 /* a row's sum to that */

/* The R sequence in five dimensions: 2^32 / phi^(k + 1), phi^6 = phi + 1, made odd. */
static const uint32_t alpha[5] = {0xe19b01abu, 0xc6d1d6c9u, 0xaf36d01fu, 0x9a69443fu, 0x881403b9u};

typedef struct row {
    uint32_t count, room;
    uint32_t *to;
    float *factor;
    float open;
    bool failed;
} row;

typedef struct shooting {
    const form_factors_input *in;
    row *rows;
} shooting;

static bool make_room(row *r) {
    const uint32_t room = r->room ? 2 * r->room : 64;
    uint32_t *to = realloc(r->to, room * sizeof *to);
    if (!to)
        return false;
    r->to = to;
    float *factor = realloc(r->factor, room * sizeof *factor);
    if (!factor)
        return false;
    r->factor = factor;
    r->room = room;
    return true;
}

static void add(row *r, uint32_t to, float factor) {
    if (r->count == r->room && !make_room(r)) {
        r->failed = true;
        return;
    }
    r->to[r->count] = to;
    r->factor[r->count++] = factor;
}

static int by_column(const void *a, const void *b) {
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* One patch's rays. Hits are sorted by patch and summed up: an entry each. */
static void shoot(void *user, uint32_t item) {
    const shooting *s = user;
    const form_factors_input *in = s->in;
    row *r = s->rows + item;
    uint32_t hits = 0;
    float weight = 0.0f;
    uint64_t *hit = malloc(in->samples * sizeof *hit); /* patch << 32 | bits of the weight, which is not negative */
    r->failed = !hit;
    for (uint32_t i = 0; hit && i < in->samples; i++) {
        float x[5], b1, b2;
        for (uint32_t k = 0; k < 5; k++)
            x[k] = unit_float(pcg(item * 5u + k) + i * alpha[k]);
        const uint32_t side = patches_place(in->patches, item, x[0], x[1], x[2], &b1, &b2);
        const vec3 face = side_face(in->geometry, side);
        const vec3 from = vec3_along(side_place(in->geometry, side, b1, b2), face, in->rays->s->ray_offset);
        const gather_hit at = gather(in->rays, in->geometry, from, vec3_cosine(face, x[3], x[4]), pcg(item ^ pcg(i)));
        const uint32_t to = at.side == VIT_NONE ? VIT_NONE : patches_at(in->patches, at.side, at.b1, at.b2);
        if (to == VIT_NONE || !(at.weight > 0.0f))
            continue;
        uint32_t bits;
        memcpy(&bits, &at.weight, sizeof bits);
        hit[hits++] = (uint64_t)to << 32 | bits;
        weight += at.weight;
    }
    if (hit)
        qsort(hit, hits, sizeof *hit, by_column);
    for (uint32_t i = 0; i < hits && !r->failed;) {
        const uint32_t to = (uint32_t)(hit[i] >> 32);
        double sum = 0.0;
        for (; i < hits && (uint32_t)(hit[i] >> 32) == to; i++) {
            const uint32_t bits = (uint32_t)hit[i];
            float w;
            memcpy(&w, &bits, sizeof w);
            sum += (double)w;
        }
        add(r, to, (float)(sum / in->samples));
    }
    r->open = 1.0f - weight / (float)in->samples;
    free(hit);
}

/* Rows of the transpose, so that each entry meets its counterpart: counts, then places. */
typedef struct transpose {
    size_t *first;
    uint32_t *to;
    float *factor;
} transpose;

static bool transpose_of(const row *rows, uint32_t count, size_t entries, transpose *t) {
    t->first = calloc((size_t)count + 2u, sizeof *t->first);
    t->to = malloc((entries + 1u) * sizeof *t->to);
    t->factor = malloc((entries + 1u) * sizeof *t->factor);
    if (!t->first || !t->to || !t->factor)
        return false;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < rows[i].count; k++)
            t->first[rows[i].to[k] + 2]++;
    for (uint32_t i = 0; i < count; i++)
        t->first[i + 2] += t->first[i + 1];
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < rows[i].count; k++) {
            const size_t at = t->first[rows[i].to[k] + 1]++;
            t->to[at] = i;
            t->factor[at] = rows[i].factor[k];
        }
    return true;
}

/* A_i F_ij of both directions, weighted by how sure each is: rays from either patch have a variance in proportion to its area,
 * so that both are A_i A_j (F_ij + F_ji) / (A_i + A_j). Entries of one direction only have a zero in the other. */
static bool make_equal(const patch_set *p, row *rows, form_factors *out) {
    size_t entries = 0;
    transpose t = {0};
    for (uint32_t i = 0; i < out->count; i++)
        entries += rows[i].count;
    bool fine = transpose_of(rows, out->count, entries, &t);
    out->first = fine ? calloc((size_t)out->count + 1u, sizeof *out->first) : NULL;
    out->to = malloc((2 * entries + 1u) * sizeof *out->to);
    out->factor = malloc((2 * entries + 1u) * sizeof *out->factor);
    fine = fine && out->first && out->to && out->factor;
    double apart = 0.0, all = 0.0;
    size_t n = 0;
    for (uint32_t i = 0; fine && i < out->count; i++) {
        size_t b = t.first[i];
        const size_t end = t.first[i + 1];
        const uint32_t count = rows[i].factor ? rows[i].count : 0;
        for (uint32_t a = 0; a < count || b < end;) {
            const uint32_t to_a = a < count ? rows[i].to[a] : VIT_NONE, to_b = b < end ? t.to[b] : VIT_NONE;
            const uint32_t to = to_a < to_b ? to_a : to_b;
            const double mine = a < count && to_a == to ? (double)rows[i].factor[a++] : 0.0,
                         other = b < end && to_b == to ? (double)t.factor[b++] : 0.0;
            const double ai = (double)p->patch[i].area, aj = (double)p->patch[to].area;
            apart += fabs(ai * mine - aj * other);
            all += ai * mine + aj * other;
            out->to[n] = to;
            out->factor[n++] = (float)(aj * (mine + other) / (ai + aj));
        }
        out->first[i + 1] = n;
    }
    out->unequal = all > 0.0 ? apart / all : 0.0;
    free(t.first);
    free(t.to);
    free(t.factor);
    return fine;
}

/* Brings rows' sums to what rays found by one factor per patch on both sides, which keeps A_i F_ij = A_j F_ji (Sinkhorn and
 * Knopp 1967). */
static bool make_sums_right(form_factors *f, const row *rows) {
    double *scale = malloc((f->count + 1u) * sizeof *scale), largest = 0.0;
    if (!scale)
        return false;
    for (int sweep = 0; sweep <= SWEEPS; sweep++) {
        double apart = 0.0;
        largest = 0.0;
        for (uint32_t i = 0; i < f->count; i++) {
            const double right = 1.0 - (double)rows[i].open;
            double sum = 0.0;
            for (size_t k = f->first[i]; k < f->first[i + 1]; k++)
                sum += (double)f->factor[k];
            f->open[i] = rows[i].open;
            f->excess = sweep == 0 && sum - 1.0 > f->excess ? sum - 1.0 : f->excess;
            largest = sum > largest ? sum : largest;
            apart = fabs(sum - right) > apart ? fabs(sum - right) : apart;
            scale[i] = sum > 0.0 ? sqrt(right / sum) : 1.0;
        }
        if (sweep == SWEEPS || apart < NEAR_ENOUGH)
            break;
        for (uint32_t i = 0; i < f->count; i++)
            for (size_t k = f->first[i]; k < f->first[i + 1]; k++)
                f->factor[k] = (float)((double)f->factor[k] * scale[i] * scale[f->to[k]]);
    }
    if (largest > 1.0) /* by rounding, or because sweeps do not get there: no series survives it */
        for (size_t k = 0; k < f->first[f->count]; k++)
            f->factor[k] = (float)((double)f->factor[k] / largest * (1.0 - 0x1p-23));
    free(scale);
    return true;
}

#define BATCH 256u /* patches between two reports of progress */

typedef struct batch {
    shooting *s;
    uint32_t first;
} batch;

static void shoot_one(void *user, uint32_t item) {
    const batch *b = user;
    shoot(b->s, b->first + item);
}

vit_status form_factors_find(const form_factors_input *in, form_factors *out, vit_text *why) {
    *out = (form_factors){.count = in->patches->count};
    row *rows = calloc(out->count + 1u, sizeof *rows);
    out->open = calloc(out->count + 1u, sizeof *out->open);
    bool fine = rows && out->open;
    shooting s = {in, rows};
    for (batch b = {&s, 0}; fine && b.first < out->count; b.first += BATCH) {
        const uint32_t left = out->count - b.first;
        parallel_for(in->threads, left < BATCH ? left : BATCH, shoot_one, &b);
        if (in->progress)
            in->progress(in->user, (double)(b.first + (left < BATCH ? left : BATCH)) / out->count);
    }
    for (uint32_t i = 0; fine && i < out->count; i++)
        fine = !rows[i].failed;
    fine = fine && make_equal(in->patches, rows, out) && make_sums_right(out, rows);
    for (uint32_t i = 0; rows && i < out->count; i++) {
        free(rows[i].to);
        free(rows[i].factor);
    }
    free(rows);
    if (fine)
        return VIT_OK;
    form_factors_free(out);
    return bake_fail(why, VIT_FAILED, "form factors: out of memory");
}

void form_factors_free(form_factors *f) {
    free(f->first);
    free(f->to);
    free(f->factor);
    free(f->open);
    *f = (form_factors){0};
}
