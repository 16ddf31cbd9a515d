/* Statements of OBJ, one a line, in one pass. */
#include "import/obj/obj_file.h"
#include <math.h>
#include <string.h>

static bool not_a_number(obj_file *o, obj_text line) {
    const obj_text word = obj_word(&line);
    if (obj_is_empty(word))
        return import_fail(o->im, "line %u: too few numbers", o->lines.number);
    return import_fail(o->im, "line %u: '%.*s' is no number", o->lines.number, obj_size(word, 40), word.at);
}

/* Up to `most` numbers; at least `least`. */
static bool numbers(obj_file *o, obj_text *line, float *out, size_t least, size_t most, size_t *count) {
    for (*count = 0; *count < most; ++*count) {
        obj_text ahead = *line;
        if (*count >= least && obj_is_empty(obj_word(&ahead)))
            return true;
        if (!obj_number(line, &out[*count]))
            return not_a_number(o, *line);
    }
    return true;
}

static bool append(obj_file *o, float **list, size_t *count, size_t *room, const float *value, size_t size) {
    if (*count >= OBJ_MOST)
        return import_fail(o->im, "line %u: too many elements", o->lines.number);
    if (!import_room(o->im, list, room, *count + 1, size * sizeof **list))
        return false;
    memcpy(*list + size * *count, value, size * sizeof **list);
    ++*count;
    return true;
}

/* White for the vertices before the first that has a colour, and for those behind it that have none. */
static bool add_color(obj_file *o, const float color[3], size_t upto) {
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    while (o->colors + 1 < upto)
        if (!append(o, &o->color, &o->colors, &o->color_room, white, 3))
            return false;
    return append(o, &o->color, &o->colors, &o->color_room, color ? color : white, 3);
}

/* x y z, with a weight, which is for curves alone, or a colour behind it. */
static bool read_position(obj_file *o, obj_text line) {
    float v[8];
    size_t count;
    if (!numbers(o, &line, v, 3, 8, &count))
        return false;
    if (count == 5 || count == 8)
        return import_fail(o->im, "line %u: 'v' with %zu numbers", o->lines.number, count);
    if (!append(o, &o->position, &o->positions, &o->position_room, v, 3))
        return false;
    return count < 6 || add_color(o, v + 3, o->positions);
}

static bool read_uv(obj_file *o, obj_text line) {
    float uv[3] = {0.0f, 0.0f, 0.0f};
    size_t count;
    return numbers(o, &line, uv, 1, 3, &count) && append(o, &o->uv, &o->uvs, &o->uv_room, uv, 2);
}

static bool read_normal(obj_file *o, obj_text line) {
    float n[3];
    size_t count;
    return numbers(o, &line, n, 3, 3, &count) && append(o, &o->normal, &o->normals, &o->normal_room, n, 3);
}

/* Faces to come are of the mesh of this name, "o" and "g" alike; a mesh may be gone on with later. */
static void read_mesh_name(obj_file *o, obj_text line) {
    o->mesh_name = obj_rest(line);
    o->mesh = OBJ_NONE;
}

static bool read_material_name(obj_file *o, obj_text line) {
    const obj_text name = obj_rest(line);
    o->material = obj_is_empty(name) ? OBJ_NONE : obj_name(o->im, &o->materials, name);
    return obj_is_empty(name) || o->material != OBJ_NONE;
}

/* A number from 1 on, 0 or "off". */
static bool read_group(obj_file *o, obj_text line) {
    const obj_text word = obj_word(&line);
    uint64_t group = 0;
    if (obj_is(word, "off") || obj_is_empty(word)) {
        o->group = IMPORT_FLAT;
        return true;
    }
    for (const char *c = word.at; c < word.end; c++) {
        if (*c < '0' || *c > '9')
            return import_not_done(o->im, "line %u: '%.*s' is no smoothing group; it is left out", o->lines.number,
                                   obj_size(word, 40), word.at);
        group = group < OBJ_MOST ? 10 * group + (uint64_t)(*c - '0') : OBJ_MOST;
    }
    o->group = group < OBJ_MOST ? (uint32_t)group : OBJ_MOST;
    return true;
}

/* ---- what is left out ---- */

static bool say_once(obj_file *o, bool *said, const char *words, obj_text word) {
    if (*said)
        return true;
    *said = true;
    return import_not_done(o->im, "line %u: '%.*s': %s", o->lines.number, obj_size(word, 40), word.at, words);
}

static bool is_one_of(obj_text word, const char *const *list) {
    while (*list && !obj_is(word, *list))
        list++;
    return *list != NULL;
}

/* Switched off, or at the default that has no effect. */
static bool is_off(obj_text line) {
    const obj_text word = obj_word(&line);
    return obj_is_empty(word) || obj_is(word, "off") || obj_is(word, "0");
}

static bool leave_out(obj_file *o, obj_text word, obj_text line) {
    static const char *const curves[] = {"vp",   "cstype", "deg",  "bmat", "step", "curv",  "curv2", "surf",
                                         "parm", "trim",   "hole", "scrv", "sp",   "end",   "con",   "cdc",
                                         "bzp",  "bsp",    "cdp",  "res",  "mg",   "ctech", "stech", NULL};
    static const char *const states[] = {"bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", NULL};
    static const char *const calls[] = {"call", "csh", NULL};
    static const char *const textures[] = {"usemap", "maplib", NULL};
    if (is_one_of(word, curves))
        return is_off(line) && obj_is(word, "mg")
                   ? true
                   : say_once(o, &o->curves, "curves and surfaces of free form are left out", word);
    if (is_one_of(word, states))
        return is_off(line) ? true : say_once(o, &o->states, "is left out, and so are other states of display", word);
    if (is_one_of(word, calls))
        return say_once(o, &o->calls, "other files' statements are left out", word);
    if (is_one_of(word, textures))
        return is_off(line) ? true : say_once(o, &o->textures, "textures beside those of materials are left out", word);
    return say_once(o, &o->unknown, "is not known and left out, and so may be others", word);
}

/* ZBrush and ZRemesher write colours of vertices as comments. */
static bool read_comment(obj_file *o, const char *at, const char *end) {
    static const char mark[] = "#MRGB";
    const size_t size = sizeof mark - 1;
    if ((size_t)(end - at) < size || memcmp(at, mark, size) != 0)
        return true;
    return say_once(o, &o->painted, "colours of vertices in comments are left out", (obj_text){at, at + size});
}

/* ---- all of them ---- */

static bool read_statement(obj_file *o, obj_text word, obj_text line) {
    if (obj_is(word, "o") || obj_is(word, "g"))
        read_mesh_name(o, line);
    else if (obj_is(word, "l") || obj_is(word, "p"))
        obj_count_elements(o, line, obj_is(word, "l"));
    else if (obj_is(word, "s"))
        return read_group(o, line);
    else if (obj_is(word, "fo")) /* an older word for it */
        return obj_read_face(o, line);
    else if (obj_is(word, "usemtl"))
        return read_material_name(o, line);
    else if (obj_is(word, "mtllib"))
        return obj_is_empty(obj_rest(line)) || obj_name(o->im, &o->libraries, obj_rest(line)) != OBJ_NONE;
    else
        return leave_out(o, word, line);
    return true;
}

static bool read_line(obj_file *o, obj_text line) {
    const obj_text word = obj_word(&line);
    if (obj_is_empty(word))
        return read_comment(o, word.at, line.end);
    const size_t size = (size_t)(word.end - word.at);
    if (size == 1 && word.at[0] == 'v')
        return read_position(o, line);
    if (size == 1 && word.at[0] == 'f')
        return obj_read_face(o, line);
    if (size == 2 && word.at[0] == 'v' && word.at[1] == 't')
        return read_uv(o, line);
    if (size == 2 && word.at[0] == 'v' && word.at[1] == 'n')
        return read_normal(o, line);
    return read_statement(o, word, line);
}

bool obj_read(obj_file *o) {
    obj_text line;
    o->lines = obj_lines_of(&o->bytes);
    o->mesh = o->material = OBJ_NONE;
    o->group = IMPORT_GROUPLESS;
    while (obj_next_line(&o->lines, &line))
        if (!read_line(o, line))
            return false;
    return o->colors == 0 || o->colors == o->positions || add_color(o, NULL, o->positions);
}
