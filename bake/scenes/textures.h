/* textures.c: procedural pictures as PNG. */
#ifndef VIT_SCENES_TEXTURES_H
#define VIT_SCENES_TEXTURES_H

#include <stdbool.h>
#include <stddef.h>

/* sRGB values in 0..1 of the point (u, v) of the unit square; v grows downward. Must repeat at the borders. */
typedef void texture_fn(double u, double v, double rgb[3]);

typedef struct texture {
    const char *file;
    int width, height; /* pixels */
    texture_fn *at;
} texture;

/* atrium_textures.c: the list of the atrium's textures, `count` of them. */
const texture *atrium_textures(size_t *count);

/* Writes DIR/file. False: errno says why. */
bool texture_write(const texture *t, const char *dir);

#endif
