/* fields.c: groups of a libconfig file into plain structs, by a table of fields. A setting that no field knows is an error. */
#ifndef VIT_BAKE_FIELDS_H
#define VIT_BAKE_FIELDS_H

#include "vitrine.h"
#include <libconfig.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef enum field_kind {
    FIELD_NUMBER, /* double; an integer will do */
    FIELD_WHOLE,  /* int */
    FIELD_AUTO,   /* double, or "auto": 0 */
    FIELD_SWITCH, /* bool */
    FIELD_CHOICE, /* bool: `allowed` is "a|b", false for a and true for b */
    FIELD_WORD,   /* int: place of the word in `allowed`, "a|b|c" */
    FIELD_AMONG,  /* int: one of the whole numbers of `allowed`, "1|4|16" */
    FIELD_TEXT,   /* char[SCENE_NAME] */
    FIELD_PATH,   /* char[SCENE_PATH], resolved against the scene file's folder; "" stays "" */
    FIELD_VECTOR, /* double[3]: [x, y, z] or (x, y, z) */
    FIELD_SCALE,  /* double[3]: a vector, or one number for all three */
    FIELD_OTHER   /* known, but read by the caller */
} field_kind;

typedef struct config_field {
    const char *name;
    field_kind kind;
    size_t offset;       /* in the struct that fields_read() fills */
    const char *allowed; /* numbers: "[lo, hi)" with round brackets for excluded ends; words: "a|b" */
} config_field;

/* Where in the scene file we are: goes in front of every error. */
typedef struct config_place {
    const char *path;   /* the scene file */
    const char *folder; /* that it lies in, with its slash; "" for the current one */
    char what[64];      /* "light 2, key 1"; "" at the top level */
    vit_text *why;
} config_place;

/* Writes "file:line: what: text" into place.why, on one line whatever the text holds, and returns false.
 * A NULL setting leaves the line out. */
bool fields_fail(const config_place *at, const config_setting_t *setting, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Reads every setting of `group` into `out`; what the group leaves out stays as it was.
 * seen: bit i is set if fields[i] was there. False: place.why says why. */
bool fields_read(const config_place *at, const config_setting_t *group, const config_field *fields, int count, void *out,
                 uint64_t *seen);

/* The setting as it stands in a group: "name = value; ". Numbers are the shortest that read back the same. Returns the bytes
 * written, fewer than `room`. For all kinds but texts and vectors. */
size_t fields_write(const config_field *f, const void *from, char *text, size_t room);

/* Puts the text of an option into the field; a switch is 0 or 1. False: it is not allowed, and nothing is changed. Not for
 * texts and vectors. */
bool fields_put(const config_field *f, const char *text, void *out);
/* What fields_put() takes: "1, 4 or 16", "0 to 1", "1e-12 to 1e6 m, or auto". unit: NULL for the form of a line of help,
 * "1|4|16", "0..1". */
void fields_wants(const config_field *f, const char *unit, char *text, size_t room);
/* What the scene file may say, for a table: "`\"box\"` or `\"tent\"`", "[0, 1]". */
void fields_values(const config_field *f, const char *unit, char *text, size_t room);

/* Member `name` of `group` as a list of groups. Absent: *list is NULL. False: it is something else, or longer than `most`. */
bool fields_list(const config_place *at, const config_setting_t *group, const char *name, int most, config_setting_t **list);

/* Element `index` of a list, which must be a group. */
bool fields_group(const config_place *at, const config_setting_t *list, int index, config_setting_t **group);

/* Place of `text` in a list "a|b|c", or -1; text may be NULL. */
int fields_place(const char *list, const char *text);

#endif
