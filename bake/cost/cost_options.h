/* cost_options.c: the command line of vitrine-cost. */
#ifndef VIT_COST_OPTIONS_H
#define VIT_COST_OPTIONS_H

#include "vitrine.h"
#include <stdbool.h>

typedef struct cost_options {
    const char *input, *output, *knobs, *cache, *write;
    bool no_cache, strict, quiet, relmse, help, version;
    uint32_t settings, every, repeats, max_samples, threads, memory, converge; /* memory: MiB, 0: a quarter of the machine's */
    const char *device;     /* as vit_device_find() takes it; NULL: the default */
    int64_t frame;          /* < 0: the middle one */
    int width, height;      /* 0: as the scene says */
    double shrink;          /* of converge_plan */
    double reference_error; /* 0: a tenth of the smallest error */
    double fit;             /* ms, 0: none */
    double fit_work;        /* work units, a whole number, 0: none */
} cost_options;

/* VIT_USAGE: why->text names the option. */
vit_status cost_options_parse(int argc, char **argv, cost_options *out, vit_text *why);
void cost_options_help(void);

#endif
