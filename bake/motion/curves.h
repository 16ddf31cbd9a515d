/* curves.c: monotone cubics through keys (Fritsch and Carlson, SIAM J. Numer. Anal. 17(2), 1980), a component each: between
 * two keys a component never leaves the range of their values, so that an eye does not overshoot through a wall. */
#ifndef VIT_BAKE_CURVES_H
#define VIT_BAKE_CURVES_H

#include <stdbool.h>

typedef struct curves {
    int keys, components;
    double *time;  /* keys, strictly increasing */
    double *value; /* keys * components, a key's components side by side */
    double *slope; /* likewise; filled by curves_smooth() */
} curves;

/* Room for all values; false: out of memory. Fill `time` and `value`, then call curves_smooth(). */
bool curves_make(curves *c, int keys, int components);
void curves_smooth(curves *c);
/* Components at time t: constant before the first key and after the last. */
void curves_at(const curves *c, double t, double *out);
void curves_free(curves *c);

#endif
