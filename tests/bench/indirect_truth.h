/* What light should be, for bench_indirect.c: the path tracer's, until its own noise is small or time is up, kept in a file
 * between runs; and how far a method's picture is from it. */
#ifndef VIT_BENCH_INDIRECT_TRUTH_H
#define VIT_BENCH_INDIRECT_TRUTH_H

#include "indirect_scenes.h"
#include "reference/metrics.h"
#include "reference/reference.h"

#define TRUTH_NOISE 0.002 /* NMSE of indirect light that is enough */
#define TRUTH_BOUNCES                                                                                                          \
    4u /* of light with an end: the default of `bounces`; another number would be another cached reference                     \
        */

/* Indirect light of all reflections; of as many as photons make by default; the whole picture; direct light. */
enum { ALL, LIMITED, PICTURE, DIRECT, TRUTH_PARTS };

typedef struct truth_part {
    const double *light, *variance;
    double mean, noise; /* NMSE that its variance makes */
    double *around;     /* a pixel: what its neighbours show, less its own */
} truth_part;

typedef struct truth {
    reference r;
    double *sum, *sum_variance; /* of direct and all indirect light */
    truth_part part[TRUTH_PARTS];
} truth;

static inline double mean_of(const double *v, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += v[i];
    return sum / (double)count;
}

static inline truth_part truth_part_of(const double *light, const double *variance, size_t values) {
    truth_part p = {.light = light, .variance = variance, .mean = mean_of(light, values)};
    p.noise = p.mean > 0 ? mean_of(variance, values) / (p.mean * p.mean) : 0;
    return p;
}

/* The means of a pixel's 24 neighbours: they tell what is dark without the noise of the pixel itself, which would make whatever
 * is sorted by it too dark. */
static inline void truth_look_around(const reference *r, truth_part *p) {
    const int w = (int)r->width, h = (int)r->height;
    p->around = bench_array((size_t)w * (size_t)h, sizeof *p->around);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            double sum = 0;
            int count = 0;
            for (int v = y > 2 ? y - 2 : 0; v <= y + 2 && v < h; v++)
                for (int u = x > 2 ? x - 2 : 0; u <= x + 2 && u < w; u++)
                    for (int k = 0; k < 3 && (u != x || v != y); k++, count++)
                        sum += p->light[3 * (v * w + u) + k];
            p->around[y * w + x] = sum / count;
        }
}

static inline void truth_finish(truth *t) {
    const size_t values = 3 * (size_t)t->r.width * t->r.height;
    t->sum = bench_array(values, sizeof *t->sum);
    t->sum_variance = bench_array(values, sizeof *t->sum_variance);
    for (size_t i = 0; i < values; i++) {
        t->sum[i] = t->r.direct[i] + t->r.unlimited[i];
        t->sum_variance[i] = t->r.direct_variance[i] + t->r.unlimited_variance[i];
    }
    t->part[ALL] = truth_part_of(t->r.unlimited, t->r.unlimited_variance, values);
    t->part[LIMITED] = truth_part_of(t->r.limited, t->r.limited_variance, values);
    t->part[PICTURE] = truth_part_of(t->sum, t->sum_variance, values);
    t->part[DIRECT] = truth_part_of(t->r.direct, t->r.direct_variance, values);
    for (int k = 0; k < TRUTH_PARTS; k++)
        truth_look_around(&t->r, &t->part[k]);
}

/* Paths are doubled until the noise is small enough or twice as many would take more than `seconds`. */
static inline void truth_trace(reference_input *in, double noise, double seconds, truth *t) {
    vit_text why;
    memset(t, 0, sizeof *t);
    in->target = 1e-12; /* never: this loop decides */
    in->bounces = TRUTH_BOUNCES;
    for (in->max_samples = REFERENCE_ROUND; in->max_samples <= REFERENCE_MOST; in->max_samples *= 2) {
        reference_free(&t->r);
        if (reference_render(in, &t->r, &why) != VIT_OK)
            bench_fail("reference: %s", why.text);
        const truth_part p = truth_part_of(t->r.unlimited, t->r.unlimited_variance, 3 * (size_t)t->r.width * t->r.height);
        if (!(p.mean > 0))
            bench_fail("reference: there is no indirect light");
        if (p.noise <= noise || 2 * t->r.seconds > seconds)
            break;
        while (in->max_samples < t->r.samples) /* of an earlier run */
            in->max_samples *= 2;
    }
    truth_finish(t);
}

/* Linear light as a display has it, 0..255. */
static inline int truth_shade(double linear) {
    const double c = linear < 0 ? 0 : linear > 1 ? 1 : linear;
    return (int)(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055) + 0.5);
}

static inline void truth_free(truth *t) {
    reference_free(&t->r);
    free(t->sum);
    free(t->sum_variance);
    for (int k = 0; k < TRUTH_PARTS; k++)
        free(t->part[k].around);
}

typedef struct verdict {
    double flux[3], dark; /* over the truth's; 1 where both are black */
    double nmse, relmse;  /* less what the truth's noise adds to them, by its variance */
    double noise[2];      /* that */
} verdict;

typedef struct by_light {
    double light;
    size_t pixel;
} by_light;

static inline int darker(const void *a, const void *b) {
    const by_light *x = a, *y = b;
    if (x->light != y->light)
        return x->light < y->light ? -1 : 1;
    return x->pixel < y->pixel ? -1 : x->pixel > y->pixel;
}

static inline double truth_ratio(double got, double right) {
    return right > 0 ? got / right : got > 0 ? INFINITY : 1;
}

static inline double truth_dark_half(const truth_part *p, size_t pixels, const float *rgb) {
    by_light *order = bench_array(pixels, sizeof *order);
    double got = 0, right = 0;
    for (size_t i = 0; i < pixels; i++)
        order[i] = (by_light){p->around[i], i};
    qsort(order, pixels, sizeof *order, darker);
    for (size_t i = 0; i < pixels / 2; i++)
        for (size_t k = 3 * order[i].pixel; k < 3 * order[i].pixel + 3; k++) {
            got += (double)rgb[k];
            right += p->light[k];
        }
    free(order);
    return truth_ratio(got, right);
}

static inline verdict truth_compare(const truth *t, int part, const float *rgb) {
    const truth_part *p = &t->part[part];
    const size_t pixels = (size_t)t->r.width * t->r.height;
    const cost_error e = metrics_compare(p->light, rgb, NULL, t->r.width, t->r.height);
    verdict v = {.dark = truth_dark_half(p, pixels, rgb), .noise = {p->noise, 0}};
    double got[3] = {0}, right[3] = {0};
    for (size_t i = 0; i < 3 * pixels; i++) {
        got[i % 3] += (double)rgb[i];
        right[i % 3] += p->light[i];
        v.noise[1] += p->variance[i] / (p->light[i] * p->light[i] + 0.01 * p->mean * p->mean) / (3.0 * (double)pixels);
    }
    for (int k = 0; k < 3; k++)
        v.flux[k] = truth_ratio(got[k], right[k]);
    v.nmse = e.nmse - v.noise[0];
    v.relmse = e.relmse - v.noise[1];
    return v;
}

/* How far a pixel is off beyond three standard errors of the truth, squared, over the channels. */
static inline double truth_off(const truth_part *p, const float *rgb, size_t pixel) {
    double sum = 0;
    for (size_t i = 3 * pixel; i < 3 * pixel + 3; i++) {
        const double off = fabs((double)rgb[i] - p->light[i]) - 3 * sqrt(p->variance[i]);
        sum += off > 0 ? off * off : 0;
    }
    return sum;
}

/* The `count` worst pixels of all indirect light, none within 4 grid points of another: places rather than spots. */
static inline void truth_print_worst(const truth *t, const float *rgb, uint32_t every, int count) {
    const truth_part *p = &t->part[ALL];
    const size_t w = t->r.width, pixels = w * t->r.height;
    bool *taken = bench_array(pixels, sizeof *taken);
    for (int n = 0; n < count; n++) {
        size_t worst = pixels;
        for (size_t i = 0; i < pixels; i++)
            if (!taken[i] && (worst == pixels || truth_off(p, rgb, i) > truth_off(p, rgb, worst)))
                worst = i;
        if (worst == pixels)
            break;
        const float *g = rgb + 3 * worst;
        const double *r = p->light + 3 * worst;
        printf("    at %3zu %3zu: got %.4g %.4g %.4g, expected %.4g %.4g %.4g (mean %.4g)\n", every * (worst % w) + every / 2,
               every * (worst / w) + every / 2, (double)g[0], (double)g[1], (double)g[2], r[0], r[1], r[2], p->mean);
        for (size_t i = 0; i < pixels; i++) {
            const double dx = (double)(i % w) - (double)(worst % w), dy = (double)(i / w) - (double)(worst / w);
            taken[i] = taken[i] || dx * dx + dy * dy < 16;
        }
    }
    free(taken);
}

#endif
