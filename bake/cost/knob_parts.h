/* What knobs.c and knob_list.c share: the table, and what each knob can be set to for the scene at hand. */
#ifndef VIT_COST_KNOB_PARTS_H
#define VIT_COST_KNOB_PARTS_H

#include "knobs.h"

#define MOST_VALUES 8
#define MOST_TRIED (2 * MOST_VALUES)

/* What the numbers of a row do: a row has either texts or numbers. */
typedef enum knob_kind {
    KNOB_TEXTS,   /* values[].text: settings of the quality block */
    KNOB_PHOTONS, /* numbers: multiples of the default's photons */
    KNOB_RADIUS,  /* multiples of the default's radius */
    KNOB_SIZE,    /* multiples of the output's width and height */
    KNOB_LANES    /* samples a work-item */
} knob_kind;

typedef struct knob {
    const char *name; /* as --knobs takes it; of the setting in the quality block if it is there */
    const char *what;
    bool combined; /* also tried together with the others that are */
    knob_kind kind;
    struct {
        const char *label, *text; /* label: after the knob's name where it stands alone */
    } values[MOST_VALUES];        /* what matters most comes first */
    double numbers[MOST_VALUES];
    uint64_t needs; /* effects, one of which the scene must have, else the knob changes nothing; 0: none */
} knob;

extern const knob knob_table[];
extern const int knob_count; /* at most KNOBS_MOST */

/* What a knob can be set to; count 0: nothing, or it is not asked for. */
typedef struct knob_values {
    int count;
    char label[MOST_TRIED][COST_NAME / 2];
    knob_setting set[MOST_TRIED];     /* the default with this knob alone turned */
    char text[MOST_TRIED][COST_NAME]; /* for the quality block; "": none */
} knob_values;

/* Whether two settings are the same but for their names. */
bool knob_same(const knob_setting *a, const knob_setting *b);

/* Fills values[knob_count]. VIT_USAGE: `only` names no knob. */
vit_status knob_find_values(const knobs_input *in, const knob_setting *base, knob_values *values, vit_text *why);

#endif
