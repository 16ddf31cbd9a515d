/* settings.c: the rows of settings.inc, for what reads, shows or turns any setting. */
#ifndef VIT_BAKE_SETTING_ROWS_H
#define VIT_BAKE_SETTING_ROWS_H

#include "scene/fields.h"
#include "scene/settings.h"

enum { SETTING_CHOSEN = 1, SETTING_TOGETHER = 2 };

typedef struct setting_row {
    config_field field; /* its offset is that in scene_quality */
    const char *unit;
    unsigned marks; /* SETTING_* */
    uint64_t needs; /* effects, one of which a scene must have; 0: none */
    const char *tried, *help, *more;
} setting_row;

extern const setting_row setting_rows[SETTINGS];
/* The setting whose word has the first `length` characters of `name`, '-' counting as '_'; or NULL. */
const setting_row *settings_named(const char *name, size_t length);

/* Puts `text`, as an option has it, into *q. False: it is not allowed, and *q is as it was. */
bool settings_put(const setting_row *s, const char *text, scene_quality *q);
/* What an option takes, "1, 4 or 16"; `zones` also takes 2. */
void settings_wants(const setting_row *s, char *text, size_t room);

/* All settings for --help of vitrine-bake, and as README.md's table. */
void settings_help(void);
void settings_table(FILE *to);

#endif
