#include "radiosity/transport.h"
#include "common/fail.h"
#include "common/parallel.h"
#include "radiosity/transport_parts.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_REFLECTIONS 64u
#define LEAST 2e-3 /* of the whole, that a reflection adds: then the rest is a geometric series */

typedef struct passing {
    const transport *t;
    const transport_rows *rows;
    const float *from, *albedo; /* albedo: 3 a number, or NULL */
    float *to;
    bool add; /* to what is there */
} passing;

/* What a row's cells send it. */
static void pass_row(void *user, uint32_t row) {
    const passing *p = user;
    const uint32_t columns = p->t->columns;
    float *to = p->to + (size_t)row * columns;
    if (!p->add)
        memset(to, 0, columns * sizeof *to);
    if (row >= p->rows->count)
        return;
    for (size_t k = p->rows->first[row]; k < p->rows->first[row + 1]; k++) {
        const float *from = p->from + (size_t)p->rows->to[k] * columns, factor = p->rows->factor[k];
        for (uint32_t c = 0; c < columns; c++)
            to[c] += factor * from[c];
    }
    for (uint32_t c = 0; c < columns && p->albedo; c++)
        to[c] *= p->albedo[3 * (size_t)row + c % 3u];
    for (uint32_t c = 0; c < columns && p->add;
         c++) /* light close by took off what means add: rounding may leave less than 0 */
        to[c] = float_max(to[c], 0.0f);
}

/* The deviation of what a row's rays brought. A ray that chance sent stands for one of all; weights below that are of rays
 * that were aimed. */
static void find_noise(void *user, uint32_t row) {
    const passing *p = user;
    const double one = 1.0 / p->t->in->receiver_rays;
    double squares = 0.0, sum = 0.0;
    for (size_t k = p->rows->first[row]; k < p->rows->first[row + 1]; k++) {
        const float *from = p->from + (size_t)p->rows->to[k] * p->t->columns;
        const double factor = (double)p->rows->factor[k];
        double all = 0.0;
        for (uint32_t c = 0; c < p->t->columns; c++)
            all += (double)from[c];
        squares += all * all * factor * (factor < one ? factor : one);
        sum += factor * all;
    }
    const double variance = squares - sum * sum * one;
    p->to[row] = variance > 0.0 ? (float)sqrt(variance) : 0.0f;
}

static double sum_of(const transport *t, const float *light) {
    double sum = 0.0;
    for (size_t i = 0; i < (size_t)t->count * t->columns; i++)
        sum += (double)light[i];
    return sum;
}

/* all: direct light's radiosity; reflections are added to it. */
static bool reflect(transport *t, float *all, const float *albedo) {
    const size_t numbers = (size_t)t->count * t->columns;
    float *one = malloc((numbers + 1u) * sizeof *one), *other = malloc((numbers + 1u) * sizeof *other);
    if (!one || !other) {
        free(one);
        free(other);
        return false;
    }
    const uint32_t most = t->in->reflections == TRANSPORT_CONVERGED ? MOST_REFLECTIONS : t->in->reflections - 1u;
    double before = sum_of(t, all), whole = before;
    memcpy(one, all, numbers * sizeof *one);
    for (uint32_t h = 0; h < most && before > 0.0; h++) {
        const passing p = {.t = t, .rows = &t->bounces, .from = one, .albedo = albedo, .to = other};
        parallel_for(t->in->threads, t->count, pass_row, (void *)(uintptr_t)&p);
        const double now = sum_of(t, other), left = now / before;
        whole += now;
        t->report->spectral = left;
        t->report->reflections = h + 1;
        /* With nothing to end it, what is left to come is what has come, over and over. */
        const bool last = t->in->reflections == TRANSPORT_CONVERGED && left < 1.0 && now < LEAST * whole;
        const float scale = last ? (float)(1.0 / (1.0 - left)) : 1.0f;
        for (size_t i = 0; i < numbers; i++)
            all[i] += other[i] * scale;
        if (last)
            break;
        float *swap = one;
        one = other;
        other = swap;
        before = now;
    }
    free(one);
    free(other);
    return true;
}

typedef struct albedos {
    const transport *t;
    float *out;
} albedos;

static void find_albedo(void *user, uint32_t n) {
    const albedos *a = user;
    transport_albedo(a->t, n, a->out + 3 * (size_t)n);
}

static bool compute(transport *t, const transport_light *out) {
    const size_t numbers = (size_t)t->count * t->columns;
    float *radiosity = malloc((numbers + 1u) * sizeof *radiosity),
          *albedo = malloc((3u * (size_t)t->count + 1u) * sizeof *albedo);
    bool fine = radiosity && albedo && transport_direct(t, radiosity);
    if (fine) {
        albedos a = {t, albedo};
        parallel_for(t->in->threads, t->count, find_albedo, &a);
        transport_near_light(t, radiosity, out->irradiance);
        fine = reflect(t, radiosity, albedo) && transport_aim(t, radiosity);
    }
    if (fine) {
        passing p = {.t = t, .rows = &t->gathers, .from = radiosity, .to = out->irradiance, .add = true};
        parallel_for(t->in->threads, t->in->receiver_count, pass_row, &p);
        p.to = out->noise;
        if (out->noise)
            parallel_for(t->in->threads, t->in->receiver_count, find_noise, &p);
    }
    free(radiosity);
    free(albedo);
    return fine;
}

static void drop(transport *t) {
    cells_free(&t->cells);
    free(t->edge);
    separations_free(&t->apart);
    free(t->number);
    free(t->cell);
    free(t->place_count);
    free(t->places);
    transport_drop_rows(&t->gathers);
    transport_drop_rows(&t->bounces);
    free(t->near);
    free(t->varies);
}

vit_status transport_find(const transport_input *in, const transport_light *out, transport_report *report, vit_text *why) {
    *report = (transport_report){0};
    transport t = {.in = in, .report = report, .columns = 3 * in->state_count};
    vit_text divided = {""};
    const bool fine = transport_divide(&t, &divided) && transport_gather(&t) && compute(&t, out);
    report->cells = t.count;
    report->splits = t.apart.count;
    drop(&t);
    if (fine)
        return VIT_OK;
    return divided.text[0] ? bake_fail(why, VIT_BAD_INPUT, "%s", divided.text)
                           : bake_fail(why, VIT_FAILED, "radiosity: out of memory");
}
