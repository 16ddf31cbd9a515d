#include "import/image_head.h"
#include <limits.h>
#include <math.h>
#include <stb/stb_image.h>
#include <string.h>

bool image_head_size(const uint8_t *bytes, size_t size, int *width, int *height) {
    int channels;
    if (size > INT_MAX || !stbi_info_from_memory(bytes, (int)size, width, height, &channels))
        return false;
    if (size >= 2 && memcmp(bytes, "BM", 2) == 0 && *height < 0 && *height > -INT_MAX)
        *height = -*height;
    return true;
}

/* ---- JPEG: ITU T.81, annex B ---- */

enum { SOF0 = 0xc0, DHT = 0xc4, JPG = 0xc8, DAC = 0xcc, SOF15 = 0xcf, SOS = 0xda, APP14 = 0xee };

static bool begins_frame(int marker) {
    return marker >= SOF0 && marker <= SOF15 && marker != DHT && marker != JPG && marker != DAC;
}

const char *image_head_jpeg(const uint8_t *bytes, size_t size) {
    bool adobe = false;
    if (size < 4 || bytes[0] != 0xff || bytes[1] != 0xd8)
        return NULL;
    for (size_t at = 2; at + 4 <= size && bytes[at] == 0xff;) {
        const int marker = bytes[at + 1];
        const size_t length = (size_t)bytes[at + 2] << 8 | bytes[at + 3];
        const uint8_t *segment = bytes + at + 4;
        if (marker == 0xff) { /* fill */
            at++;
            continue;
        }
        if (marker == SOS || length < 2 || at + 2 + length > size)
            return NULL; /* the decoder has the words for it */
        adobe |= marker == APP14 && length >= 14 && memcmp(segment, "Adobe", 5) == 0;
        if (begins_frame(marker) && length >= 8) {
            if (marker > SOF0 + 2 || segment[0] != 8)
                return "is a JPEG of a kind that is not read (arithmetic, lossless, hierarchical or more than 8 bits)";
            if (segment[5] == 4 && !adobe)
                return "is a JPEG of four channels that does not say which (no Adobe marker): save it as RGB";
        }
        at += 2 + length;
    }
    return NULL;
}

/* ---- PNG: ISO/IEC 15948 ---- */

static uint32_t big_endian(const uint8_t *at) {
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

double image_head_gamma(const uint8_t *bytes, size_t size) {
    double gamma = 0.0;
    if (size < 8 || memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) != 0)
        return 0.0;
    for (size_t at = 8; size - at >= 12;) {
        const uint32_t length = big_endian(bytes + at);
        const uint8_t *kind = bytes + at + 4;
        if (!memcmp(kind, "sRGB", 4) || !memcmp(kind, "iCCP", 4) || !memcmp(kind, "cICP", 4))
            return 0.0;
        if (!memcmp(kind, "IDAT", 4) || length > size - at - 12)
            break;
        if (!memcmp(kind, "gAMA", 4) && length == 4)
            gamma = big_endian(kind + 4) / 1e5;
        at += 12 + (size_t)length;
    }
    return fabs(gamma - 1.0 / 2.2) < 0.02 ? 0.0 : gamma;
}
