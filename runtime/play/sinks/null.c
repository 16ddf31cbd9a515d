/* null: frames are rendered, transferred and forgotten. For --verify, --hash and measuring. */
#include "sink.h"

static vit_status null_open(const sink_setup *setup, void **state, vit_text *why) {
    (void)setup;
    (void)why;
    *state = NULL;
    return VIT_OK;
}

static vit_status null_write(void *state, const void *pixels, uint32_t index, vit_text *why) {
    (void)state;
    (void)pixels;
    (void)index;
    (void)why;
    return VIT_OK;
}

static vit_status null_close(void *state, vit_text *why) {
    (void)state;
    (void)why;
    return VIT_OK;
}

const sink_kind sink_null = {
    .name = "null",
    .meaning = "keeps no frame (the default)",
    .any_format = true,
    .open = null_open,
    .write = null_write,
    .close = null_close,
};
