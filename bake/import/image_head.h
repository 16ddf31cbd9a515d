/* image_head.c: what stb_image leaves to its caller of a picture's head. */
#ifndef VIT_BAKE_IMAGE_HEAD_H
#define VIT_BAKE_IMAGE_HEAD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Pixels; false: no picture that stb_image reads. Rows of a BMP may begin at the top, which it hands on as a height below 0. */
bool image_head_size(const uint8_t *bytes, size_t size, int *width, int *height);
/* What keeps a JPEG from being read right, or NULL: four channels of which no Adobe marker says what they are (stb_image takes
 * them for luma, chroma and something to ignore), or a process that it does not have. Other files pass. */
const char *image_head_jpeg(const uint8_t *bytes, size_t size);
/* The exponent by which a PNG's samples are codes of light (gAMA: PNG, 11.3.3.2), where it states one alone, without sRGB, iCCP
 * or cICP, and not sRGB's 1/2.2; else 0. */
double image_head_gamma(const uint8_t *bytes, size_t size);

#endif
