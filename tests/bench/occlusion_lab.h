/* The kernels' ray casts alone, on rays from memory: built from the library's own sources with the options of an open pack, run
 * on its queue and its buffers. */
#ifndef VIT_BENCH_OCCLUSION_LAB_H
#define VIT_BENCH_OCCLUSION_LAB_H

#include "device_opencl.h"
#include "embree_packets.h"
#include "kernel_sources.h"
#include "variant.h"

#define LAB_SOURCES 64

static const char occlusion_kernel[] =
    "kernel void bench_occlusion(RAY_SCENE_PARAMETERS, global const float *rays, global uint *occluded)\n"
    "{\n"
    "    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;\n"
    "    if (first >= n)\n"
    "        return;\n"
    "    lf limit = L_LOAD(VIT_PLANE(rays, 6, n) + first);\n"
    "    li active = L_GE(limit, (lf)0), dark = (li)0;\n"
    "    if (l_any(active)) {\n"
    "        ray_packet r = ray_make(lv3_load_planes(rays, n, first), lv3_load_planes(VIT_PLANE(rays, 3, n), n, first));\n"
    "        dark = ray_occluded(RAY_SCENE, &r, active, limit);\n"
    "    }\n"
    "    L_STORE(L_AS_UINT(dark & 1), occluded + first);\n"
    "}\n";

typedef struct occlusion_lab {
    cl_program program;
    cl_kernel kernel;
    cl_mem rays, occluded;
} occlusion_lab;

static inline void lab_check(cl_int error, const char *call) {
    if (error != CL_SUCCESS)
        bench_fail("OpenCL: %s: error %d", call, (int)error);
}

/* The rays may change until the lab is opened, and have one entry a view sample of `p`. */
static inline occlusion_lab occlusion_open(player *p, const ray_planes *rays) {
    static const uint32_t scene[] = {B_scene, B_triangles, B_attributes, B_materials, B_textures, B_mips, B_texels, B_bvh};
    const vit_opencl *d = p->v->state;
    const char *sources[LAB_SOURCES];
    char options[4096]; /* as long as the device may make them */
    cl_int e;
    occlusion_lab l;
    if (vit_kernel_source_count >= LAB_SOURCES)
        bench_fail("more than %d kernel sources", LAB_SOURCES);
    memcpy(sources, vit_kernel_sources, vit_kernel_source_count * sizeof *sources);
    sources[vit_kernel_source_count] = occlusion_kernel;
    lab_check(clGetProgramBuildInfo(d->program, d->id, CL_PROGRAM_BUILD_OPTIONS, sizeof options, options, NULL),
              "build options");
    l.program = clCreateProgramWithSource(d->context, vit_kernel_source_count + 1, sources, NULL, &e);
    lab_check(e, "clCreateProgramWithSource");
    lab_check(clBuildProgram(l.program, 1, &d->id, options, NULL, NULL), "clBuildProgram");
    l.kernel = clCreateKernel(l.program, "bench_occlusion", &e);
    lab_check(e, "clCreateKernel");
    l.rays = clCreateBuffer(d->context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, (size_t)rays->n * 28, rays->value, &e);
    lab_check(e, "clCreateBuffer");
    l.occluded = clCreateBuffer(d->context, CL_MEM_READ_WRITE, (size_t)rays->n * 4, NULL, &e);
    lab_check(e, "clCreateBuffer");
    cl_uint at = 0;
    for (; at < sizeof scene / sizeof *scene; at++) {
        const cl_mem *b = &d->buffers[scene[at]];
        lab_check(clSetKernelArg(l.kernel, at, sizeof(cl_mem), *b ? b : NULL), "clSetKernelArg");
    }
    lab_check(clSetKernelArg(l.kernel, at, sizeof(cl_mem), &l.rays), "clSetKernelArg");
    lab_check(clSetKernelArg(l.kernel, at + 1, sizeof(cl_mem), &l.occluded), "clSetKernelArg");
    return l;
}

/* Milliseconds on the device. */
static inline double occlusion_run(occlusion_lab *l, player *p) {
    const vit_launch *limits = &p->v->launch;
    const size_t local = limits->group, items = p->v->pack.scene->samples / limits->lanes;
    const size_t global = (items + local - 1) / local * local;
    const vit_opencl *d = p->v->state;
    cl_event event;
    cl_ulong begin, end;
    lab_check(clEnqueueNDRangeKernel(d->queue, l->kernel, 1, NULL, &global, &local, 0, NULL, &event), "bench_occlusion");
    lab_check(clWaitForEvents(1, &event), "clWaitForEvents");
    lab_check(clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof begin, &begin, NULL), "profiling");
    lab_check(clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, NULL), "profiling");
    clReleaseEvent(event);
    return (double)(end - begin) * 1e-6;
}

static inline uint32_t *occlusion_read(occlusion_lab *l, player *p) {
    const size_t n = p->v->pack.scene->samples;
    const vit_opencl *d = p->v->state;
    uint32_t *out = bench_array(n, 4);
    lab_check(clEnqueueReadBuffer(d->queue, l->occluded, CL_TRUE, 0, n * 4, out, 0, NULL, NULL), "clEnqueueReadBuffer");
    return out;
}

static inline void occlusion_close(occlusion_lab *l) {
    clReleaseMemObject(l->rays);
    clReleaseMemObject(l->occluded);
    clReleaseKernel(l->kernel);
    clReleaseProgram(l->program);
}

#endif
