/* image_whole.c: pictures that stb_image reads otherwise than they are, and says nothing. */
#ifndef VIT_BAKE_IMAGE_WHOLE_H
#define VIT_BAKE_IMAGE_WHOLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A TGA, BMP or JPEG that ends before its last pixel: what is missing would come out grey or black. Others pass. */
bool image_is_cut(const uint8_t *bytes, size_t size);
/* A BMP with run lengths, which is not read. */
bool image_is_packed_bmp(const uint8_t *bytes, size_t size);
/* Turns the rows of a TGA whose pixels begin at the right; rgba: width * height * 4 as decoded. */
void image_turn(const uint8_t *bytes, size_t size, uint8_t *rgba, int width, int height);

#endif
