/* Which devices there are, and which of them a name means. */
#include "device.h"
#include <stdio.h>
#include <string.h>

#if !VIT_OPENCL
static const char *vit_opencl_name(uint32_t index, vit_text *why) {
    (void)index;
    snprintf(why->text, sizeof why->text, "built without OpenCL: the only device is host");
    return NULL;
}

static int vit_opencl_is(uint32_t index, int gpu) {
    (void)index;
    (void)gpu;
    return 0;
}
#endif

const char *vit_device_name(uint32_t index, vit_text *why) {
    static const char unnamed[] = "";
    vit_text unused = {""};
    const char *name =
        index == VIT_DEVICE_HOST ? vit_host_name(why ? why : &unused) : vit_opencl_name(index, why ? why : &unused);
    return name && !why ? unnamed : name;
}

uint32_t vit_device_default(void) {
    return vit_device_name(0, NULL) ? 0 : VIT_DEVICE_HOST;
}

static char lower(char c) {
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

/* Is `part` at the beginning of `text`, in either case? */
static int begins(const char *text, const char *part) {
    while (*part && lower(*text) == lower(*part)) {
        text++;
        part++;
    }
    return *part == '\0';
}

static int same(const char *a, const char *b) {
    return strlen(a) == strlen(b) && begins(a, b);
}

/* How well a name fits a device: 2 by its platform or kind, 1 by the rest of its text, 0 not. */
static int fits(uint32_t index, const char *text, const char *name) {
    if (same(name, "gpu") || same(name, "cpu"))
        return vit_opencl_is(index, same(name, "gpu")) ? 2 : 0;
    if (same(name, "pocl"))
        name = "Portable Computing Language";
    const char *device = strstr(text, " / ");
    for (const char *at = text; *at; at++)
        if (begins(at, name))
            return !device || at < device ? 2 : 1;
    return 0;
}

/* Adds the devices that there are to the text. */
static void list_devices(vit_text *why) {
    vit_text name;
    size_t n = strlen(why->text);
    for (uint32_t i = 0; vit_opencl_name(i, &name) && n < sizeof why->text; i++)
        n += (size_t)snprintf(why->text + n, sizeof why->text - n, "%u %.100s; ", i, name.text);
    const char *without = strstr(name.text, "; without"); /* what is said beyond the last */
    if (n < sizeof why->text)
        snprintf(why->text + n, sizeof why->text - n, "host%s", without ? without : "");
}

/* Digits only; beyond 32 bits it is no number of a device, but a name that none has. */
static int number(const char *text, uint32_t *out) {
    uint64_t value = 0;
    if (!*text)
        return 0;
    for (; *text; text++) {
        if (*text < '0' || *text > '9')
            return 0;
        value = value < VIT_DEVICE_HOST ? value * 10 + (uint64_t)(*text - '0') : value;
    }
    *out = value < VIT_DEVICE_HOST ? (uint32_t)value : VIT_DEVICE_HOST;
    return value < VIT_DEVICE_HOST;
}

vit_status vit_device_find(const char *name, uint32_t *index, vit_text *why) {
    vit_text text, first, unused = {""};
    int best = 0, unlike = 0; /* devices that fit as well as the first, and are called otherwise */
    why = why ? why : &unused;
    *index = VIT_DEVICE_HOST;
    if (same(name, "host"))
        return VIT_OK;
    if (number(name, index))
        return vit_opencl_name(*index, why) ? VIT_OK : VIT_FAILED;
    for (uint32_t i = 0; *name && vit_opencl_name(i, &text); i++) {
        const int fit = fits(i, text.text, name);
        if (fit > best) {
            *index = i;
            best = fit;
            unlike = 0;
            first = text;
        } else if (fit > 0 && fit == best)
            unlike += strcmp(first.text, text.text) != 0;
    }
    if (best > 0 && unlike == 0)
        return VIT_OK;
    snprintf(why->text, sizeof why->text,
             best > 0 ? "device '%.60s' may be one of several; there are: " : "there is no device '%.60s'; there are: ", name);
    list_devices(why);
    return best > 0 || !*name ? VIT_USAGE : VIT_FAILED;
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
