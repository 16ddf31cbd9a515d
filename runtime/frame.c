/* vit_frame, vit_trace: walks the table and enqueues. One in-order queue, one wait a frame. */
#include "vit.h"
#include <stdio.h>

static vit_status set_varying(vit *v, uint32_t pass, uint32_t level, uint32_t frame, vit_text *why) {
    for (uint32_t i = 0; vit_passes[pass].args[i] != V_END; i++) {
        uint32_t a = vit_passes[pass].args[i];
        if (a != V_frame && a != V_level && a != V_chunks)
            continue;
        uint32_t value = a == V_frame ? frame : a == V_level ? level : vit_pass_chunks(&vit_passes[pass], &v->limits, level);
        cl_int e = clSetKernelArg(v->device.kernels[pass], i, sizeof value, &value);
        if (e != CL_SUCCESS)
            return vit_cl_failed(why, vit_passes[pass].name, e);
    }
    return VIT_OK;
}

/* What a walk over the frame does after each enqueue; NULL: nothing. */
typedef vit_status after_fn(vit *v, uint32_t pass, uint32_t level, void *user, vit_text *why);

static vit_status enqueue(vit *v, uint32_t pass, uint32_t level, uint32_t frame, after_fn *after, void *user, vit_text *why) {
    size_t local, global;
    cl_event *event = NULL;
    vit_pass_size(&vit_passes[pass], v->pack.scene, &v->limits, level, &local, &global);
    vit_status status = set_varying(v, pass, level, frame, why);
    if (status != VIT_OK || global == 0)
        return status;
    if (v->profile && v->enqueued < VIT_MAX_ENQUEUES) {
        v->enqueued_pass[v->enqueued] = pass;
        event = &v->events[v->enqueued];
    }
    cl_int e = clEnqueueNDRangeKernel(v->device.queue, v->device.kernels[pass], 1, NULL, &global, &local, 0, NULL, event);
    if (e != CL_SUCCESS)
        return vit_cl_failed(why, vit_passes[pass].name, e);
    if (event)
        v->enqueued++;
    return after ? after(v, pass, level, user, why) : VIT_OK;
}

/* Work is counted from nothing each frame. */
static vit_status clear_work(vit *v, vit_text *why) {
    static const uint32_t zero = 0;
    cl_mem work = v->device.buffers[B_work];
    if (!work)
        return VIT_OK;
    size_t bytes = (size_t)vit_buffer_bytes(B_work, v->pack.scene, &v->limits);
    cl_int e = clEnqueueFillBuffer(v->device.queue, work, &zero, sizeof zero, 0, bytes, 0, NULL, NULL);
    return e == CL_SUCCESS ? VIT_OK : vit_cl_failed(why, "clEnqueueFillBuffer", e);
}

/* Rows in order; a run of rows that repeat is walked once a level. */
static vit_status walk(vit *v, uint32_t frame, after_fn *after, void *user, vit_text *why) {
    const vit_scene *s = v->pack.scene;
    if (clear_work(v, why) != VIT_OK)
        return VIT_FAILED;
    for (uint32_t p = 0, end; p < vit_pass_count; p = end) {
        end = p + 1;
        while (vit_passes[p].repeat != ONCE && vit_passes[p].repeat != UPWARD && end < vit_pass_count &&
               (vit_passes[end].repeat == LISTED || vit_passes[end].repeat == LAST))
            end++;
        uint32_t levels = vit_passes[p].repeat == ONCE ? 1 : s->levels;
        for (uint32_t i = 0; i < levels; i++) {
            uint32_t level = vit_passes[p].repeat == UPWARD ? levels - 1 - i : i;
            for (uint32_t row = p; row < end; row++) {
                if (!v->device.kernels[row] || !vit_pass_at_level(&vit_passes[row], s, &v->limits, level))
                    continue;
                vit_status status = enqueue(v, row, level, frame, after, user, why);
                if (status != VIT_OK)
                    return status;
            }
        }
    }
    return VIT_OK;
}

/* Times of the frame before, and its events given back. */
static void collect_times(vit *v) {
    for (uint32_t p = 0; p < VIT_MAX_PASSES; p++)
        v->pass_ms[p] = 0;
    for (uint32_t i = 0; i < v->enqueued; i++) {
        cl_ulong begin = 0, end = 0;
        clGetEventProfilingInfo(v->events[i], CL_PROFILING_COMMAND_START, sizeof begin, &begin, NULL);
        clGetEventProfilingInfo(v->events[i], CL_PROFILING_COMMAND_END, sizeof end, &end, NULL);
        v->pass_ms[v->enqueued_pass[i]] += (double)(end - begin) * 1e-6;
        clReleaseEvent(v->events[i]);
    }
    v->enqueued = 0;
}

/* The frame is in the caller's memory already: mapping waits for it and says that the host may look. */
static cl_int show_in_place(vit *v, size_t bytes) {
    cl_int e;
    cl_mem b = v->device.buffers[B_framebuffer];
    void *at = clEnqueueMapBuffer(v->device.queue, b, CL_TRUE, CL_MAP_READ, 0, bytes, 0, NULL, NULL, &e);
    return e == CL_SUCCESS ? clEnqueueUnmapMemObject(v->device.queue, b, at, 0, NULL, NULL) : e;
}

static vit_status read_frame(vit *v, void *framebuffer, size_t stride, vit_text *why) {
    const vit_scene *s = v->pack.scene;
    size_t row = (size_t)s->width * vit_format_bytes(v->limits.format), zero[3] = {0, 0, 0}, region[3] = {row, s->height, 1};
    cl_int e;
    if (!framebuffer)
        e = clFinish(v->device.queue);
    else if (framebuffer == v->in_place && stride == row)
        e = show_in_place(v, row * s->height);
    else if (stride == row)
        e = clEnqueueReadBuffer(v->device.queue, v->device.buffers[B_framebuffer], CL_TRUE, 0, row * s->height, framebuffer, 0, NULL, NULL);
    else
        e = clEnqueueReadBufferRect(v->device.queue, v->device.buffers[B_framebuffer], CL_TRUE, zero, zero, region, row, 0, stride, 0, framebuffer,
                                    0, NULL, NULL);
    return e == CL_SUCCESS ? VIT_OK : vit_cl_failed(why, "reading the frame", e);
}

static vit_status check_index(const vit *v, uint32_t index, vit_text *why) {
    if (index < v->pack.scene->frames)
        return VIT_OK;
    snprintf(why->text, sizeof why->text, "there is no frame %u, only 0 to %u", index, v->pack.scene->frames - 1);
    return VIT_USAGE;
}

vit_status vit_frame(vit *v, uint32_t index, void *framebuffer, size_t stride, vit_text *why) {
    vit_status status = check_index(v, index, why);
    if (status == VIT_OK && framebuffer && stride < (size_t)v->pack.scene->width * vit_format_bytes(v->limits.format)) {
        snprintf(why->text, sizeof why->text, "stride %zu is less than a row", stride);
        status = VIT_USAGE;
    }
    if (status == VIT_OK)
        status = walk(v, index, NULL, NULL, why);
    if (status == VIT_OK)
        status = read_frame(v, framebuffer, stride, why);
    if (v->profile)
        collect_times(v);
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

static vit_status trace_pass(vit *v, uint32_t pass, uint32_t level, void *user, vit_text *why) {
    trace *t = user;
    for (uint32_t b = 0; b < B_COUNT; b++) {
        uint64_t bytes = vit_buffer_bytes(b, v->pack.scene, &v->limits);
        if (!(vit_passes[pass].writes >> b & 1) || bytes == 0)
            continue;
        if (bytes > t->size) {
            snprintf(why->text, sizeof why->text, "trace: the scratch must hold buffer %s, %llu bytes", vit_buffer_names[b], (unsigned long long)bytes);
            return VIT_USAGE;
        }
        cl_int e = clEnqueueReadBuffer(v->device.queue, v->device.buffers[b], CL_TRUE, 0, (size_t)bytes, t->scratch, 0, NULL, NULL);
        if (e != CL_SUCCESS)
            return vit_cl_failed(why, "reading a buffer", e);
        char name[96];
        if (vit_passes[pass].repeat == ONCE)
            snprintf(name, sizeof name, "%s.%s", vit_passes[pass].name, vit_buffer_names[b]);
        else
            snprintf(name, sizeof name, "%s[%u].%s", vit_passes[pass].name, level, vit_buffer_names[b]);
        t->pass(t->user, name, vit_hash(t->scratch, (size_t)bytes));
    }
    return VIT_OK;
}

vit_status vit_trace(vit *v, uint32_t index, void *scratch, size_t scratch_size, vit_trace_fn *pass, void *user, vit_text *why) {
    trace t = {scratch, scratch_size, pass, user};
    vit_status status = check_index(v, index, why);
    if (status == VIT_OK)
        status = walk(v, index, trace_pass, &t, why);
    if (v->profile)
        collect_times(v);
    if (status == VIT_OK)
        v->frames++;
    return status;
}
