#include "import/assimp/assimp_tags.h"
#include "import/importer.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

bool tag_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

bool tag_begins(tag_span s, const char *with) {
    const size_t length = strlen(with);
    return (size_t)(s.end - s.at) >= length && memcmp(s.at, with, length) == 0;
}

/* What follows a "<" begins a tag of that name, or any tag. */
static bool is_named(tag_span inside, const char *name) {
    if (!name)
        return inside.at < inside.end && (isalpha((unsigned char)*inside.at) || *inside.at == '/');
    const size_t length = strlen(name);
    return tag_begins(inside, name) && inside.end - inside.at > (ptrdiff_t)length &&
           (tag_blank(inside.at[length]) || strchr("/>", inside.at[length]));
}

bool tag_find(tag_span in, const char *name, tag_span *out) {
    bool comment = false;
    for (; in.at < in.end; in.at++) {
        if (comment || *in.at != '<') {
            comment = comment && !tag_begins(in, "-->");
            continue;
        }
        const tag_span inside = {in.at + 1, in.end};
        comment = tag_begins(inside, "!--");
        if (comment || !is_named(inside, name))
            continue;
        char *close = memchr(in.at, '>', (size_t)(in.end - in.at));
        *out = (tag_span){in.at, close ? close : in.end};
        return true;
    }
    return false;
}

char *tag_behind(tag_span tag, const char *name, char *end) {
    char word[40];
    tag_span close;
    (void)snprintf(word, sizeof word, "/%s", name);
    if (tag.end[-1] == '/' || !tag_find((tag_span){tag.end, end}, word, &close))
        close = tag;
    return close.end < end ? close.end + 1 : end;
}

bool tag_value(tag_span tag, const char *name, tag_span *out) {
    for (tag_span at = {tag.at + 1, tag.end}; at.at < tag.end; at.at++) {
        if (!tag_blank(at.at[-1]) || !tag_begins(at, name))
            continue;
        char *c = at.at + strlen(name);
        while (c < tag.end && tag_blank(*c))
            c++;
        if (c == tag.end || *c != '=')
            continue;
        for (c++; c < tag.end && tag_blank(*c); c++)
            ;
        if (c == tag.end || (*c != '"' && *c != '\''))
            return false;
        char *close = memchr(c + 1, *c, (size_t)(tag.end - c - 1));
        *out = (tag_span){c + 1, close ? close : tag.end};
        return close != NULL;
    }
    return false;
}

bool tag_length(tag_span value, char **from, double *metres) {
    while (value.at < value.end && tag_blank(*value.at))
        value.at++;
    while (value.at < value.end && tag_blank(value.end[-1]))
        value.end--;
    *from = value.at;
    return value.at < value.end && import_number(value.at, value.end, false, metres) == value.end && *metres > 0.0 &&
           isfinite(*metres);
}
