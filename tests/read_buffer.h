/* What an open pack's device holds between frames, for tests that recompute a pass's work on the host. */
#ifndef VIT_TESTS_READ_BUFFER_H
#define VIT_TESTS_READ_BUFFER_H

#include "open_pack.h"
#include "vit.h"

/* A copy of a device buffer; free() it. */
static inline void *read_buffer(const open_pack *p, vit_buffer b) {
    const size_t bytes = (size_t)vit_buffer_bytes(b, p->v->pack.scene, &p->v->launch);
    void *out = malloc(bytes + 1);
    assert_non_null(out);
    vit_text why = {""};
    if (p->v->device->read(p->v->state, b, bytes, out, &why) != VIT_OK)
        fail_msg("%s", why.text);
    return out;
}

#endif
