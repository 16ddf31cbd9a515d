/* png: one 8-bit RGB file a frame, DIR/frame_00000.png, marked as sRGB. Encoded in memory by libpng's simplified interface,
 * which needs no setjmp, then written whole. Built without libpng, the sink is still listed and says what is missing. */
#include "sink.h"
#include "output.h"
#include "../failure.h"

#if !defined(VIT_NO_PNG) && defined(__has_include)
#if __has_include(<png.h>)
#define HAVE_PNG 1
#endif
#endif

#ifdef HAVE_PNG
#include <png.h>
#include <stdlib.h>
#include <string.h>

typedef struct png_state {
    const char *folder;
    uint32_t width, height; /* pixels */
    size_t room;            /* bytes of `file` */
    uint8_t *rgb;           /* the frame as red, green, blue bytes */
    uint8_t *file;          /* the encoded frame */
} png_state;

/* Deflate adds at most 5 bytes to each stored block of 16 KiB or more; filters add a byte a row; chunk headers (12 bytes for
 * each 8 KiB of IDAT in libpng) and the small chunks come on top. A sixteenth and 64 KiB hold them all, many times over. */
static size_t room_for(size_t rgb_bytes, size_t rows) {
    size_t plain = rgb_bytes + rows;
    return plain + plain / 16 + 65536;
}

static vit_status png_sink_close(void *state, vit_text *why) {
    (void)why;
    png_state *s = state;
    free(s->rgb);
    free(s->file);
    free(s);
    return VIT_OK;
}

static vit_status png_sink_open(const sink_setup *setup, void **state, vit_text *why) {
    vit_status status = output_folder(setup->target, why);
    if (status != VIT_OK)
        return status;
    size_t bytes = (size_t)setup->width * setup->height * 3;
    png_state *s = calloc(1, sizeof *s);
    if (s == NULL)
        return play_fail(why, VIT_FAILED, "png: out of memory");
    s->folder = setup->target;
    s->width = setup->width;
    s->height = setup->height;
    s->room = room_for(bytes, setup->height);
    s->rgb = malloc(bytes);
    s->file = malloc(s->room);
    if (s->rgb == NULL || s->file == NULL) {
        (void)png_sink_close(s, why);
        return play_fail(why, VIT_FAILED, "png: out of memory for a frame of %zu bytes", bytes);
    }
    *state = s;
    return VIT_OK;
}

static vit_status png_sink_write(void *state, const void *pixels, uint32_t index, vit_text *why) {
    png_state *s = state;
    const uint32_t *in = pixels;
    size_t count = (size_t)s->width * s->height;
    for (size_t i = 0; i < count; i++) {
        s->rgb[3 * i] = (uint8_t)(in[i] >> 16);
        s->rgb[3 * i + 1] = (uint8_t)(in[i] >> 8);
        s->rgb[3 * i + 2] = (uint8_t)in[i];
    }
    png_image image;
    memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    image.width = s->width;
    image.height = s->height;
    image.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = s->room;
    if (!png_image_write_to_memory(&image, s->file, &size, 0, s->rgb, 0, NULL))
        return play_fail(why, VIT_FAILED, "png: frame %u: %s", index, image.message);
    return output_frame_file(s->folder, index, "png", s->file, size, why);
}

#else

static vit_status png_sink_open(const sink_setup *setup, void **state, vit_text *why) {
    (void)setup;
    (void)state;
    return play_fail(why, VIT_USAGE, "--out png: this build has no libpng: use ppm:DIR, or build again with libpng's header");
}

static vit_status png_sink_write(void *state, const void *pixels, uint32_t index, vit_text *why) {
    (void)state;
    (void)pixels;
    return play_fail(why, VIT_USAGE, "--out png: frame %u: this build has no libpng", index);
}

static vit_status png_sink_close(void *state, vit_text *why) {
    (void)state;
    (void)why;
    return VIT_OK;
}

#endif

const sink_kind sink_png = {
    .name = "png",
    .target = "DIR",
    .meaning = "DIR/frame_00000.png and on, 8-bit RGB",
    .writes = SINK_FOLDER,
    .open = png_sink_open,
    .write = png_sink_write,
    .close = png_sink_close,
};
