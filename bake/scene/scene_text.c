/* libconfig 1.5 takes 010 for 10 and 4294967298 for 2; 1.7 takes 010 for 8, and the other for a number of 64 bits; the one does
 * not know a comma behind the last element of a list, the other does. A scene file means one thing. */
#include "scene/scene_text.h"
#include "common/fail.h"
#include <ctype.h>
#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct cursor {
    const char *at, *end;
    unsigned line;
} cursor;

static void step(cursor *c, const char *to) {
    for (; c->at < to && c->at < c->end; c->at++)
        c->line += *c->at == '\n';
}

/* Past what begins at p and is no part of the scene: a comment or white space; p itself if it is none. */
static const char *past_nothing(const cursor *c, const char *p) {
    if (p < c->end && isspace((unsigned char)*p))
        return p + 1;
    if (*p == '#' || (p[0] == '/' && p[1] == '/'))
        return p + strcspn(p, "\n");
    if (p[0] == '/' && p[1] == '*') {
        const char *end = strstr(p + 2, "*/");
        return end ? end + 2 : c->end;
    }
    return p;
}

static const char *past_string(const char *p) {
    for (p++; *p && *p != '"'; p++)
        p += *p == '\\' && p[1] != '\0';
    return *p ? p + 1 : p;
}

/* A number, or what was meant for one: "1e-5", "0x1F", "10L". */
static const char *past_number(const char *p) {
    const char *start = p;
    p += *p == '+' || *p == '-';
    while (isalnum((unsigned char)*p) || *p == '.' || ((*p == '+' || *p == '-') && p > start && (p[-1] == 'e' || p[-1] == 'E')))
        p++;
    return p > start ? p : start + 1;
}

/* What is wrong with the number, or NULL. */
static const char *wrong_number(const char *word, size_t length) {
    const size_t sign = *word == '+' || *word == '-', digits = strspn(word + sign, "0123456789");
    const char *rest = word + sign + digits;
    const size_t left = length - sign - digits;
    if (digits == 1 && word[sign] == '0' && left > 0 && strchr("xXbBoOqQ", *rest))
        return "numbers are decimal here";
    const bool wide = (left == 1 && rest[0] == 'L') || (left == 2 && rest[0] == 'L' && rest[1] == 'L');
    if (digits == 0 || (left > 0 && !wide)) /* no whole number */
        return NULL;
    if (digits > 1 && word[sign] == '0')
        return "begins with 0, which not every reader takes for a decimal number";
    errno = 0;
    const long long value = strtoll(word, NULL, 10);
    if (errno == ERANGE || (!wide && (value < INT32_MIN || value > INT32_MAX)))
        return wide ? "is beyond 64 bits" : "is beyond 32 bits, -2147483648 to 2147483647";
    return NULL;
}

static bool refuse(const config_place *at, const char *path, unsigned line, const char *word, size_t length, const char *what) {
    (void)bake_fail(at->why, VIT_BAD_INPUT, "%.300s:%u: '%.*s' %s", path, line, length < 40 ? (int)length : 40, word, what);
    return false;
}

/* A comma, but for space and comments the last thing before a bracket that closes. */
static bool hangs(const cursor *c) {
    const char *p = c->at + 1;
    for (const char *next = past_nothing(c, p); next != p; next = past_nothing(c, p))
        p = next;
    return *p == ')' || *p == ']';
}

bool scene_text_check(const config_place *at, const char *path, const char *text, size_t size) {
    cursor c = {text, text + size, 1};
    if (size >= 2 && (memcmp(text, "\xff\xfe", 2) == 0 || memcmp(text, "\xfe\xff", 2) == 0))
        return refuse(at, path, 1, "UTF-16", 6, "is no encoding of a scene file: save it as UTF-8");
    while (c.at < c.end) {
        const char *next = past_nothing(&c, c.at);
        if (next == c.at && *c.at == '"')
            next = past_string(c.at);
        else if (next == c.at && (isalpha((unsigned char)*c.at) || *c.at == '*')) { /* a name, which may hold digits */
            for (next++; isalnum((unsigned char)*next) || (*next && strchr("-_*", *next));)
                next++;
        } else if (next == c.at && (isdigit((unsigned char)*c.at) || strchr("+-.", *c.at)) && *c.at) {
            next = past_number(c.at);
            const size_t length = (size_t)(next - c.at);
            const char *wrong = wrong_number(c.at, length);
            if (wrong)
                return refuse(at, path, c.line, c.at, length, wrong);
        } else if (next == c.at && *c.at == ',' && hangs(&c))
            return refuse(at, path, c.line, ",", 1, "has nothing behind it: the last element of a list takes no comma");
        else if (next == c.at)
            next++;
        step(&c, next);
    }
    return true;
}
