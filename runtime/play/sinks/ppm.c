/* ppm: one binary P6 file a frame, DIR/frame_00000.ppm. */
#include "sink.h"
#include "output.h"
#include "../failure.h"
#include <stdio.h>
#include <stdlib.h>

#define HEADER_MAX 48 /* "P6\n7680 4320\n255\n" and room */

typedef struct ppm_state {
    const char *folder;
    size_t pixels;  /* a frame */
    size_t header;  /* bytes of the header, the same for all frames */
    uint8_t file[]; /* header, then red, green, blue bytes */
} ppm_state;

static vit_status ppm_open(const sink_setup *setup, void **state, vit_text *why) {
    vit_status status = output_folder(setup->target, why);
    if (status != VIT_OK)
        return status;
    size_t pixels = (size_t)setup->width * setup->height;
    ppm_state *s = malloc(sizeof *s + HEADER_MAX + 3 * pixels);
    if (s == NULL)
        return play_fail(why, VIT_FAILED, "ppm: out of memory for a frame of %zu pixels", pixels);
    s->folder = setup->target;
    s->pixels = pixels;
    s->header = (size_t)snprintf((char *)s->file, HEADER_MAX, "P6\n%u %u\n255\n", setup->width, setup->height);
    *state = s;
    return VIT_OK;
}

static vit_status ppm_write(void *state, const void *pixels, uint32_t index, vit_text *why) {
    ppm_state *s = state;
    const uint32_t *in = pixels;
    uint8_t *out = s->file + s->header;
    for (size_t i = 0; i < s->pixels; i++) {
        out[3 * i] = (uint8_t)(in[i] >> 16);
        out[3 * i + 1] = (uint8_t)(in[i] >> 8);
        out[3 * i + 2] = (uint8_t)in[i];
    }
    return output_frame_file(s->folder, index, "ppm", s->file, s->header + 3 * s->pixels, why);
}

static vit_status ppm_close(void *state, vit_text *why) {
    (void)why;
    free(state);
    return VIT_OK;
}

const sink_kind sink_ppm = {
    .name = "ppm",
    .target = "DIR",
    .meaning = "DIR/frame_00000.ppm and on, binary P6",
    .writes = SINK_FOLDER,
    .open = ppm_open,
    .write = ppm_write,
    .close = ppm_close,
};
