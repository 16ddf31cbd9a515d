/* An open pack: what vit_open() puts into the caller's arena. The device's state and memory follow it there. */
#ifndef VIT_VIT_H
#define VIT_VIT_H

#include "device.h"

#define VIT_HOST_FAULTS 16 /* kept */

/* A fault that the host noticed: a call of the device in this pass and frame failed. */
typedef struct vit_host_fault {
    uint32_t pass, frame; /* pass VIT_MAX_PASSES: none */
} vit_host_fault;

struct vit {
    vit_pack pack;
    vit_launch launch;
    const vit_device *device;
    void *state; /* the device's */
    int profile;
    uint32_t history; /* effect live-cache: the frame that comes after those in its buffers; VIT_NONE: nobody knows */
    uint64_t frames;  /* rendered since vit_open */
    double pass_ms[VIT_MAX_PASSES];
    vit_host_fault faults[VIT_HOST_FAULTS]; /* a ring */
    uint64_t noted;                         /* faults put into it */
};

/* frame.c: puts the passes of a frame behind one another; they may still run. */
vit_status vit_walk(vit *v, uint32_t frame, vit_text *why);

void vit_note_fault(vit *v, uint32_t pass, uint32_t frame);

#endif
