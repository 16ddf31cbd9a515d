#include "pack/opened.h"
#include "common/fail.h"
#include <stdlib.h>
#include <string.h>

#define PAGE ((size_t)4096)

static size_t rounded(size_t size) {
    return (size + PAGE - 1) / PAGE * PAGE;
}

vit_status opened_begin(const vit_open_info *how, opened *out, vit_text *why) {
    vit_open_info info = *how;
    memset(out, 0, sizeof *out);
    vit_status status = vit_require(&info, &out->need, why);
    if (status != VIT_OK)
        return status;
    info.arena = out->arena = aligned_alloc(PAGE, rounded(out->need.host_bytes));
    info.arena_size = out->need.host_bytes;
    info.framebuffer = out->frame = aligned_alloc(PAGE, rounded(out->need.frame_bytes));
    out->stride = out->need.frame_bytes / out->need.height;
    if (out->arena && out->frame)
        status = vit_open(&info, &out->v, why);
    else {
        status = bake_fail(why, VIT_FAILED, "out of memory");
    }
    if (status != VIT_OK)
        opened_end(out);
    return status;
}

vit_status opened_frame(opened *o, uint32_t index, vit_text *why) {
    return vit_frame(o->v, index, o->frame, o->stride, why);
}

void opened_end(opened *o) {
    vit_close(o->v);
    free(o->arena);
    free(o->frame);
    memset(o, 0, sizeof *o);
}
