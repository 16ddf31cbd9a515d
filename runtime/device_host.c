/* The device `host`: the kernels compiled as C (host/kernels.c), run by threads. Buffers lie in the caller's arena, the pack's
 * sections are used where vit_pack has them. Work-groups are single work-items, so nothing waits within a pass. */
#include "device.h"
#include "fail.h"
#include "host/host.h"
#include "host/pool.h"
#include <stdio.h>
#include <string.h>
#include <time.h>

typedef struct host_device {
    const vit_scene *scene;
    const vit_launch *launch;
    const host_program *program;
    host_call call;
    host_pool pool;
    int profile, opened;
    double pass_ms[VIT_MAX_PASSES];
} host_device;

const char *vit_host_name(vit_text *why) {
    snprintf(why->text, sizeof why->text, "Vitrine / kernels as C, %s / " VIT_VERSION, vit_host_isa(0));
    return why->text;
}

static size_t round_up(uint64_t bytes) {
    return (size_t)((bytes + 63) / 64 * 64);
}

/* Is the buffer neither a section nor the caller's framebuffer? */
static int is_own(uint32_t b, int in_place) {
    return vit_buffer_sections[b] == VIT_SECTION_NONE && !(b == B_framebuffer && in_place);
}

static size_t memory_bytes(const vit_scene *s, const vit_launch *l, int in_place) {
    uint64_t sum = 0; /* of less than 2^6 buffers, each less than 2^40 */
    for (uint32_t b = 0; b < B_COUNT; b++)
        sum += is_own(b, in_place) ? round_up(vit_buffer_bytes(b, s, l)) : 0;
    return sum <= SIZE_MAX / 2 ? (size_t)sum : SIZE_MAX;
}

static void list_isas(vit_text *why) {
    size_t n = strlen(why->text);
    const char *isa;
    for (uint32_t i = 0; (isa = vit_host_isa(i)) != NULL && n < sizeof why->text; i++)
        n += (size_t)snprintf(why->text + n, sizeof why->text - n, "%s%s", i == 0 ? "" : ", ", isa);
}

static vit_status suit(const vit_open_info *info, const vit_scene *s, vit_launch *l, vit_text *why) {
    const host_program *program = vit_host_find(info->host_isa, l->lanes);
    if (info->wide_divide)
        return vit_fail(why, VIT_USAGE, "device host: wide_divide is for devices of OpenCL");
    if (!program) {
        char lanes[32] = "";
        if (l->lanes > 0)
            snprintf(lanes, sizeof lanes, " with %u lanes", l->lanes);
        snprintf(why->text, sizeof why->text,
                 "device host: no kernels for '%.60s'%s here; there are: ", info->host_isa ? info->host_isa : "this machine",
                 lanes);
        list_isas(why);
        return VIT_USAGE;
    }
    l->lanes = program->lanes;
    l->group = l->scan_group = l->splat_group = 1;
    l->run = s->tile * s->tile;
    l->chunks = 16;
    return VIT_OK;
}

/* Buffers in the order of their table. */
static void place_buffers(host_device *d, const vit_device_setup *setup) {
    char *at = setup->memory;
    void *framebuffer = setup->info->framebuffer;
    for (uint32_t b = 0; b < B_COUNT; b++) {
        size_t bytes = (size_t)vit_buffer_bytes(b, d->scene, d->launch);
        vit_section section = vit_buffer_sections[b];
        if (bytes == 0)
            continue;
        if (section != VIT_SECTION_NONE)
            d->call.buffers[b] = (void *)(uintptr_t)setup->pack->section[section];
        else if (is_own(b, framebuffer != NULL)) {
            d->call.buffers[b] = at;
            at += round_up(bytes);
        } else
            d->call.buffers[b] = framebuffer;
        if (section == VIT_SECTION_NONE &&
            b != B_framebuffer) /* each frame writes all pixels, and what lies between rows is not ours */
            memset(d->call.buffers[b], 0, bytes);
    }
}

static vit_status open_device(const vit_device_setup *setup, vit_text *why) {
    host_device *d = setup->state;
    const vit_launch *l = setup->launch;
    const vit_scene *s = d->scene = setup->pack->scene;
    d->launch = l;
    d->profile = setup->info->profile != 0;
    d->program = vit_host_find(setup->info->host_isa, l->lanes);
    d->call = (host_call){.run = l->run,
                          .max_nodes = l->max_nodes,
                          .max_list = l->max_list,
                          .layers = l->layers,
                          .pitch = l->pitch,
                          .effects = l->effects,
                          .view = l->view,
                          .format = l->format};
    place_buffers(d, setup);
    if (s->baked > 0 && d->call.buffers[B_photons])
        memcpy((vit_photon *)d->call.buffers[B_photons] + (s->photons - s->baked), setup->pack->section[VIT_SECTION_PHOT],
               s->baked * sizeof(vit_photon));
    vit_status status = vit_host_pool_open(&d->pool, setup->info->threads, why);
    d->opened = status == VIT_OK;
    return status;
}

static void close_device(void *state) {
    host_device *d = state;
    if (d->opened)
        vit_host_pool_close(&d->pool);
    d->opened = 0;
}

static void run_items(void *user, size_t first, size_t count) {
    const host_device *d = user;
    d->program->run(&d->call, first, count);
}

static double now_ms(void) {
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static vit_status run(void *state, const vit_step *step, vit_text *why) {
    host_device *d = state;
    const vit_pass *p = &vit_passes[step->pass];
    double began = d->profile ? now_ms() : 0;
    size_t local, items;
    (void)why;
    vit_pass_size(p, d->scene, d->launch, step->level, &local, &items);
    d->call.pass = step->pass;
    d->call.level = step->level;
    d->call.frame = step->frame;
    d->call.round = step->round;
    d->call.chunks = vit_pass_chunks(p, d->launch, step->level);
    vit_host_pool_run(&d->pool, run_items, d, items);
    if (d->profile)
        d->pass_ms[step->pass] += now_ms() - began;
    return VIT_OK;
}

static vit_status clear(void *state, vit_buffer b, vit_text *why) {
    host_device *d = state;
    (void)why;
    memset(d->call.buffers[b], 0, (size_t)vit_buffer_bytes(b, d->scene, d->launch));
    return VIT_OK;
}

static vit_status read_buffer(void *state, vit_buffer b, size_t bytes, void *out, vit_text *why) {
    const host_device *d = state;
    (void)why;
    memcpy(out, d->call.buffers[b], bytes);
    return VIT_OK;
}

static vit_status show(void *state, void *framebuffer, size_t stride, vit_text *why) {
    const host_device *d = state;
    const char *from = d->call.buffers[B_framebuffer];
    const size_t row = vit_row_bytes(d->scene, d->launch), pitch = vit_pitch_bytes(d->launch);
    (void)why;
    if (!framebuffer || (framebuffer == from && stride == pitch))
        return VIT_OK;
    for (size_t y = 0; y < d->scene->height; y++)
        memmove((char *)framebuffer + y * stride, from + y * pitch, row);
    return VIT_OK;
}

static void times(void *state, double *pass_ms) {
    host_device *d = state;
    memcpy(pass_ms, d->pass_ms, sizeof d->pass_ms);
    memset(d->pass_ms, 0, sizeof d->pass_ms);
}

const vit_device vit_device_host = {sizeof(host_device), memory_bytes, suit, open_device, close_device, NULL, run, clear,
                                    read_buffer,         show,         times};
