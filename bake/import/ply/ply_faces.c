/* Rows of 'face' and 'tristrips': triangles, each with the number of its texture and its colour. */
#include "import/ply/ply_file.h"
#include <string.h>

/* A vertex of the file, or VIT_NONE. */
static uint32_t index_of(const ply_file *p, double value) {
    return value >= 0.0 && value < (double)p->stated && value == (double)(uint32_t)value ? (uint32_t)value : VIT_NONE;
}

uint32_t *ply_corners(const ply_file *p) {
    return p->im->m->index + 3 * (size_t)p->im->m->triangles;
}

/* At least this many. */
static bool make_room(ply_file *p, size_t triangles) {
    const size_t more = p->triangle_room + p->triangle_room / 2, count = more > triangles ? more : triangles;
    if (triangles <= p->triangle_room)
        return true;
    p->wrong = "more triangles than there is room for";
    if (!import_make_room(p->im, 0, count > VIT_MAX_TRIANGLES ? triangles : count))
        return false;
    p->triangle_room = count;
    return true;
}

static bool add_triangle(ply_file *p, uint32_t a, uint32_t b, uint32_t c, uint32_t key) {
    const size_t at = p->triangles;
    const bool first = key != 0 && !p->key;
    if (!make_room(p, at + 1) || ((key != 0 || p->key) && !import_room(p->im, &p->key, &p->key_room, at + 1, sizeof *p->key)))
        return false;
    if (first)
        memset(p->key, 0, at * sizeof *p->key);
    if (p->key)
        p->key[at] = key;
    uint32_t *to = ply_corners(p) + 3 * at;
    to[0] = a;
    to[1] = b;
    to[2] = c;
    p->triangles++;
    return true;
}

/* ---- polygons ---- */

static bool read_indices(ply_file *p, const ply_property *property, uint64_t count) {
    double value;
    p->corners = count;
    if (count > IMPORT_CORNERS)
        return ply_skip_list(p, property, count);
    for (size_t i = 0; i < count; i++) {
        if (!ply_read_value(p, property->type, &value))
            return false;
        p->polygon[i] = index_of(p, value);
    }
    return true;
}

static bool read_coordinates(ply_file *p, const ply_property *property, uint64_t count) {
    double value;
    p->coordinates = count;
    if (count > sizeof p->texcoord / sizeof *p->texcoord)
        return ply_skip_list(p, property, count);
    for (size_t i = 0; i < count; i++) {
        if (!ply_read_value(p, property->type, &value))
            return false;
        p->texcoord[i] = (float)value;
    }
    return true;
}

static bool read_lists(ply_file *p, const ply_property *property, uint64_t count) {
    return property->role == PLY_INDICES    ? read_indices(p, property, count)
           : property->role == PLY_TEXCOORD ? read_coordinates(p, property, count)
                                            : ply_skip_list(p, property, count);
}

/* What MeshLab writes: two coordinates a corner, or none. */
static bool take_coordinates(ply_file *p) {
    static const float zero[2] = {0.0f, 0.0f};
    const bool there = p->coordinates == 2 * p->corners;
    if (!there && p->coordinates > 0 && !p->said_texcoord) {
        p->said_texcoord = true;
        if (!import_not_done(p->im, "texture coordinates of faces that are not two for each corner are left out"))
            return false;
    }
    for (size_t i = 0; i < p->corners; i++)
        if (p->polygon[i] != VIT_NONE && !ply_corner(p, p->polygon[i], there ? p->texcoord + 2 * i : zero, &p->polygon[i]))
            return false;
    return true;
}

static bool is_whole(const ply_file *p) {
    for (size_t i = 0; i < p->corners; i++)
        if (p->polygon[i] == VIT_NONE)
            return false;
    return true;
}

static bool add_polygon(ply_file *p, bool mapped, uint32_t key) {
    uint32_t cut[3 * (IMPORT_CORNERS - 2)];
    if (p->corners < 3) {
        p->im->m->not_triangles += p->corners > 0;
        return true;
    }
    if (p->corners > IMPORT_CORNERS || (p->corners > 3 && !is_whole(p))) {
        p->im->bad_polygon++;
        return true;
    }
    if (mapped && !take_coordinates(p))
        return false;
    if (p->corners == 3)
        return add_triangle(p, p->polygon[0], p->polygon[1], p->polygon[2], key);
    import_cut_polygon(&(const mesh_floats){p->position, 3}, p->polygon, (unsigned)p->corners, cut);
    for (size_t i = 0; i < p->corners - 2; i++)
        if (!add_triangle(p, p->polygon[cut[3 * i]], p->polygon[cut[3 * i + 1]], p->polygon[cut[3 * i + 2]], key))
            return false;
    return true;
}

/* ---- textures and colours ---- */

/* Its number among the colours of faces; 0 if there are too many. */
static uint32_t color_number(ply_file *p, const double rgb[3], ply_type type) {
    for (unsigned i = p->color_count; i > 0; i--)
        if (memcmp(p->colors[i].value, rgb, sizeof p->colors[i].value) == 0 && p->colors[i].type == type)
            return i;
    if (p->color_count + 1 == PLY_COLORS) {
        p->more_colors = true;
        return 0;
    }
    ply_color *c = &p->colors[++p->color_count];
    memcpy(c->value, rgb, sizeof c->value);
    c->type = type;
    c->there = true;
    return p->color_count;
}

/* What is no number of a texture is none: texture_count. */
static uint32_t texture_number(const ply_file *p, double value) {
    return value >= 0.0 && value < (double)p->texture_count ? (uint32_t)value : p->texture_count;
}

bool ply_read_faces(ply_file *p, const ply_element *e) {
    const ply_property *red = ply_property_of(p, e, PLY_RED), *alpha = ply_property_of(p, e, PLY_ALPHA);
    const bool numbered = ply_property_of(p, e, PLY_TEXNUMBER), mapped = ply_property_of(p, e, PLY_TEXCOORD);
    const double opaque = alpha ? ply_most(alpha->type) : 1.0;
    double row[PLY_ROLES];
    if (!ply_property_of(p, e, PLY_INDICES))
        return import_fail(p->im, "its faces have no list 'vertex_indices'");
    if (!ply_rows_fit(p, e) || !make_room(p, p->triangles + (size_t)e->rows))
        return false;
    for (uint64_t i = 0; i < e->rows; i++) {
        p->coordinates = 0;
        if (!ply_read_row(p, e, read_lists, row) || (alpha && row[PLY_ALPHA] < opaque && !ply_say_alpha(p)))
            return false;
        const uint32_t texture = numbered ? texture_number(p, row[PLY_TEXNUMBER]) : 0,
                       color = red ? color_number(p, row + PLY_RED, red->type) : 0;
        if (!add_polygon(p, mapped, texture | color << 16))
            return false;
    }
    return true;
}

/* ---- strips ---- */

/* Each vertex makes a triangle with the two before it, every second one turned round; -1 begins anew. */
static bool read_strip(ply_file *p, const ply_property *property, uint64_t count) {
    uint32_t last[2] = {VIT_NONE, VIT_NONE};
    double value;
    if (property->role != PLY_INDICES)
        return ply_skip_list(p, property, count);
    for (uint64_t i = 0, at = 0; i < count; i++) {
        if (!ply_read_value(p, property->type, &value))
            return false;
        if (value == -1.0 || (value == (double)UINT32_MAX && property->type == PLY_UINT32)) {
            at = 0;
            continue;
        }
        const uint32_t v = index_of(p, value);
        if (at >= 2 && !add_triangle(p, last[at % 2], last[1 - at % 2], v, 0))
            return false;
        last[0] = last[1];
        last[1] = v;
        at++;
    }
    return true;
}

bool ply_read_strips(ply_file *p, const ply_element *e) {
    double row[PLY_ROLES];
    if (!ply_property_of(p, e, PLY_INDICES))
        return import_fail(p->im, "its strips have no list 'vertex_indices'");
    if (!ply_rows_fit(p, e))
        return false;
    for (uint64_t i = 0; i < e->rows; i++)
        if (!ply_read_row(p, e, read_strip, row))
            return false;
    return true;
}
