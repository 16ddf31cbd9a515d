/* Parts of the archive through expat, piece by piece: no part is ever in memory as a whole, and entities cannot grow, since a
 * document type, which 3MF forbids (Core 2.3), ends the reading. */
#include "import/3mf/threemf_file.h"
#include <expat.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { CHUNK = 1 << 16, TAG_MOST = 1 << 20 }; /* bytes of a read; of a tag and of what else is one piece to expat */

bool threemf_wrong(threemf_xml *x, const char *format, ...) {
    char text[400];
    va_list args;
    va_start(args, format);
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return import_fail(x->f->im, "%.100s:%lu: %s", x->part, (unsigned long)XML_GetCurrentLineNumber(x->parser), text);
}

/* ---- namespaces ---- */

threemf_ns threemf_namespace(const char *uri, size_t length) {
    static const struct {
        const char *uri;
        threemf_ns ns;
    } known[] = {{"http://schemas.microsoft.com/3dmanufacturing/core/2015/02", THREEMF_CORE},
                 {"http://schemas.microsoft.com/3dmanufacturing/material/2015/02", THREEMF_MATERIAL},
                 {"http://schemas.microsoft.com/3dmanufacturing/production/2015/06", THREEMF_PRODUCTION},
                 {"http://schemas.microsoft.com/3dmanufacturing/2013/01", THREEMF_CORE}};
    if (length == 0)
        return THREEMF_CORE;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strlen(known[i].uri) == length && memcmp(known[i].uri, uri, length) == 0)
            return known[i].ns;
    return THREEMF_FOREIGN;
}

static threemf_element element_of(const char *name, const char **attributes) {
    const char *bar = strrchr(name, '|');
    return (threemf_element){.ns = threemf_namespace(name, bar ? (size_t)(bar - name) : 0),
                             .uri = bar ? name : "|",
                             .name = bar ? bar + 1 : name,
                             .attributes = (const char *const *)attributes};
}

/* ---- attributes ---- */

const char *threemf_attribute(const threemf_element *e, const char *name) {
    for (const char *const *a = e->attributes; *a; a += 2)
        if (strcmp(a[0], name) == 0)
            return a[1];
    return NULL;
}

const char *threemf_production(const threemf_element *e, const char *name) {
    for (const char *const *a = e->attributes; *a; a += 2) {
        const char *bar = strrchr(a[0], '|');
        if (bar && strcmp(bar + 1, name) == 0 && threemf_namespace(a[0], (size_t)(bar - a[0])) == THREEMF_PRODUCTION)
            return a[1];
    }
    return NULL;
}

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

static const char *past_blanks(const char *at) {
    while (is_blank(*at))
        at++;
    return at;
}

bool threemf_next_index(const char **at, uint32_t *out) {
    const char *c = past_blanks(*at);
    uint64_t value = 0;
    c += *c == '+';
    const char *digits = c;
    for (; *c >= '0' && *c <= '9' && value < UINT64_C(1) << 40; c++)
        value = 10 * value + (uint64_t)(*c - '0');
    if (c == digits || (*c && !is_blank(*c)) || value > INT32_MAX)
        return false;
    *out = (uint32_t)value;
    *at = past_blanks(c);
    return true;
}

bool threemf_index(const char *text, uint32_t *out) {
    return threemf_next_index(&text, out) && !*text;
}

bool threemf_next_number(const char **at, bool single, double *out) {
    const char *begin = past_blanks(*at), *end = begin;
    while (*end && !is_blank(*end))
        end++;
    if (begin == end || import_number(begin, end, single, out) != end)
        return false;
    *at = past_blanks(end);
    return true;
}

/* ---- expat's calls ---- */

static void stop(threemf_xml *x) {
    x->failed = true;
    (void)XML_StopParser(x->parser, XML_FALSE);
}

static void XMLCALL begin(void *user, const char *name, const char **attributes) {
    threemf_xml *x = user;
    bool skip = false;
    if (x->failed)
        return;
    if (x->depth++ >= IMPORT_DEPTH) {
        (void)threemf_wrong(x, "elements are nested deeper than %d", IMPORT_DEPTH);
        stop(x);
    } else if (x->skipped > 0)
        x->skipped++;
    else {
        const threemf_element e = element_of(name, attributes);
        if (!x->begin(x, &e, &skip))
            stop(x);
        x->skipped = skip;
    }
}

static void XMLCALL end(void *user, const char *name) {
    threemf_xml *x = user;
    (void)name;
    x->depth--;
    if (x->skipped > 0)
        x->skipped--;
    else if (x->end && !x->failed)
        x->end(x);
}

static void XMLCALL prefix(void *user, const char *prefix, const char *uri) {
    threemf_xml *x = user;
    if (!x->failed && x->depth == 0 && x->prefix && uri && !x->prefix(x, prefix ? prefix : "", uri))
        stop(x);
}

static void XMLCALL doctype(void *user, const char *name, const char *system, const char *public, int internal) {
    threemf_xml *x = user;
    (void)name;
    (void)system;
    (void)public;
    (void)internal;
    if (!x->failed)
        (void)threemf_wrong(x, "has a document type, which 3MF forbids");
    stop(x);
}

/* ---- reading ---- */

/* Something that does not end would be looked at from its beginning again and again. */
static bool check_piece(threemf_xml *x, uint64_t fed) {
    const XML_Index at = XML_GetCurrentByteIndex(x->parser);
    return at < 0 || fed - (uint64_t)at <= TAG_MOST + CHUNK || threemf_wrong(x, "a tag is longer than %d bytes", TAG_MOST);
}

static bool feed(threemf_xml *x, zip_file_t *from) {
    uint64_t fed = 0;
    for (zip_int64_t got = 1; got > 0;) {
        void *piece = XML_GetBuffer(x->parser, CHUNK);
        if (!piece)
            return import_fail(x->f->im, "out of memory");
        got = zip_fread(from, piece, CHUNK);
        if (got < 0)
            return import_fail(x->f->im, "%.100s is damaged: %.100s", x->part, zip_file_strerror(from));
        fed += (uint64_t)got;
        if (XML_ParseBuffer(x->parser, (int)got, got == 0) == XML_STATUS_ERROR)
            return x->failed ? false : threemf_wrong(x, "%s", XML_ErrorString(XML_GetErrorCode(x->parser)));
        if (!check_piece(x, fed))
            return false;
    }
    return true;
}

bool threemf_read_xml(threemf_xml *x, const char *name) {
    const char *wrong;
    x->part = name + strspn(name, "/");
    zip_file_t *from = threemf_open_part(x->f, name, &wrong);
    if (!from)
        return import_fail(x->f->im, "%.200s in the archive %s", x->part, wrong);
    x->parser = XML_ParserCreateNS(NULL, '|');
    if (x->parser) {
        XML_SetUserData(x->parser, x);
        XML_SetElementHandler(x->parser, begin, end);
        XML_SetStartNamespaceDeclHandler(x->parser, prefix);
        XML_SetStartDoctypeDeclHandler(x->parser, doctype);
    }
    const bool fine = x->parser ? feed(x, from) : import_fail(x->f->im, "out of memory");
    XML_ParserFree(x->parser);
    (void)zip_fclose(from);
    return fine;
}
