/* The fault log: a ring in the arena of what the host noticed, and one on the device (kernel `account`), read back only here.
 */
#include "vit.h"
#include <string.h>

void vit_note_fault(vit *v, uint32_t pass, uint32_t frame) {
    v->faults[v->noted++ % VIT_HOST_FAULTS] = (vit_host_fault){pass, frame};
}

static const vit_fault kinds[VIT_FAULT_COUNT] = {
#define X(name, level, pass, meaning) {level, #name, pass, meaning, 0, 0},
    VIT_FAULTS(X)
#undef X
};

static void add(vit_fault *out, uint32_t *count, uint32_t code, uint32_t frame, uint64_t times) {
    vit_fault *f = out + (*count)++;
    *f = kinds[code];
    f->frame = frame;
    f->count = times;
}

static void add_devices(const uint32_t words[VIT_FAULT_WORDS], vit_fault *out, uint32_t *count, int *lost) {
    uint32_t noted = words[0], kept = noted < VIT_FAULT_RING ? noted : VIT_FAULT_RING;
    *lost |= noted > kept;
    for (uint32_t i = noted - kept; i < noted; i++) {
        const uint32_t *w = words + 1 + 3 * (i % VIT_FAULT_RING);
        if (w[1] < VIT_FAULT_COUNT) /* what a failing device left behind need not be one */
            add(out, count, w[1], w[0], w[2]);
    }
}

static void add_hosts(const vit *v, vit_fault *out, uint32_t *count, int *lost) {
    uint64_t kept = v->noted < VIT_HOST_FAULTS ? v->noted : VIT_HOST_FAULTS;
    *lost |= v->noted > kept;
    for (uint64_t i = v->noted - kept; i < v->noted; i++) {
        const vit_host_fault *f = v->faults + i % VIT_HOST_FAULTS;
        add(out, count, VIT_FAULT_device_failed, f->frame, 1);
        out[*count - 1].pass = f->pass < vit_pass_count ? vit_passes[f->pass].name : NULL;
    }
}

vit_status vit_faults(vit *v, vit_fault out[VIT_MAX_FAULTS], uint32_t *count, int *lost, vit_text *why) {
    vit_text unused = {""};
    why = why ? why : &unused;
    uint32_t words[VIT_FAULT_WORDS];
    vit_status status = VIT_OK;
    memset(words, 0, sizeof words);
    *count = 0;
    *lost = 0;
    if (vit_buffer_called(B_faults, &v->launch))
        status = v->device->read(v->state, B_faults, sizeof words, words, why);
    if (status == VIT_OK)
        add_devices(words, out, count, lost);
    add_hosts(v, out, count, lost);
    return status;
}
