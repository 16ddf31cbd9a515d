#include "device_opencl.h"
#include "fail.h"
#include "kernel_sources.h"
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define MAX_PLATFORMS 16
#define MAX_DEVICES 32
#define POCL "Portable Computing Language" /* its platform */

static const char *error_name(cl_int error) {
    switch (error) {
#define E(name)                                                                                                                \
    case name:                                                                                                                 \
        return #name;
        E(CL_DEVICE_NOT_FOUND)
        E(CL_DEVICE_NOT_AVAILABLE)
        E(CL_COMPILER_NOT_AVAILABLE)
        E(CL_MEM_OBJECT_ALLOCATION_FAILURE)
        E(CL_OUT_OF_RESOURCES)
        E(CL_OUT_OF_HOST_MEMORY)
        E(CL_BUILD_PROGRAM_FAILURE)
        E(CL_INVALID_VALUE)
        E(CL_INVALID_BUFFER_SIZE)
        E(CL_INVALID_KERNEL_NAME)
        E(CL_INVALID_KERNEL_ARGS)
        E(CL_INVALID_ARG_INDEX)
        E(CL_INVALID_ARG_SIZE)
        E(CL_INVALID_ARG_VALUE)
        E(CL_INVALID_WORK_GROUP_SIZE)
        E(CL_INVALID_BUILD_OPTIONS)
#undef E
    case -1001: /* CL_PLATFORM_NOT_FOUND_KHR */
        return "no OpenCL platform is installed";
    default:
        return "error";
    }
}

static vit_status failed(vit_text *why, const char *call, cl_int error) {
    return vit_fail(why, VIT_FAILED, "OpenCL: %s: %s (%d)", call, error_name(error), (int)error);
}

static vit_status find(uint32_t index, cl_device_id *id, vit_text *why) {
    cl_platform_id platforms[MAX_PLATFORMS];
    cl_uint platform_count = 0, seen = 0;
    bool pocl = false;
    char without[320] = ""; /* platforms that are installed, but have no device: PoCL without a place for its cache */
    cl_int e = clGetPlatformIDs(MAX_PLATFORMS, platforms, &platform_count);
    if (e != CL_SUCCESS)
        return failed(why, "clGetPlatformIDs", e);
    if (platform_count > MAX_PLATFORMS)
        platform_count = MAX_PLATFORMS;
    for (cl_uint p = 0; p < platform_count; p++) {
        cl_device_id devices[MAX_DEVICES];
        cl_uint count = 0;
        if (clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, MAX_DEVICES, devices, &count) != CL_SUCCESS || count == 0) {
            char name[100] = "?";
            size_t n = strlen(without);
            clGetPlatformInfo(platforms[p], CL_PLATFORM_NAME, sizeof name, name, NULL);
            snprintf(without + n, sizeof without - n, "%s%s", n > 0 ? ", " : "; without a device: ", name);
            pocl = pocl || strstr(name, POCL) != NULL;
            continue;
        }
        if (count > MAX_DEVICES)
            count = MAX_DEVICES;
        if (index < seen + count) {
            *id = devices[index - seen];
            return VIT_OK;
        }
        seen += count;
    }
    const size_t n = strlen(without);
    if (pocl)
        snprintf(without + n, sizeof without - n,
                 " (it has none where it cannot make its cache: set POCL_CACHE_DIR to a folder with room)");
    if (seen > 1)
        return vit_fail(why, VIT_FAILED, "OpenCL: there is no device %u, only 0 to %u, and host%s", index, seen - 1, without);
    return vit_fail(why, VIT_FAILED, "OpenCL: there is no device %u, only %shost%s", index, seen > 0 ? "0 and " : "", without);
}

const char *vit_opencl_name(uint32_t index, vit_text *why) {
    cl_device_id id;
    cl_platform_id platform;
    char names[3][150] = {"?", "?", "?"};
    if (find(index, &id, why) != VIT_OK)
        return NULL;
    if (clGetDeviceInfo(id, CL_DEVICE_PLATFORM, sizeof platform, &platform, NULL) == CL_SUCCESS)
        clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof names[0], names[0], NULL);
    clGetDeviceInfo(id, CL_DEVICE_NAME, sizeof names[1], names[1], NULL);
    clGetDeviceInfo(id, CL_DRIVER_VERSION, sizeof names[2], names[2], NULL);
    snprintf(why->text, sizeof why->text, "%s / %s / %s", names[0], names[1], names[2]);
    return why->text;
}

/* The greatest power of two up to n and 256. */
static uint32_t group_up_to(size_t n) {
    uint32_t group = 256;
    while (group > 1 && group > n)
        group /= 2;
    return group;
}

static uint32_t lesser(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

static vit_status refuse_group(const char *what, uint32_t asked, uint32_t most, vit_text *why) {
    return vit_fail(why, VIT_USAGE, "group %u: %s takes at most %u work-items a work-group on this device (0: what suits)",
                    asked, what, most);
}

int vit_opencl_is(uint32_t index, int gpu) {
    cl_device_id id;
    cl_device_type type = 0;
    vit_text unused = {""};
    if (find(index, &id, &unused) == VIT_OK)
        clGetDeviceInfo(id, CL_DEVICE_TYPE, sizeof type, &type, NULL);
    return (type & (gpu ? CL_DEVICE_TYPE_GPU : CL_DEVICE_TYPE_CPU)) != 0;
}

static vit_status suit(const vit_open_info *info, const vit_scene *s, vit_launch *l, vit_text *why) {
    cl_device_id id;
    cl_device_type type = CL_DEVICE_TYPE_CPU;
    cl_uint width = 8;
    size_t most = 256;
    if (find(info->device, &id, why) != VIT_OK)
        return VIT_FAILED;
    clGetDeviceInfo(id, CL_DEVICE_TYPE, sizeof type, &type, NULL);
    clGetDeviceInfo(id, CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT, sizeof width, &width, NULL);
    clGetDeviceInfo(id, CL_DEVICE_MAX_WORK_GROUP_SIZE, sizeof most, &most, NULL);
    int cpu = (type & CL_DEVICE_TYPE_CPU) != 0;
    const uint32_t top = group_up_to(most);
    if (l->group > top)
        return refuse_group("OpenCL", l->group, top, why);
    if (l->lanes == 0)
        l->lanes = !cpu ? 1 : width >= 16 ? 16 : 8;
    if (l->group > 0) { /* asked for: everywhere the same */
        l->scan_group = l->splat_group = l->group;
    } else {
        l->group = lesser(cpu ? 16 : 64, top);
        l->scan_group = cpu ? 1 : top;
        l->splat_group = lesser(cpu ? 1 : 32, top);
    }
    l->run = cpu ? s->tile * s->tile : 16;
    l->chunks = cpu ? 16 : VIT_CHUNKS;
    return VIT_OK;
}

/* Options of the one program: exactly this effect set, view, format and width. */
static int build_options(char *text, size_t size, const vit_launch *l, int wide_divide) {
    int n = snprintf(text, size,
                     "-cl-std=CL1.2 %s -DVIT_LANES=%u -DVIT_VIEW=%d -DVIT_FORMAT=%d "
                     "-DVIT_COUNT_WORK=%d",
                     wide_divide ? "-DVIT_WIDE_DIVIDE" : "-cl-fp32-correctly-rounded-divide-sqrt", l->lanes, (int)l->view,
                     (int)l->format, (l->effects & ON_WORK) != 0);
#define X(bit, name, macro, why)                                                                                               \
    n += snprintf(text + n, n < (int)size ? size - (size_t)n : 0, " -DVIT_EFFECT_" #macro "=%d", (int)(l->effects >> bit & 1));
    VIT_EFFECTS(X)
#undef X
#define X(macro)                                                                                                               \
    n += snprintf(text + n, n < (int)size ? size - (size_t)n : 0, " -DVIT_EFFECT_" #macro "=%d",                               \
                  (l->effects & ON_##macro) != 0);
    VIT_MODES(X)
#undef X
    return n < (int)size;
}

/* A kernel may have room for fewer work-items than the device, for want of registers. */
static vit_status make_kernel(vit_opencl *d, uint32_t pass, uint32_t asked_group, vit_text *why) {
    const char *name = vit_passes[pass].name;
    size_t most = 256;
    cl_int e;
    d->kernels[pass] = clCreateKernel(d->program, name, &e);
    if (e != CL_SUCCESS)
        return failed(why, name, e);
    clGetKernelWorkGroupInfo(d->kernels[pass], d->id, CL_KERNEL_WORK_GROUP_SIZE, sizeof most, &most, NULL);
    d->most[pass] = group_up_to(most);
    return asked_group > d->most[pass] ? refuse_group(name, asked_group, d->most[pass], why) : VIT_OK;
}

/* PoCL fails to build what it builds elsewhere where it cannot write; it does not say so. */
static void say_where_pocl_writes(const vit_opencl *d, vit_text *why) {
    cl_platform_id platform;
    char name[128] = "";
    if (clGetDeviceInfo(d->id, CL_DEVICE_PLATFORM, sizeof platform, &platform, NULL) == CL_SUCCESS)
        clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof name, name, NULL);
    const size_t n = strlen(why->text);
    if (strstr(name, POCL))
        snprintf(why->text + n, sizeof why->text - n,
                 "; PoCL compiles in its cache: set POCL_CACHE_DIR to a folder with room, or take the device host");
}

static vit_status build(vit_opencl *d, const vit_launch *l, uint32_t asked_group, vit_text *why) {
    char options[4096];
    cl_int e;
    if (!build_options(options, sizeof options, l, d->wide_divide))
        return failed(why, "build options are too long", CL_INVALID_BUILD_OPTIONS);
    d->program =
        clCreateProgramWithSource(d->context, vit_kernel_source_count, (const char **)(uintptr_t)vit_kernel_sources, NULL, &e);
    if (e != CL_SUCCESS)
        return failed(why, "clCreateProgramWithSource", e);
    e = clBuildProgram(d->program, 1, &d->id, options, NULL, NULL);
    if (e != CL_SUCCESS) {
        failed(why, "clBuildProgram", e);
        say_where_pocl_writes(d, why); /* first: a log may be long */
        if (clGetProgramBuildInfo(d->program, d->id, CL_PROGRAM_BUILD_LOG, sizeof d->log, d->log, NULL) == CL_SUCCESS) {
            size_t n = strlen(why->text);
            snprintf(why->text + n, sizeof why->text - n, ": %s", d->log);
            for (char *c = why->text; *c; c++)
                if (*c == '\n')
                    *c = ' ';
        }
        return VIT_FAILED;
    }
    vit_status status = VIT_OK;
    for (uint32_t p = 0; p < vit_pass_count && status == VIT_OK; p++)
        if (vit_pass_called(p, l))
            status = make_kernel(d, p, asked_group, why);
    return status;
}

static vit_status clear(void *state, vit_buffer b, vit_text *why) {
    static const uint32_t zero = 0;
    vit_opencl *d = state;
    uint64_t bytes = vit_buffer_bytes(b, d->scene, d->launch);
    cl_int e = clEnqueueFillBuffer(d->queue, d->buffers[b], &zero, sizeof zero, 0, (size_t)bytes, 0, NULL, NULL);
    return e == CL_SUCCESS ? VIT_OK : failed(why, "clEnqueueFillBuffer", e);
}

/* Data of the pack is used in place where device and host share memory; the rest starts as zeros, so that traces repeat, but
 * for the framebuffer: each frame writes all pixels, and what lies between the rows of the caller's is not ours. */
static vit_status make_buffer(vit_opencl *d, uint32_t b, void *framebuffer, vit_text *why) {
    uint64_t bytes = vit_buffer_bytes(b, d->scene, d->launch);
    vit_section section = vit_buffer_sections[b];
    cl_int e;
    if (bytes == 0)
        return VIT_OK;
    if (section != VIT_SECTION_NONE) {
        cl_mem_flags flags = CL_MEM_READ_ONLY | (d->is_cpu ? CL_MEM_USE_HOST_PTR : CL_MEM_COPY_HOST_PTR);
        d->buffers[b] = clCreateBuffer(d->context, flags, (size_t)bytes, (void *)(uintptr_t)d->pack->section[section], &e);
        return e == CL_SUCCESS ? VIT_OK : failed(why, vit_buffer_names[b], e);
    }
    void *host = b == B_framebuffer && d->is_cpu ? framebuffer : NULL;
    d->buffers[b] = clCreateBuffer(d->context, CL_MEM_READ_WRITE | (host ? CL_MEM_USE_HOST_PTR : 0), (size_t)bytes, host, &e);
    if (e != CL_SUCCESS)
        return failed(why, vit_buffer_names[b], e);
    return b == B_framebuffer ? VIT_OK : clear(d, (vit_buffer)b, why);
}

static vit_status upload_baked_photons(vit_opencl *d, vit_text *why) {
    const vit_scene *s = d->scene;
    size_t size = s->baked * sizeof(vit_photon), at = (s->photons - s->baked) * sizeof(vit_photon);
    if (s->baked == 0 || !d->buffers[B_photons])
        return VIT_OK;
    cl_int e = clEnqueueWriteBuffer(d->queue, d->buffers[B_photons], CL_TRUE, at, size, d->pack->section[VIT_SECTION_PHOT], 0,
                                    NULL, NULL);
    return e == CL_SUCCESS ? VIT_OK : failed(why, "clEnqueueWriteBuffer", e);
}

/* What an argument of a pass is in all frames; those that vary are set later. */
static uint32_t fixed_value(uint32_t argument, uint32_t pass, const vit_launch *l) {
    switch (argument) {
    case V_run:
        return l->run;
    case V_layers:
        return l->layers;
    case V_max_nodes:
        return l->max_nodes;
    case V_max_list:
        return l->max_list;
    case V_pitch:
        return l->pitch;
    case V_pass:
        return pass;
    default:
        return 0;
    }
}

/* Arguments that never change; frame, round and level are set when a pass is enqueued. */
static vit_status set_arguments(vit_opencl *d, vit_text *why) {
    const vit_launch *l = d->launch;
    for (uint32_t p = 0; p < vit_pass_count; p++) {
        if (!d->kernels[p])
            continue;
        for (uint32_t i = 0; vit_passes[p].args[i] != V_END; i++) {
            uint32_t a = vit_passes[p].args[i];
            if (a == B_work && !vit_buffer_called(a, l))
                break;
            const uint32_t value = fixed_value(a, p, l);
            cl_int e = a < B_COUNT ? clSetKernelArg(d->kernels[p], i, sizeof(cl_mem), d->buffers[a] ? &d->buffers[a] : NULL)
                                   : clSetKernelArg(d->kernels[p], i, sizeof value, &value);
            if (e != CL_SUCCESS)
                return failed(why, vit_passes[p].name, e);
        }
    }
    return VIT_OK;
}

/* Same bits need the same rounding: see kernels/strict.clh. */
static vit_status check_arithmetic(vit_opencl *d, int ask_wide, vit_text *why) {
    static const cl_device_fp_config needed = CL_FP_DENORM | CL_FP_INF_NAN | CL_FP_ROUND_TO_NEAREST;
    cl_device_fp_config config = 0, doubles = 0;
    cl_bool little = CL_TRUE;
    clGetDeviceInfo(d->id, CL_DEVICE_SINGLE_FP_CONFIG, sizeof config, &config, NULL);
    clGetDeviceInfo(d->id, CL_DEVICE_DOUBLE_FP_CONFIG, sizeof doubles, &doubles, NULL);
    clGetDeviceInfo(d->id, CL_DEVICE_ENDIAN_LITTLE, sizeof little, &little, NULL);
    d->wide_divide = ask_wide || !(config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT);
    if ((little == CL_TRUE) == (VIT_BIG_ENDIAN != 0))
        return vit_fail(why, VIT_FAILED, "OpenCL: the device's order of bytes is not this machine's");
    if ((config & needed) != needed)
        return vit_fail(why, VIT_FAILED,
                        "OpenCL: the device's floats do not round as every frame's bits need it (subnormals, to nearest)");
    if (d->wide_divide && !doubles)
        return vit_fail(
            why, VIT_FAILED,
            "OpenCL: the device does not divide floats as every frame's bits need it, and has no doubles to do it by");
    return VIT_OK;
}

static vit_status open_on(vit_opencl *d, const vit_device_setup *setup, vit_text *why) {
    cl_int e;
    cl_device_type type = CL_DEVICE_TYPE_CPU;
    clGetDeviceInfo(d->id, CL_DEVICE_TYPE, sizeof type, &type, NULL);
    d->is_cpu = (type & CL_DEVICE_TYPE_CPU) != 0;
    d->in_place = d->is_cpu ? setup->info->framebuffer : NULL;
    if (check_arithmetic(d, setup->info->wide_divide != 0, why) != VIT_OK)
        return VIT_FAILED;
    d->context = clCreateContext(NULL, 1, &d->id, NULL, NULL, &e);
    if (e != CL_SUCCESS)
        return failed(why, "clCreateContext", e);
    d->queue = clCreateCommandQueue(d->context, d->id, d->profile ? CL_QUEUE_PROFILING_ENABLE : 0, &e);
    if (e != CL_SUCCESS)
        return failed(why, "clCreateCommandQueue", e);
    vit_status status = build(d, d->launch, setup->info->group, why);
    for (uint32_t b = 0; b < B_COUNT && status == VIT_OK; b++)
        status = make_buffer(d, b, setup->info->framebuffer, why);
    if (status == VIT_OK)
        status = upload_baked_photons(d, why);
    if (status == VIT_OK)
        status = set_arguments(d, why);
    if (status == VIT_OK && (e = clFinish(d->queue)) != CL_SUCCESS)
        status = failed(why, "clFinish", e);
    return status;
}

static vit_status open_device(const vit_device_setup *setup, vit_text *why) {
    vit_opencl *d = setup->state;
    d->pack = setup->pack;
    d->scene = setup->pack->scene;
    d->launch = setup->launch;
    d->profile = setup->info->profile != 0;
    vit_status status = find(setup->info->device, &d->id, why);
    return status == VIT_OK ? open_on(d, setup, why) : status;
}

static void close_device(void *state) {
    vit_opencl *d = state;
    if (d->queue)
        clFinish(d->queue);
    for (uint32_t i = 0; i < d->enqueued; i++)
        clReleaseEvent(d->events[i]);
    for (uint32_t b = 0; b < B_COUNT; b++)
        if (d->buffers[b])
            clReleaseMemObject(d->buffers[b]);
    for (uint32_t p = 0; p < VIT_MAX_PASSES; p++)
        if (d->kernels[p])
            clReleaseKernel(d->kernels[p]);
    if (d->program)
        clReleaseProgram(d->program);
    if (d->queue)
        clReleaseCommandQueue(d->queue);
    if (d->context)
        clReleaseContext(d->context);
    memset(d, 0, sizeof *d);
}

static vit_status rewind_buffers(void *state, vit_text *why) {
    vit_opencl *d = state;
    vit_status status = VIT_OK;
    for (uint32_t b = 0; b < B_COUNT && status == VIT_OK; b++)
        if (d->buffers[b] && vit_buffer_sections[b] == VIT_SECTION_NONE && b != B_framebuffer)
            status = clear(d, (vit_buffer)b, why);
    return status == VIT_OK ? upload_baked_photons(d, why) : status;
}

static vit_status set_varying(vit_opencl *d, const vit_step *step, vit_text *why) {
    const uint32_t pass = step->pass;
    for (uint32_t i = 0; vit_passes[pass].args[i] != V_END; i++) {
        uint32_t a = vit_passes[pass].args[i];
        if (a != V_frame && a != V_level && a != V_chunks && a != V_round)
            continue;
        uint32_t value = a == V_frame ? step->frame : a == V_round ? step->round : step->level;
        if (a == V_chunks)
            value = vit_pass_chunks(&vit_passes[pass], d->launch, step->level);
        cl_int e = clSetKernelArg(d->kernels[pass], i, sizeof value, &value);
        if (e != CL_SUCCESS)
            return failed(why, vit_passes[pass].name, e);
    }
    return VIT_OK;
}

static vit_status run(void *state, const vit_step *step, vit_text *why) {
    vit_opencl *d = state;
    const uint32_t pass = step->pass;
    size_t local, global;
    cl_event *event = NULL;
    vit_launch l = *d->launch;
    l.group = lesser(l.group, d->most[pass]);
    l.scan_group = lesser(l.scan_group, d->most[pass]);
    l.splat_group = lesser(l.splat_group, d->most[pass]);
    vit_pass_size(&vit_passes[pass], d->scene, &l, step->level, &local, &global);
    vit_status status = set_varying(d, step, why);
    if (status != VIT_OK || global == 0)
        return status;
    if (d->profile && d->enqueued < VIT_MAX_ENQUEUES) {
        d->enqueued_pass[d->enqueued] = pass;
        event = &d->events[d->enqueued];
    }
    cl_int e = clEnqueueNDRangeKernel(d->queue, d->kernels[pass], 1, NULL, &global, &local, 0, NULL, event);
    if (e != CL_SUCCESS)
        return failed(why, vit_passes[pass].name, e);
    if (event)
        d->enqueued++;
    return VIT_OK;
}

static vit_status read_buffer(void *state, vit_buffer b, size_t bytes, void *out, vit_text *why) {
    vit_opencl *d = state;
    cl_int e = clEnqueueReadBuffer(d->queue, d->buffers[b], CL_TRUE, 0, bytes, out, 0, NULL, NULL);
    return e == CL_SUCCESS ? VIT_OK : failed(why, vit_buffer_names[b], e);
}

/* The frame is in the caller's memory already: mapping waits for it and says that the host may look. */
static cl_int show_in_place(vit_opencl *d, size_t bytes) {
    cl_int e;
    cl_mem b = d->buffers[B_framebuffer];
    void *at = clEnqueueMapBuffer(d->queue, b, CL_TRUE, CL_MAP_READ, 0, bytes, 0, NULL, NULL, &e);
    return e == CL_SUCCESS ? clEnqueueUnmapMemObject(d->queue, b, at, 0, NULL, NULL) : e;
}

static vit_status show(void *state, void *framebuffer, size_t stride, vit_text *why) {
    vit_opencl *d = state;
    const vit_scene *s = d->scene;
    const size_t row = vit_row_bytes(s, d->launch), pitch = vit_pitch_bytes(d->launch), zero[3] = {0, 0, 0},
                 region[3] = {row, s->height, 1};
    const size_t bytes = (size_t)vit_buffer_bytes(B_framebuffer, s, d->launch);
    cl_int e;
    if (!framebuffer)
        e = clFinish(d->queue);
    else if (framebuffer == d->in_place && stride == pitch)
        e = show_in_place(d, bytes);
    else if (stride == row && pitch == row)
        e = clEnqueueReadBuffer(d->queue, d->buffers[B_framebuffer], CL_TRUE, 0, bytes, framebuffer, 0, NULL, NULL);
    else
        e = clEnqueueReadBufferRect(d->queue, d->buffers[B_framebuffer], CL_TRUE, zero, zero, region, pitch, 0, stride, 0,
                                    framebuffer, 0, NULL, NULL);
    return e == CL_SUCCESS ? VIT_OK : failed(why, "reading the frame", e);
}

/* Events are given back. */
static void times(void *state, double *pass_ms) {
    vit_opencl *d = state;
    for (uint32_t p = 0; p < VIT_MAX_PASSES; p++)
        pass_ms[p] = 0;
    for (uint32_t i = 0; i < d->enqueued; i++) {
        cl_ulong begin = 0, end = 0;
        clGetEventProfilingInfo(d->events[i], CL_PROFILING_COMMAND_START, sizeof begin, &begin, NULL);
        clGetEventProfilingInfo(d->events[i], CL_PROFILING_COMMAND_END, sizeof end, &end, NULL);
        pass_ms[d->enqueued_pass[i]] += (double)(end - begin) * 1e-6;
        clReleaseEvent(d->events[i]);
    }
    d->enqueued = 0;
}

/* Buffers are OpenCL's. */
static size_t memory_bytes(const vit_scene *s, const vit_launch *l, int in_place) {
    (void)s;
    (void)l;
    (void)in_place;
    return 0;
}

const vit_device vit_device_opencl = {
    sizeof(vit_opencl), memory_bytes, suit, open_device, close_device, rewind_buffers, run, clear, read_buffer, show, times};
