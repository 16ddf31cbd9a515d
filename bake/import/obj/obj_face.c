/* Faces, lines and points: corners by their indices, which count from 1, or backwards from the last. */
#include "import/obj/obj_file.h"

/* One index; OBJ_NONE where there is no digit. False: something else is there. */
static bool read_index(obj_text *word, size_t count, uint32_t *out) {
    const bool back = word->at < word->end && *word->at == '-';
    const char *at = word->at + (back || (word->at < word->end && *word->at == '+')), *first = at;
    uint64_t value = 0;
    for (; at < word->end && *at >= '0' && *at <= '9'; at++)
        value = value < OBJ_MOST ? 10 * value + (uint64_t)(*at - '0') : value;
    if (at == first) {
        *out = OBJ_NONE;
        return at == word->at;
    }
    word->at = at;
    if (value == 0 || value > OBJ_MOST || (back && value > count))
        *out = OBJ_BAD;
    else
        *out = (uint32_t)(back ? count - value : value - 1);
    return true;
}

/* v, v/vt, v//vn, v/vt/vn. */
static bool read_corner(const obj_file *o, obj_text word, uint32_t index[3]) {
    const size_t counts[3] = {o->positions, o->uvs, o->normals};
    index[0] = index[1] = index[2] = OBJ_NONE;
    for (int k = 0; k < 3; k++) {
        if (!read_index(&word, counts[k], &index[k]))
            return false;
        if (word.at == word.end || *word.at != '/')
            break;
        word.at++;
    }
    return word.at == word.end && index[0] != OBJ_NONE;
}

/* A list that is there from the first corner on that has any. */
static bool add_optional(obj_file *o, uint32_t **list, size_t *room, uint32_t index) {
    if (!*list && index == OBJ_NONE)
        return true;
    const bool fresh = !*list;
    if (!import_room(o->im, list, room, o->corners + 1, sizeof **list))
        return false;
    for (size_t i = 0; fresh && i < o->corners; i++)
        (*list)[i] = OBJ_NONE;
    (*list)[o->corners] = index;
    return true;
}

static bool add_corner(obj_file *o, const uint32_t index[3]) {
    if (!import_room(o->im, &o->corner, &o->corner_room, o->corners + 1, sizeof *o->corner) ||
        !add_optional(o, &o->corner_uv, &o->corner_uv_room, index[1]) ||
        !add_optional(o, &o->corner_normal, &o->corner_normal_room, index[2]))
        return false;
    o->corner[o->corners++] = index[0];
    return true;
}

/* ---- parts ---- */

static bool find_mesh(obj_file *o) {
    static const char unnamed[] = "unnamed";
    if (o->mesh == OBJ_NONE)
        o->mesh = obj_name(o->im, &o->meshes,
                           obj_is_empty(o->mesh_name) ? (obj_text){unnamed, unnamed + sizeof unnamed - 1} : o->mesh_name);
    return o->mesh != OBJ_NONE;
}

/* The part that a face with or without normals goes to, which begins with the last `corners` corners. */
static bool find_part(obj_file *o, bool normals, size_t corners) {
    if (!find_mesh(o))
        return false;
    const obj_part *last = o->parts > 0 ? &o->part[o->parts - 1] : NULL;
    if (last && last->mesh == o->mesh && last->material == o->material && last->normals == normals)
        return true;
    if (!import_room(o->im, &o->part, &o->part_room, o->parts + 1, sizeof *o->part))
        return false;
    o->part[o->parts++] = (obj_part){
        .mesh = o->mesh, .material = o->material, .normals = normals, .face = o->faces, .corner = o->corners - corners};
    return true;
}

static bool add_smoothing(obj_file *o) {
    if (!o->smoothing && o->group == IMPORT_GROUPLESS)
        return true;
    const bool fresh = !o->smoothing;
    if (!import_room(o->im, &o->smoothing, &o->smoothing_room, o->faces + 1, sizeof *o->smoothing))
        return false;
    for (size_t i = 0; fresh && i < o->faces; i++)
        o->smoothing[i] = IMPORT_GROUPLESS;
    o->smoothing[o->faces] = o->group;
    return true;
}

/* The last `count` corners are a face. */
static bool add_face(obj_file *o, size_t count, bool normals) {
    if (!find_part(o, normals, count) || !add_smoothing(o) ||
        !import_room(o->im, &o->face, &o->face_room, o->faces + 1, sizeof *o->face))
        return false;
    o->face[o->faces++] = (uint16_t)count;
    o->part[o->parts - 1].triangles += count - 2;
    return true;
}

bool obj_read_face(obj_file *o, obj_text line) {
    const size_t first = o->corners;
    size_t count = 0;
    bool normals = true;
    for (obj_text word = obj_word(&line); !obj_is_empty(word); word = obj_word(&line), count++) {
        uint32_t index[3];
        if (!read_corner(o, word, index))
            return import_fail(o->im, "line %u: '%.*s' is no corner of a face", o->lines.number, obj_size(word, 40), word.at);
        normals = normals && index[2] != OBJ_NONE;
        if (count < IMPORT_CORNERS && !add_corner(o, index))
            return false;
    }
    if (count >= 3 && count <= IMPORT_CORNERS)
        return add_face(o, count, normals);
    o->corners = first;
    o->im->bad_polygon += count > IMPORT_CORNERS;
    o->im->m->not_triangles += count == 1 || count == 2;
    return true;
}

/* Points, or the segments of a line. */
void obj_count_elements(obj_file *o, obj_text line, bool lines) {
    uint64_t count = 0;
    while (!obj_is_empty(obj_word(&line)))
        count++;
    o->im->m->not_triangles += lines && count > 0 ? count - 1 : count;
}
