/* opened.c: a pack in memory, opened with the memory that it asks for. */
#ifndef VIT_BAKE_OPENED_H
#define VIT_BAKE_OPENED_H

#include "vitrine.h"

typedef struct opened {
    void *arena;
    uint8_t *frame; /* tightly packed, on a page: rendered in place where the device can */
    size_t stride;  /* bytes per row */
    vit_requirements need;
    vit *v;
} opened;

/* `how`: all of vit_open_info but arena and framebuffer. On failure nothing is left to close. */
vit_status opened_begin(const vit_open_info *how, opened *out, vit_text *why);
/* Renders frame `index` into o->frame. */
vit_status opened_frame(opened *o, uint32_t index, vit_text *why);
/* Zeroed structs are allowed. */
void opened_end(opened *o);

#endif
