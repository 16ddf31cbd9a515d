/* What list.c finds, and its two ways of print. */
#ifndef VIT_BAKE_LIST_PARTS_H
#define VIT_BAKE_LIST_PARTS_H

#include "import/model.h"
#include <stdio.h>

typedef struct list {
    const scene *s;
    model model;
    char **not_done; /* the import's warnings */
    size_t not_done_count;
    bool failed; /* out of memory */
} list;

enum { LIST_WORD = 24 };
/* Word number `place` of "a|b|c". */
const char *list_word(const char *words, uint32_t place, char out[LIST_WORD]);
/* Of what the file states: "cd", "lx", or "" if its format says no unit. */
const char *list_stated_unit(const model_light *l);
/* Of what the baker takes it for. */
const char *list_power_unit(const model_light *l);

void list_for_people(const list *l, FILE *to);
void list_for_programs(const list *l, FILE *to); /* list_json.c */

#endif
