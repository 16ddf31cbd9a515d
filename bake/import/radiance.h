/* radiance.c: what stb_image leaves out of Radiance pictures (Ward, "Real Pixels", Graphics Gems II, 1991): the header's
 * factors, and run lengths of the old kind, which it takes for pixels. */
#ifndef VIT_BAKE_RADIANCE_H
#define VIT_BAKE_RADIANCE_H

#include <stddef.h>
#include <stdint.h>

/* Divisors of the three channels: the products of the header's EXPOSURE and COLORCORR lines. Returns what keeps the picture
 * from being read right, or NULL: a factor that is no positive number, pixels that are cut short, runs of the old kind. */
const char *radiance_check(const uint8_t *bytes, size_t size, int width, int height, double divisor[3]);

#endif
