#include "device_opencl.h"
#include "kernel_sources.h"
#include <stdio.h>
#include <string.h>

#define MAX_PLATFORMS 16
#define MAX_DEVICES 32

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

vit_status vit_cl_failed(vit_text *why, const char *call, cl_int error) {
    snprintf(why->text, sizeof why->text, "OpenCL: %s: %s (%d)", call, error_name(error), (int)error);
    return VIT_FAILED;
}

vit_status vit_device_find(uint32_t index, cl_device_id *id, vit_text *why) {
    cl_platform_id platforms[MAX_PLATFORMS];
    cl_uint platform_count = 0, seen = 0;
    cl_int e = clGetPlatformIDs(MAX_PLATFORMS, platforms, &platform_count);
    if (e != CL_SUCCESS)
        return vit_cl_failed(why, "clGetPlatformIDs", e);
    if (platform_count > MAX_PLATFORMS)
        platform_count = MAX_PLATFORMS;
    for (cl_uint p = 0; p < platform_count; p++) {
        cl_device_id devices[MAX_DEVICES];
        cl_uint count = 0;
        if (clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, MAX_DEVICES, devices, &count) != CL_SUCCESS)
            continue;
        if (count > MAX_DEVICES)
            count = MAX_DEVICES;
        if (index < seen + count) {
            *id = devices[index - seen];
            return VIT_OK;
        }
        seen += count;
    }
    snprintf(why->text, sizeof why->text, "OpenCL: there is no device %u, only %u", index, seen);
    return VIT_FAILED;
}

const char *vit_device_name(uint32_t index, vit_text *why) {
    cl_device_id id;
    cl_platform_id platform;
    char names[3][150] = {"?", "?", "?"};
    if (vit_device_find(index, &id, why) != VIT_OK)
        return NULL;
    if (clGetDeviceInfo(id, CL_DEVICE_PLATFORM, sizeof platform, &platform, NULL) == CL_SUCCESS)
        clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof names[0], names[0], NULL);
    clGetDeviceInfo(id, CL_DEVICE_NAME, sizeof names[1], names[1], NULL);
    clGetDeviceInfo(id, CL_DRIVER_VERSION, sizeof names[2], names[2], NULL);
    snprintf(why->text, sizeof why->text, "%s / %s / %s", names[0], names[1], names[2]);
    return why->text;
}

void vit_device_suit(cl_device_id id, const vit_scene *s, vit_limits *l) {
    cl_device_type type = CL_DEVICE_TYPE_CPU;
    cl_uint width = 8;
    size_t most = 256;
    clGetDeviceInfo(id, CL_DEVICE_TYPE, sizeof type, &type, NULL);
    clGetDeviceInfo(id, CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT, sizeof width, &width, NULL);
    clGetDeviceInfo(id, CL_DEVICE_MAX_WORK_GROUP_SIZE, sizeof most, &most, NULL);
    int cpu = (type & CL_DEVICE_TYPE_CPU) != 0;
    uint32_t top = most < 256 ? (uint32_t)most : 256;
    if (l->lanes == 0)
        l->lanes = !cpu ? 1 : width >= 16 ? 16 : 8;
    if (l->group > 0) { /* asked for: everywhere the same */
        l->scan_group = l->splat_group = l->group;
    } else {
        l->group = cpu ? 16 : top < 64 ? top : 64;
        l->scan_group = cpu ? 1 : top;
        l->splat_group = cpu ? 1 : 32;
    }
    l->run = cpu ? s->tile * s->tile : 16;
    l->chunks = cpu ? 16 : VIT_CHUNKS;
}

/* Options of the one program: exactly this effect set, view, format and width. */
static int build_options(char *text, size_t size, const vit_limits *l) {
    int n = snprintf(text, size,
                     "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt -DVIT_LANES=%u -DVIT_VIEW=%d -DVIT_FORMAT=%d "
                     "-DVIT_EFFECT_DOTS=%d -DVIT_COUNT_WORK=%d",
                     l->lanes, (int)l->view, (int)l->format, (l->effects & ON_DOTS) != 0, (l->effects & ON_WORK) != 0);
#define X(bit, name, macro, why)                                                                                               \
    n += snprintf(text + n, n < (int)size ? size - (size_t)n : 0, " -DVIT_EFFECT_" #macro "=%d", (l->effects >> bit) & 1);
    VIT_EFFECTS(X)
#undef X
    return n < (int)size;
}

static vit_status build(vit_device *d, const vit_limits *l, vit_text *why) {
    char options[2048];
    cl_int e;
    if (!build_options(options, sizeof options, l))
        return vit_cl_failed(why, "build options are too long", CL_INVALID_BUILD_OPTIONS);
    d->program = clCreateProgramWithSource(d->context, vit_kernel_source_count, (const char **)(uintptr_t)vit_kernel_sources, NULL, &e);
    if (e != CL_SUCCESS)
        return vit_cl_failed(why, "clCreateProgramWithSource", e);
    e = clBuildProgram(d->program, 1, &d->id, options, NULL, NULL);
    if (e != CL_SUCCESS) {
        vit_cl_failed(why, "clBuildProgram", e);
        if (clGetProgramBuildInfo(d->program, d->id, CL_PROGRAM_BUILD_LOG, sizeof d->log, d->log, NULL) == CL_SUCCESS) {
            size_t n = strlen(why->text);
            snprintf(why->text + n, sizeof why->text - n, ": %s", d->log);
            for (char *c = why->text; *c; c++)
                if (*c == '\n')
                    *c = ' ';
        }
        return VIT_FAILED;
    }
    for (uint32_t p = 0; p < vit_pass_count; p++) {
        if (!vit_pass_called(p, l))
            continue;
        d->kernels[p] = clCreateKernel(d->program, vit_passes[p].name, &e);
        if (e != CL_SUCCESS)
            return vit_cl_failed(why, vit_passes[p].name, e);
    }
    return VIT_OK;
}

/* Data of the pack is used in place where device and host share memory; the rest starts as zeros, so that traces repeat. */
static vit_status make_buffer(vit_device *d, uint32_t b, const vit_pack *pack, const vit_limits *l, void *framebuffer, vit_text *why) {
    uint64_t bytes = vit_buffer_bytes(b, pack->scene, l);
    vit_section section = vit_buffer_sections[b];
    cl_int e;
    if (bytes == 0)
        return VIT_OK;
    if (section != VIT_SECTION_NONE) {
        cl_mem_flags flags = CL_MEM_READ_ONLY | (d->is_cpu ? CL_MEM_USE_HOST_PTR : CL_MEM_COPY_HOST_PTR);
        d->buffers[b] = clCreateBuffer(d->context, flags, (size_t)bytes, (void *)(uintptr_t)pack->section[section], &e);
        return e == CL_SUCCESS ? VIT_OK : vit_cl_failed(why, vit_buffer_names[b], e);
    }
    void *host = b == B_framebuffer && d->is_cpu ? framebuffer : NULL;
    d->buffers[b] = clCreateBuffer(d->context, CL_MEM_READ_WRITE | (host ? CL_MEM_USE_HOST_PTR : 0), (size_t)bytes, host, &e);
    if (e != CL_SUCCESS)
        return vit_cl_failed(why, vit_buffer_names[b], e);
    static const uint32_t zero = 0;
    size_t pattern = bytes % 4 == 0 ? 4 : 2; /* RGB565 frames of odd size */
    e = clEnqueueFillBuffer(d->queue, d->buffers[b], &zero, pattern, 0, (size_t)bytes, 0, NULL, NULL);
    return e == CL_SUCCESS ? VIT_OK : vit_cl_failed(why, "clEnqueueFillBuffer", e);
}

static vit_status upload_baked_photons(vit_device *d, const vit_pack *pack, vit_text *why) {
    const vit_scene *s = pack->scene;
    size_t size = s->baked * sizeof(vit_photon), at = (s->photons - s->baked) * sizeof(vit_photon);
    if (s->baked == 0 || !d->buffers[B_photons])
        return VIT_OK;
    cl_int e = clEnqueueWriteBuffer(d->queue, d->buffers[B_photons], CL_TRUE, at, size, pack->section[VIT_SECTION_PHOT], 0, NULL, NULL);
    return e == CL_SUCCESS ? VIT_OK : vit_cl_failed(why, "clEnqueueWriteBuffer", e);
}

/* Arguments that never change; frame and level are set when a pass is enqueued. */
static vit_status set_arguments(vit_device *d, const vit_limits *l, vit_text *why) {
    for (uint32_t p = 0; p < vit_pass_count; p++) {
        if (!d->kernels[p])
            continue;
        for (uint32_t i = 0; vit_passes[p].args[i] != V_END; i++) {
            uint32_t a = vit_passes[p].args[i];
            if (a == B_work && !vit_buffer_called(a, l))
                break;
            uint32_t value = a == V_run ? l->run : a == V_max_nodes ? l->max_nodes : a == V_max_list ? l->max_list : 0;
            value = a == V_pass ? p : value;
            cl_int e = a < B_COUNT ? clSetKernelArg(d->kernels[p], i, sizeof(cl_mem), d->buffers[a] ? &d->buffers[a] : NULL)
                                   : clSetKernelArg(d->kernels[p], i, sizeof value, &value);
            if (e != CL_SUCCESS)
                return vit_cl_failed(why, vit_passes[p].name, e);
        }
    }
    return VIT_OK;
}

/* Same bits need the same rounding: see kernels/strict.clh. */
static vit_status check_arithmetic(cl_device_id id, vit_text *why) {
    static const cl_device_fp_config needed = CL_FP_DENORM | CL_FP_INF_NAN | CL_FP_ROUND_TO_NEAREST | CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT;
    cl_device_fp_config config = 0;
    clGetDeviceInfo(id, CL_DEVICE_SINGLE_FP_CONFIG, sizeof config, &config, NULL);
    if ((config & needed) == needed)
        return VIT_OK;
    snprintf(why->text, sizeof why->text, "OpenCL: the device's floats do not round as every frame's bits need it (subnormals, division, sqrt)");
    return VIT_FAILED;
}

vit_status vit_device_open(vit_device *d, const vit_pack *pack, const vit_limits *l, int profile, void *framebuffer, vit_text *why) {
    cl_int e;
    cl_device_type type = CL_DEVICE_TYPE_CPU;
    clGetDeviceInfo(d->id, CL_DEVICE_TYPE, sizeof type, &type, NULL);
    d->is_cpu = (type & CL_DEVICE_TYPE_CPU) != 0;
    if (check_arithmetic(d->id, why) != VIT_OK)
        return VIT_FAILED;
    d->context = clCreateContext(NULL, 1, &d->id, NULL, NULL, &e);
    if (e != CL_SUCCESS)
        return vit_cl_failed(why, "clCreateContext", e);
    d->queue = clCreateCommandQueue(d->context, d->id, profile ? CL_QUEUE_PROFILING_ENABLE : 0, &e);
    if (e != CL_SUCCESS)
        return vit_cl_failed(why, "clCreateCommandQueue", e);
    vit_status status = build(d, l, why);
    for (uint32_t b = 0; b < B_COUNT && status == VIT_OK; b++)
        status = make_buffer(d, b, pack, l, framebuffer, why);
    if (status == VIT_OK)
        status = upload_baked_photons(d, pack, why);
    if (status == VIT_OK)
        status = set_arguments(d, l, why);
    if (status == VIT_OK && (e = clFinish(d->queue)) != CL_SUCCESS)
        status = vit_cl_failed(why, "clFinish", e);
    return status;
}

void vit_device_close(vit_device *d) {
    if (d->queue)
        clFinish(d->queue);
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
