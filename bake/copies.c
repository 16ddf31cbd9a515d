/* Direct3D 11's standard sample patterns: no two samples of a set share a column or a row, their mean is the centre, and the
 * first is the nearest to it, which in pixels without an edge is the only one. */
#include "copies.h"
#include <math.h>
#include <string.h>

static const signed char patterns[] = {
    /* in 1/16 pixel; those of 16 samples lie half a step further on */
    0,  0,                                                                                                              /* 1 */
    4,  4,  -4, -4,                                                                                                     /* 2 */
    -2, -6, 6,  -2, -6, 2, 2,  6,                                                                                       /* 4 */
    1,  -3, -1, 3,  5,  1, -3, -5, -5, 5,  -7, -1, 3, 7, 7, -7,                                                         /* 8 */
    1,  1,  -1, -3, -3, 2, 4,  -1, -5, -2, 2,  5,  5, 3, 3, -5, -2, 6, 0, -7, -4, -6, -6, 4, -8, 0, 7, -4, 6, 7, -7, -8 /* 16 */
};

/* Where a tent over -1..1 has as much of its area on the left as a box over -0.5..0.5 has left of x. */
static double tent_at(double x) {
    return x < 0 ? sqrt(1.0 + 2.0 * x) - 1.0 : 1.0 - sqrt(1.0 - 2.0 * x);
}

void copies_place(uint32_t count, bool tent, float offset[VIT_MAX_COPIES][2]) {
    const signed char *pattern = patterns + (count - 1) * 2; /* 1, 2, 4, ... pairs lie before it */
    const double half = count == 16 ? 0.5 : 0.0;
    memset(offset, 0, VIT_MAX_COPIES * sizeof *offset);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < 2; k++) {
            const double x = (pattern[2 * i + k] + half) / 16.0;
            offset[i][k] = (float)(tent ? tent_at(x) : x);
        }
}
