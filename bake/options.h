/* options.c: the baker's command line. */
#ifndef VIT_BAKE_OPTIONS_H
#define VIT_BAKE_OPTIONS_H

#include "scene.h"

typedef struct options {
    const char *input, *output;
    bool explain, strict, quiet, all_formats, no_check, help, version, list, json;
    unsigned threads;          /* 0: all cores */
    const char *device;        /* as vit_device_find() takes it; NULL: the default */
    /* Overrides of the scene file; 0, NULL or negative: none. */
    int width, height, frames, photons, bounces, tile, indirect_samples, vertex_bits, normal_bits, sample_bits, antialias,
        light_samples, sky_samples, specular_depth;
    double radius;             /* 0 with radius_given: auto */
    bool radius_given;
    double fit;                /* milliseconds a frame, 0: none */
    double fit_work;           /* work units a frame, a whole number, 0: none */
    double exposure;           /* of all frames; 0 with exposure_given: auto */
    bool exposure_given;
    const char *quality, *estimate, *smoothing, *kernel, *texture_filter, *antialias_filter;
    int normal_keys, zones, effective_area, guiding, bounce_sequence, caustics; /* -1: as the scene says; zones: 2 with light_zones */
    double antialias_contrast; /* -1: as the scene says */
    bool effects_given;
    int effects_choice;        /* as in `scene` */
    uint64_t effects;
} options;

/* VIT_USAGE: why->text names the option. */
vit_status options_parse(int argc, char **argv, options *out, vit_text *why);
void options_help(void);
/* Puts the overrides into the scene. VIT_USAGE. */
vit_status options_apply(const options *o, scene *s, vit_text *why);

#endif
