/* report_image.c: 8-bit pictures as PNG in base64, and the two colour maps. */
#include "report/report_parts.h"

#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

/* Colour `i` of the map between the given ones, which are evenly spaced, in sRGB values. */
static void between(report_map *map, const uint8_t (*stops)[3], uint32_t count) {
    for (uint32_t i = 0; i < REPORT_COLOURS; i++) {
        const double at = (double)i * (count - 1) / (REPORT_COLOURS - 1);
        const uint32_t k = (uint32_t)at < count - 2 ? (uint32_t)at : count - 2;
        for (int c = 0; c < 3; c++)
            map->rgb[i][c] = (uint8_t)lround(stops[k][c] + (at - k) * (stops[k + 1][c] - stops[k][c]));
    }
}

/* ColorBrewer's RdBu (Brewer 2003), blue first: told apart with every common colour blindness. */
report_map report_map_signed(void) {
    static const uint8_t stops[][3] = {{5, 48, 97},     {33, 102, 172},  {67, 147, 195},  {146, 197, 222},
                                       {209, 229, 240}, {247, 247, 247}, {253, 219, 199}, {244, 165, 130},
                                       {214, 96, 77},   {178, 24, 43},   {103, 0, 31}};
    report_map map;
    between(&map, stops, sizeof stops / sizeof stops[0]);
    return map;
}

/* Nine colours of matplotlib's inferno (Smith, van der Walt 2015): brightness rises evenly. */
report_map report_map_squared(void) {
    static const uint8_t stops[][3] = {{0, 0, 4},     {31, 12, 72},   {85, 15, 109},  {136, 34, 106}, {186, 54, 85},
                                       {227, 89, 51}, {249, 140, 10}, {249, 201, 50}, {252, 255, 164}};
    report_map map;
    between(&map, stops, sizeof stops / sizeof stops[0]);
    return map;
}

static void print_base64(FILE *to, const uint8_t *bytes, size_t size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        const uint32_t left = size - i < 3 ? (uint32_t)(size - i) : 3;
        uint32_t word = (uint32_t)bytes[i] << 16;
        if (left > 1)
            word |= (uint32_t)bytes[i + 1] << 8;
        if (left > 2)
            word |= bytes[i + 2];
        const char four[4] = {digits[word >> 18], digits[word >> 12 & 63], left > 1 ? digits[word >> 6 & 63] : '=',
                              left > 2 ? digits[word & 63] : '='};
        (void)fwrite(four, 1, sizeof four, to);
    }
}

static bool print_png(FILE *to, png_image *image, const void *pixels, const void *colours) {
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(*image);
    uint8_t *file = malloc(size);
    if (!file || !png_image_write_to_memory(image, file, &size, 0, pixels, 0, colours)) {
        free(file);
        return false;
    }
    (void)fputs("data:image/png;base64,", to);
    print_base64(to, file, size);
    free(file);
    return true;
}

bool report_png_rgb(FILE *to, const uint8_t *rgb, uint32_t width, uint32_t height) {
    png_image image = {.version = PNG_IMAGE_VERSION, .width = width, .height = height, .format = PNG_FORMAT_RGB};
    return print_png(to, &image, rgb, NULL);
}

bool report_png_map(FILE *to, const uint8_t *index, uint32_t width, uint32_t height, const report_map *map) {
    png_image image = {.version = PNG_IMAGE_VERSION,
                       .width = width,
                       .height = height,
                       .format = PNG_FORMAT_RGB_COLORMAP,
                       .colormap_entries = REPORT_COLOURS};
    return print_png(to, &image, index, map->rgb);
}
