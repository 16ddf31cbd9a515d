/* A laboratory for kernel functions: the library's own kernel sources with a test kernel behind them, built with the runtime's
 * options for the first OpenCL device, run on host arrays. Any OpenCL error fails the test that caused it and names the call.
 */
#ifndef VIT_TESTS_KERNEL_LAB_H
#define VIT_TESTS_KERNEL_LAB_H

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <CL/cl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "kernel_sources.h"
#include "vitrine_pack.h"

#define LAB_MAX_SOURCES 64

typedef struct lab {
    cl_device_id device;
    cl_context context;
    cl_command_queue queue;
    cl_program program;
} lab;

/* The widths that a program can have. */
static const unsigned lab_lanes[] = {1, 8, 16};
#define LAB_WIDTHS 3u

static inline void lab_check(cl_int error, const char *call) {
    if (error != CL_SUCCESS)
        fail_msg("OpenCL: %s: error %d", call, (int)error);
}

static inline cl_device_id lab_first_device(void) {
    cl_platform_id platforms[16];
    cl_uint count = 0;
    lab_check(clGetPlatformIDs(16, platforms, &count), "clGetPlatformIDs");
    for (cl_uint p = 0; p < count && p < 16; p++) {
        cl_device_id id;
        if (clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, 1, &id, NULL) == CL_SUCCESS)
            return id;
    }
    fail_msg("OpenCL: there is no device");
    return NULL;
}

/* The runtime's options for this width and effect set, the view `final` in XRGB8888. */
static inline void lab_options(char *text, size_t size, unsigned lanes, vit_u64 effects) {
    int n = snprintf(text, size,
                     "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt -DVIT_LANES=%u -DVIT_VIEW=0 -DVIT_FORMAT=0", lanes);
#define X(bit, name, macro, why)                                                                                               \
    n += snprintf(text + n, n < (int)size ? size - (size_t)n : 0, " -DVIT_EFFECT_" #macro "=%u",                               \
                  (unsigned)(effects >> bit & 1u));
    VIT_EFFECTS(X)
#undef X
    /* Of the modes only what the effects themselves ask for. */
    const unsigned FILM = 0, DOTS = 0, REACH = 0, CHAINS = (effects & (VIT_BIT(MIRROR) | VIT_BIT(GLASS))) != 0,
                   LOOKED_UP = (effects & VIT_BIT(LIGHTMAP)) && !(effects & VIT_BIT(SPECULAR)),
                   SKY_RAYS = (effects & VIT_BIT(SKY_LIGHT)) && !LOOKED_UP,
                   AREA_RAYS = (effects & VIT_BIT(AREA_LIGHTS)) && !LOOKED_UP;
#define X(macro) n += snprintf(text + n, n < (int)size ? size - (size_t)n : 0, " -DVIT_EFFECT_" #macro "=%u", macro);
    VIT_MODES(X)
#undef X
    assert_in_range(n, 0, size - 1);
}

static inline void lab_build(lab *l, const char *options) {
    const cl_int e = clBuildProgram(l->program, 1, &l->device, options, NULL, NULL);
    if (e == CL_SUCCESS)
        return;
    size_t size = 0;
    clGetProgramBuildInfo(l->program, l->device, CL_PROGRAM_BUILD_LOG, 0, NULL, &size);
    char *log = calloc(size + 1, 1);
    if (log && clGetProgramBuildInfo(l->program, l->device, CL_PROGRAM_BUILD_LOG, size, log, NULL) == CL_SUCCESS)
        fprintf(stderr, "%s\n", log);
    free(log);
    lab_check(e, "clBuildProgram");
}

/* The kernels and `test_kernels` as one program, `lanes` wide, with more options (a space first). lab_close() when done. */
static inline lab lab_open_with(unsigned lanes, vit_u64 effects, const char *more, const char *test_kernels) {
    const char *sources[LAB_MAX_SOURCES];
    char options[4096];
    cl_int e;
    lab l = {.device = lab_first_device()};
    assert_in_range(vit_kernel_source_count, 1, LAB_MAX_SOURCES - 1);
    memcpy(sources, vit_kernel_sources, vit_kernel_source_count * sizeof *sources);
    sources[vit_kernel_source_count] = test_kernels;
    lab_options(options, sizeof options, lanes, effects);
    const size_t length = strlen(options);
    assert_in_range(snprintf(options + length, sizeof options - length, "%s", more), 0, sizeof options - length - 1);
    l.context = clCreateContext(NULL, 1, &l.device, NULL, NULL, &e);
    lab_check(e, "clCreateContext");
    l.queue = clCreateCommandQueue(l.context, l.device, 0, &e);
    lab_check(e, "clCreateCommandQueue");
    l.program = clCreateProgramWithSource(l.context, vit_kernel_source_count + 1, sources, NULL, &e);
    lab_check(e, "clCreateProgramWithSource");
    lab_build(&l, options);
    return l;
}

static inline lab lab_open(unsigned lanes, vit_u64 effects, const char *test_kernels) {
    return lab_open_with(lanes, effects, "", test_kernels);
}

static inline void lab_close(lab *l) {
    clReleaseProgram(l->program);
    clReleaseCommandQueue(l->queue);
    clReleaseContext(l->context);
    *l = (lab){0};
}

/* A device buffer of `size` bytes with `data` in it, or zeros if data is NULL. */
static inline cl_mem lab_buffer(lab *l, const void *data, size_t size) {
    cl_int e;
    cl_mem m = clCreateBuffer(l->context, CL_MEM_READ_WRITE, size, NULL, &e);
    lab_check(e, "clCreateBuffer");
    static const unsigned char zero = 0;
    if (data)
        lab_check(clEnqueueWriteBuffer(l->queue, m, CL_TRUE, 0, size, data, 0, NULL, NULL), "clEnqueueWriteBuffer");
    else
        lab_check(clEnqueueFillBuffer(l->queue, m, &zero, 1, 0, size, 0, NULL, NULL), "clEnqueueFillBuffer");
    return m;
}

/* Runs `name` over `global` work-items with these buffers as its arguments, and waits. Scalars travel in buffers too. */
static inline void lab_run(lab *l, const char *name, size_t global, const cl_mem *arguments, cl_uint count) {
    cl_int e;
    cl_kernel k = clCreateKernel(l->program, name, &e);
    lab_check(e, name);
    for (cl_uint i = 0; i < count; i++)
        lab_check(clSetKernelArg(k, i, sizeof(cl_mem), &arguments[i]), "clSetKernelArg");
    lab_check(clEnqueueNDRangeKernel(l->queue, k, 1, NULL, &global, NULL, 0, NULL, NULL), name);
    lab_check(clFinish(l->queue), "clFinish");
    clReleaseKernel(k);
}

static inline void lab_read(lab *l, cl_mem m, void *data, size_t size) {
    lab_check(clEnqueueReadBuffer(l->queue, m, CL_TRUE, 0, size, data, 0, NULL, NULL), "clEnqueueReadBuffer");
}

/* Random numbers of the tests: splitmix64, the same on every machine. */
static inline uint64_t lab_random(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Uniform in [0, 1), 24 bits. */
static inline float lab_uniform(uint64_t *state) {
    return (float)(lab_random(state) >> 40) * 0x1p-24f;
}

#endif
