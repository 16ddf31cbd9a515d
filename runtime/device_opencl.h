/* device_opencl.c: everything that calls OpenCL: devices, program, buffers, queue. */
#ifndef VIT_DEVICE_OPENCL_H
#define VIT_DEVICE_OPENCL_H

#include "passes.h"
#include "pack_read.h"
#include <CL/cl.h>

typedef struct vit_device {
    cl_device_id id;
    cl_context context;
    cl_command_queue queue;
    cl_program program;
    cl_kernel kernels[VIT_MAX_PASSES];
    cl_mem buffers[B_COUNT];
    int is_cpu;
    char log[4096];            /* of a failed build */
} vit_device;

/* One line naming the call and its error; VIT_FAILED. */
vit_status vit_cl_failed(vit_text *why, const char *call, cl_int error);

vit_status vit_device_find(uint32_t index, cl_device_id *id, vit_text *why);
/* Sets what in `l` is 0: lanes and group sizes that suit the device. Changes no bit of any frame. */
void vit_device_suit(cl_device_id id, const vit_scene *s, vit_limits *l);
/* framebuffer: host memory to render into if the device shares it, or NULL. */
vit_status vit_device_open(vit_device *d, const vit_pack *pack, const vit_limits *l, int profile, void *framebuffer, vit_text *why);
void vit_device_close(vit_device *d);

#endif
