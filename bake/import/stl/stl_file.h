/* stl*.c: what the parts of the STL reader share. Private to them. Whatever fails says why by import_fail(). */
#ifndef VIT_BAKE_STL_FILE_H
#define VIT_BAKE_STL_FILE_H

#include "import/importer.h"

enum { STL_COLORS = 256 };    /* of facets, each of which becomes a material */
enum { STL_PLAIN = 1 << 15 }; /* key of a facet without a colour of its own */

/* Facets from `first` on, up to the next solid's. */
typedef struct stl_solid {
    size_t first;
    char name[SCENE_NAME]; /* "" if it has none */
} stl_solid;

/* importer.reader */
typedef struct stl_file {
    importer *im;
    import_bytes file;
    float *position; /* 9 a facet */
    size_t facets, position_room;
    stl_solid *solids;
    size_t solid_count, solid_room;
    uint16_t *key;    /* of a facet: 5 bits each of red, green, blue from the lowest on, or STL_PLAIN; NULL: all are that */
    bool has_color;   /* of all plain facets */
    uint8_t color[3]; /* sRGB */
} stl_file;

/* stl_text.c, stl_binary.c: the facets of the whole file. */
bool stl_read_text(stl_file *f);
bool stl_read_binary(stl_file *f);
/* The file is binary. */
bool stl_is_binary(const uint8_t *at, size_t size);
/* Some text that begins as STL's does, in any case of its letters. */
bool stl_is_text(const uint8_t *at, size_t size);
/* Where `word` stands, in any case of its letters; NULL: nowhere. */
const char *stl_find(const char *at, const char *end, const char *word);

#endif
