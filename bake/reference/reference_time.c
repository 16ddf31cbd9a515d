#define _POSIX_C_SOURCE 200809L
#include "reference/caustics.h"
#include "common/fail.h"
#include "common/parallel.h"
#include "reference/metrics.h"
#include "reference/paths.h"
#include <stdlib.h>
#include <time.h>

#define CHUNK 256u       /* pixels that a thread takes at a time */
#define SEED 0x51ed270bu /* other numbers than the reference's */

struct reference_timer {
    const reference_input *in;
    path_scene scene;
    float radius; /* of photons by mirrors and glass; 0: there are none */
    caustics caustics;
    uint32_t width, height, grid_width, grid_height, number; /* number: of the frame */
    unsigned threads;
    float *image;  /* on truth's grid */
    double *total; /* truth's direct + limited */
};

static double now_ms(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static void keep(reference_timer *t, uint32_t x, uint32_t y, const view_sample *v, const path_sums *path) {
    const uint32_t every = t->in->every;
    if (x % every != every / 2 || y % every != every / 2)
        return;
    float *out = t->image + 3 * ((size_t)(y / every) * t->grid_width + x / every);
    for (int k = 0; k < 3; k++)
        out[k] = (float)(v->direct[k] + path->direct[k] + path->limited[k]);
}

static void pixel_chunk(void *user, uint32_t chunk, uint64_t *rays) {
    reference_timer *t = user;
    const uint32_t pixels = t->width * t->height, end = (chunk + 1) * CHUNK;
    for (uint32_t i = chunk * CHUNK; i < end && i < pixels; i++) {
        const uint32_t x = i % t->width, y = i / t->width;
        view_sample v;
        path_sums path;
        paths_view(&t->scene, x, y, &v, rays);
        paths_trace(&t->scene, t->radius > 0.0f ? &t->caustics : NULL, &v, pcg(x ^ pcg(y ^ pcg(t->number ^ SEED))), 0, 1, true,
                    &path, rays);
        keep(t, x, y, &v, &path);
    }
}

reference_timing reference_timer_frame(reference_timer *t) {
    reference_timing r = {.rays = 0};
    const parallel_work w = {
        .run = pixel_chunk, .user = t, .step = 1, .count = (t->width * t->height + CHUNK - 1) / CHUNK, .threads = t->threads};
    const double began = now_ms();
    caustics_free(&t->caustics);
    if (!caustics_trace(&t->scene, t->radius, pcg(t->number ^ SEED), 0, t->threads, &t->caustics, &r.rays))
        t->caustics = (caustics){.count = 0}; /* out of memory: a frame without them */
    (void)parallel_run(&w, &r.rays);          /* cannot be cancelled */
    r.ms = now_ms() - began;
    t->number++;
    const cost_error e = metrics_compare(t->total, t->image, NULL, t->grid_width, t->grid_height);
    r.nmse = e.nmse;
    r.relmse = e.relmse;
    return r;
}

vit_status reference_timer_open(const reference_input *in, const reference *truth, reference_timer **out, vit_text *why) {
    const vit_scene *s = in->sections->data[VIT_SECTION_META];
    const size_t values = 3 * (size_t)truth->width * truth->height;
    reference_timer *t = calloc(1, sizeof *t);
    *out = NULL;
    if (t) {
        *t = (reference_timer){.in = in,
                               .width = s->width,
                               .height = s->height,
                               .grid_width = truth->width,
                               .grid_height = truth->height,
                               .threads = parallel_threads(in->threads, 1),
                               .image = calloc(values, sizeof(float)),
                               .total = calloc(values, sizeof(double))};
    }
    if (!t || !t->image || !t->total || !paths_open(in, t->threads, &t->scene)) {
        (void)bake_fail(why, VIT_FAILED, "reference: %s", t && t->image && t->total ? "Embree fails" : "out of memory");
        reference_timer_close(t);
        return VIT_FAILED;
    }
    for (size_t i = 0; i < values; i++)
        t->total[i] = truth->direct[i] + truth->limited[i];
    t->radius = caustics_possible(&t->scene) ? float_max(caustics_first_radius(&t->scene, t->threads), 0.0f) : 0.0f;
    *out = t;
    return VIT_OK;
}

void reference_timer_close(reference_timer *t) {
    if (!t)
        return;
    caustics_free(&t->caustics);
    paths_close(&t->scene);
    free(t->image);
    free(t->total);
    free(t);
}

static int by_ms(const void *a, const void *b) {
    const double x = ((const reference_timing *)a)->ms, y = ((const reference_timing *)b)->ms;
    return (x > y) - (x < y);
}

vit_status reference_time(const reference_input *in, const reference *truth, uint32_t frames, reference_timing *out,
                          vit_text *why) {
    reference_timer *t;
    reference_timing *all = calloc(frames ? frames : 1, sizeof *all);
    *out = (reference_timing){0};
    if (!all)
        return bake_fail(why, VIT_FAILED, "reference: out of memory");
    const vit_status status = reference_timer_open(in, truth, &t, why);
    if (status == VIT_OK && frames > 0) {
        double nmse = 0, relmse = 0;
        for (uint32_t i = 0; i < frames; i++) {
            all[i] = reference_timer_frame(t);
            nmse += all[i].nmse / frames;
            relmse += all[i].relmse / frames;
        }
        qsort(all, frames, sizeof *all, by_ms);
        *out = all[frames / 2];
        out->nmse = nmse;
        out->relmse = relmse;
    }
    if (status == VIT_OK)
        reference_timer_close(t);
    free(all);
    return status;
}
