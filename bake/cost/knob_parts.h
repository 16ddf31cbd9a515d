/* What knobs.c and knob_list.c share: the table, and what each knob can be set to for the scene at hand. */
#ifndef VIT_COST_KNOB_PARTS_H
#define VIT_COST_KNOB_PARTS_H

#include "cost/knobs.h"

#define MOST_TRIED 16

/* A knob is a setting of the quality block that has values to try (settings.inc), or one of these, which lie outside it. */
enum { KNOB_SIZE = SETTINGS, KNOB_LANES, KNOBS };
_Static_assert(KNOBS <= KNOBS_MOST, "raise KNOBS_MOST");

/* As --knobs takes it; NULL: the setting is none. */
const char *knob_name(int k);
/* Whether it is also tried together with the others that are. */
bool knob_combined(int k);

/* What a knob can be set to; count 0: nothing, or it is not asked for. */
typedef struct knob_values {
    int count;
    char label[MOST_TRIED][COST_NAME / 2];
    knob_setting set[MOST_TRIED];     /* the default with this knob alone turned */
    char text[MOST_TRIED][COST_NAME]; /* for the quality block; "": none */
} knob_values;

/* Whether two settings are the same but for their names. */
bool knob_same(const knob_setting *a, const knob_setting *b);

/* Fills values[KNOBS]. VIT_USAGE: `only` names no knob. */
vit_status knob_find_values(const knobs_input *in, const knob_setting *base, knob_values *values, vit_text *why);

#endif
