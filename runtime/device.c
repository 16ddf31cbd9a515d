/* Which devices there are. */
#include "device.h"
#include <stdio.h>

#if !VIT_OPENCL
static const char *vit_opencl_name(uint32_t index, vit_text *why) {
    (void)index;
    snprintf(why->text, sizeof why->text, "built without OpenCL: the only device is host");
    return NULL;
}
#endif

const char *vit_device_name(uint32_t index, vit_text *why) {
    return index == VIT_DEVICE_HOST ? vit_host_name(why) : vit_opencl_name(index, why);
}

uint32_t vit_device_default(void) {
    vit_text unused;
    return vit_opencl_name(0, &unused) ? 0 : VIT_DEVICE_HOST;
}

vit_status vit_device_of(uint32_t index, const vit_device **out, vit_text *why) {
#if VIT_OPENCL
    (void)why;
    *out = index == VIT_DEVICE_HOST ? &vit_device_host : &vit_device_opencl;
    return VIT_OK;
#else
    *out = &vit_device_host;
    return index == VIT_DEVICE_HOST || vit_opencl_name(index, why) ? VIT_OK : VIT_FAILED;
#endif
}
