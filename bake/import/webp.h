/* webp.c: WebP pictures, still ones, lossy or not (RFC 9649), through libwebp. */
#ifndef VIT_BAKE_WEBP_H
#define VIT_BAKE_WEBP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

bool webp_is_it(const uint8_t *bytes, size_t size);
/* False: it is cut short, broken, or moves. */
bool webp_size(const uint8_t *bytes, size_t size, int *width, int *height);
/* 4 * width * height, sRGB colour, linear alpha, first row on top; free() it. NULL: broken, or out of memory. */
uint8_t *webp_decode(const uint8_t *bytes, size_t size, int width, int height);

#endif
