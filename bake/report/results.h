/* What a sweep found, as plain data: sweep.c fills it, report.c and fit.c read it. */
#ifndef VIT_COST_RESULTS_H
#define VIT_COST_RESULTS_H

#include "reference/metrics.h"
#include "reference/reference.h"
#include "vitrine.h"
#include <stdbool.h>

#define COST_NAME 96
#define COST_VALUES 1024 /* SCENE_QUALITY */

typedef struct cost_setting {
    char name[COST_NAME];      /* short and unique: "default", "radius 0.5", "buckets, tile 16" */
    char knob[COST_NAME];      /* the one knob that differs from the default; "default"; or "several" */
    char values[COST_VALUES];  /* every knob and its value, as the scene's quality block takes them: "photons = 17000; radius =
                                  0.5; ..." */
    double ms, ms_p95, ms_mad; /* a frame: median, 95th percentile, median absolute deviation */
    uint32_t timed;            /* frames that these are over, >= 7 */
    uint32_t pass_count;
    char pass_names[VIT_MAX_PASSES][32];
    double pass_ms[VIT_MAX_PASSES];                    /* medians */
    uint64_t pass_work[VIT_MAX_PASSES][VIT_MAX_WORKS]; /* of the frame that is compared: exact */
    uint64_t work;                                     /* work units of that frame (fit.h) */
    uint64_t device_bytes, pack_bytes;
    double bake_seconds;        /* of the pack of the frames that are timed */
    cost_error total, indirect; /* against the bounce-limited reference */
    cost_error unlimited;       /* total light against the unlimited reference */
    float *image;               /* total light on the reference's grid: 3 floats a pixel, linear, exposed */
    bool elsewhere; /* differs from the default in what no quality block holds (output size, lanes): not for --fit, no front */
    bool pareto;    /* no other setting is at once faster and nearer to the reference, by ms and total.nmse */
    bool pareto_relmse; /* likewise by total.relmse */
} cost_setting;

typedef struct cost_results {
    char scene[COST_NAME];
    char device[256], cpu[COST_NAME];
    uint32_t width, height; /* of the frames timed */
    uint32_t frame, every;  /* frame compared, spacing of the compared pixels */
    reference reference;
    cost_error direct;       /* the default's direct light against the reference's: what is no estimate's fault */
    double direct_largest;   /* largest difference of one value / mean of the reference's direct light */
    cost_error truncation;   /* limited against unlimited reference: what `bounces` leaves out */
    cost_error normals;      /* if asked for: indirect light about geometric normals against the reference, both pictures' noise
                              * taken off: nmse, relmse and bias alone; 0 where no surface is smooth */
    double path_tracer_ms;   /* one path a pixel of the whole frame by the reference's path tracer, timed among the settings */
    double path_tracer_nmse; /* its error at one path a pixel; falls as 1 / paths */
    double path_tracer_relmse;
    uint32_t work_count; /* kinds of work, as vit_statistics names them */
    char work_names[VIT_MAX_WORKS][32];
    cost_setting *settings; /* [0] is the scene's own, "default" */
    uint32_t count;
} cost_results;

#endif
