/* STL in binary, little-endian: 80 bytes, the number of facets, 50 bytes a facet, the last two of which may be a colour. */
#include "import/stl/stl_file.h"
#include <stdlib.h>
#include <string.h>

enum { HEADER = 80, FRONT = HEADER + 4, FACET = 50, VERTICES = 12, ATTRIBUTE = 48 }; /* bytes; where they begin in a facet */

static uint32_t word_at(const uint8_t *at) {
    return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

/* Many begin with "solid", too. One of the right length is binary; others if they have a zero where text has none, unless they
 * have a word of STL's text as well. */
bool stl_is_binary(const uint8_t *at, size_t size) {
    const char *text = (const char *)at;
    if (size >= FRONT && size - FRONT == (uint64_t)FACET * word_at(at + HEADER))
        return true;
    const size_t head = size < 4096 ? size : 4096;
    return memchr(at, 0, head) != NULL && !(stl_is_text(at, size) && stl_find(text, text + head, "vertex "));
}

/* How many facets are read. Programs that do not know it when they begin leave 0 or 2^32 - 1 there. */
static bool count_facets(stl_file *f, size_t *count) {
    *count = 0;
    if (f->file.size < FRONT)
        return import_fail(f->im, "is cut short: %zu bytes are no STL file", f->file.size);
    const uint32_t stated = word_at(f->file.at + HEADER);
    const uint64_t there = (f->file.size - FRONT) / FACET, rest = (f->file.size - FRONT) % FACET;
    *count = (size_t)there;
    if ((stated == 0 && there > 0) || (stated == UINT32_MAX && there != stated))
        return (rest == 0 ||
                import_not_done(f->im, "%llu bytes behind the last facet are left out", (unsigned long long)rest)) &&
               import_not_done(f->im, "has no number of facets (%lu): there are %llu", (unsigned long)stated,
                               (unsigned long long)there);
    if (stated > there)
        return import_fail(f->im, "is cut short: %lu facets are announced, %llu are there", (unsigned long)stated,
                           (unsigned long long)there);
    *count = stated;
    const uint64_t behind = f->file.size - FRONT - (uint64_t)FACET * stated;
    return behind == 0 || import_not_done(f->im, "%llu bytes behind the last of %lu facets are left out",
                                          (unsigned long long)behind, (unsigned long)stated);
}

/* Magics: "COLOR=" and four bytes are the colour of all; a facet's own is in its 15 lower bits, red the lowest, if the highest
 * is 0. */
static bool read_header(stl_file *f, bool *magics) {
    const char *text = (const char *)f->file.at, *color = stl_find(text, text + HEADER, "COLOR=");
    *magics = color && color + 10 <= text + HEADER;
    if (!*magics)
        return true;
    memcpy(f->color, color + 6, 3);
    f->has_color = true;
    return ((uint8_t)color[9] == 255 || import_not_done(f->im, "alpha of its colour is left out")) &&
           (!stl_find(text, text + HEADER, "MATERIAL=") || import_not_done(f->im, "MATERIAL of its header is left out"));
}

/* VisCAM and SolidView: a facet's colour, blue the lowest, if the highest bit is 1. */
static uint16_t key_of(uint16_t attribute, bool magics) {
    if ((attribute >> 15 == 0) != magics)
        return STL_PLAIN;
    if (magics)
        return attribute;
    return (uint16_t)((attribute >> 10 & 31) | (attribute & 31 << 5) | (attribute & 31) << 10);
}

static bool read_facets(stl_file *f, size_t count, bool magics) {
    bool unknown = false;
    for (size_t i = 0; i < count; i++) {
        const uint8_t *facet = f->file.at + FRONT + FACET * i;
        for (size_t k = 0; k < 9; k++) {
            const uint32_t bits = word_at(facet + VERTICES + 4 * k);
            memcpy(f->position + 9 * i + k, &bits, sizeof bits);
        }
        const uint16_t attribute = (uint16_t)(facet[ATTRIBUTE] | facet[ATTRIBUTE + 1] << 8);
        f->key[i] = key_of(attribute, magics);
        unknown = unknown || (!magics && attribute != 0 && attribute >> 15 == 0);
    }
    return !unknown || import_not_done(f->im, "attributes of facets that are no colours are left out");
}

bool stl_read_binary(stl_file *f) {
    size_t count;
    bool magics;
    if (!count_facets(f, &count) || !read_header(f, &magics) ||
        !import_room(f->im, &f->position, &f->position_room, count, 9 * sizeof *f->position) ||
        !import_room(f->im, &f->solids, &f->solid_room, 1, sizeof *f->solids))
        return false;
    f->key = malloc((count + 1) * sizeof *f->key);
    if (!f->key)
        return import_fail(f->im, "out of memory");
    f->facets = count;
    f->solid_count = 1;
    f->solids[0] = (stl_solid){0};
    return read_facets(f, count, magics);
}
