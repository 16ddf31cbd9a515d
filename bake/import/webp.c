#include "import/webp.h"
#include <stdlib.h>
#include <string.h>
#include <webp/decode.h>

bool webp_is_it(const uint8_t *bytes, size_t size) {
    return size >= 12 && memcmp(bytes, "RIFF", 4) == 0 && memcmp(bytes + 8, "WEBP", 4) == 0;
}

bool webp_size(const uint8_t *bytes, size_t size, int *width, int *height) {
    WebPBitstreamFeatures head;
    if (WebPGetFeatures(bytes, size, &head) != VP8_STATUS_OK || head.has_animation)
        return false;
    *width = head.width;
    *height = head.height;
    return true;
}

uint8_t *webp_decode(const uint8_t *bytes, size_t size, int width, int height) {
    const size_t row = 4 * (size_t)width, all = row * (size_t)height;
    uint8_t *rgba = malloc(all);
    if (rgba && !WebPDecodeRGBAInto(bytes, size, rgba, all, (int)row)) {
        free(rgba);
        return NULL;
    }
    return rgba;
}
