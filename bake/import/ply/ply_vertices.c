/* Rows of 'vertex': positions, normals, texture coordinates, and whether all have one colour. */
#include "import/ply/ply_file.h"
#include <string.h>

bool ply_say_alpha(ply_file *p) {
    const bool said = p->said_alpha;
    p->said_alpha = true;
    return said || import_not_done(p->im, "alpha of vertices and faces is left out");
}

/* Integers are of 8 bits, whatever their type, but for unsigned ones of 16. */
double ply_most(ply_type type) {
    return type == PLY_FLOAT || type == PLY_DOUBLE ? 1.0 : type == PLY_UINT16 ? 65535.0 : 255.0;
}

static void note_color(ply_color *c, const double rgb[3]) {
    if (c->varies)
        return;
    if (!c->there)
        memcpy(c->value, rgb, sizeof c->value);
    c->there = true;
    c->varies = memcmp(c->value, rgb, sizeof c->value) != 0;
}

static void keep(float *list, size_t at, const double *values, size_t count) {
    for (size_t k = 0; list && k < count; k++)
        list[count * at + k] = (float)values[k];
}

static bool make_room(ply_file *p, const ply_element *e) {
    const size_t count = (size_t)e->rows;
    return import_room(p->im, &p->position, &p->position_room, count, 3 * sizeof *p->position) &&
           (!ply_property_of(p, e, PLY_NORMAL) ||
            import_room(p->im, &p->normal, &p->normal_room, count, 3 * sizeof *p->normal)) &&
           (!ply_property_of(p, e, PLY_U) || import_room(p->im, &p->uv, &p->uv_room, count, 2 * sizeof *p->uv));
}

bool ply_read_vertices(ply_file *p, const ply_element *e) {
    const ply_property *red = ply_property_of(p, e, PLY_RED), *alpha = ply_property_of(p, e, PLY_ALPHA);
    double row[PLY_ROLES];
    if (p->has_vertices)
        return import_fail(p->im, "has vertices twice");
    if (!ply_property_of(p, e, PLY_X))
        return import_fail(p->im, "its vertices have no 'x', 'y' and 'z'");
    if (e->rows >= VIT_NONE)
        return import_fail(p->im, "has more vertices than 2^32 - 2");
    if (!ply_rows_fit(p, e) || !make_room(p, e))
        return false;
    const double opaque = alpha ? ply_most(alpha->type) : 1.0;
    p->color.type = red ? red->type : PLY_FLOAT;
    for (size_t i = 0; i < e->rows; i++) {
        if (!ply_read_row(p, e, ply_skip_list, row))
            return false;
        keep(p->position, i, row + PLY_X, 3);
        keep(p->normal, i, row + PLY_NORMAL, 3);
        keep(p->uv, i, row + PLY_U, 2);
        if (red)
            note_color(&p->color, row + PLY_RED);
        if (alpha && row[PLY_ALPHA] < opaque && !ply_say_alpha(p))
            return false;
    }
    p->stated = p->vertices = (uint32_t)e->rows;
    p->has_vertices = true;
    return true;
}
