/* radiance.c: what stb_image leaves out of Radiance pictures (Ward, "Real Pixels", Graphics Gems II, 1991): the header's
 * factors, and run lengths of the old kind, which it takes for pixels. */
#ifndef VIT_BAKE_RADIANCE_H
#define VIT_BAKE_RADIANCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* In what order the pixels are, but for "-Y N +X M": rows from the top, each from the left. */
typedef struct radiance_order {
    bool columns;                 /* scanlines are columns */
    bool from_bottom, from_right; /* the picture begins there */
} radiance_order;

/* Takes note of the order that the resolution line states and writes "-Y ... +X ..." over it, which is all that stb_image
 * reads: as many scanlines, as many pixels each. What keeps the picture from being read, or NULL. */
const char *radiance_stand(uint8_t *bytes, size_t size, radiance_order *order);
/* Puts the pixels that were read so, 3 floats each, in rows from the top; sides change places where scanlines are columns. *rgb
 * is malloc's. False: out of memory, and *rgb is freed and NULL. */
bool radiance_turn(float **rgb, int *width, int *height, const radiance_order *order);

/* Divisors of the three channels: the products of the header's EXPOSURE and COLORCORR lines. Returns what keeps the picture
 * from being read right, or NULL: a factor that is no positive number, pixels that are cut short, runs of the old kind. */
const char *radiance_check(const uint8_t *bytes, size_t size, int width, int height, double divisor[3]);

#endif
