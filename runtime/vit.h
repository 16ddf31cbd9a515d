/* An open pack: what vit_open() puts into the caller's arena. The device's state and memory follow it there. */
#ifndef VIT_VIT_H
#define VIT_VIT_H

#include "device.h"

struct vit {
    vit_pack pack;
    vit_limits limits;
    const vit_device *device;
    void *state;               /* the device's */
    int profile;
    uint64_t frames;           /* rendered since vit_open */
    double pass_ms[VIT_MAX_PASSES];
};

#endif
