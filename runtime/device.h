/* The seam between the library and what runs the frame's passes: device_opencl.c and device_host.c give a vit_device each, and
 * nothing else knows which it has. All of a device's state, and the buffers that are the host's memory, lie in the caller's
 * arena. */
#ifndef VIT_DEVICE_H
#define VIT_DEVICE_H

#include "passes.h"
#include "pack_read.h"

#define VIT_MAX_ENQUEUES 2048 /* rows of the table times levels times rounds, at most */

/* One run of a pass. */
typedef struct vit_step {
    uint32_t pass, level, frame, round;
} vit_step;

/* What a device is opened with. All but the info lives as long as the device. */
typedef struct vit_device_setup {
    const vit_open_info *info; /* device, threads, host_isa, wide_divide, profile, framebuffer */
    const vit_pack *pack;      /* in the machine's byte order */
    const vit_launch *launch;
    void *state, *memory; /* in the arena, 64-byte aligned, state zeroed: state_bytes, memory_bytes() */
} vit_device_setup;

typedef struct vit_device {
    size_t state_bytes;
    /* Bytes of buffers that the arena must hold; in_place: the caller's framebuffer is used. SIZE_MAX: more than there can be.
     */
    size_t (*memory_bytes)(const vit_scene *s, const vit_launch *l, int in_place);
    /* Sets what in `l` is 0: lanes and group sizes that suit the device. Changes no bit of any frame. VIT_FAILED: no such
     * device. */
    vit_status (*suit)(const vit_open_info *info, const vit_scene *s, vit_launch *l, vit_text *why);
    /* After an error close() is still to be called. All buffers begin as zeros or with the pack's data. */
    vit_status (*open)(const vit_device_setup *setup, vit_text *why);
    void (*close)(void *state);
    /* Buffers as open() left them. NULL: nothing of a device's work is left to its first frame, so that it needs no frame
     * before. */
    vit_status (*rewind)(void *state, vit_text *why);
    /* Puts one run of a pass behind those before it. */
    vit_status (*run)(void *state, const vit_step *step, vit_text *why);
    vit_status (*clear)(void *state, vit_buffer b, vit_text *why);
    /* Waits, then copies the beginning of a buffer. */
    vit_status (*read)(void *state, vit_buffer b, size_t bytes, void *out, vit_text *why);
    /* Waits; then the frame is in `framebuffer`, rows `stride` bytes apart; NULL: it only waits. */
    vit_status (*show)(void *state, void *framebuffer, size_t stride, vit_text *why);
    /* Milliseconds of each pass since the last call, VIT_MAX_PASSES of them; after show() or read() of the frame. */
    void (*times)(void *state, double *pass_ms);
} vit_device;

extern const vit_device vit_device_host;
#if VIT_OPENCL
extern const vit_device vit_device_opencl;
/* "platform / device / driver" of OpenCL device `index`; NULL: there is none, and `why` says why. */
const char *vit_opencl_name(uint32_t index, vit_text *why);
/* Is OpenCL device `index` a GPU, or, with gpu 0, a CPU? */
int vit_opencl_is(uint32_t index, int gpu);
#endif

/* "Vitrine / host / ..." of the built-in device. */
const char *vit_host_name(vit_text *why);

/* The device that vit_open_info.device means. VIT_FAILED: this library was built without OpenCL. */
vit_status vit_device_of(uint32_t index, const vit_device **out, vit_text *why);

#endif
