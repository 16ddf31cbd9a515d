#include "cost/timing.h"
#include "common/fail.h"
#include "pack/opened.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double timing_median(double *values, uint32_t count) {
    qsort(values, count, sizeof *values, ascending);
    return count % 2 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

double timing_percentile(double *values, uint32_t count, double percent) {
    qsort(values, count, sizeof *values, ascending);
    const double rank = ceil(percent / 100 * count);
    return values[rank < 1 ? 0 : rank > count ? count - 1 : (uint32_t)rank - 1];
}

double timing_deviation(double *values, uint32_t count) {
    const double middle = timing_median(values, count);
    for (uint32_t i = 0; i < count; i++)
        values[i] = fabs(values[i] - middle);
    return timing_median(values, count);
}

static double now_ms(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static bool cancelled(const timing_input *in, vit_text *why) {
    if (in->cancel && *in->cancel)
        (void)bake_fail(why, VIT_FAILED, "interrupted");
    return in->cancel && *in->cancel;
}

/* Opens and verifies: no time of a wrong picture is worth anything. The kernels are warm then, too. */
static vit_status open_entry(const timing_input *in, timing_entry *e, opened *o, vit_text *why) {
    const vit_open_info info = {
        .pack = e->pack, .pack_size = e->pack_size, .device = in->device, .lanes = e->lanes, .profile = 1};
    vit_status status = opened_begin(&info, o, why);
    for (uint32_t f = 0; status == VIT_OK && f < o->need.frames; f++) {
        status = opened_frame(o, f, why);
        if (status == VIT_OK && vit_hash_frame(o->frame, info.format, o->need.frame_bytes) != vit_golden(o->v, f)) {
            status = bake_fail(why, VIT_MISMATCH, "setting '%s': frame %u of its pack has another hash than its golden one",
                               e->name, f);
        }
        if (status == VIT_OK && cancelled(in, why))
            status = VIT_FAILED;
    }
    return status;
}

static vit_status measure_frame(timing_entry *e, opened *o, uint32_t round, vit_text *why) {
    vit_statistics stats;
    const double began = now_ms();
    vit_status status = opened_frame(o, round % o->need.frames, why);
    e->ms[round] = now_ms() - began;
    if (status == VIT_OK)
        status = vit_stats(o->v, &stats, why);
    if (status != VIT_OK)
        return status;
    e->pass_count = stats.pass_count;
    memcpy(e->pass_ms + (size_t)round * VIT_MAX_PASSES, stats.pass_ms, sizeof stats.pass_ms);
    for (uint32_t p = 0; p < stats.pass_count; p++)
        (void)snprintf(e->pass_names[p], sizeof e->pass_names[p], "%s", stats.pass_names[p]);
    return VIT_OK;
}

static vit_status measure_round(const timing_input *in, opened *opens, uint32_t round, vit_text *why) {
    vit_status status = VIT_OK;
    for (uint32_t i = 0; i < in->count && status == VIT_OK; i++)
        status = cancelled(in, why) ? VIT_FAILED : measure_frame(&in->entries[i], &opens[i], round, why);
    if (status == VIT_OK && in->between)
        in->between(in->other);
    return status;
}

vit_status timing_measure(const timing_input *in, vit_text *why) {
    opened *opens = calloc(in->count, sizeof *opens);
    vit_status status = VIT_OK;
    if (!opens) {
        return bake_fail(why, VIT_FAILED, "out of memory");
    }
    for (uint32_t i = 0; i < in->count && status == VIT_OK; i++) {
        status = open_entry(in, &in->entries[i], &opens[i], why);
        if (in->progress)
            in->progress(in->user, 0.5 * (i + 1) / in->count);
    }
    for (uint32_t r = 0; r < in->repeats && status == VIT_OK; r++) {
        status = measure_round(in, opens, r, why);
        if (in->progress)
            in->progress(in->user, 0.5 + 0.5 * (r + 1) / in->repeats);
    }
    for (uint32_t i = 0; i < in->count; i++)
        opened_end(&opens[i]);
    free(opens);
    return status;
}
