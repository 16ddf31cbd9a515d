/* y4m: YUV4MPEG2, which ffmpeg, mpv and encoders read from a pipe. Planes Y, Cb, Cr of 8 bits in full resolution (C444),
 * limited range, matrix of ITU-R BT.709-6: section 3 for the luma weights, section 4 for the quantisation
 * (luma 16..235, chroma 16..240). In integers, so that the same frame gives the same bytes everywhere. */
#include "sink.h"
#include "output.h"
#include "../failure.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct y4m_state {
    output out;
    size_t pixels;   /* a frame */
    size_t bytes;    /* of `frame` */
    uint8_t frame[]; /* "FRAME\n" and three planes */
} y4m_state;

static const char frame_header[] = "FRAME\n";
#define FRAME_HEADER_BYTES (sizeof frame_header - 1)

typedef struct ratio {
    uint32_t over, under;
} ratio;

static bool close_to(double a, double b, double tolerance) {
    return a - b < tolerance && b - a < tolerance;
}

/* The rate as players write it: 24:1, 24000:1001 (which scene files round to 23.976), else thousandths. */
static ratio rate_of(double fps) {
    double limited = fps < 0.001 ? 0.001 : fps > 1e6 ? 1e6 : fps; /* keeps the numbers below in 32 bits */
    uint32_t whole = (uint32_t)(limited + 0.5);
    if (close_to(limited, whole, 1e-5))
        return (ratio){whole, 1};
    uint32_t ntsc = (uint32_t)(limited * 1.001 + 0.5) * 1000;
    if (close_to(limited, ntsc / 1001.0, 5e-4))
        return (ratio){ntsc, 1001};
    return (ratio){(uint32_t)(limited * 1000 + 0.5), 1000};
}

static vit_status write_header(const output *out, const sink_setup *setup, vit_text *why) {
    char header[160];
    ratio r = rate_of(setup->fps);
    int length = snprintf(header, sizeof header, "YUV4MPEG2 W%u H%u F%u:%u Ip A1:1 C444 XYSCSS=444 XCOLORRANGE=LIMITED\n",
                          setup->width, setup->height, r.over, r.under);
    return output_write(out, header, (size_t)length, why);
}

static vit_status y4m_open(const sink_setup *setup, void **state, vit_text *why) {
    size_t pixels = (size_t)setup->width * setup->height;
    size_t bytes = FRAME_HEADER_BYTES + 3 * pixels;
    y4m_state *s = malloc(sizeof *s + bytes);
    if (s == NULL)
        return play_fail(why, VIT_FAILED, "y4m: out of memory for a frame of %zu bytes", bytes);
    s->pixels = pixels;
    s->bytes = bytes;
    memcpy(s->frame, frame_header, FRAME_HEADER_BYTES);
    vit_status status = output_open(setup->target, &s->out, why);
    if (status == VIT_OK) {
        status = write_header(&s->out, setup, why);
        vit_text unused;
        if (status != VIT_OK)
            (void)output_close(&s->out, &unused);
    }
    if (status != VIT_OK) {
        free(s);
        return status;
    }
    *state = s;
    return VIT_OK;
}

/* Rows of the matrix times 65536, scaled by 219/255 (luma) and 224/255 (chroma). Chroma rows sum to 0: grey stays grey. The
 * offsets 16 and 128 and the rounding half keep every sum positive, so the shift is a division with known rounding. */
static void to_yuv(const uint32_t *pixels, size_t count, uint8_t *y, uint8_t *cb, uint8_t *cr) {
    for (size_t i = 0; i < count; i++) {
        int32_t r = (int32_t)(pixels[i] >> 16 & 255), g = (int32_t)(pixels[i] >> 8 & 255), b = (int32_t)(pixels[i] & 255);
        y[i] = (uint8_t)((11966 * r + 40254 * g + 4064 * b + (16 << 16) + 32768) >> 16);
        cb[i] = (uint8_t)((-6596 * r - 22188 * g + 28784 * b + (128 << 16) + 32768) >> 16);
        cr[i] = (uint8_t)((28784 * r - 26145 * g - 2639 * b + (128 << 16) + 32768) >> 16);
    }
}

static vit_status y4m_write(void *state, const void *pixels, uint32_t index, vit_text *why) {
    (void)index;
    y4m_state *s = state;
    uint8_t *y = s->frame + FRAME_HEADER_BYTES;
    to_yuv(pixels, s->pixels, y, y + s->pixels, y + 2 * s->pixels);
    return output_write(&s->out, s->frame, s->bytes, why);
}

static vit_status y4m_close(void *state, vit_text *why) {
    y4m_state *s = state;
    vit_status status = output_close(&s->out, why);
    free(s);
    return status;
}

const sink_kind sink_y4m = {
    .name = "y4m",
    .target = "FILE|-",
    .meaning = "YUV4MPEG2 video, 4:4:4, BT.709: what ffmpeg and mpv read",
    .writes = SINK_STREAM,
    .open = y4m_open,
    .write = y4m_write,
    .close = y4m_close,
};
