/* knobs.c: the one table of what a sweep turns, and the settings made from it. A new knob is a row of the table beside its
 * field in the quality block.
 *
 * There is no knob for a fixed-point scale: irradiance is summed by each view sample in floats and in a fixed order, so that no
 * sum across work-items, and no scale, exists. */
#ifndef VIT_COST_KNOBS_H
#define VIT_COST_KNOBS_H

#include "results.h"
#include "scene.h"

typedef struct knob_setting {
    char name[COST_NAME]; /* "default", "radius 0.5", "photons 4250, buckets" */
    char knob[COST_NAME]; /* the one knob that differs from the default; "default"; "several" */
    scene_quality quality;
    double scale;   /* output edge / the scene's */
    uint32_t lanes; /* vit_open_info.lanes */
} knob_setting;

typedef struct knobs_input {
    const scene_quality *base; /* the default: the scene's own */
    double radius;    /* metres that the default has in the end, if it is "auto": what radii are multiples of; 0: no photons */
    const char *only; /* names with commas between; NULL: all */
    uint32_t most;    /* settings, >= 1 */
} knobs_input;

/* The default, then each knob alone, value by value, then combinations, spread evenly over the product of the knobs that are
 * combined; no two alike, and the same for the same input. Caller frees *out. VIT_USAGE: `only` names no knob. */
vit_status knobs_settings(const knobs_input *in, knob_setting **out, uint32_t *count, vit_text *why);

/* False: the setting differs in the output size or in what is chosen when a pack is opened; --fit leaves it out. */
bool knobs_in_quality(const knob_setting *s);

/* One line a knob for --help: name, what it is. */
void knobs_help(void);

#endif
