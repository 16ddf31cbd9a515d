/* knobs.c: what a sweep turns; knob_list.c: the settings made from it. A setting of the quality block is a knob if its row of
 * settings.inc has values to try.
 *
 * There is no knob for a fixed-point scale: irradiance is summed by each view sample in floats and in a fixed order, so that no
 * sum across work-items, and no scale, exists. */
#ifndef VIT_COST_KNOBS_H
#define VIT_COST_KNOBS_H

#include "report/results.h"
#include "scene/scene.h"

#define KNOBS_MOST 64

typedef struct knob_setting {
    char name[COST_NAME]; /* "default", "radius 0.5", "photons 4250, buckets" */
    char knob[COST_NAME]; /* the one knob that differs from the default; "default"; "several" */
    scene_quality quality;
    double scale;              /* output edge / the scene's */
    uint32_t lanes;            /* vit_open_info.lanes */
    uint8_t digit[KNOBS_MOST]; /* a knob: 0: as in the default; i: its value i - 1 */
} knob_setting;

typedef struct knobs_input {
    const scene_quality *base; /* the default: the scene's own */
    double radius;    /* metres that the default has in the end, if it is "auto": what radii are multiples of; 0: no photons */
    uint64_t effects; /* that the default has: some knobs are for scenes with theirs alone */
    const char *only; /* names with commas between; NULL: all */
    uint32_t most;    /* settings, >= 1 */
    bool in_quality;  /* only what a quality block can hold */
} knobs_input;

/* Settings, no two alike, the same for the same calls. */
typedef struct knob_list {
    knob_setting *settings; /* `count` of them, malloc'ed */
    uint32_t count, most;
    knob_setting base;
    struct knob_values *values; /* what each knob can be set to; NULL: there are no knobs, the list is complete */
} knob_list;

/* The default and each knob alone, value by value. VIT_USAGE: `only` names no knob. On failure nothing is left to close. */
vit_status knobs_open(const knobs_input *in, knob_list *out, vit_text *why);
void knobs_close(knob_list *l);
/* Names of the knobs among those asked for that turn nothing, since another way makes indirect light; "": none. */
void knobs_idle(const knobs_input *in, char *text, size_t room);
/* That alone: whether `only`, "a,b,c" or NULL, names knobs. */
vit_status knobs_check(const char *only, vit_text *why);

/* Adds combinations until there are `upto` settings, spread evenly over the product of the knobs that are combined. */
vit_status knobs_spread(knob_list *l, uint32_t upto, vit_text *why);

/* Adds, unless it is there or the list is full, the setting that differs from settings[of] in one combined knob: number `step`
 * of those. False: there are not so many. */
bool knobs_beside(knob_list *l, uint32_t of, uint32_t step, vit_status *status, vit_text *why);

/* False: the setting differs in the output size or in what is chosen when a pack is opened; --fit leaves it out. */
bool knobs_in_quality(const knob_setting *s);

/* One line a knob for --help: name, what it is. */
void knobs_help(void);

#endif
