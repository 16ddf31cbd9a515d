/* vit_frame, vit_trace: walks the table, in order, and waits once a frame. */
#include "byte_order.h"
#include "fail.h"
#include "vit.h"
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* What a walk over the frame does after each pass; NULL: nothing. */
typedef vit_status after_fn(vit *v, const vit_step *step, void *user, vit_text *why);

static vit_status run_step(vit *v, const vit_step *step, after_fn *after, void *user, vit_text *why) {
    vit_status status = v->device->run(v->state, step, why);
    if (status != VIT_OK)
        vit_note_fault(v, step->pass, step->frame);
    if (status == VIT_OK && after)
        status = after(v, step, user, why);
    return status;
}

/* Rows in order; a run of rows that repeat is walked once a level. */
static vit_status walk_round(vit *v, uint32_t frame, uint32_t round, after_fn *after, void *user, vit_text *why) {
    const vit_scene *s = v->pack.scene;
    for (uint32_t p = 0, end; p < vit_pass_count; p = end) {
        end = p + 1;
        while (vit_passes[p].repeat != ONCE && vit_passes[p].repeat != UPWARD && end < vit_pass_count &&
               (vit_passes[end].repeat == LISTED || vit_passes[end].repeat == LAST))
            end++;
        uint32_t levels = vit_passes[p].repeat == ONCE ? 1 : s->levels;
        for (uint32_t i = 0; i < levels; i++) {
            uint32_t level = vit_passes[p].repeat == UPWARD ? levels - 1 - i : i;
            for (uint32_t row = p; row < end; row++) {
                const vit_pass *pass = &vit_passes[row];
                if (!vit_pass_called(row, &v->launch) || !vit_pass_at_level(pass, s, &v->launch, level) ||
                    !vit_pass_in_round(pass, &v->launch, round))
                    continue;
                vit_status status = run_step(v, &(vit_step){row, level, frame, round}, after, user, why);
                if (status != VIT_OK)
                    return status;
            }
        }
    }
    return VIT_OK;
}

/* The cache's share of a frame that is not shown. */
static vit_status replay(vit *v, uint32_t frame, uint64_t rows, vit_text *why) {
    for (uint32_t row = 0; row < vit_pass_count; row++) {
        const vit_status status = rows >> row & 1 ? run_step(v, &(vit_step){row, 0, frame, 0}, NULL, NULL, why) : VIT_OK;
        if (status != VIT_OK)
            return status;
    }
    return VIT_OK;
}

/* A frame has what all frames before it left, and nothing else, whatever was played before: where that is not at hand, their
 * passes of the cache run again. */
static vit_status bring_history(vit *v, uint32_t frame, vit_text *why) {
    vit_status status = VIT_OK;
    const bool there = v->history == frame;
    v->history = VIT_NONE; /* until the frame is done */
    if (there)
        return VIT_OK;
    for (uint32_t b = 0; b < B_COUNT && status == VIT_OK; b++)
        if (vit_buffer_of_history(b))
            status = v->device->clear(v->state, (vit_buffer)b, why);
    const uint64_t rows = vit_passes_of_history(&v->launch);
    for (uint32_t f = 0; f < frame && status == VIT_OK; f++)
        status = replay(v, f, rows, why);
    return status;
}

static vit_status walk(vit *v, uint32_t frame, after_fn *after, void *user, vit_text *why) {
    const bool live = v->launch.effects & ON(LIVE_CACHE);
    vit_status status = live ? bring_history(v, frame, why) : VIT_OK;
    if (status == VIT_OK && (v->launch.effects & ON_WORK)) /* counted from nothing each frame */
        status = v->device->clear(v->state, B_work, why);
    if (status == VIT_OK && (v->launch.effects & ON_REACH))
        status = v->device->clear(v->state, B_reached, why);
    for (uint32_t round = 0; round < v->launch.rounds && status == VIT_OK; round++)
        status = walk_round(v, frame, round, after, user, why);
    if (status == VIT_OK && live)
        v->history = frame + 1;
    return status;
}

vit_status vit_walk(vit *v, uint32_t frame, vit_text *why) {
    return walk(v, frame, NULL, NULL, why);
}

static vit_status check_index(const vit *v, uint32_t index, vit_text *why) {
    if (index < v->pack.scene->frames)
        return VIT_OK;
    return vit_fail(why, VIT_USAGE, "there is no frame %u, only 0 to %u", index, v->pack.scene->frames - 1);
}

vit_status vit_frame(vit *v, uint32_t index, void *framebuffer, size_t stride, vit_text *why) {
    vit_text unused = {""};
    why = why ? why : &unused;
    vit_status status = check_index(v, index, why);
    if (status == VIT_OK && framebuffer && stride < vit_row_bytes(v->pack.scene, &v->launch))
        status = vit_fail(why, VIT_USAGE, "stride %zu is less than a row", stride);
    if (status == VIT_OK)
        status = vit_walk(v, index, why);
    if (status == VIT_OK && (status = v->device->show(v->state, framebuffer, stride, why)) != VIT_OK)
        vit_note_fault(v, VIT_MAX_PASSES, index);
    if (v->profile)
        v->device->times(v->state, v->pass_ms);
    if (status == VIT_OK)
        v->frames++;
    return status;
}

typedef struct trace {
    void *scratch;
    size_t size;
    vit_trace_fn *pass;
    void *user;
} trace;

/* Rows one behind another: what lies between those of the caller's framebuffer is nobody's. Returns bytes. */
static size_t pack_rows(const vit *v, char *pixels) {
    const size_t row = vit_row_bytes(v->pack.scene, &v->launch), pitch = vit_pitch_bytes(&v->launch);
    for (size_t y = 1; y < v->pack.scene->height && pitch != row; y++)
        memmove(pixels + y * row, pixels + y * pitch, row);
    return row * v->pack.scene->height;
}

static vit_status trace_pass(vit *v, const vit_step *step, void *user, vit_text *why) {
    trace *t = user;
    const vit_pass *pass = &vit_passes[step->pass];
    for (uint32_t b = B_FIRST_WRITTEN; b < B_COUNT; b++) {
        uint64_t bytes = vit_buffer_bytes(b, v->pack.scene, &v->launch);
        if (!(pass->writes >> (b - B_FIRST_WRITTEN) & 1) || bytes == 0)
            continue;
        if (bytes > t->size)
            return vit_fail(why, VIT_USAGE, "trace: the scratch must hold buffer %s, %llu bytes", vit_buffer_names[b],
                            (unsigned long long)bytes);
        if (v->device->read(v->state, (vit_buffer)b, (size_t)bytes, t->scratch, why) != VIT_OK)
            return VIT_FAILED;
        if (b == B_framebuffer)
            bytes = pack_rows(v, t->scratch);
        char name[96], round[16] = "", level[16] = "";
        if (v->launch.rounds > 1)
            snprintf(round, sizeof round, "{%u}", step->round);
        if (pass->repeat != ONCE)
            snprintf(level, sizeof level, "[%u]", step->level);
        snprintf(name, sizeof name, "%s%s%s.%s", pass->name, round, level, vit_buffer_names[b]);
        t->pass(t->user, name, vit_hash_words(t->scratch, (size_t)bytes, vit_buffer_word(b, &v->launch)));
    }
    return VIT_OK;
}

vit_status vit_trace(vit *v, uint32_t index, void *scratch, size_t scratch_size, vit_trace_fn *pass, void *user,
                     vit_text *why) {
    vit_text unused = {""};
    why = why ? why : &unused;
    trace t = {scratch, scratch_size, pass, user};
    vit_status status = check_index(v, index, why);
    if (status == VIT_OK)
        status = walk(v, index, trace_pass, &t, why);
    if (v->profile)
        v->device->times(v->state, v->pass_ms);
    if (status == VIT_OK)
        v->frames++;
    return status;
}
