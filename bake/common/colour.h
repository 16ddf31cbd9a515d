/* colour.h: luminance and the transfer curve of displays. srgb_linear(), the curve's inverse, is in strict_math.h. */
#ifndef VIT_BAKE_COLOUR_H
#define VIT_BAKE_COLOUR_H

#include <math.h>

/* ITU-R BT.709. Positive wherever any channel is. */
static inline double luminance(double red, double green, double blue) {
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

static inline double luminance_of(const float c[3]) {
    return luminance((double)c[0], (double)c[1], (double)c[2]);
}

/* IEC 61966-2-1 curve of a linear value, clamped to 0..1; not a number is 0. As kernels/resolve.cl. */
static inline double srgb_encoded(double linear) {
    const double c = linear > 0 ? (linear < 1 ? linear : 1) : 0;
    return c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055;
}

#endif
