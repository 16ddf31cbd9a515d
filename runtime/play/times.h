/* times.c: what a column of times says. */
#ifndef VIT_PLAY_TIMES_H
#define VIT_PLAY_TIMES_H

#include <stddef.h>

/* All in the unit of the times; 0 if there are none. Percentile p of n times is the smallest that at least p % of them do not
 * exceed (nearest rank), but p50 of an even number is the mean of the middle two. */
typedef struct times {
    double p50, p95, p99, max;
    double mad; /* median absolute deviation from p50 */
} times;

/* Of column[0 .. count - 1], which stays as it is; `scratch` has room for as many. */
times times_of(const double *column, size_t count, double *scratch);

/* Percentile 50, 95, 99 or 100 (the maximum), and its name: "p95", "max". */
double times_percentile(const times *t, unsigned percentile);
const char *times_percentile_name(unsigned percentile);

#endif
