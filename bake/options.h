/* options.c: the baker's command line. */
#ifndef VIT_BAKE_OPTIONS_H
#define VIT_BAKE_OPTIONS_H

#include "scene/scene.h"

typedef struct options {
    const char *input, *output;
    bool explain, strict, quiet, all_formats, no_check, help, version, list, json, table;
    unsigned threads;   /* 0: all cores */
    const char *device; /* as vit_device_find() takes it; NULL: the default */
    /* Overrides of the scene file; 0 or NULL: none. */
    int width, height, frames;
    double fit;      /* milliseconds per frame, 0: none */
    double fit_work; /* work units per frame, a whole number, 0: none */
    double exposure; /* of all frames; 0 with exposure_given: auto */
    bool exposure_given;
    const char *quality;            /* auto or stated */
    const char *settings[SETTINGS]; /* values of settings of the quality block, each known to be allowed */
    bool effects_given;
    int effects_choice; /* as in `scene` */
    uint64_t effects;
} options;

/* VIT_USAGE: why->text names the option. */
vit_status options_parse(int argc, char **argv, options *out, vit_text *why);
void options_help(void);
/* Puts the overrides into the scene. VIT_USAGE. */
vit_status options_apply(const options *o, scene *s, vit_text *why);

#endif
