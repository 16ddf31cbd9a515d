/* fit.c: the most accurate setting that a budget allows. */
#ifndef VIT_COST_FIT_H
#define VIT_COST_FIT_H

#include "report/results.h"
#include <stdio.h>

typedef struct fit_budget {
    double ms;     /* > 0: the 95th percentile of a frame's milliseconds on the device measured */
    uint64_t work; /* > 0: work units of a frame instead: the same choice on every machine */
    bool relmse;   /* accurate by total.relmse, not total.nmse */
} fit_budget;

/* Work units of passes' work, as vit_statistics.pass_work has it: the sum of exact counts, each kind times a small whole number
 * (the table in fit.c; about a tenth of a nanosecond on the CPU that they were measured on). Kinds that depend on the lane
 * width count nothing. `names`: of the `count` kinds, as vit_statistics has them. */
uint64_t fit_work_units(const uint64_t work[][VIT_MAX_WORKS], uint32_t passes, const char *const *names, uint32_t count);

/* Index of the most accurate setting within the budget, among those that a quality block can hold; of equally
 * accurate ones the cheaper, then the first. VIT_BUDGET: none fits; the text
 * names the one that misses by least and by how much. VIT_FAILED: work was not counted. */
vit_status fit_choose(const cost_results *r, const fit_budget *budget, uint32_t *chosen, vit_text *why);

/* The front and the choice as a table of plain text. */
void fit_print(const cost_results *r, const fit_budget *budget, uint32_t chosen, FILE *to);

#endif
