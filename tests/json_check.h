/* Whether a text is one JSON value and nothing else, as strict as RFC 8259. */
#ifndef VIT_TESTS_JSON_CHECK_H
#define VIT_TESTS_JSON_CHECK_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

static inline const char *json_space(const char *t) {
    return t + strspn(t, " \n\r\t");
}

static inline const char *json_text(const char *t) {
    if (*t++ != '"')
        return NULL;
    for (; *t != '"'; t++) {
        if ((unsigned char)*t < 0x20)
            return NULL;
        if (*t != '\\')
            continue;
        t++;
        if (*t == 'u' && strspn(t + 1, "0123456789abcdefABCDEF") >= 4)
            t += 4;
        else if (!*t || !strchr("\"\\/bfnrt", *t))
            return NULL;
    }
    return t + 1;
}

static inline const char *json_number(const char *t) {
    t += *t == '-';
    const size_t whole = strspn(t, "0123456789");
    if (whole == 0 || (whole > 1 && *t == '0'))
        return NULL;
    t += whole;
    if (*t == '.') {
        const size_t digits = strspn(++t, "0123456789");
        if (digits == 0)
            return NULL;
        t += digits;
    }
    if (*t == 'e' || *t == 'E') {
        t++;
        t += *t == '-' || *t == '+';
        const size_t digits = strspn(t, "0123456789");
        if (digits == 0)
            return NULL;
        t += digits;
    }
    return t;
}

/* Past one value as RFC 8259 has it; NULL: it is none. */
static inline const char *json_value(const char *t) {
    t = json_space(t);
    const char *words[] = {"null", "true", "false"};
    for (int i = 0; i < 3; i++)
        if (strncmp(t, words[i], strlen(words[i])) == 0)
            return t + strlen(words[i]);
    if (*t == '"')
        return json_text(t);
    if (*t != '{' && *t != '[')
        return json_number(t);
    const char end = *t == '{' ? '}' : ']';
    t = json_space(t + 1);
    if (*t == end)
        return t + 1;
    for (;;) {
        if (end == '}') {
            t = json_text(json_space(t));
            t = t ? json_space(t) : NULL;
            if (!t || *t++ != ':')
                return NULL;
        }
        t = json_value(t);
        t = t ? json_space(t) : NULL;
        if (!t || (*t != ',' && *t != end))
            return NULL;
        if (*t++ == end)
            return t;
    }
}

static inline bool json_valid(const char *text) {
    const char *end = json_value(text);
    return end && *json_space(end) == '\0';
}

#endif
