#include "framebuffer.h"
#include "failure.h"
#include <stdlib.h>
#include <string.h>

#define PAGE 4096 /* devices that share host memory want the framebuffer on a page */

vit_status framebuffer_take(framebuffer *f, const sink_memory *lent, const vit_requirements *need, vit_text *why) {
    *f = (framebuffer){.row = need->frame_bytes / need->height, .height = need->height, .lent = lent != NULL};
    if (lent != NULL)
        f->memory = *lent;
    if (lent != NULL && lent->pitch == f->row)
        return VIT_OK;
    f->own = aligned_alloc(PAGE, (need->frame_bytes / PAGE + 1) * PAGE);
    if (f->own == NULL)
        return play_fail(why, VIT_FAILED, "out of memory: %zu bytes for the framebuffer", need->frame_bytes);
    if (lent == NULL)
        f->memory = (sink_memory){f->own, f->row, need->frame_bytes};
    return VIT_OK;
}

const void *framebuffer_rows(framebuffer *f) {
    if (f->memory.pitch == f->row)
        return f->memory.pixels;
    for (size_t y = 0; y < f->height; y++)
        memcpy((char *)f->own + y * f->row, (const char *)f->memory.pixels + y * f->memory.pitch, f->row);
    return f->own;
}

void framebuffer_free(framebuffer *f) {
    free(f->own);
    *f = (framebuffer){0};
}
