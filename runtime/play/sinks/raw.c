/* raw: tightly packed frames one after another, in the asked format and the machine's byte order; no header. */
#include "sink.h"
#include "output.h"
#include "../failure.h"
#include <stdlib.h>

typedef struct raw_state {
    output out;
    size_t frame_bytes;
} raw_state;

static vit_status raw_open(const sink_setup *setup, void **state, vit_text *why) {
    raw_state *s = malloc(sizeof *s);
    if (s == NULL)
        return play_fail(why, VIT_FAILED, "raw: out of memory");
    s->frame_bytes = setup->frame_bytes;
    vit_status status = output_open(setup->target, &s->out, why);
    if (status != VIT_OK) {
        free(s);
        return status;
    }
    *state = s;
    return VIT_OK;
}

static vit_status raw_write(void *state, const void *pixels, uint32_t index, vit_text *why) {
    (void)index;
    const raw_state *s = state;
    return output_write(&s->out, pixels, s->frame_bytes, why);
}

static vit_status raw_close(void *state, vit_text *why) {
    raw_state *s = state;
    vit_status status = output_close(&s->out, why);
    free(s);
    return status;
}

const sink_kind sink_raw = {
    .name = "raw",
    .target = "FILE|-",
    .meaning = "tightly packed frames in --format and this machine's byte order",
    .writes = SINK_STREAM,
    .any_format = true,
    .open = raw_open,
    .write = raw_write,
    .close = raw_close,
};
