/* pareto.c: which settings are worth their time. */
#ifndef VIT_COST_PARETO_H
#define VIT_COST_PARETO_H

#include "report/results.h"

typedef struct pareto_point {
    double price, error; /* time or work; NMSE or relMSE */
} pareto_point;

/* Whether `a` dominates `b`: at most its price with at most its error, and better in one of the two, or equal and the first. */
bool pareto_beats(pareto_point a, pareto_point b, bool first);
/* Whether no other setting beats setting `i`. Settings that are `elsewhere` do not take part. */
bool pareto_on_front(const cost_results *r, uint32_t i, pareto_point (*point)(const cost_setting *s));
/* Sets pareto and pareto_relmse: the fronts of the time with either error. */
void pareto_mark(cost_results *r);

#endif
