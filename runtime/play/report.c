#include "report.h"
#include "failure.h"
#include "pacing.h"
#include "vitrine_pack.h" /* VIT_EFFECTS, the one list of effects; nothing else of the pack is looked at */
#include <inttypes.h>
#include <stdlib.h>

#define ROOM_MAX 4096           /* frames that medians are over, at most */
#define PROGRESS_EVERY_MS 100.0 /* a terminal needs no more */

vit_status report_begin(report *r, uint64_t frames, uint32_t passes, bool progress, vit_text *why) {
    *r = (report){.passes = passes, .room = frames < ROOM_MAX ? (uint32_t)frames : ROOM_MAX, .progress = progress};
    r->frame_ms = calloc((size_t)r->room * (passes + 2), sizeof *r->frame_ms);
    if (r->frame_ms == NULL)
        return play_fail(why, VIT_FAILED, "out of memory for the report");
    r->sorted = r->frame_ms + r->room;
    r->pass_ms = r->sorted + r->room;
    r->began_ms = pacing_now_ms();
    return VIT_OK;
}

void report_free(report *r) {
    free(r->frame_ms);
    *r = (report){0};
}

vit_status report_frame(report *r, vit *v, double ms, vit_text *why) {
    size_t slot = (size_t)(r->frames % r->room);
    r->frame_ms[slot] = ms;
    if (r->passes != 0) {
        vit_statistics s;
        vit_status status = vit_stats(v, &s, why);
        if (status != VIT_OK)
            return status;
        for (uint32_t i = 0; i < r->passes && i < s.pass_count; i++)
            r->pass_ms[(size_t)i * r->room + slot] = s.pass_ms[i];
    }
    r->frames++;
    return VIT_OK;
}

void report_progress(report *r, uint64_t done, uint64_t all) {
    double now = pacing_now_ms();
    if (!r->progress || (done != all && now - r->drawn_ms < PROGRESS_EVERY_MS))
        return;
    double rate = (double)r->frames * 1e3 / (now - r->began_ms + 1e-6);
    if (all == UINT64_MAX)
        (void)fprintf(stderr, "\rframe %" PRIu64 ", %.1f a second\033[K", done, rate);
    else
        (void)fprintf(stderr, "\rframe %" PRIu64 " of %" PRIu64 ", %.1f a second, %.0f s left\033[K", done, all, rate,
                      (double)(all - done) / rate);
    (void)fflush(stderr);
    r->drawn_ms = now;
}

void report_progress_clear(report *r) {
    if (r->drawn_ms > 0)
        (void)fputs("\r\033[K", stderr);
    r->drawn_ms = 0;
}

size_t report_timed(const report *r) {
    return r->frames < r->room ? (size_t)r->frames : r->room;
}

times report_frame_times(const report *r) {
    return times_of(r->frame_ms, report_timed(r), r->sorted);
}

times report_pass_times(const report *r, uint32_t pass) {
    return times_of(r->pass_ms + (size_t)pass * r->room, report_timed(r), r->sorted);
}

static double mib(uint64_t bytes) {
    return (double)bytes / (1024.0 * 1024.0);
}

static void print_times(const char *name, const times *t, FILE *to) {
    (void)fprintf(to, "%-28s %10.3f %10.3f %10.3f %10.3f %10.3f", name, t->p50, t->p95, t->p99, t->max, t->mad);
}

static void print_passes(const report *r, const vit_requirements *need, FILE *to) {
    double sum = 0;
    for (uint32_t i = 0; i < r->passes; i++)
        sum += report_pass_times(r, i).p50;
    (void)fprintf(to, "%-28s %10s %10s %10s %10s %10s %7s\n", "pass, ms", "median", "p95", "p99", "max", "deviation", "share");
    for (uint32_t i = 0; i < r->passes; i++) {
        times t = report_pass_times(r, i);
        print_times(need->passes[i], &t, to);
        (void)fprintf(to, " %6.1f%%\n", sum > 0 ? 100 * t.p50 / sum : 0);
    }
    times frame = report_frame_times(r);
    (void)fprintf(to, "%-28s %10.3f\n", "sum of passes", sum);
    print_times("frame, seen from the host", &frame, to);
    (void)fputs("\n\n", to);
}

static void print_buffers(const vit_requirements *need, FILE *to) {
    (void)fprintf(to, "%-28s %14s %10s  %s\n", "buffer", "bytes", "MiB", "called for by");
    for (uint32_t i = 0; i < need->buffer_count; i++) {
        const vit_buffer_info *b = &need->buffers[i];
        (void)fprintf(to, "%-28s %14" PRIu64 " %10.2f  %s\n", b->name, b->bytes, mib(b->bytes), b->effect);
    }
    (void)fprintf(to, "%-28s %14" PRIu64 " %10.2f\n", "device, total", need->device_bytes, mib(need->device_bytes));
    (void)fprintf(to, "%-28s %14zu %10.2f  the library's arena\n", "host, arena", need->host_bytes, mib(need->host_bytes));
    (void)fprintf(to, "%-28s %14zu %10.2f  the finished frame\n", "host, framebuffer", need->frame_bytes,
                  mib(need->frame_bytes));
}

void report_print(const report *r, const vit_requirements *need, const vit_statistics *s, uint64_t late, bool paced, FILE *to) {
    print_passes(r, need, to);
    print_buffers(need, to);
    (void)fprintf(to, "\nindirect light: %s\n", s->indirect ? s->indirect : "none");
    (void)fprintf(to,
                  "last frame: %u hierarchy nodes, %u clusters, %u photons, %u list entries, %u photon-cluster pairs, "
                  "%u photons in the fullest cluster\n",
                  s->nodes, s->clusters, s->photons, s->list, s->pairs, s->largest);
    if (paced)
        (void)fprintf(to, "late frames: %" PRIu64 " of %" PRIu64 "\n", late, r->frames);
}

void report_closing(const report *r, const char *device, const char *end, FILE *to) {
    double seconds = (pacing_now_ms() - r->began_ms) * 1e-3;
    (void)fprintf(to, "%" PRIu64 " %s in %.2f s, %.2f ms a frame (median) on %s%s\n", r->frames,
                  r->frames == 1 ? "frame" : "frames", seconds, report_frame_times(r).p50, device, end);
}

void report_dropped(const vit_statistics *s, FILE *to) {
    if (s->dropped_samples == 0 && s->dropped_entries == 0)
        return;
    (void)fprintf(to,
                  "vitrine-play: bounds were too small: %" PRIu64 " view samples and %" PRIu64
                  " list entries were dropped (the frames wanted up to %u nodes and %u list entries)\n",
                  s->dropped_samples, s->dropped_entries, s->max_nodes, s->max_list);
}

void report_faults(vit *v, FILE *to) {
    vit_fault f[VIT_MAX_FAULTS];
    uint32_t count;
    int lost;
    vit_text why;
    (void)vit_faults(v, f, &count, &lost, &why); /* the host's own are there in any case */
    if (lost)
        (void)fprintf(to, "vitrine-play: faults before these are not kept\n");
    for (uint32_t i = 0; i < count; i++)
        (void)fprintf(to, "vitrine-play: %s: frame %u%s%s: %s (%s, %" PRIu64 ")\n", f[i].level, f[i].frame,
                      f[i].pass ? ", " : "", f[i].pass ? f[i].pass : "", f[i].meaning, f[i].code, f[i].count);
}

static void print_effects(uint64_t effects, FILE *to) {
    static const struct {
        uint64_t bit;
        const char *name, *why;
    } rows[] = {
#define X(bit, name, macro, why) {(uint64_t)1 << bit, name, why},
        VIT_EFFECTS(X)
#undef X
    };
    (void)fputs("\neffects\n", to);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (effects & rows[i].bit)
            (void)fprintf(to, "  %-24s %s\n", rows[i].name, rows[i].why);
    if (effects == 0)
        (void)fputs("  none\n", to);
}

void report_explain(const char *file, size_t pack_bytes, const vit_requirements *need, FILE *to) {
    double fps = (double)need->fps;
    (void)fprintf(to, "%s: %ux%u, %u %s at %g a second (%.2f s), %zu bytes\n", file, need->width, need->height, need->frames,
                  need->frames == 1 ? "frame" : "frames", fps, fps > 0 ? need->frames / fps : 0, pack_bytes);
    print_effects(need->effects, to);
    (void)fputs("\npasses of a frame, in order\n", to);
    for (uint32_t i = 0; i < need->pass_count; i++)
        (void)fprintf(to, "  %2u %s\n", i + 1, need->passes[i]);
    (void)fputc('\n', to);
    print_buffers(need, to);
}
