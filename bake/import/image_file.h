/* image_file.c: files of pictures as they are, for the decoders of textures and the sky. */
#ifndef VIT_BAKE_IMAGE_FILE_H
#define VIT_BAKE_IMAGE_FILE_H

#include <stdint.h>

#define IMAGE_FILE_MOST (1 << 30) /* bytes */

/* The whole file, 1..IMAGE_FILE_MOST bytes; free() it. NULL if it cannot be had. */
uint8_t *image_file_read(const char *path, int *size);

#endif
