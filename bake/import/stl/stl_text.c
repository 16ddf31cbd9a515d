/* STL in text: words between blanks, of which most programs mind neither the lines nor the case. */
#include "import/stl/stl_file.h"
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { KEY = 16 }; /* bytes of a key word */

typedef struct words {
    const char *at, *end;
} words;

typedef struct stl_text {
    stl_file *f;
    const char *at, *end;
    unsigned long long line;
    bool open; /* a solid has not ended */
    bool said; /* that something is left out */
} stl_text;

/* Zeros are padding. */
static bool is_blank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r') || c == '\0';
}

/* Lines may end in LF, CR LF or CR. */
static bool ends_line(const stl_text *t) {
    return *t->at == '\n' || (*t->at == '\r' && !(t->at + 1 < t->end && t->at[1] == '\n'));
}

/* The next word, of length 0 at the end. */
static words take(stl_text *t) {
    for (; t->at < t->end && is_blank(*t->at); t->at++)
        t->line += ends_line(t);
    words w = {t->at, t->at};
    while (w.end < t->end && !is_blank(*w.end))
        w.end++;
    t->at = w.end;
    return w;
}

static int shown(words w) {
    return w.end - w.at < 60 ? (int)(w.end - w.at) : 60;
}

/* The next word as a key: "end loop" is "endloop", as some write it. */
static words take_key(stl_text *t, char key[KEY]) {
    words w = take(t);
    (void)snprintf(key, KEY, "%.*s", shown(w), w.at);
    if (strcasecmp(key, "end") == 0) {
        w = take(t);
        (void)snprintf(key, KEY, "end%.*s", shown(w), w.at);
    }
    return w;
}

static bool fail_at(const stl_text *t, words w, const char *word) {
    if (w.at == w.end)
        return import_fail(t->f->im, "is cut short in line %llu", t->line);
    return import_fail(t->f->im, "line %llu: '%.*s' where '%s' should be", t->line, shown(w), w.at, word);
}

static bool expect(stl_text *t, const char *word) {
    char key[KEY];
    const words w = take_key(t, key);
    return strcasecmp(key, word) == 0 || fail_at(t, w, word);
}

static bool read_vertex(stl_text *t, float out[3]) {
    if (!expect(t, "vertex"))
        return false;
    for (int k = 0; k < 3; k++) {
        const words w = take(t);
        double value;
        if (w.at == w.end)
            return fail_at(t, w, "vertex");
        if (import_number(w.at, w.end, true, &value) != w.end)
            return import_fail(t->f->im, "line %llu: a value is no number: '%.*s'", t->line, shown(w), w.at);
        out[k] = (float)value;
    }
    return true;
}

/* What stands there for the normal means nothing (stl.c), and may be anything. */
static void pass_normal(stl_text *t) {
    for (int k = 0; k < 4; k++) {
        const stl_text before = *t;
        const words w = take(t);
        if (w.end - w.at == 5 && strncasecmp(w.at, "outer", 5) == 0) {
            *t = before;
            return;
        }
    }
}

/* The rest of the line, or of what stands before the next facet. */
static words take_name(stl_text *t) {
    while (t->at < t->end && is_blank(*t->at) && *t->at != '\n' && *t->at != '\r')
        t->at++;
    words w = {t->at, t->at};
    while (w.end < t->end && *w.end != '\n' && *w.end != '\r')
        w.end++;
    const char *facet = stl_find(w.at, w.end, "facet normal ");
    if (facet && (facet == w.at || is_blank(facet[-1])))
        w.end = facet;
    t->at = w.end;
    while (w.end > w.at && is_blank(w.end[-1]))
        w.end--;
    return w;
}

/* Colours, of which there is no one way, and whatever else some program may have written. */
static bool leave_out(stl_text *t, words w) {
    (void)take_name(t);
    const bool said = t->said;
    t->said = true;
    return said || import_not_done(t->f->im, "line %llu: '%.*s' and perhaps others are left out", t->line, shown(w), w.at);
}

static bool read_facet(stl_text *t) {
    stl_file *f = t->f;
    pass_normal(t);
    if (!import_room(f->im, &f->position, &f->position_room, f->facets + 1, 9 * sizeof *f->position) || !expect(t, "outer") ||
        !expect(t, "loop"))
        return false;
    for (size_t k = 0; k < 3; k++)
        if (!read_vertex(t, f->position + 9 * f->facets + 3 * k))
            return false;
    f->facets++;
    if (!expect(t, "endloop"))
        return false;
    for (;;) {
        char key[KEY];
        const words w = take_key(t, key);
        if (strcasecmp(key, "endfacet") == 0)
            return true;
        if (w.at == w.end || strcasecmp(key, "outer") == 0 || strcasecmp(key, "facet") == 0)
            return fail_at(t, w, "endfacet");
        if (!leave_out(t, w))
            return false;
    }
}

static bool begin_solid(stl_text *t, words name) {
    stl_file *f = t->f;
    if (!import_room(f->im, &f->solids, &f->solid_room, f->solid_count + 1, sizeof *f->solids))
        return false;
    stl_solid *solid = &f->solids[f->solid_count++];
    solid->first = f->facets;
    (void)snprintf(solid->name, sizeof solid->name, "%.*s",
                   name.end - name.at < SCENE_NAME ? (int)(name.end - name.at) : SCENE_NAME - 1, name.at);
    t->open = true;
    return true;
}

bool stl_read_text(stl_file *f) {
    stl_text t = {.f = f, .at = (const char *)f->file.at, .line = 1};
    t.end = t.at + f->file.size;
    if (f->file.size >= 3 && memcmp(t.at, "\xef\xbb\xbf", 3) == 0)
        t.at += 3;
    for (;;) {
        char key[KEY];
        const words w = take_key(&t, key);
        if (w.at == w.end)
            break;
        const bool facet = strcasecmp(key, "facet") == 0, solid = strcasecmp(key, "solid") == 0;
        if (strcasecmp(key, "endsolid") == 0) {
            t.open = false;
            (void)take_name(&t);
        } else if (!facet && !solid) {
            if (!leave_out(&t, w))
                return false;
        } else if ((solid || f->solid_count == 0) && !begin_solid(&t, solid ? take_name(&t) : (words){w.at, w.at}))
            return false;
        if (facet && !read_facet(&t))
            return false;
    }
    return !t.open || import_not_done(f->im, "ends without 'endsolid': some of it may be missing");
}
