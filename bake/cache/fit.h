/* fit.c: values of points from those of places, by least squares. */
#ifndef VIT_CACHE_FIT_H
#define VIT_CACHE_FIT_H

#include "cache/points_met.h"

#define CACHE_HELD_OUT 16u /* one place of so many is not fitted to, and says how far off the others' fit is */

/* Values of the points, VIT_CACHE_POINTS a cell, NAN of those that no fitted place reads, so that rows times values come near
 * `value`, a number a row, in least squares: first the mean of the places that read a point, then by simultaneous iterations
 * (SART: Andersen and Kak, 1984), whose early end leaves open what rows hardly tell. *error: root of the mean square of what
 * is left at places held out. noise: deviation of each row's value, by which points are not moved unless what is left is more
 * than that; NULL: values have none. NULL: out of memory. */
float *cache_fit(const cache_met *m, const float *value, const float *noise, double *error);

#endif
