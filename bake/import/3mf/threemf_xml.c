/* Parts of the archive through libxml2's SAX, piece by piece: no part is ever in memory as a whole, and entities cannot grow,
 * since a document type, which 3MF forbids (Core 2.3), ends the reading. */
#include "import/3mf/threemf_file.h"
#include <libxml/parser.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool threemf_wrong(threemf_xml *x, const char *format, ...) {
    const xmlParserCtxt *parser = x->parser;
    char text[400];
    va_list args;
    va_start(args, format);
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return import_fail(x->f->im, "%.100s:%d: %s", x->part, parser->input ? parser->input->line : 0, text);
}

/* ---- namespaces ---- */

threemf_ns threemf_namespace(const char *uri) {
    static const struct {
        const char *uri;
        threemf_ns ns;
    } known[] = {{"http://schemas.microsoft.com/3dmanufacturing/core/2015/02", THREEMF_CORE},
                 {"http://schemas.microsoft.com/3dmanufacturing/material/2015/02", THREEMF_MATERIAL},
                 {"http://schemas.microsoft.com/3dmanufacturing/production/2015/06", THREEMF_PRODUCTION},
                 {"http://schemas.microsoft.com/3dmanufacturing/2013/01", THREEMF_CORE},
                 {"", THREEMF_CORE}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(known[i].uri, uri) == 0)
            return known[i].ns;
    return THREEMF_FOREIGN;
}

/* Namespaces are few, and libxml2 has each text once. */
static threemf_ns namespace_of(threemf_xml *x, const char *uri) {
    if (uri != x->last_uri) {
        x->last_uri = uri;
        x->last_ns = threemf_namespace(uri);
    }
    return x->last_ns;
}

/* ---- attributes ---- */

const char *threemf_attribute(const threemf_element *e, const char *name) {
    for (size_t i = 0; i < e->count; i++)
        if (!*e->attributes[i].uri && strcmp(e->attributes[i].name, name) == 0)
            return e->attributes[i].value;
    return NULL;
}

const char *threemf_production(const threemf_element *e, const char *name) {
    for (size_t i = 0; i < e->count; i++)
        if (strcmp(e->attributes[i].name, name) == 0 && threemf_namespace(e->attributes[i].uri) == THREEMF_PRODUCTION)
            return e->attributes[i].value;
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

/* ---- libxml2's calls ---- */

static void stop(threemf_xml *x) {
    x->failed = true;
    xmlStopParser(x->parser);
}

static const char *text_of(const xmlChar *text) {
    return text ? (const char *)text : "";
}

/* A prefix that stands for nothing is as good a name of a namespace. */
static const char *uri_of(const xmlChar *uri, const xmlChar *prefix) {
    return text_of(uri ? uri : prefix);
}

/* libxml2 has five texts for each: name, prefix, namespace, and the value from its beginning to its end. */
static bool read_attributes(threemf_xml *x, const xmlChar *const *five, size_t count) {
    importer *im = x->f->im;
    size_t size = 0;
    for (size_t i = 0; i < count; i++)
        size += (size_t)(five[5 * i + 4] - five[5 * i + 3]) + 1;
    if (!import_room(im, &x->attributes, &x->attribute_room, count, sizeof *x->attributes) ||
        !import_room(im, &x->values, &x->value_room, size, 1))
        return false;
    char *to = x->values;
    for (size_t i = 0; i < count; i++, five += 5) {
        const size_t length = (size_t)(five[4] - five[3]);
        x->attributes[i] = (threemf_attribute_value){(const char *)five[0], uri_of(five[2], five[1]), to};
        memcpy(to, five[3], length);
        to[length] = '\0';
        to += length + 1;
    }
    return true;
}

static bool begin_element(threemf_xml *x, const xmlChar *name, const char *uri, const xmlChar *const *five, int count) {
    bool skip = false;
    if (!read_attributes(x, five, (size_t)count))
        return false;
    const threemf_element e = {.ns = namespace_of(x, uri),
                               .uri = uri,
                               .name = (const char *)name,
                               .attributes = x->attributes,
                               .count = (size_t)count};
    const bool fine = x->begin(x, &e, &skip);
    x->skipped = skip;
    return fine;
}

static void begin(void *user, const xmlChar *name, const xmlChar *prefix, const xmlChar *uri, int spaces, const xmlChar **space,
                  int count, int defaulted, const xmlChar **five) {
    threemf_xml *x = user;
    (void)defaulted;
    if (x->failed)
        return;
    for (int i = 0; x->depth == 0 && x->prefix && i < spaces; i++)
        if (!x->prefix(x, text_of(space[2 * i]), text_of(space[2 * i + 1]))) {
            stop(x);
            return;
        }
    if (x->depth++ >= IMPORT_DEPTH) {
        (void)threemf_wrong(x, "elements are nested deeper than %d", IMPORT_DEPTH);
        stop(x);
    } else if (x->skipped > 0)
        x->skipped++;
    else if (!begin_element(x, name, uri_of(uri, prefix), (const xmlChar *const *)five, count))
        stop(x);
}

static void end(void *user, const xmlChar *name, const xmlChar *prefix, const xmlChar *uri) {
    threemf_xml *x = user;
    (void)name;
    (void)prefix;
    (void)uri;
    x->depth--;
    if (x->skipped > 0)
        x->skipped--;
    else if (x->end && !x->failed)
        x->end(x);
}

static void doctype(void *user, const xmlChar *name, const xmlChar *public, const xmlChar *system) {
    threemf_xml *x = user;
    (void)name;
    (void)public;
    (void)system;
    if (!x->failed)
        (void)threemf_wrong(x, "has a document type, which 3MF forbids");
    stop(x);
}

/* ---- reading ---- */

static int read_piece(void *user, char *to, int size) {
    threemf_xml *x = user;
    const zip_int64_t got = zip_fread(x->from, to, (zip_uint64_t)size);
    x->damaged = x->damaged || got < 0;
    return (int)got;
}

static bool read_document(threemf_xml *x) {
    xmlParserCtxt *parser = x->parser;
    (void)xmlCtxtUseOptions(parser, XML_PARSE_NONET);
    (void)xmlParseDocument(parser);
    if (x->failed)
        return false;
    if (x->damaged)
        return import_fail(x->f->im, "%.100s is damaged: %.100s", x->part, zip_file_strerror(x->from));
    const xmlError *error = xmlCtxtGetLastError(parser);
    return parser->wellFormed ||
           import_fail(x->f->im, "%.100s:%d: is no well-formed XML: %.200s", x->part, error ? error->line : 0,
                       error && error->message ? error->message : "it has an end");
}

bool threemf_read_xml(threemf_xml *x, const char *name) {
    xmlSAXHandler calls = {
        .initialized = XML_SAX2_MAGIC, .startElementNs = begin, .endElementNs = end, .internalSubset = doctype};
    const char *wrong;
    x->part = name + strspn(name, "/");
    x->from = threemf_open_part(x->f, name, &wrong);
    if (!x->from)
        return import_fail(x->f->im, "%.200s in the archive %s", x->part, wrong);
    x->parser = xmlCreateIOParserCtxt(&calls, x, read_piece, NULL, x, XML_CHAR_ENCODING_NONE);
    const bool fine = x->parser ? read_document(x) : import_fail(x->f->im, "out of memory");
    xmlFreeParserCtxt(x->parser);
    (void)zip_fclose(x->from);
    free(x->attributes);
    free(x->values);
    return fine;
}
