/* The unit of AMF files, which Assimp leaves aside. */
#include "import/assimp/assimp_scene.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { HEAD = 1 << 14, WORD = 64 }; /* bytes of the file, of which the root element is among the first; of a value */

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

bool assimp_unit_amf(importer *im, double *unit, bool *stated) {
    char text[HEAD + 1], word[WORD] = "";
    FILE *file = fopen(im->file, "rb");
    const size_t size = file ? fread(text, 1, HEAD, file) : 0;
    if (file)
        (void)fclose(file);
    for (size_t i = 0; i < size; i++)
        text[i] = text[i] ? text[i] : ' ';
    text[size] = '\0';
    const char *root = strstr(text, "<amf");
    if (root)
        attribute(root, "unit", word);
    *stated = word[0] != '\0';
    *unit = *stated ? metres(word) : 1e-3;
    return *unit > 0.0 || import_fail(im, "has unit '%.40s', which is none", word);
}
