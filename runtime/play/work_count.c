#include "work_count.h"
#include "failure.h"
#include "pacing.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static void add(work_counts *w, const vit_statistics *s) {
    w->passes = s->pass_count;
    w->kinds = s->work_count;
    w->lanes = s->lanes;
    memcpy(w->pass_names, s->pass_names, sizeof w->pass_names);
    memcpy(w->kind_names, s->work_names, sizeof w->kind_names);
    memcpy(w->same, s->work_same, sizeof w->same);
    for (uint32_t p = 0; p < s->pass_count; p++)
        for (uint32_t k = 0; k < s->work_count; k++) {
            uint64_t n = s->pass_work[p][k];
            w->sum[p][k] += n;
            if (n > w->max[p][k])
                w->max[p][k] = n;
        }
    w->last = *s;
    w->frames++;
}

static vit_status count_frame(vit *v, uint32_t index, report *progress, work_counts *out, vit_text *why) {
    vit_statistics s;
    double began = pacing_now_ms();
    vit_status status = vit_frame(v, index, NULL, 0, why);
    if (status == VIT_OK)
        status = vit_stats(v, &s, why);
    if (status != VIT_OK)
        return status;
    add(out, &s);
    return report_frame(progress, v, pacing_now_ms() - began, why);
}

static vit_status count_frames(vit *v, bool progress, const volatile sig_atomic_t *stop, work_counts *out, vit_text *why) {
    report r;
    vit_status status = report_begin(&r, out->end - out->first, 0, progress, why);
    for (uint32_t i = out->first; i < out->end && status == VIT_OK && !*stop; i++) {
        status = count_frame(v, i, &r, out, why);
        if (status == VIT_OK)
            report_progress(&r, out->frames, out->end - out->first);
    }
    report_progress_clear(&r);
    report_free(&r);
    return status;
}

vit_status work_count(const vit_open_info *how, uint32_t first, uint32_t end, bool progress, const volatile sig_atomic_t *stop,
                      work_counts *out, vit_text *why) {
    vit_open_info info = *how;
    vit_requirements need;
    vit *v;
    *out = (work_counts){.first = first, .end = end};
    info.count_work = 1;
    info.profile = 0;
    info.framebuffer = NULL;
    vit_status status = vit_require(&info, &need, why);
    if (status != VIT_OK)
        return status;
    info.arena_size = (need.host_bytes + 63) / 64 * 64;
    info.arena = aligned_alloc(64, info.arena_size);
    if (info.arena == NULL)
        return play_fail(why, VIT_FAILED, "out of memory: %zu bytes for the library's arena", info.arena_size);
    status = vit_open(&info, &v, why);
    if (status == VIT_OK)
        status = count_frames(v, progress, stop, out, why);
    vit_close(v);
    free(info.arena);
    return status;
}

void work_print(const work_counts *w, FILE *to) {
    (void)fprintf(to, "\n%-18s %-18s %18s %18s\n", "pass", "work", "mean of a frame", "most of a frame");
    for (uint32_t p = 0; p < w->passes; p++)
        for (uint32_t k = 0; k < w->kinds; k++)
            if (w->sum[p][k] > 0)
                (void)fprintf(to, "%-18s %-18s %18.1f %18" PRIu64 "%s\n", w->pass_names[p], w->kind_names[k],
                              (double)w->sum[p][k] / (double)w->frames, w->max[p][k], w->same[k] ? "" : " *");
    (void)fprintf(to, "* depends on the lanes, here %u; the rest is equal on every device\n", w->lanes);
}
