#include "scene/fields.h"
#include "common/names.h"
#include "common/option_text.h"
#include "scene/text_sizes.h"
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool fields_fail(const config_place *at, const config_setting_t *setting, const char *format, ...) {
    char *text = at->why->text;
    const size_t size = sizeof at->why->text;
    const char *file = setting ? config_setting_source_file(setting) : NULL;
    int used = snprintf(text, size, "%s:", file ? file : at->path);
    const unsigned line = setting ? config_setting_source_line(setting) : 0; /* 0: the top level, which stands on no line */
    if (line && used >= 0 && (size_t)used < size)
        used += snprintf(text + used, size - (size_t)used, "%u:", line);
    if (used >= 0 && (size_t)used < size)
        used += snprintf(text + used, size - (size_t)used, at->what[0] ? " %s: " : " ", at->what);
    if (used >= 0 && (size_t)used < size) {
        va_list args;
        va_start(args, format);
        (void)vsnprintf(text + used, size - (size_t)used, format, args);
        va_end(args);
    }
    /* Strings of the file may hold line feeds; an error is one line. */
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            *c = '?';
    return false;
}

static bool is_number(const config_setting_t *s) {
    const int type = config_setting_type(s);
    return type == CONFIG_TYPE_INT || type == CONFIG_TYPE_INT64 || type == CONFIG_TYPE_FLOAT;
}

static double number_of(const config_setting_t *s) {
    if (config_setting_type(s) == CONFIG_TYPE_FLOAT)
        return config_setting_get_float(s);
    return (double)config_setting_get_int64(s);
}

/* `allowed` is the very text that the error shows, so that message and check cannot part. */
static bool in_range(double value, const char *allowed) {
    char *end;
    const double lo = strtod(allowed + 1, &end);
    const double hi = strtod(end + 1, &end);
    return isfinite(value) && (*allowed == '[' ? value >= lo : value > lo) && (*end == ']' ? value <= hi : value < hi);
}

static bool read_number(const config_place *at, const config_setting_t *s, const config_field *f, double *out) {
    const char *also = f->kind == FIELD_AUTO ? " or \"auto\"" : "";
    if (f->kind == FIELD_AUTO && config_setting_type(s) == CONFIG_TYPE_STRING &&
        !strcmp(config_setting_get_string(s), "auto")) {
        *out = 0.0;
        return true;
    }
    if (!is_number(s))
        return fields_fail(at, s, "'%s' must be a number in %s%s", f->name, f->allowed, also);
    const double value = number_of(s);
    if (!in_range(value, f->allowed))
        return fields_fail(at, s, "'%s' must be in %s%s, got %g", f->name, f->allowed, also, value);
    *out = value;
    return true;
}

static bool read_whole(const config_place *at, const config_setting_t *s, const config_field *f, int *out) {
    const int type = config_setting_type(s);
    if (type != CONFIG_TYPE_INT && type != CONFIG_TYPE_INT64)
        return fields_fail(at, s, "'%s' must be a whole number in %s", f->name, f->allowed);
    const long long value = config_setting_get_int64(s);
    if (!in_range((double)value, f->allowed))
        return fields_fail(at, s, "'%s' must be in %s, got %lld", f->name, f->allowed, value);
    *out = (int)value;
    return true;
}

static bool read_choice(const config_place *at, const config_setting_t *s, const config_field *f, bool *out) {
    const char *bar = strchr(f->allowed, '|');
    const int first = (int)(bar - f->allowed);
    const char *text = config_setting_type(s) == CONFIG_TYPE_STRING ? config_setting_get_string(s) : NULL;
    if (text && strlen(text) == (size_t)first && !strncmp(text, f->allowed, (size_t)first))
        *out = false;
    else if (text && !strcmp(text, bar + 1))
        *out = true;
    else
        return fields_fail(at, s, "'%s' must be \"%.*s\" or \"%s\"%s%.64s%s", f->name, first, f->allowed, bar + 1,
                           text ? ", got \"" : "", text ? text : "", text ? "\"" : "");
    return true;
}

int fields_place(const char *list, const char *text) {
    const size_t length = text ? strlen(text) : 0;
    for (int i = 0; text && list; i++) {
        const char *bar = strchr(list, '|');
        if (length == (bar ? (size_t)(bar - list) : strlen(list)) && strncmp(list, text, length) == 0)
            return i;
        list = bar ? bar + 1 : NULL;
    }
    return -1;
}

/* "a|b|c" as `a, b or c`, each between `open` and `close`. */
static void spell(const char *list, const char *open, const char *close, char *out, size_t room) {
    size_t used = 0;
    out[0] = 0;
    for (const char *at = list; at && used < room;) {
        const char *bar = strchr(at, '|');
        const char *before = at == list ? "" : bar ? ", " : " or ";
        const int length = bar ? (int)(bar - at) : (int)strlen(at);
        used += (size_t)snprintf(out + used, room - used, "%s%s%.*s%s", before, open, length, at, close);
        at = bar ? bar + 1 : NULL;
    }
}

static bool read_listed(const config_place *at, const config_setting_t *s, const config_field *f, int *out) {
    const int type = config_setting_type(s);
    const bool number = f->kind == FIELD_AMONG,
               fits = number ? type == CONFIG_TYPE_INT || type == CONFIG_TYPE_INT64 : type == CONFIG_TYPE_STRING;
    char text[80] = "", allowed[128];
    if (fits && number)
        (void)snprintf(text, sizeof text, "%lld", config_setting_get_int64(s));
    else if (fits)
        (void)snprintf(text, sizeof text, "%s", config_setting_get_string(s));
    const int found = fits ? fields_place(f->allowed, text) : -1;
    const char *quote = number ? "" : "\"";
    spell(f->allowed, quote, quote, allowed, sizeof allowed);
    if (found < 0)
        return fields_fail(at, s, "'%s' must be %s%s%s%.64s%s", f->name, allowed, fits ? ", got " : "", fits ? quote : "", text,
                           fits ? quote : "");
    *out = number ? (int)config_setting_get_int64(s) : found; /* it is in the list */
    return true;
}

static bool read_text(const config_place *at, const config_setting_t *s, const config_field *f, char *out) {
    const char *text = config_setting_type(s) == CONFIG_TYPE_STRING ? config_setting_get_string(s) : NULL;
    if (!text)
        return fields_fail(at, s, "'%s' must be text in \"quotes\"", f->name);
    const bool path = f->kind == FIELD_PATH;
    const size_t room = path ? SCENE_PATH : SCENE_NAME;
    const char *folder = path && *text && *text != '/' ? at->folder : "";
    if (strlen(folder) + strlen(text) >= room)
        return fields_fail(at, s, "'%s' is longer than %zu bytes", f->name, room - 1);
    (void)snprintf(out, room, "%s%s", folder, text);
    return true;
}

static bool read_vector(const config_place *at, const config_setting_t *s, const config_field *f, double *out) {
    if (f->kind == FIELD_SCALE && is_number(s)) {
        if (!read_number(at, s, f, &out[0]))
            return false;
        out[1] = out[2] = out[0];
        return true;
    }
    if ((!config_setting_is_array(s) && !config_setting_is_list(s)) || config_setting_length(s) != 3)
        return fields_fail(at, s, "'%s' must be %sthree numbers, [x, y, z]", f->name,
                           f->kind == FIELD_SCALE ? "a number or " : "");
    for (int i = 0; i < 3; i++) {
        const config_setting_t *element = config_setting_get_elem(s, (unsigned)i);
        if (!element || !is_number(element))
            return fields_fail(at, s, "'%s' must be three numbers", f->name);
        const double value = number_of(element);
        if (!in_range(value, f->allowed))
            return fields_fail(at, s, "'%s' must have its numbers in %s, got %g", f->name, f->allowed, value);
        out[i] = value;
    }
    return true;
}

static bool read_field(const config_place *at, const config_setting_t *s, const config_field *f, char *out) {
    void *to = out + f->offset;
    switch (f->kind) {
    case FIELD_NUMBER:
    case FIELD_AUTO:
        return read_number(at, s, f, to);
    case FIELD_WHOLE:
        return read_whole(at, s, f, to);
    case FIELD_SWITCH:
        if (config_setting_type(s) != CONFIG_TYPE_BOOL)
            return fields_fail(at, s, "'%s' must be true or false", f->name);
        *(bool *)to = config_setting_get_bool(s) != 0;
        return true;
    case FIELD_CHOICE:
        return read_choice(at, s, f, to);
    case FIELD_WORD:
    case FIELD_AMONG:
        return read_listed(at, s, f, to);
    case FIELD_TEXT:
    case FIELD_PATH:
        return read_text(at, s, f, to);
    case FIELD_VECTOR:
    case FIELD_SCALE:
        return read_vector(at, s, f, to);
    case FIELD_OTHER:
        break;
    }
    return true;
}

static const char *field_name(const void *list, int index) {
    return ((const config_field *)list)[index].name;
}

bool fields_read(const config_place *at, const config_setting_t *group, const config_field *fields, int count, void *out,
                 uint64_t *seen) {
    *seen = 0;
    if (!config_setting_is_group(group))
        return fields_fail(at, group, "must be a group, { ... }");
    for (int i = 0; i < config_setting_length(group); i++) {
        const config_setting_t *s = config_setting_get_elem(group, (unsigned)i);
        int k = 0;
        while (k < count && strcmp(fields[k].name, config_setting_name(s)) != 0)
            k++;
        if (k == count) {
            char names[NAMES_TEXT];
            names_offer(config_setting_name(s), field_name, fields, count, names);
            return fields_fail(at, s, "unknown setting '%.60s'%s", config_setting_name(s), names);
        }
        if (!read_field(at, s, &fields[k], out))
            return false;
        *seen |= (uint64_t)1 << k;
    }
    return true;
}

/* The shortest digits that read back the same. */
static void write_number(double value, char *text, size_t room) {
    for (int digits = 6; digits <= 17; digits++) {
        (void)snprintf(text, room, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
}

size_t fields_write(const config_field *f, const void *from, char *text, size_t room) {
    const void *value = (const char *)from + f->offset;
    char word[64] = "";
    switch (f->kind) {
    case FIELD_NUMBER:
        write_number(*(const double *)value, word, sizeof word);
        break;
    case FIELD_AUTO:
        if (*(const double *)value > 0)
            write_number(*(const double *)value, word, sizeof word);
        else
            (void)snprintf(word, sizeof word, "\"auto\"");
        break;
    case FIELD_WORD: {
        const char *at = f->allowed;
        for (int i = 0; i < *(const int *)value; i++)
            at = strchr(at, '|') + 1;
        (void)snprintf(word, sizeof word, "\"%.*s\"", (int)strcspn(at, "|"), at);
        break;
    }
    case FIELD_AMONG:
    case FIELD_WHOLE:
        (void)snprintf(word, sizeof word, "%d", *(const int *)value);
        break;
    case FIELD_SWITCH:
        (void)snprintf(word, sizeof word, "%s", *(const bool *)value ? "true" : "false");
        break;
    case FIELD_CHOICE: {
        const char *bar = strchr(f->allowed, '|');
        if (*(const bool *)value)
            (void)snprintf(word, sizeof word, "\"%s\"", bar + 1);
        else
            (void)snprintf(word, sizeof word, "\"%.*s\"", (int)(bar - f->allowed), f->allowed);
        break;
    }
    case FIELD_TEXT:
    case FIELD_PATH:
    case FIELD_VECTOR:
    case FIELD_SCALE:
    case FIELD_OTHER:
        break;
    }
    const int used = word[0] ? snprintf(text, room, "%s = %s; ", f->name, word) : 0;
    return used < 0 ? 0 : (size_t)used < room ? (size_t)used : room - 1;
}

bool fields_put(const config_field *f, const char *text, void *out) {
    void *to = (char *)out + f->offset;
    long whole;
    double number;
    int found;
    switch (f->kind) {
    case FIELD_WHOLE:
        if (!option_whole(text, INT_MIN, INT_MAX, &whole) || !in_range((double)whole, f->allowed))
            return false;
        *(int *)to = (int)whole;
        return true;
    case FIELD_NUMBER:
    case FIELD_AUTO:
        number = 0;
        if (f->kind == FIELD_NUMBER || !text || strcmp(text, "auto") != 0)
            if (!option_number(text, -DBL_MAX, DBL_MAX, &number) || !in_range(number, f->allowed))
                return false;
        *(double *)to = number;
        return true;
    case FIELD_SWITCH:
    case FIELD_CHOICE:
        found = fields_place(f->kind == FIELD_SWITCH ? "0|1" : f->allowed, text);
        if (found < 0)
            return false;
        *(bool *)to = found == 1;
        return true;
    case FIELD_WORD:
    case FIELD_AMONG:
        found = fields_place(f->allowed, text);
        if (found < 0)
            return false;
        *(int *)to = f->kind == FIELD_WORD ? found : (int)strtol(text, NULL, 10);
        return true;
    case FIELD_TEXT:
    case FIELD_PATH:
    case FIELD_VECTOR:
    case FIELD_SCALE:
    case FIELD_OTHER:
        break;
    }
    return false;
}

void fields_wants(const config_field *f, const char *unit, char *text, size_t room) {
    const bool number = f->kind == FIELD_WHOLE || f->kind == FIELD_NUMBER || f->kind == FIELD_AUTO;
    const char *list = f->kind == FIELD_SWITCH ? "0|1" : f->allowed, *comma = strchr(list, ',');
    if (number) {
        const int low = (int)(comma - list) - 1, high = (int)strcspn(comma + 2, ")]");
        (void)snprintf(text, room, "%s%.*s%s%.*s%s%s%s",
                       *list != '(' ? ""
                       : unit       ? "above "
                                    : ">",
                       low, list + 1, unit ? " to " : "..", high, comma + 2, unit && *unit ? " " : "", unit ? unit : "",
                       f->kind != FIELD_AUTO ? ""
                       : unit                ? ", or auto"
                                             : "|auto");
    } else if (unit)
        spell(list, "", "", text, room);
    else
        (void)snprintf(text, room, "%s", list);
}

void fields_values(const config_field *f, const char *unit, char *text, size_t room) {
    char list[128];
    const bool words = f->kind == FIELD_CHOICE || f->kind == FIELD_WORD;
    if (f->kind == FIELD_SWITCH)
        (void)snprintf(text, room, "true or false");
    else if (words || f->kind == FIELD_AMONG) {
        spell(f->allowed, words ? "`\"" : "", words ? "\"`" : "", list, sizeof list);
        (void)snprintf(text, room, "%s", list);
    } else
        (void)snprintf(text, room, "%s%s%s%s%s", f->kind == FIELD_WHOLE ? "whole, " : "", f->allowed, *unit ? " " : "", unit,
                       f->kind == FIELD_AUTO ? ", or `\"auto\"`" : "");
}

bool fields_list(const config_place *at, const config_setting_t *group, const char *name, int most, config_setting_t **list) {
    *list = config_setting_get_member(group, name);
    if (!*list)
        return true;
    if (!config_setting_is_list(*list))
        return fields_fail(at, *list, "'%s' must be a list of groups, ( { ... }, { ... } )", name);
    if (config_setting_length(*list) > most)
        return fields_fail(at, *list, "'%s' has %d entries, at most %d are allowed", name, config_setting_length(*list), most);
    return true;
}

bool fields_group(const config_place *at, const config_setting_t *list, int index, config_setting_t **group) {
    *group = config_setting_get_elem(list, (unsigned)index);
    if (!*group || !config_setting_is_group(*group))
        return fields_fail(at, *group ? *group : list, "must be a group, { ... }");
    return true;
}
