/* An open pack: what vit_open() puts into the caller's arena. */
#ifndef VIT_VIT_H
#define VIT_VIT_H

#include "device_opencl.h"

#define VIT_MAX_ENQUEUES 160 /* rows of the table times levels, at most */

struct vit {
    vit_pack pack;
    vit_limits limits;
    vit_device device;
    int profile;
    void *in_place;            /* the framebuffer that the device renders into; NULL: frames are read out */
    uint64_t frames;           /* rendered since vit_open */
    uint32_t enqueued;         /* commands of the last frame, with profile */
    uint32_t enqueued_pass[VIT_MAX_ENQUEUES];
    cl_event events[VIT_MAX_ENQUEUES];
    double pass_ms[VIT_MAX_PASSES];
};

#endif
