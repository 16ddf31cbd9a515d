/* framebuffer.c: the memory that frames are rendered into: the sink's own if it lends some, else taken here. */
#ifndef VIT_PLAY_FRAMEBUFFER_H
#define VIT_PLAY_FRAMEBUFFER_H

#include "sinks/sink.h"

typedef struct framebuffer {
    sink_memory memory;
    size_t row, height; /* bytes of a row of pixels; rows */
    bool lent;
    void *own; /* memory's pixels if it is not lent, or else, if its rows lie apart, room for them one behind another */
} framebuffer;

/* `lent`: the sink's memory, or NULL. VIT_FAILED: out of memory. */
vit_status framebuffer_take(framebuffer *f, const sink_memory *lent, const vit_requirements *need, vit_text *why);
/* The frame's rows one behind another; copied only if they lie apart. */
const void *framebuffer_rows(framebuffer *f);
void framebuffer_free(framebuffer *f);

#endif
