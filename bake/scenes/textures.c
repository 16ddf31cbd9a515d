#include "textures.h"
#include "scenes.h"
#include "vector.h"

#include <errno.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void fill(const texture *t, png_byte *rgb) {
    for (int y = 0; y < t->height; y++) {
        for (int x = 0; x < t->width; x++) {
            double c[3];
            t->at((x + 0.5) / t->width, (y + 0.5) / t->height, c);
            for (int k = 0; k < 3; k++)
                *rgb++ = (png_byte)(clamp01(c[k]) * 255.0 + 0.5);
        }
    }
}

bool texture_write(const texture *t, const char *dir) {
    char path[SCENES_PATH];
    if (!scenes_path(path, dir, t->file, ""))
        return false;
    png_image image;
    memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    image.format = PNG_FORMAT_RGB;
    image.width = (png_uint_32)t->width;
    image.height = (png_uint_32)t->height;
    png_byte *rgb = malloc((size_t)t->width * (size_t)t->height * 3);
    FILE *f = rgb ? fopen(path, "wb") : NULL;
    bool good = false;
    if (f) {
        fill(t, rgb);
        errno = EIO; /* libpng need not set it */
        good = png_image_write_to_stdio(&image, f, 0, rgb, 0, NULL) != 0;
        if (fclose(f) != 0)
            good = false;
    }
    free(rgb);
    return good;
}
