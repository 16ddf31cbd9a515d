/* AMF: the unit, which Assimp leaves aside, and archives, which it does not read (ISO/ASTM 52915: a ZIP of one file). */
#include "import/assimp/assimp_scene.h"
#include "import/assimp/assimp_tags.h"
#include "import/import_zip.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HEAD = 1 << 14, WORD = sizeof(((assimp_scene *)0)->amf_unit) }; /* bytes in which the root element is; of a value */

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

static char *unpack(const char *bytes, size_t *size) {
    zip_source_t *source = zip_source_buffer_create(bytes, *size, 0, NULL);
    zip_t *archive = source ? zip_open_from_source(source, ZIP_RDONLY, NULL) : NULL;
    zip_file_t *file = archive ? zip_fopen_index(archive, 0, 0) : NULL;
    char *out = file ? import_unzipped(file, size) : NULL;
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
    char *unpacked = *size > 4 && memcmp(text, "PK\3\4", 4) == 0 ? unpack(text, size) : NULL;
    if (unpacked) {
        free(text);
        text = unpacked;
    }
    tag_span root, unit;
    if (tag_find((tag_span){text, text + (*size < HEAD ? *size : HEAD)}, "amf", &root) && tag_value(root, "unit", &unit))
        (void)snprintf(a->amf_unit, WORD, "%.*s", unit.end - unit.at < WORD ? (int)(unit.end - unit.at) : WORD - 1, unit.at);
    a->amf_turns = turns_instances(text, text + *size);
    return text;
}

bool assimp_unit_amf(const assimp_scene *a, double *unit, bool *stated) {
    *stated = a->amf_unit[0] != '\0';
    *unit = *stated ? metres(a->amf_unit) : 1e-3;
    return *unit > 0.0 || import_fail(a->im, "has unit '%.40s', which is none", a->amf_unit);
}
