/* Times of all settings: in turns, as many open at once as the memory allows, the default in every batch. */
#include "cost/sweep_parts.h"
#include "common/fail.h"
#include "cost/timing.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PATH_TRACED SWEEP_LEAST_REPEATS

/* What is open at once: the default first. */
typedef struct batch {
    const uint32_t *setting; /* an entry: its setting */
    uint32_t count;
    timing_entry *entries;
    double *ms; /* repeats a setting */
    double *pass_ms;
} batch;

static uint64_t bytes_of(const cost_setting *c) {
    return c->device_bytes + c->pack_bytes;
}

static uint32_t settings_timed(const sweep *s) {
    return s->in->timed > 0 && s->in->timed < s->out->count ? s->in->timed : s->out->count;
}

/* At least one setting beside the default. */
static uint32_t batch_end(const sweep *s, uint32_t first) {
    uint64_t bytes = bytes_of(&s->out->settings[0]);
    uint32_t end = first;
    while (end < settings_timed(s) && (end == first || bytes + bytes_of(&s->out->settings[end]) <= s->in->memory))
        bytes += bytes_of(&s->out->settings[end++]);
    return end;
}

static void batch_free(batch *b) {
    free(b->entries);
    free(b->ms);
    free(b->pass_ms);
}

static vit_status batch_fill(sweep *s, batch *b, vit_text *why) {
    const size_t most = b->count, repeats = s->in->repeats;
    b->entries = calloc(most, sizeof *b->entries);
    b->ms = calloc(most * repeats, sizeof *b->ms);
    b->pass_ms = calloc(most * repeats * VIT_MAX_PASSES, sizeof *b->pass_ms);
    if (!b->entries || !b->ms || !b->pass_ms) {
        return bake_fail(why, VIT_FAILED, "out of memory");
    }
    for (uint32_t k = 0; k < b->count; k++) {
        const uint32_t i = b->setting[k];
        vit_status status = sweep_take_pack(s, i, why);
        if (status != VIT_OK)
            return status;
        b->entries[k] = (timing_entry){.name = s->knobs.settings[i].name,
                                       .pack = s->packs[i].bytes,
                                       .pack_size = s->packs[i].size,
                                       .lanes = s->knobs.settings[i].lanes,
                                       .ms = b->ms + k * repeats,
                                       .pass_ms = b->pass_ms + k * repeats * VIT_MAX_PASSES};
    }
    return VIT_OK;
}

/* Drift between batches: all times of one are multiplied by what makes its default as fast as the first batch's. */
static void note_times(sweep *s, const batch *b, uint32_t entry, double scale) {
    const timing_entry *e = &b->entries[entry];
    cost_setting *c = &s->out->settings[b->setting[entry]];
    const uint32_t n = s->in->repeats;
    double *pass = calloc(n, sizeof *pass);
    for (uint32_t p = 0; pass && p < e->pass_count; p++) {
        for (uint32_t r = 0; r < n; r++)
            pass[r] = e->pass_ms[(size_t)r * VIT_MAX_PASSES + p];
        c->pass_ms[p] = scale * timing_median(pass, n);
        (void)snprintf(c->pass_names[p], sizeof c->pass_names[p], "%s", e->pass_names[p]);
    }
    free(pass);
    c->pass_count = e->pass_count;
    c->timed = n;
    c->ms = scale * timing_median(e->ms, n);
    c->ms_p95 = scale * timing_percentile(e->ms, n, 95);
    c->ms_mad = scale * timing_deviation(e->ms, n); /* last: it changes the values */
}

static void step(void *user, double fraction) {
    progress_step(user, fraction);
}

/* The reference's path tracer, one path a pixel, timed in turn with the settings. */
typedef struct tracer {
    reference_timer *timer;
    double *ms;          /* PATH_TRACED values */
    double nmse, relmse; /* sums over them */
    uint32_t count;
} tracer;

static void trace_frame(void *other) {
    tracer *t = other;
    if (t->count == PATH_TRACED) /* they take long, and vary little */
        return;
    const reference_timing one = reference_timer_frame(t->timer);
    t->ms[t->count++] = one.ms;
    t->nmse += one.nmse;
    t->relmse += one.relmse;
}

static vit_status time_batch(sweep *s, batch *b, tracer *traced, vit_text *why) {
    char label[64];
    vit_status status = batch_fill(s, b, why);
    if (status != VIT_OK)
        return status;
    snprintf(label, sizeof label, b->count > 1 ? "times: settings %u to %u" : "times: the default", b->setting[b->count > 1],
             b->setting[b->count - 1]);
    progress_stage(s->progress, label);
    const timing_input in = {.entries = b->entries,
                             .count = b->count,
                             .device = s->in->device,
                             .repeats = s->in->repeats,
                             .progress = step,
                             .user = s->progress,
                             .between = traced ? trace_frame : NULL,
                             .other = traced,
                             .cancel = s->in->cancel};
    status = timing_measure(&in, why);
    progress_end(s->progress);
    if (status != VIT_OK)
        return status;
    const bool anchored = s->out->settings[0].timed > 0;
    double scale = 1;
    if (anchored)
        scale = s->out->settings[0].ms / timing_median(b->entries[0].ms, s->in->repeats);
    for (uint32_t i = anchored ? 1 : 0; i < b->count; i++)
        note_times(s, b, i, scale);
    return VIT_OK;
}

static vit_status time_list(sweep *s, const uint32_t *list, uint32_t count, tracer *traced, vit_text *why) {
    batch b = {.setting = list, .count = count};
    vit_status status = time_batch(s, &b, traced, why);
    for (uint32_t k = 1; k < count; k++)
        sweep_drop_pack(s, list[k]);
    batch_free(&b);
    return status;
}

vit_status sweep_time_some(sweep *s, const uint32_t *list, uint32_t count, vit_text *why) {
    return time_list(s, list, count, NULL, why);
}

static vit_status time_batches(sweep *s, tracer *traced, vit_text *why) {
    uint32_t *list = calloc(s->out->count, sizeof *list);
    vit_status status = VIT_OK;
    if (!list)
        return bake_fail(why, VIT_FAILED, "out of memory");
    for (uint32_t first = 1; status == VIT_OK && (first == 1 || first < settings_timed(s));) {
        const uint32_t end = batch_end(s, first);
        for (uint32_t i = first; i < end; i++)
            list[1 + i - first] = i;
        status = time_list(s, list, 1 + end - first, traced, why);
        first = end > first ? end : first + 1;
    }
    free(list);
    return status;
}

vit_status sweep_times(sweep *s, vit_text *why) {
    double ms[PATH_TRACED];
    tracer traced = {.ms = ms};
    vit_status status = reference_timer_open(&s->truth, &s->out->reference, &traced.timer, why);
    if (status != VIT_OK)
        return status;
    status = time_batches(s, &traced, why);
    reference_timer_close(traced.timer);
    if (status == VIT_OK && traced.count > 0) {
        s->out->path_tracer_ms = timing_median(ms, traced.count);
        s->out->path_tracer_nmse = traced.nmse / traced.count;
        s->out->path_tracer_relmse = traced.relmse / traced.count;
    }
    return status;
}
