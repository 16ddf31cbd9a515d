/* device_opencl.c: everything that calls OpenCL. Its state, for benches that run kernels of their own on an open pack's device.
 */
#ifndef VIT_DEVICE_OPENCL_H
#define VIT_DEVICE_OPENCL_H

#include "device.h"
#include <CL/cl.h>

typedef struct vit_opencl {
    const vit_pack *pack;
    const vit_scene *scene;
    const vit_launch *launch;
    cl_device_id id;
    cl_context context;
    cl_command_queue queue;
    cl_program program;
    cl_kernel kernels[VIT_MAX_PASSES];
    uint32_t most[VIT_MAX_PASSES]; /* work-items of a work-group that the kernel can be run with here, a power of two */
    cl_mem buffers[B_COUNT];
    int is_cpu, profile;
    int wide_divide;   /* floats are divided as doubles: VIT_WIDE_DIVIDE in strict.clh */
    void *in_place;    /* the caller's framebuffer if the device renders into it */
    uint32_t enqueued; /* commands since times() was asked for, with profile */
    uint32_t enqueued_pass[VIT_MAX_ENQUEUES];
    cl_event events[VIT_MAX_ENQUEUES];
    char log[4096]; /* of a failed build */
} vit_opencl;

#endif
