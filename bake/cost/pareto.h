/* pareto.c: which settings are worth their time. */
#ifndef VIT_COST_FRONT_H
#define VIT_COST_FRONT_H

#include "report/results.h"

/* Sets front and pareto_relmse: a setting is on the Pareto front if no other one takes at most as long with at most its error,
 * and is better in one of the two. Of equal ones the first is on it. Settings that are `elsewhere` do not take part. */
void pareto_mark(cost_results *r);

#endif
