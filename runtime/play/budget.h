/* budget.c: --budget, milliseconds that the frame or a pass may take. */
#ifndef VIT_PLAY_BUDGET_H
#define VIT_PLAY_BUDGET_H

#include "report.h"

#define BUDGET_NAME 48

typedef struct budget {
    double frame_ms; /* 0: none */
    uint32_t count;
    struct {
        char name[BUDGET_NAME];
        double ms;
    } passes[VIT_MAX_PASSES];
} budget;

/* "MS", "PASS=MS", or several with commas between: "33", "visibility=5,33". VIT_USAGE: the text says what is wrong. */
vit_status budget_parse(const char *text, budget *out, vit_text *why);
/* VIT_USAGE: the pack's frames have no such pass. */
vit_status budget_check_names(const budget *b, const vit_requirements *need, vit_text *why);

#define BUDGET_BUSY 0.1  /* part of the processors' time that others may have before the median decides */
#define BUDGET_NOISY 1.2 /* p95 / p50 beyond which it is told */

/* Which frame decides: the one asked for; 0: p95, but p50 where other programs had more of the processors than BUDGET_BUSY (-1:
 * not known). */
unsigned budget_percentile(unsigned asked, double others);

/* Holds that percentile (50, 95, 99; 100: the maximum) of the frame's times, seen from the host, and of the passes' times to
 * the budget. `noise`: a line on how far the verdict can be trusted. VIT_BUDGET: the text says what is over and by how much:
 * the frame with its longest pass, and the first pass over its own. */
vit_status budget_check(const budget *b, unsigned asked, double others, const report *r, const vit_requirements *need,
                        vit_text *noise, vit_text *why);

#endif
