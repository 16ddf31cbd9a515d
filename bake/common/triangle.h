/* A triangle's normal as vit_triangle has it, (v1 - v0) x (v2 - v0), not normalised, each component within an ulp of the exact
 * one: in float the products of a sliver's edges cancel, and what is left is rounding, or nothing, although the triangle has an
 * area and closes the mesh. In double the differences are exact, but for coordinates of very unlike size, and the products
 * nearly. */
#ifndef VIT_BAKE_TRIANGLE_H
#define VIT_BAKE_TRIANGLE_H

#include <math.h>
#include <stdbool.h>

static inline void triangle_normal(const float v0[3], const float v1[3], const float v2[3], float n[3]) {
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (double)v1[k] - (double)v0[k];
        b[k] = (double)v2[k] - (double)v0[k];
    }
    for (int k = 0; k < 3; k++)
        n[k] = (float)(a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
}

/* Of unit length. False: the normal is 0, and has no direction. */
static inline bool triangle_unit_normal(const float v0[3], const float v1[3], const float v2[3], double n[3]) {
    float f[3];
    triangle_normal(v0, v1, v2, f);
    const double length = sqrt((double)f[0] * (double)f[0] + (double)f[1] * (double)f[1] + (double)f[2] * (double)f[2]);
    for (int k = 0; k < 3; k++)
        n[k] = (double)f[k] / length;
    return length > 0.0;
}

#endif
