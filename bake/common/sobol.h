/* sobol.h: sets of points for pixels: stretches of a plane sequence of which any 2^m in a row, from a multiple of 2^m on, lie
 * one in each elementary box: the first two dimensions of Sobol's (1967). Kollig & Keller, Efficient multidimensional sampling,
 * 2002. */
#ifndef VIT_BAKE_SOBOL_H
#define VIT_BAKE_SOBOL_H

#include <stdint.h>

/* Point i of the `samples` of set k of 16, 0 < x, y < 1. The 16 sets are those of a 4 x 4 block of pixels: they take stretches
 * in Z-order, so that the four of each 2 x 2 pixels, and all 16, make one even set, too. */
static inline void sobol_point(uint32_t samples, uint32_t k, uint32_t i, double *x, double *y) {
    uint32_t a = 0, b = 0, middle = 1u << 31;
    for (uint32_t n = 1; n < 16 * samples; n *= 2)
        middle >>= 1; /* half of the finest digit: points lie in the middles of their boxes */
    i += ((k & 1) | (k & 4) >> 1 | (k & 2) << 1 | (k & 8)) * samples;
    for (uint32_t u = 1u << 31, v = 1u << 31; i; i >>= 1, u >>= 1, v ^= v >> 1)
        if (i & 1) {
            a ^= u;
            b ^= v;
        }
    *x = (double)(a | middle) * 0x1p-32;
    *y = (double)(b | middle) * 0x1p-32;
}

#endif
