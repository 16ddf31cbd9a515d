/* converge.c: does the runtime's list estimate go towards the reference as photons grow and their radius shrinks, how fast, and
 * what is left. converge_report.c prints it. */
#ifndef VIT_COST_CONVERGE_H
#define VIT_COST_CONVERGE_H

#include "cost/sweep.h"
#include <stdio.h>

#define CONVERGE_LEAST 5
#define CONVERGE_MOST 12
#define CONVERGE_GROWTH 4.0        /* photon paths from step to step */
#define CONVERGE_SHRINK (1.0 / 3)  /* of the radius, if nothing is said: README.md, "Convergence", says why */
#define CONVERGE_MOST_PATHS 990000 /* what a frame may have, less the rounding up of many lights' shares */

typedef struct converge_plan {
    uint32_t steps; /* CONVERGE_LEAST .. CONVERGE_MOST */
    double shrink;  /* the radius goes with paths^-shrink; 0: it stays, and so does its bias */
} converge_plan;

typedef struct converge_step {
    uint32_t paths;    /* asked for, quality.photons */
    double radius;     /* m */
    cost_error total;  /* against the reference with the same bounce limit */
    double indirect;   /* NMSE of indirect light, over its own squared mean */
    double blur;       /* total NMSE that no number of photons removes at this radius; noise may make it negative */
    double noise;      /* total NMSE that they do: variance */
    double ms, ms_mad; /* median and median absolute deviation of a frame; 0: not timed */
} converge_step;

/* log y = slope log x + log at_one, by least squares. */
typedef struct converge_line {
    double slope, slope_error; /* standard error */
    double at_one;             /* y at x = 1 */
    uint32_t points;           /* with x, y > 0; fewer than 3, or all at one x: the rest is NAN */
} converge_line;

typedef struct converge_results {
    char scene[COST_NAME], device[256];
    uint32_t width, height, frame, samples; /* samples: paths a pixel of the reference */
    double own;                             /* NMSE of the reference's own standard error */
    double shrink;
    converge_step steps[CONVERGE_MOST];
    uint32_t count;
    converge_line error, indirect, noise; /* steps' total.nmse, indirect, noise over paths */
    converge_line blur;                   /* steps' blur over radius */
    cost_error truncation;                /* bounce-limited against unlimited reference */
    cost_error normals;                   /* cost_results.normals */
    double direct;                        /* NMSE of the runtime's direct light, over the squared mean of direct light */
} converge_results;

converge_line converge_fit(const double *x, const double *y, uint32_t count);

/* The settings that are played: steps, then as many partners, each of its step's radius but with other photons: their number is
 * another, and their reflections' random numbers come from the sequence where the step's come from hashes, or the other way
 * round. The scene's own photons and radius are a step, unless more than CONVERGE_MOST_PATHS would be needed.
 * sweep_list_fn; `user`: const converge_plan *. VIT_BAD_INPUT: the scene has
 * no indirect light. */
sweep_list_fn converge_list;

/* `in`: as for sweep_run(); knobs, settings and what makes them are overridden. Under MPI only rank 0 gets steps.
 * VIT_BAD_INPUT: no light that could be compared. */
vit_status converge_run(const sweep_input *in, const converge_plan *how, converge_results *out, vit_text *why);

/* The table, for people. */
void converge_print(const converge_results *r, FILE *to);
/* converge.csv and converge.svg in `folder`, which is made if need be. VIT_FAILED: cannot be written; gnuplot fails. */
vit_status converge_write(const converge_results *r, const char *folder, vit_text *why);
/* Name of file `index` of those; NULL beyond the last. */
const char *converge_name(uint32_t index);

#endif
