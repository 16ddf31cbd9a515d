/* inputs.c: the files that a run reads; what it writes must be none of them. */
#ifndef VIT_BAKE_INPUTS_H
#define VIT_BAKE_INPUTS_H

#include "vitrine.h"
#include <stdbool.h>
#include <sys/types.h>

/* Zero: none. */
typedef struct inputs {
    struct input_file *files; /* each once, whatever the names and links by which it was come by */
    size_t count, room;
    bool lost; /* memory ran out: some are missing */
} inputs;

/* Notes the file that `path` leads to; one that is not there is none. */
void inputs_add(inputs *in, const char *path);
void inputs_free(inputs *in);

const char *inputs_path(const inputs *in, size_t index);
bool inputs_hold(const inputs *in, const char *path);

/* VIT_USAGE: `path`, which `option` names, is one of the inputs, by this or another name. */
vit_status inputs_check_output(const inputs *in, const char *option, const char *path, vit_text *why);

#endif
