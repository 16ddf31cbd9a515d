#include "radiosity/basis.h"
#include "common/fail.h"
#include "common/kernel_math.h"
#include "common/parallel.h"
#include <stdlib.h>
#include <string.h>

#define STEP 0.02      /* of the scene's size, that a light moves from knot to knot */
#define TURN 0.5       /* of the scene's size: what a turn by one radian counts for */
#define MOST_KNOTS 64u /* of a light */
#define ITERATIONS 24  /* of the power method, a vector */
#define PALE 0.05      /* of the channels' mean: a channel of less counts as so much more */
#define DIM 0.1        /* of a group's mean: light so dim does not count for more */
#define LONGEST 32767.0f

/* 1. Knots: frames of a light's track. */

static double moved(const vit_light *a, const vit_light *b, double size) {
    const vec3 p = vec3_sub(vec3_load(a->position), vec3_load(b->position)),
               d = vec3_sub(vec3_load(a->direction), vec3_load(b->direction));
    const double way = a->kind == VIT_LIGHT_DIRECTIONAL ? 0.0 : sqrt((double)vec3_dot(p, p)),
                 turn = a->kind == VIT_LIGHT_POINT ? 0.0 : sqrt((double)vec3_dot(d, d));
    const double other =
        fabs((double)a->cos_outer - (double)b->cos_outer) +
        (a->inv_range2 != b->inv_range2 || a->spot_scale != b->spot_scale || a->spot_offset != b->spot_offset ? STEP / TURN
                                                                                                              : 0.0);
    return way + (turn + (a->kind == VIT_LIGHT_DIRECTIONAL ? 0.0 : other)) * TURN * size;
}

vit_status basis_knots_find(const tracks *t, uint32_t frames, uint32_t light, double size, basis_knots *out, vit_text *why) {
    *out = (basis_knots){.frame = malloc(frames * sizeof *out->frame), .place = calloc(frames, sizeof *out->place)};
    double *way = calloc(frames, sizeof *way);
    if (!out->frame || !out->place || !way) {
        free(way);
        basis_knots_free(out);
        return bake_fail(why, VIT_FAILED, "basis: out of memory");
    }
    way[0] = 0.0;
    for (uint32_t f = 1; f < frames; f++)
        way[f] = way[f - 1] + moved(t->lights + (size_t)(f - 1) * t->light_count + light,
                                    t->lights + (size_t)f * t->light_count + light, size);
    const double all = way[frames - 1], step = fmax(STEP * size, all / (MOST_KNOTS - 2u));
    out->frame[out->count++] = 0;
    for (uint32_t f = 1; f < frames && all > 0.0; f++) {
        const double since = way[f] - way[out->frame[out->count - 1]];
        const bool jumps = f + 1 < frames && way[f + 1] - way[f] > step && out->count + 1 < MOST_KNOTS;
        if (f + 1 == frames || (since > 0.0 && (since >= step || jumps)))
            out->frame[out->count++] = f;
        if (out->count == MOST_KNOTS && f + 1 < frames) /* jumps have used them up: the rest is the last knot's */
            out->frame[out->count - 1] = f;
    }
    for (uint32_t f = 0, k = 0; f < frames; f++) {
        while (k + 1 < out->count && out->frame[k + 1] <= f)
            k++;
        vit_basis_frame *p = out->place + f;
        *p = (vit_basis_frame){.light = light, .knot = k};
        if (k + 1 < out->count) {
            const double from = way[out->frame[k]], to = way[out->frame[k + 1]];
            p->weight = to > from ? (float)((way[f] - from) / (to - from)) : 0.0f;
        }
    }
    for (uint32_t k = 0; k + 1 < out->count; k++)
        if (out->frame[k + 1] > out->frame[k] + 1)
            out->widest = fmax(out->widest, (way[out->frame[k + 1]] - way[out->frame[k]]) / size);
    free(way);
    return VIT_OK;
}

void basis_knots_free(basis_knots *k) {
    free(k->frame);
    free(k->place);
    *k = (basis_knots){0};
}

/* 2. Factors of a group's matrix for one light. */

typedef struct factors {
    uint32_t rank;
    float *left;  /* rank x VIT_BASIS_GROUP */
    float *right; /* rank x columns */
    double all, rest;
} factors;

typedef struct factoring {
    const basis_input *in;
    factors *found; /* group x light */
    uint32_t groups;
    bool failed; /* set alike by any thread */
} factoring;

/* The largest product that is in the rows: left x right^T, right unit. 0: nothing is left. */
static double largest(const double *m, uint32_t columns, double *left, double *right) {
    double length = 0.0;
    for (uint32_t c = 0; c < columns; c++)
        right[c] = 0.0;
    for (uint32_t r = 0; r < VIT_BASIS_GROUP; r++) /* start from the sum of the rows' own directions */
        for (uint32_t c = 0; c < columns; c++)
            right[c] += m[(size_t)r * columns + c] * (1.0 + 0.01 * (r % 7u));
    for (int step = 0; step < ITERATIONS; step++) {
        length = 0.0;
        for (uint32_t c = 0; c < columns; c++)
            length += right[c] * right[c];
        if (!(length > 0.0))
            return 0.0;
        length = sqrt(length);
        for (uint32_t c = 0; c < columns; c++)
            right[c] /= length;
        for (uint32_t r = 0; r < VIT_BASIS_GROUP; r++) {
            left[r] = 0.0;
            for (uint32_t c = 0; c < columns; c++)
                left[r] += m[(size_t)r * columns + c] * right[c];
        }
        if (step + 1 == ITERATIONS)
            break;
        memset(right, 0, columns * sizeof *right);
        for (uint32_t r = 0; r < VIT_BASIS_GROUP; r++)
            for (uint32_t c = 0; c < columns; c++)
                right[c] += left[r] * m[(size_t)r * columns + c];
    }
    double sum = 0.0;
    for (uint32_t r = 0; r < VIT_BASIS_GROUP; r++)
        sum += left[r] * left[r];
    return sum;
}

/* What a group's numbers are multiplied by, so that squares of errors are relative to what is there. */
typedef struct weights {
    double row[VIT_BASIS_GROUP], channel[3];
} weights;

static bool keep(factors *f, uint32_t columns, const double *left, const double *right, const weights *by) {
    float *l = realloc(f->left, (size_t)(f->rank + 1) * VIT_BASIS_GROUP * sizeof *l);
    if (l)
        f->left = l;
    float *r = realloc(f->right, (size_t)(f->rank + 1) * columns * sizeof *r);
    if (r)
        f->right = r;
    if (!l || !r)
        return false;
    for (uint32_t i = 0; i < VIT_BASIS_GROUP; i++)
        l[(size_t)f->rank * VIT_BASIS_GROUP + i] = (float)(left[i] / by->row[i]);
    for (uint32_t c = 0; c < columns; c++)
        r[(size_t)f->rank * columns + c] = (float)(right[c] / by->channel[c % 3u]);
    f->rank++;
    return true;
}

/* The matrix of a group, weighted. Returns the sum of its squares. */
static double weigh(const factoring *w, uint32_t group, uint32_t light, double *m, weights *by) {
    const basis_input *in = w->in;
    const uint32_t columns = 3 * in->knots[light];
    double mean = 0.0, all = 0.0, of_channel[3] = {0.0, 0.0, 0.0}, part = 0.0;
    for (uint32_t r = 0; r < VIT_BASIS_GROUP; r++) {
        const uint32_t receiver = group * VIT_BASIS_GROUP + r;
        double sum = 0.0;
        for (uint32_t c = 0; c < columns; c++) {
            const double v =
                receiver < in->receivers ? (double)in->irradiance[(size_t)receiver * in->columns + in->first[light] + c] : 0.0;
            m[(size_t)r * columns + c] = v;
            sum += v;
        }
        by->row[r] = sum / columns;
        mean += sum / columns / VIT_BASIS_GROUP;
    }
    for (uint32_t r = 0; r < VIT_BASIS_GROUP; r++) {
        by->row[r] = mean > 0.0 ? 1.0 / (by->row[r] + DIM * mean) : 1.0;
        for (uint32_t c = 0; c < columns; c++)
            of_channel[c % 3u] += m[(size_t)r * columns + c] *= by->row[r];
    }
    for (uint32_t c = 0; c < 3; c++)
        part += of_channel[c] / 3.0;
    for (uint32_t c = 0; c < 3; c++)
        by->channel[c] = part > 0.0 ? 1.0 / (of_channel[c] / part + PALE) : 1.0;
    for (uint32_t r = 0; r < VIT_BASIS_GROUP; r++)
        for (uint32_t c = 0; c < columns; c++) {
            double *v = m + (size_t)r * columns + c;
            *v *= by->channel[c % 3u];
            all += *v * *v;
        }
    return all;
}

static void factor(void *user, uint32_t item) {
    factoring *w = user;
    const uint32_t light = item % w->in->lights, columns = 3 * w->in->knots[light];
    factors *f = w->found + item;
    double *m = malloc((size_t)VIT_BASIS_GROUP * columns * sizeof *m), *right = malloc(columns * sizeof *right),
           left[VIT_BASIS_GROUP];
    weights by;
    bool fine = m && right;
    if (fine) {
        f->all = f->rest = weigh(w, item / w->in->lights, light, m, &by);
        const double enough = f->all * w->in->error;
        while (fine && f->rest > enough && f->rank < VIT_BASIS_RANK && f->rank < columns) {
            const double got = largest(m, columns, left, right);
            if (!(got > 0.0))
                break;
            fine = keep(f, columns, left, right, &by);
            f->rest = 0.0;
            for (uint32_t r = 0; r < VIT_BASIS_GROUP; r++)
                for (uint32_t c = 0; c < columns; c++) {
                    double *v = m + (size_t)r * columns + c;
                    *v -= left[r] * right[c];
                    f->rest += *v * *v;
                }
        }
    }
    if (!fine)
        w->failed = true;
    free(m);
    free(right);
}

/* 3. As the kernel relight reads it: a vector's numbers are 16-bit integers, receivers i and i + 128 of a group in one word;
 * what scales them is in the coefficients. */

static void write_group(const factoring *w, uint32_t item, basis *out) {
    const factors *f = w->found + item;
    const uint32_t knots = w->in->knots[item % w->in->lights], half = VIT_BASIS_GROUP / 2;
    out->groups[item] =
        (vit_basis_group){.first_word = out->word_count, .rank = f->rank, .first_coefficient = out->coefficient_count};
    for (uint32_t k = 0; k < f->rank; k++) {
        const float *left = f->left + (size_t)k * VIT_BASIS_GROUP, *right = f->right + (size_t)k * knots * 3;
        float longest = 0.0f;
        for (uint32_t i = 0; i < VIT_BASIS_GROUP; i++)
            longest = float_max(longest, fabsf(left[i]));
        const float scale = longest > 0.0f ? longest / LONGEST : 0.0f;
        for (uint32_t i = 0; i < half; i++) {
            const int32_t low = scale > 0.0f ? (int32_t)lrintf(left[i] / scale) : 0,
                          high = scale > 0.0f ? (int32_t)lrintf(left[i + half] / scale) : 0;
            out->words[out->word_count + k * half + i] = ((uint32_t)low & 0xffffu) | (uint32_t)high << 16;
        }
        for (uint32_t n = 0; n < knots; n++)
            for (uint32_t c = 0; c < 3; c++)
                out->coefficients[out->coefficient_count + n * f->rank + k].rgb[c] = right[3 * n + c] * scale;
    }
    out->word_count += f->rank * half;
    out->coefficient_count += f->rank * knots;
}

static void drop(factoring *w) {
    for (uint32_t i = 0; w->found && i < w->groups * w->in->lights; i++) {
        free(w->found[i].left);
        free(w->found[i].right);
    }
    free(w->found);
}

vit_status basis_make(const basis_input *in, basis *out, vit_text *why) {
    *out = (basis){.group_count = (in->receivers + VIT_BASIS_GROUP - 1) / VIT_BASIS_GROUP};
    factoring w = {.in = in, .groups = out->group_count};
    const uint32_t items = w.groups * in->lights;
    w.found = calloc(items + 1u, sizeof *w.found);
    if (w.found)
        parallel_for(in->threads, items, factor, &w);
    size_t words = 0, coefficients = 0, ranks = 0;
    double all = 0.0, rest = 0.0;
    for (uint32_t i = 0; w.found && i < items; i++) {
        const factors *f = w.found + i;
        words += (size_t)f->rank * (VIT_BASIS_GROUP / 2);
        coefficients += (size_t)f->rank * in->knots[i % in->lights];
        ranks += f->rank;
        all += f->all;
        rest += f->rest;
    }
    out->groups = calloc(items + 1u, sizeof *out->groups);
    out->words = malloc((words + 1u) * sizeof *out->words);
    out->coefficients = calloc(coefficients + 1u, sizeof *out->coefficients);
    const bool fine =
        w.found && !w.failed && out->groups && out->words && out->coefficients && words < VIT_NONE && coefficients < VIT_NONE;
    for (uint32_t i = 0; fine && i < items; i++)
        write_group(&w, i, out);
    out->left = all > 0.0 ? rest / all : 0.0;
    out->mean_rank = items ? (double)ranks / items : 0.0;
    drop(&w);
    if (fine)
        return VIT_OK;
    basis_free(out);
    return bake_fail(why, VIT_FAILED, "basis: out of memory");
}

void basis_free(basis *b) {
    free(b->groups);
    free(b->words);
    free(b->coefficients);
    *b = (basis){0};
}
