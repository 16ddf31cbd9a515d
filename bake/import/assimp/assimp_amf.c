/* AMF: the unit, which Assimp leaves aside, and archives, which it does not read (ISO/ASTM 52915: a ZIP of one file). */
#include "import/assimp/assimp_scene.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zip.h>

enum { HEAD = 1 << 14, WORD = sizeof(((assimp_scene *)0)->amf_unit) }; /* bytes in which the root element is; of a value */
#define UNPACKED_MOST ((size_t)1 << 30)                                /* bytes */

/* The value of an attribute of the tag that begins at `tag`, cut to WORD - 1 bytes; "" if it is not there. */
static void attribute(const char *tag, const char *name, char out[WORD]) {
    const char *end = tag + strcspn(tag, ">");
    out[0] = '\0';
    for (const char *at = tag; (at = strstr(at, name)) && at < end; at += strlen(name)) {
        const char *c = at + strlen(name) + strspn(at + strlen(name), " \t\r\n");
        if (at == tag || !isspace((unsigned char)at[-1]) || *c != '=')
            continue;
        c += 1 + strspn(c + 1, " \t\r\n");
        if (*c == '"' || *c == '\'') {
            const char quote[2] = {*c, '\0'};
            const size_t size = strcspn(c + 1, quote);
            (void)snprintf(out, WORD, "%.*s", (int)(size < WORD ? size : WORD - 1), c + 1);
        }
        return;
    }
}

/* Metres; 0: no unit of AMF's. */
static double metres(const char *word) {
    static const struct {
        const char *word;
        double metres;
    } units[] = {{"micron", 1e-6}, {"millimeter", 1e-3}, {"meter", 1.0},        {"inch", 0.0254},
                 {"foot", 0.3048}, {"feet", 0.3048},     {"millimeters", 1e-3}, {"centimeter", 1e-2}};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (!strcmp(units[i].word, word))
            return units[i].metres;
    return 0.0;
}

/* All of it, in steps: sizes that an archive states are not believed. NULL: it is damaged, or does not fit. */
static char *read_whole(zip_file_t *from, size_t *size) {
    char *bytes = NULL;
    zip_int64_t got = 1;
    *size = 0;
    for (size_t room = 1 << 16; got > 0 && room <= UNPACKED_MOST; room *= 2) {
        char *grown = realloc(bytes, room);
        if (!grown)
            break;
        bytes = grown;
        while (*size < room && (got = zip_fread(from, bytes + *size, room - *size)) > 0)
            *size += (size_t)got;
    }
    if (got == 0)
        return bytes;
    free(bytes);
    return NULL;
}

static char *unpack(const char *bytes, size_t *size) {
    zip_source_t *source = zip_source_buffer_create(bytes, *size, 0, NULL);
    zip_t *archive = source ? zip_open_from_source(source, ZIP_RDONLY, NULL) : NULL;
    zip_file_t *file = archive ? zip_fopen_index(archive, 0, 0) : NULL;
    char *out = file ? read_whole(file, size) : NULL;
    if (file)
        (void)zip_fclose(file);
    if (archive)
        zip_discard(archive);
    else
        zip_source_free(source);
    return out;
}

/* By <rx>, <ry> or <rz>, degrees, of an instance. */
static bool turns_instances(const char *at, const char *end) {
    for (; at < end && (at = memchr(at, '<', (size_t)(end - at))); at++) {
        double degrees = 0.0;
        if (end - at < 5 || at[1] != 'r' || at[2] < 'x' || at[2] > 'z' || at[3] != '>')
            continue;
        const char *number = at + 4;
        while (number < end && isspace((unsigned char)*number))
            number++;
        if (!import_number(number, end, false, &degrees) || degrees != 0.0)
            return true;
    }
    return false;
}

char *assimp_read_amf(assimp_scene *a, char *text, size_t *size) {
    char head[HEAD + 1];
    char *unpacked = *size > 4 && memcmp(text, "PK\3\4", 4) == 0 ? unpack(text, size) : NULL;
    if (unpacked) {
        free(text);
        text = unpacked;
    }
    const size_t length = *size < HEAD ? *size : HEAD;
    for (size_t i = 0; i < length; i++)
        head[i] = text[i] ? text[i] : ' ';
    head[length] = '\0';
    const char *root = strstr(head, "<amf");
    if (root)
        attribute(root, "unit", a->amf_unit);
    a->amf_turns = turns_instances(text, text + *size);
    return text;
}

bool assimp_unit_amf(const assimp_scene *a, double *unit, bool *stated) {
    *stated = a->amf_unit[0] != '\0';
    *unit = *stated ? metres(a->amf_unit) : 1e-3;
    return *unit > 0.0 || import_fail(a->im, "has unit '%.40s', which is none", a->amf_unit);
}
