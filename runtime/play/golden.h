/* golden.c: the hashes of frames as a text file, to be committed beside a scene and compared wherever it plays.
 *
 *     vitrine-golden 1
 *     frames 0:24 view final format xrgb8888 size 640x360
 *     0 8f0c3a5e12d4b697        frame and hash (16 hexadecimal digits), each frame of the range in its order
 *     ...
 *     end
 *
 * Lines that begin with '#' say nothing. Hashes are equal on every device and machine, so a frame that differs by one bit is a
 * change. */
#ifndef VIT_PLAY_GOLDEN_H
#define VIT_PLAY_GOLDEN_H

#include "vitrine.h"

#define GOLDEN_NAME 48

/* What the frames are of. */
typedef struct golden_frames {
    uint32_t first, end;
    const char *view, *format; /* names */
    uint32_t width, height;
} golden_frames;

/* Fills hashes[0 .. end - first - 1]. VIT_BAD_INPUT: "FILE:LINE: cause", or it cannot be read. VIT_USAGE: it is of other
 * frames, of another view, format or size, which the text tells. */
vit_status golden_read(const char *path, const golden_frames *of, uint64_t *hashes, vit_text *why);

/* VIT_FAILED: it cannot be written. */
vit_status golden_write(const char *path, const golden_frames *of, const uint64_t *hashes, vit_text *why);

#endif
