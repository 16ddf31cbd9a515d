#include "scene/setting_rows.h"
#include "common/fail.h"
#include "vitrine_pack.h"
#include <stddef.h>
#include <stdio.h>
#include <string.h>

const setting_row setting_rows[SETTINGS] = {
#define SETTING(type, member, word, kind, usual, allowed, ...)                                                                 \
    {{word, kind, offsetof(scene_quality, member), allowed}, __VA_ARGS__},
#include "scene/settings.inc"
#undef SETTING
};

const scene_quality settings_default = {
#define SETTING(type, member, word, kind, usual, ...) .member = usual,
#include "scene/settings.inc"
#undef SETTING
};

const char *settings_indirect_name(int maker) {
    static const char *const names[] = {[INDIRECT_PHOTONS] = "photons",
                                        [INDIRECT_BASIS] = "basis",
                                        [INDIRECT_RADIOSITY] = "radiosity",
                                        [INDIRECT_AUTO] = "auto"};
    return names[maker];
}

bool settings_agree(const scene_quality *q, vit_text *why) {
    const char *fault = NULL;
    if (q->raw && !q->buckets)
        fault = "smoothing \"raw\" needs estimate \"buckets\"";
    else if (q->light_zones && !q->zones)
        fault = "'light_zones' needs zones = true";
    if (fault)
        (void)bake_fail(why, VIT_BAD_INPUT, "%s", fault);
    return !fault;
}

const setting_row *settings_named(const char *name, size_t length) {
    for (int i = 0; i < SETTINGS; i++) {
        const char *word = setting_rows[i].field.name;
        size_t same = 0;
        while (same < length && word[same] && (word[same] == name[same] || (word[same] == '_' && name[same] == '-')))
            same++;
        if (same == length && !word[same])
            return &setting_rows[i];
    }
    return NULL;
}

bool settings_put(const setting_row *s, const char *text, scene_quality *q) {
    return fields_put(&s->field, text, q);
}

void settings_wants(const setting_row *s, char *text, size_t room) {
    if (s == &setting_rows[SETTING_AT_zones]) /* 2: options.c */
        (void)snprintf(text, room, "0, 1, or 2 for light_zones too");
    else
        fields_wants(&s->field, s->unit, text, room);
}

static void write_option(const setting_row *s, char *text, size_t room) {
    size_t used = (size_t)snprintf(text, room, "--%s ", s->field.name);
    for (char *c = text; *c; c++)
        *c = *c == '_' ? '-' : *c;
    fields_wants(&s->field, NULL, text + used, room - used);
    if (s == &setting_rows[SETTING_AT_zones]) /* as settings_wants() says */
        (void)snprintf(text + strlen(text), room - strlen(text), "|2");
}

/* The default as the scene file would have it. */
static void write_default(const setting_row *s, char *text, size_t room) {
    char whole[128];
    (void)fields_write(&s->field, &settings_default, whole, sizeof whole);
    const char *value = strstr(whole, " = ") + 3;
    (void)snprintf(text, room, "%.*s", (int)strcspn(value, ";"), value);
}

/* The same for an option: 0 or 1, no quotes. */
static void write_default_option(const setting_row *s, char *text, size_t room) {
    char value[64];
    write_default(s, value, sizeof value);
    const bool quoted = value[0] == '"';
    const char *plain = s->field.kind != FIELD_SWITCH ? value + quoted : strcmp(value, "true") == 0 ? "1" : "0";
    (void)snprintf(text, room, "%.*s", (int)strcspn(plain, "\""), plain);
}

void settings_help(void) {
    for (int i = 0; i < SETTINGS; i++) {
        const setting_row *s = &setting_rows[i];
        char option[96], usual[64];
        write_option(s, option, sizeof option);
        write_default_option(s, usual, sizeof usual);
        printf("  %s%s%s   default %s\n        %s\n", option, s->unit[0] ? " " : "", s->unit, usual, s->help);
    }
}

void settings_table(FILE *to) {
    fprintf(to, "| `quality` | value | default | tried by `vitrine-cost` | |\n|---|---|---|---|---|\n");
    for (int i = 0; i < SETTINGS; i++) {
        const setting_row *s = &setting_rows[i];
        char allowed[160], usual[64];
        fields_values(&s->field, s->unit, allowed, sizeof allowed);
        write_default(s, usual, sizeof usual);
        fprintf(to, "| `%s`%s | %s | %s | ", s->field.name, s->marks & SETTING_CHOSEN ? " *" : "", allowed, usual);
        for (const char *c = s->tried ? s->tried : ""; *c; c++)
            if (strncmp(c, " | ", 3) == 0) {
                fputs("; ", to);
                c += 2;
            } else
                fputc(*c, to);
        fprintf(to, "%s | %s%s |\n", s->tried && s->marks & SETTING_TOGETHER ? " +" : "", s->help, s->more);
    }
}
