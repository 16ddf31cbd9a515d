/* Is a text JSON? */
#ifndef VIT_TESTS_JSON_CHECK_H
#define VIT_TESTS_JSON_CHECK_H

#include <ctype.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Skips one JSON value with the space around it; NULL: it is none. */
static inline const char *json_value(const char *s);
static inline const char *json_space(const char *s) {
    while (isspace((unsigned char)*s))
        s++;
    return s;
}

static inline const char *json_text(const char *s) {
    for (s++; *s && *s != '"'; s++)
        if ((unsigned char)*s < 0x20 || (*s == '\\' && !strchr("\"\\/bfnrtu", *++s)))
            return NULL;
    return *s ? s + 1 : NULL;
}

static inline const char *json_items(const char *s, char end, bool named) {
    s = json_space(s + 1);
    if (*s == end)
        return s + 1;
    for (;;) {
        if (named) {
            s = json_space(s);
            s = *s == '"' ? json_text(s) : NULL;
            s = s ? json_space(s) : NULL;
            if (!s || *s++ != ':')
                return NULL;
        }
        s = json_value(s);
        if (!s || (*s != ',' && *s != end))
            return NULL;
        if (*s++ == end)
            return s;
    }
}

static inline const char *json_value(const char *s) {
    char *number;
    s = json_space(s);
    if (*s == '{' || *s == '[')
        s = json_items(s, *s == '{' ? '}' : ']', *s == '{');
    else if (*s == '"')
        s = json_text(s);
    else if (strncmp(s, "true", 4) == 0 || strncmp(s, "false", 5) == 0)
        s += *s == 't' ? 4 : 5;
    else {
        (void)strtod(s, &number);
        s = number != s && (isdigit((unsigned char)*s) || *s == '-') ? number : NULL;
    }
    return s ? json_space(s) : NULL;
}

#endif
