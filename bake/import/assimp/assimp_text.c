/* What Assimp misreads, without a word, in the text of COLLADA and X3D files: numbers and words with white space round them,
 * which XML collapses (XML Schema, 2), and units. */
#include "import/assimp/assimp_scene.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/* Without the space between tags and text: Assimp 5.2 refuses it before numbers, which Godot's exporter writes, and knows no
 * axis with it behind. */
static size_t drop_space(char *text, size_t size) {
    size_t kept = 0;
    bool after_tag = false;
    for (size_t i = 0; i < size; i++) {
        const char c = text[i];
        if (after_tag && is_blank(c))
            continue;
        while (c == '<' && kept > 0 && is_blank(text[kept - 1]))
            kept--;
        after_tag = c == '>';
        text[kept++] = c;
    }
    return kept;
}

typedef struct span {
    char *at, *end;
} span;

static bool begins(span s, const char *with) {
    const size_t length = strlen(with);
    return (size_t)(s.end - s.at) >= length && memcmp(s.at, with, length) == 0;
}

/* The next tag of that name in `in`, from its "<" to its ">"; comments are passed over. False: there is none. */
static bool find_tag(span in, const char *name, span *out) {
    const size_t length = strlen(name);
    bool comment = false;
    for (; in.at < in.end; in.at++) {
        if (comment || *in.at != '<') {
            comment = comment && !begins(in, "-->");
            continue;
        }
        const span inside = {in.at + 1, in.end};
        comment = begins(inside, "!--");
        if (comment || !begins(inside, name) || inside.end - inside.at == (ptrdiff_t)length ||
            !(is_blank(inside.at[length]) || strchr("/>", inside.at[length])))
            continue;
        char *close = memchr(in.at, '>', (size_t)(in.end - in.at));
        *out = (span){in.at, close ? close : in.end};
        return true;
    }
    return false;
}

/* The value of the tag's attribute. */
static bool find_value(span tag, const char *name, span *out) {
    for (span at = {tag.at + 1, tag.end}; at.at < tag.end; at.at++) {
        if (!is_blank(at.at[-1]) || !begins(at, name))
            continue;
        char *c = at.at + strlen(name);
        while (c < tag.end && is_blank(*c))
            c++;
        if (c == tag.end || *c != '=')
            continue;
        for (c++; c < tag.end && is_blank(*c); c++)
            ;
        if (c == tag.end || (*c != '"' && *c != '\''))
            return false;
        char *close = memchr(c + 1, *c, (size_t)(tag.end - c - 1));
        *out = (span){c + 1, close ? close : tag.end};
        return close != NULL;
    }
    return false;
}

/* The whole value but for blanks is a positive number, from `from` on. */
static bool is_length(span value, char **from, double *metres) {
    while (value.at < value.end && is_blank(*value.at))
        value.at++;
    while (value.at < value.end && is_blank(value.end[-1]))
        value.end--;
    *from = value.at;
    return value.at < value.end && import_number(value.at, value.end, false, metres) == value.end && *metres > 0.0 &&
           isfinite(*metres);
}

static bool is_axis(span value) {
    return value.end - value.at == 4 && strchr("XYZ", *value.at) && memcmp(value.at + 1, "_UP", 3) == 0;
}

/* The first asset is the file's (COLLADA 1.4.1, 5-16). */
static void read_asset(assimp_scene *a, span text) {
    span asset, tag, value;
    char *from;
    double metres;
    if (!find_tag(text, "asset", &asset))
        return;
    span inside = {asset.end, text.end}, end;
    if (find_tag(inside, "/asset", &end))
        inside.end = end.at;
    if (find_tag(inside, "unit", &tag) && find_value(tag, "meter", &value)) {
        a->bad_unit = !is_length(value, &from, &metres);
        if (!a->bad_unit && from > value.at) { /* blanks go behind the number */
            const size_t blanks = (size_t)(from - value.at);
            memmove(value.at, from, (size_t)(value.end - from));
            memset(value.end - blanks, ' ', blanks);
        }
    }
    if (find_tag(inside, "up_axis", &tag) && tag.end < inside.end) {
        value = (span){tag.end + 1, tag.end + 1};
        while (value.end < inside.end && *value.end != '<')
            value.end++;
        a->bad_axis = !is_axis(value);
    }
}

size_t assimp_mend_collada(assimp_scene *a, char *text, size_t size) {
    size = drop_space(text, size);
    read_asset(a, (span){text, text + size});
    return size;
}

/* A unit of lengths in the head (X3D 3.3, 7.2.5.1). */
void assimp_read_x3d(assimp_scene *a, char *text, size_t size) {
    span all = {text, text + size}, tag, value;
    char *from;
    if (find_tag(all, "Scene", &tag))
        all.end = tag.at;
    while (find_tag(all, "unit", &tag)) {
        all.at = tag.end;
        if (!find_value(tag, "category", &value) || value.end - value.at != 6 || memcmp(value.at, "length", 6) != 0)
            continue;
        a->bad_unit = !find_value(tag, "conversionFactor", &value) || !is_length(value, &from, &a->unit);
    }
}
