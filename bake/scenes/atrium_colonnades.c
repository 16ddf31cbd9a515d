/* Both storeys of the four sides, from the parts. */
#include "atrium_parts.h"

/* End walls run between the long ones, whose ends show in the end aisles. */
static arch arch_of(const atrium_side *s, int bay, double thick) {
    arch a = {.middle = atrium_bay(s, bay), .z0 = -thick, .z1 = thick, .segments = 18};
    double grow = s->is_long ? thick : -thick;
    a.x0 = a.middle - BAY / 2.0 - (bay == 0 ? grow : 0.0);
    a.x1 = a.middle + BAY / 2.0 + (bay == s->bays - 1 ? grow : 0.0);
    return a;
}

static void end_caps(mesh *m, const atrium_side *s, double y0, double y1, double thick, double uv) {
    double half = s->bays * BAY / 2.0 + thick;
    for (int end = -1; end <= 1; end += 2)
        shape_quad_add(m, &(shape_quad){.o = {end * half, y0, -end * -thick},
                                        .a = {0, 0, -end * 2.0 * thick},
                                        .b = {0, y1 - y0, 0},
                                        .uv = uv,
                                        .v0 = y0 / uv});
}

/* Columns 0..bays stand on the side's line; the end sides leave the corners to the long ones. */
static bool has_column(const atrium_side *s, int k) {
    return s->is_long || (k > 0 && k < s->bays);
}

static void ground_storey(mesh *m, const atrium_side *s) {
    for (int i = 0; i < s->bays; i++) {
        arch a = arch_of(s, i, WALL);
        a.y0 = SPRING;
        a.y1 = GALLERY;
        a.radius = 1.16;
        a.uv = BAY;
        atrium_arch(m, &a, "ashlar");
        atrium_archivolt(m, &a, "trim");
    }
    if (s->is_long) {
        mesh_group_begin(m, "arcade_ends", "ashlar");
        end_caps(m, s, SPRING, GALLERY, WALL, BAY);
    }
    for (int k = 0; k <= s->bays; k++)
        if (has_column(s, k))
            atrium_column(m, v3_of(atrium_bay(s, k - 0.5), 0.02, 0), (SPRING - 0.02) / 4.2, 1.0, 24);
}

static void upper_storey(mesh *m, const atrium_side *s) {
    const double foot = GALLERY + 1.05, thick = 0.24;
    for (int i = 0; i < s->bays; i++) {
        arch a = arch_of(s, i, thick);
        a.y0 = UPPER_SPRING;
        a.y1 = 11.0;
        a.radius = 1.22;
        a.uv = 3.0;
        atrium_arch(m, &a, "plaster");
        atrium_archivolt(m, &a, "trim");
        atrium_balustrade(m, a.middle - BAY / 2.0 + 0.3, a.middle + BAY / 2.0 - 0.3, GALLERY, 0.12);
    }
    if (s->is_long) {
        mesh_group_begin(m, "arcade_ends", "plaster");
        end_caps(m, s, UPPER_SPRING, 11.0, thick, 3.0);
    }
    for (int k = 0; k <= s->bays; k++) {
        if (!has_column(s, k))
            continue;
        double x = atrium_bay(s, k - 0.5);
        atrium_pedestal(m, v3_of(x, GALLERY, 0), 0.30, foot - GALLERY);
        atrium_column(m, v3_of(x, foot, 0), (UPPER_SPRING - 0.16 - foot) / 4.2, 1.35, 16);
        mesh_group_begin(m, "imposts", "trim"); /* the arches' feet are wider than the capitals */
        shape_box(m, v3_of(x - 0.41, UPPER_SPRING - 0.16, -0.30), v3_of(x + 0.41, UPPER_SPRING, 0.30), 1.0, 0);
    }
}

static void string_course(mesh *m) {
    static const double profile[][2] = {{0.0, 5.60},  {0.06, 5.63}, {0.06, 5.70}, {0.14, 5.76},
                                        {0.15, 5.82}, {0.28, 5.88}, {0.30, 5.93}, {0.30, 6.0}};
    mesh_group_begin(m, "string_course", "trim");
    atrium_ring(m, COURT_X - WALL, COURT_Z - WALL, profile, 8, 1.0);
}

void atrium_colonnades(mesh *m) {
    for (int i = 0; i < 4; i++) {
        atrium_side s = atrium_side_of(i);
        m->frame = s.frame;
        ground_storey(m, &s);
        upper_storey(m, &s);
    }
    m->frame = mesh_frame_at(v3_of(0, 0, 0), 0);
    string_course(m);
}
