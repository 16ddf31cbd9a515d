/* Made-up results of a sweep, as plausible as a report needs them: times and errors that trade off, images with leaks and
 * noise. */
#ifndef VIT_TESTS_REPORT_LAB_H
#define VIT_TESTS_REPORT_LAB_H

#include "report/report.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LAB_SETTINGS = 20, LAB_PASSES = 12, LAB_WORKS = 5 };

/* Uniform in [0, 1), the same in every run (PCG hash, O'Neill 2014). */
static inline double lab_random(uint32_t *state) {
    *state = *state * 747796405u + 2891336453u;
    const uint32_t word = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return (double)((word >> 22) ^ word) / 4294967296.0;
}

/* A lit floor that fades into the dark, with a bright and a dark stripe. Linear. */
static inline double lab_light(uint32_t x, uint32_t y, uint32_t c, uint32_t width, uint32_t height) {
    const double u = (double)x / width, v = (double)y / height;
    const double pillar = fabs(u - 0.3) < 0.05 || fabs(u - 0.7) < 0.04 ? 0.25 : 1;
    return pillar * (0.02 + 0.9 * exp(-4 * ((u - 0.5) * (u - 0.5) + (v - 0.7) * (v - 0.7)))) *
           (c == 0   ? 1
            : c == 1 ? 0.8
                     : 0.55);
}

static inline void lab_images(cost_results *r, cost_setting *s, double noise, double leak, uint32_t seed) {
    const uint32_t w = r->reference.width, h = r->reference.height;
    s->image = malloc((size_t)w * h * 3 * sizeof s->image[0]);
    for (uint32_t y = 0; y < h; y++)
        for (uint32_t x = 0; x < w; x++) {
            const double n = 1 + noise * (lab_random(&seed) - 0.5), l = fabs((double)x / w - 0.3) < 0.05 ? leak : 0;
            for (uint32_t c = 0; c < 3; c++) {
                const size_t at = ((size_t)y * w + x) * 3 + c;
                s->image[at] = (float)((r->reference.direct[at] + r->reference.limited[at]) * n + l * 0.1);
            }
        }
}

static inline void lab_setting(cost_results *r, uint32_t i, const char *knob, const char *name, double ms, double nmse,
                               double relmse) {
    static const char *const passes[LAB_PASSES] = {"visibility",   "view samples", "direct light", "photon paths",
                                                   "cluster keys", "cluster sort", "hierarchy",    "splat count",
                                                   "splat lists",  "estimate",     "interpolate",  "resolve"};
    static const double shares[LAB_PASSES] = {0.18, 0.06, 0.14, 0.05, 0.03, 0.02, 0.02, 0.04, 0.08, 0.30, 0.03, 0.04};
    cost_setting *s = &r->settings[i];
    *s = (cost_setting){.ms = ms,
                        .ms_p95 = ms * 1.05 + 0.3,
                        .ms_mad = 0.01 * ms,
                        .timed = 9,
                        .pass_count = LAB_PASSES,
                        .device_bytes = 80000000u + 1000000u * i,
                        .pack_bytes = 9000000u + 12345u * i,
                        .work = (uint64_t)(ms * 1e6),
                        .total = {nmse, relmse, 0.02 - 0.01 * (double)i / 7, 28 - 10 * log10(nmse * 10), 1 - nmse, 3 * nmse},
                        .indirect = {nmse * 2.1, relmse * 1.4, -0.03, 25, 0.9, 4 * nmse},
                        .unlimited = {nmse + 0.003, relmse + 0.01, -0.01, 25, 0.9, 4 * nmse}};
    (void)snprintf(s->name, sizeof s->name, "%s", name);
    (void)snprintf(s->knob, sizeof s->knob, "%s", knob);
    (void)snprintf(s->values, sizeof s->values, "photons = 17000; bounces = 4; radius = auto; tile = 32; estimate = list; %s",
                   name);
    for (uint32_t p = 0; p < LAB_PASSES; p++) {
        (void)snprintf(s->pass_names[p], sizeof s->pass_names[p], "%s", passes[p]);
        s->pass_ms[p] = (p == 9 ? ms - 0.72 * 20 : shares[p] * 20) * 0.97;
        if (s->pass_ms[p] < 0)
            s->pass_ms[p] = 0.4;
        s->pass_work[p][p % LAB_WORKS] = 1000003u * (p + 1) + i;
    }
    lab_images(r, s, 4 * sqrt(nmse), 2 * nmse, i + 1);
}

static inline void lab_fronts(cost_results *r) {
    for (uint32_t i = 0; i < r->count; i++) {
        cost_setting *s = &r->settings[i];
        s->elsewhere = strcmp(s->knob, "lanes") == 0;
        s->pareto = s->pareto_relmse = !s->elsewhere;
        for (uint32_t k = 0; k < r->count; k++) {
            const cost_setting *o = &r->settings[k];
            if (o->ms < s->ms && o->total.nmse < s->total.nmse)
                s->pareto = false;
            if (o->ms < s->ms && o->total.relmse < s->total.relmse)
                s->pareto_relmse = false;
        }
    }
}

/* Of `width` x `height` compared pixels; lab_free() it. */
static inline cost_results lab_results(uint32_t width, uint32_t height) {
    static const struct {
        const char *knob, *name;
        double ms, nmse, relmse;
    } rows[LAB_SETTINGS] = {{"default", "default", 22.1, 0.061, 0.31},
                            {"photons", "photons 4000", 17.2, 0.105, 0.52},
                            {"photons", "photons 65536", 41.5, 0.038, 0.19},
                            {"photons", "photons 262144", 122, 0.029, 0.16},
                            {"radius", "radius 0.25", 18.1, 0.142, 0.44},
                            {"radius", "radius 0.5", 19.6, 0.081, 0.33},
                            {"radius", "radius 1.5", 34.8, 0.074, 0.95},
                            {"kernel", "kernel sphere", 20.9, 0.073, 0.71},
                            {"tile", "tile 16", 24.0, 0.0609, 0.309},
                            {"tile", "tile 64", 23.1, 0.062, 0.314},
                            {"normal_keys", "without normal keys", 26.3, 0.061, 0.31},
                            {"estimate", "buckets, interpolated", 14.9, 0.092, 0.48},
                            {"estimate", "buckets, raw", 13.8, 0.121, 0.6},
                            {"bounces", "bounces 2", 18.7, 0.088, 0.41},
                            {"bounces", "bounces 6", 24.6, 0.057, 0.29},
                            {"lanes", "lanes 1", 96, 0.061, 0.31},
                            {"indirect samples", "indirect at 1/4", 15.6, 0.066, 0.335},
                            {"indirect samples", "indirect at 1/16", 12.9, 0.083, 0.42},
                            {"several", "photons 65536, indirect at 1/4", 23.9, 0.041, 0.21},
                            {"several", "photons 65536, indirect at 1/16, radius 0.5", 17.5, 0.059, 0.26}};
    cost_results r = {.scene = "Made-up hall", /* 1. of the whole sweep */
                      .device = "Portable Computing Language / pthread-made-up",
                      .cpu = "Made-up processor, 2 cores",
                      .width = width * 4,
                      .height = height * 4,
                      .frame = 12,
                      .every = 4,
                      .direct = {1e-9, 2e-9, 0, 90, 1, 1e-5},
                      .direct_largest = 0.001,
                      .truncation = {0.0031, 0.012, -0.013, 41, 0.995, 0.04},
                      .path_tracer_ms = 57.3,
                      .path_tracer_nmse = 1.96,
                      .path_tracer_relmse = 2.9,
                      .work_count = LAB_WORKS,
                      .count = LAB_SETTINGS};
    static const char *const works[LAB_WORKS] = {"rays", "nodes visited", "cluster pairs", "evaluations", "bytes moved"};
    for (uint32_t w = 0; w < LAB_WORKS; w++)
        (void)snprintf(r.work_names[w], sizeof r.work_names[w], "%s", works[w]);
    r.reference = /* 2. of the reference */
        (reference){.width = width, .height = height, .samples = 4096, .error = 0.0004, .seconds = 412, .rays = 3100000000u};
    r.reference.direct = malloc((size_t)width * height * 3 * sizeof(double));
    r.reference.limited = malloc((size_t)width * height * 3 * sizeof(double));
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (uint32_t c = 0; c < 3; c++) {
                const double light = lab_light(x, y, c, width, height);
                r.reference.direct[((size_t)y * width + x) * 3 + c] = 0.6 * light;
                r.reference.limited[((size_t)y * width + x) * 3 + c] = 0.4 * light;
            }
    r.settings = calloc(LAB_SETTINGS, sizeof r.settings[0]); /* 3. of each setting */
    for (uint32_t i = 0; i < LAB_SETTINGS; i++)
        lab_setting(&r, i, rows[i].knob, rows[i].name, rows[i].ms, rows[i].nmse, rows[i].relmse);
    lab_fronts(&r);
    return r;
}

static inline void lab_free(cost_results *r) {
    for (uint32_t i = 0; i < r->count; i++)
        free(r->settings[i].image);
    free(r->settings);
    free(r->reference.direct);
    free(r->reference.limited);
}

#endif
