/* The header: lines of words, ended by LF, CR LF or CR. */
#include "import/ply/ply_file.h"
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* A part of a line. */
typedef struct words {
    const char *at, *end;
} words;

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/* The next word, of length 0 if there is none. */
static words take(words *line) {
    while (line->at < line->end && is_blank(*line->at))
        line->at++;
    words w = {line->at, line->at};
    while (w.end < line->end && !is_blank(*w.end))
        w.end++;
    line->at = w.end;
    return w;
}

static bool is(words w, const char *text) {
    return (size_t)(w.end - w.at) == strlen(text) && memcmp(w.at, text, strlen(text)) == 0;
}

static void copy(words w, char *to, size_t room) {
    (void)snprintf(to, room, "%.*s", (int)(w.end - w.at < (ptrdiff_t)room ? w.end - w.at : (ptrdiff_t)room - 1), w.at);
}

/* The first byte of the data may be any, 0x0A and 0x0D among them: how the first line ends is how all do. */
static bool next_line(ply_file *p, char ends, words *line) {
    const uint8_t *end = memchr(p->at, ends, (size_t)(p->end - p->at));
    if (!end)
        return import_fail(p->im, "the PLY header has no end");
    *line = (words){(const char *)p->at, (const char *)end};
    p->at = end + 1;
    p->line++;
    return true;
}

static bool wrong(const ply_file *p, const char *what, words w) {
    return import_fail(p->im, "line %llu: %s '%.*s'", (unsigned long long)p->line, what,
                       (int)(w.end - w.at < 60 ? w.end - w.at : 60), w.at);
}

static bool read_type(const ply_file *p, words w, ply_type *out) {
    static const struct {
        const char *name;
        ply_type type;
    } types[] = {{"char", PLY_INT8},     {"int8", PLY_INT8},     {"uchar", PLY_UINT8},   {"uint8", PLY_UINT8},
                 {"short", PLY_INT16},   {"int16", PLY_INT16},   {"ushort", PLY_UINT16}, {"uint16", PLY_UINT16},
                 {"int", PLY_INT32},     {"int32", PLY_INT32},   {"uint", PLY_UINT32},   {"uint32", PLY_UINT32},
                 {"int64", PLY_INT64},   {"uint64", PLY_UINT64}, {"float", PLY_FLOAT},   {"float32", PLY_FLOAT},
                 {"double", PLY_DOUBLE}, {"float64", PLY_DOUBLE}};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (is(w, types[i].name)) {
            *out = types[i].type;
            return true;
        }
    return wrong(p, "no type of PLY:", w);
}

static bool read_format(ply_file *p, words line, bool *known) {
    static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    const words name = take(&line), version = take(&line);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (is(name, names[i])) {
            p->encoding = (ply_encoding)i;
            *known = true;
            return is(version, "1.0") || import_not_done(p->im, "line %llu: a version other than 1.0 is read as if it were 1.0",
                                                         (unsigned long long)p->line);
        }
    return wrong(p, "no format of PLY:", name);
}

static bool read_element(ply_file *p, words line) {
    const words name = take(&line), count = take(&line);
    double rows;
    const char *end = import_number(count.at, count.end, false, &rows);
    if (end != count.end || !(rows >= 0.0 && rows < 0x1p53) || rows != (double)(uint64_t)rows)
        return wrong(p, "no number of rows:", count);
    if (!import_room(p->im, &p->elements, &p->element_room, p->element_count + 1, sizeof *p->elements))
        return false;
    ply_element *e = &p->elements[p->element_count++];
    *e = (ply_element){.rows = (uint64_t)rows, .first = p->property_count};
    copy(name, e->name, sizeof e->name);
    return true;
}

static bool read_property(ply_file *p, words line) {
    ply_property property = {.role = PLY_NOTHING};
    words type = take(&line);
    if (p->element_count == 0)
        return wrong(p, "no element before this property:", type);
    property.is_list = is(type, "list");
    if (property.is_list) {
        if (!read_type(p, take(&line), &property.count))
            return false;
        type = take(&line);
    }
    if (!read_type(p, type, &property.type) ||
        !import_room(p->im, &p->properties, &p->property_room, p->property_count + 1, sizeof *p->properties))
        return false;
    copy(take(&line), property.name, sizeof property.name);
    p->properties[p->property_count++] = property;
    p->elements[p->element_count - 1].properties++;
    return true;
}

/* MeshLab's and others': "comment TextureFile my wood.png", one for each number that faces may have. */
static bool read_comment(ply_file *p, words line) {
    const words key = take(&line);
    if (key.end - key.at != 11 || strncasecmp(key.at, "TextureFile", 11) != 0)
        return true;
    while (line.at < line.end && is_blank(*line.at))
        line.at++;
    while (line.end > line.at && is_blank(line.end[-1]))
        line.end--;
    if (p->texture_count == PLY_TEXTURES)
        return import_fail(p->im, "line %llu: more than %d textures", (unsigned long long)p->line, PLY_TEXTURES);
    if (!import_room(p->im, &p->textures, &p->texture_room, (size_t)p->texture_count + 1, sizeof *p->textures))
        return false;
    copy(line, p->textures[p->texture_count++], sizeof *p->textures);
    return true;
}

/* False also at the end, then with *ended. */
static bool read_line(ply_file *p, words line, bool *known, bool *ended) {
    const words key = take(&line);
    if (is(key, "end_header")) {
        *ended = true;
        return *known || import_fail(p->im, "the PLY header names no format");
    }
    if (is(key, "format"))
        return read_format(p, line, known);
    if (is(key, "element"))
        return read_element(p, line);
    if (is(key, "property"))
        return read_property(p, line);
    if (is(key, "comment"))
        return read_comment(p, line);
    return is(key, "obj_info") || key.at == key.end ||
           import_fail(p->im, "line %llu: not a PLY header", (unsigned long long)p->line);
}

/* ---- what properties mean ---- */

static ply_property *find(const ply_file *p, const ply_element *e, const char *name, bool is_list) {
    for (size_t i = 0; i < e->properties; i++) {
        ply_property *property = &p->properties[e->first + i];
        if (property->is_list == is_list && strcmp(property->name, name) == 0)
            return property;
    }
    return NULL;
}

const ply_property *ply_property_of(const ply_file *p, const ply_element *e, ply_role role) {
    for (size_t i = 0; i < e->properties; i++)
        if (p->properties[e->first + i].role == role)
            return &p->properties[e->first + i];
    return NULL;
}

/* Properties that mean something together, or not at all; of several ways to say the same the first. */
static void give_roles(ply_file *p, const ply_element *e) {
    static const struct {
        ply_role first;
        bool is_list;
        const char *names[3];
    } groups[] = {{PLY_X, false, {"x", "y", "z"}},
                  {PLY_NORMAL, false, {"nx", "ny", "nz"}},
                  {PLY_RED, false, {"red", "green", "blue"}},
                  {PLY_RED, false, {"diffuse_red", "diffuse_green", "diffuse_blue"}},
                  {PLY_RED, false, {"r", "g", "b"}},
                  {PLY_ALPHA, false, {"alpha"}},
                  {PLY_ALPHA, false, {"diffuse_alpha"}},
                  {PLY_ALPHA, false, {"a"}},
                  {PLY_U, false, {"texture_u", "texture_v"}},
                  {PLY_U, false, {"texture_s", "texture_t"}},
                  {PLY_U, false, {"s", "t"}},
                  {PLY_U, false, {"u", "v"}},
                  {PLY_TEXNUMBER, false, {"texnumber"}},
                  {PLY_INDICES, true, {"vertex_indices"}},
                  {PLY_INDICES, true, {"vertex_index"}},
                  {PLY_TEXCOORD, true, {"texcoord"}}};
    for (size_t i = 0; i < sizeof groups / sizeof *groups; i++) {
        ply_property *found[3] = {NULL, NULL, NULL};
        bool all = !ply_property_of(p, e, groups[i].first);
        for (size_t k = 0; k < 3 && groups[i].names[k]; k++) {
            found[k] = find(p, e, groups[i].names[k], groups[i].is_list);
            all = all && found[k];
        }
        for (unsigned k = 0; all && k < 3 && found[k]; k++)
            found[k]->role = (ply_role)(groups[i].first + k);
    }
}

/* What says how it looks, and is not done. */
static bool check_property(ply_file *p, const ply_element *e, const ply_property *property) {
    static const char *const names[] = {"material_index", "material_indices", "specular_red", "emission_red", "emissive_red"};
    bool cared = (strcmp(e->name, "vertex") == 0 && property->role == PLY_TEXNUMBER && p->texture_count > 1) ||
                 (strcmp(e->name, "face") == 0 && property->is_list && strcmp(property->name, "color") == 0);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        cared = cared || strcmp(property->name, names[i]) == 0;
    return !cared || e->rows == 0 || import_not_done(p->im, "property '%.60s' of '%.60s' is left out", property->name, e->name);
}

bool ply_read_header(ply_file *p) {
    words line = {NULL, NULL};
    const size_t left = (size_t)(p->end - p->at);
    if (left < 4 || memcmp(p->at, "ply", 3) != 0 || !(is_blank((char)p->at[3]) || p->at[3] == '\n'))
        return import_fail(p->im, "is no PLY file");
    size_t at = 3;
    while (at < left && (p->at[at] == ' ' || p->at[at] == '\t'))
        at++;
    const bool cr = at < left && p->at[at] == '\r' && !(at + 1 < left && p->at[at + 1] == '\n');
    bool known = false, ended = false;
    if (!next_line(p, cr ? '\r' : '\n', &line))
        return false;
    while (!ended)
        if (!next_line(p, cr ? '\r' : '\n', &line) || !read_line(p, line, &known, &ended))
            return false;
    p->line++;
    for (size_t i = 0; i < p->element_count; i++) {
        const ply_element *e = &p->elements[i];
        give_roles(p, e);
        for (size_t k = 0; k < e->properties; k++)
            if (!check_property(p, e, &p->properties[e->first + k]))
                return false;
    }
    return true;
}
