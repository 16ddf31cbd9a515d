/* Floors, outer walls with pilasters and a door, steps round the court, cornice and open roof. */
#include "atrium.h"

static void floor_piece(mesh *m, double x0, double x1, double z0, double z1, double y, double uv) {
    shape_quad_add(m, &(shape_quad){.o = {x0, y, z1},
                                    .a = {x1 - x0, 0, 0},
                                    .b = {0, 0, z0 - z1},
                                    .nu = (int)ceil((x1 - x0) / BAY),
                                    .nv = (int)ceil((z1 - z0) / BAY),
                                    .uv = uv,
                                    .u0 = x0 / uv,
                                    .v0 = -z1 / uv});
}

/* The band between two rectangles, as four pieces that do not overlap. */
static void floor_ring(mesh *m, double ix, double iz, double ox, double oz, double y, double uv) {
    floor_piece(m, -ox, ox, -oz, -iz, y, uv);
    floor_piece(m, -ox, ox, iz, oz, y, uv);
    floor_piece(m, -ox, -ix, -iz, iz, y, uv);
    floor_piece(m, ix, ox, -iz, iz, y, uv);
}

static void box_ring(mesh *m, double ix, double iz, double ox, double oz, double y0, double y1, double uv) {
    shape_box(m, v3_of(-ox, y0, -oz), v3_of(ox, y1, -iz), uv, SIDE_BOTTOM);
    shape_box(m, v3_of(-ox, y0, iz), v3_of(ox, y1, oz), uv, SIDE_BOTTOM);
    shape_box(m, v3_of(-ox, y0, -iz), v3_of(-ix, y1, iz), uv, SIDE_BOTTOM | SIDE_BACK | SIDE_FRONT);
    shape_box(m, v3_of(ix, y0, -iz), v3_of(ox, y1, iz), uv, SIDE_BOTTOM | SIDE_BACK | SIDE_FRONT);
}

static void floors(mesh *m) {
    mesh_group_begin(m, "court_floor", "court");
    floor_piece(m, -COURT_X + 0.3, COURT_X - 0.3, -COURT_Z + 0.3, COURT_Z - 0.3, COURT_FLOOR, BAY);
    mesh_group_begin(m, "aisle_floor", "terracotta");
    floor_ring(m, COURT_X + 0.4, COURT_Z + 0.4, OUTER_X, OUTER_Z, 0.0, 1.8);
    mesh_group_begin(m, "gallery_floor", "terracotta");
    floor_ring(m, COURT_X - WALL - 0.3, COURT_Z - WALL - 0.3, OUTER_X, OUTER_Z, GALLERY, 1.8);
    mesh_group_begin(m, "steps", "marble");
    box_ring(m, COURT_X - 0.5, COURT_Z - 0.5, COURT_X + 0.5, COURT_Z + 0.5, COURT_FLOOR, 0.02, 1.7);
    box_ring(m, COURT_X - 0.85, COURT_Z - 0.85, COURT_X - 0.5, COURT_Z - 0.5, COURT_FLOOR, -0.15, 1.7);
}

/* One storey of the four outer walls, facing inward. */
static void outer_walls(mesh *m, double y0, double y1, double uv) {
    for (int i = 0; i < 4; i++) {
        bool is_long = (i & 1) == 0;
        double half = is_long ? OUTER_X : OUTER_Z;
        m->frame = atrium_side_of(i).frame;
        m->frame.o = v3_scale(m->frame.z, is_long ? -OUTER_Z : -OUTER_X);
        shape_quad_add(m, &(shape_quad){.o = {-half, y0, 0},
                                        .a = {2 * half, 0, 0},
                                        .b = {0, y1 - y0, 0},
                                        .nu = is_long ? 9 : 5,
                                        .nv = 2,
                                        .uv = uv,
                                        .v0 = y0 / uv});
    }
    m->frame = mesh_frame_at(v3_of(0, 0, 0), 0);
}

/* Flat pillars on the outer walls, opposite the columns; the vaults' ribs rest on them. */
static void pilasters(mesh *m) {
    mesh_group_begin(m, "pilasters", "trim");
    for (int i = 0; i < 4; i++) {
        atrium_side s = atrium_side_of(i);
        m->frame = s.frame;
        m->frame.o = v3_scale(s.frame.z, s.is_long ? -OUTER_Z : -OUTER_X);
        for (int k = 0; k <= s.bays; k++) {
            double x = atrium_bay(&s, k - 0.5);
            x += k == 0 ? -0.15 : k == s.bays ? 0.15 : 0.0; /* the corners' ribs are wider outward */
            shape_box(m, v3_of(x - 0.34, 0.0, 0.0), v3_of(x + 0.34, 0.5, 0.22), 1.0, SIDE_BOTTOM | SIDE_BACK);
            shape_box(m, v3_of(x - 0.27, 0.5, 0.0), v3_of(x + 0.27, SPRING - 0.3, 0.15), 1.0, SIDE_BOTTOM | SIDE_BACK);
            shape_box(m, v3_of(x - 0.31, SPRING - 0.3, 0.0), v3_of(x + 0.31, SPRING - 0.15, 0.19), 1.0, SIDE_BACK);
            shape_box(m, v3_of(x - 0.36, SPRING - 0.15, 0.0), v3_of(x + 0.36, SPRING, 0.24), 1.0, SIDE_BACK);
        }
    }
    m->frame = mesh_frame_at(v3_of(0, 0, 0), 0);
}

/* Two leaves of panels in a stone frame, in the middle of both end walls. */
static void doors(mesh *m) {
    for (int end = 1; end < 4; end += 2) {
        m->frame = atrium_side_of(end).frame;
        m->frame.o = v3_scale(m->frame.z, -OUTER_X);
        mesh_group_begin(m, "door_frames", "marble");
        shape_box(m, v3_of(-1.15, 0, 0), v3_of(-0.85, 3.1, 0.25), 1.0, SIDE_BACK | SIDE_BOTTOM);
        shape_box(m, v3_of(0.85, 0, 0), v3_of(1.15, 3.1, 0.25), 1.0, SIDE_BACK | SIDE_BOTTOM);
        shape_box(m, v3_of(-1.3, 3.1, 0), v3_of(1.3, 3.35, 0.3), 1.0, SIDE_BACK);
        shape_box(m, v3_of(-1.4, 3.35, 0), v3_of(1.4, 3.45, 0.38), 1.0, SIDE_BACK);
        mesh_group_begin(m, "doors", "wood");
        for (int leaf = 0; leaf < 2; leaf++) {
            double x = leaf ? 0.02 : -0.85;
            shape_box(m, v3_of(x, 0.01, 0), v3_of(x + 0.83, 3.1, 0.08), 1.6, SIDE_BACK | SIDE_BOTTOM);
            for (int k = 0; k < 3; k++)
                shape_box(m, v3_of(x + 0.13, 0.2 + 0.97 * k, 0.08), v3_of(x + 0.70, 0.97 + 0.97 * k, 0.12), 1.6, SIDE_BACK);
        }
    }
    m->frame = mesh_frame_at(v3_of(0, 0, 0), 0);
}

/* Deck with an opening over the court's middle, on beams that cross the opening. */
static void roof(mesh *m) {
    static const double cornice[][2] = {{-0.07, 10.6}, {0.08, 10.66}, {0.08, 10.76}, {0.18, 10.86}, {0.20, 10.96},
                                        {0.38, 11.06}, {0.42, 11.16}, {0.42, 11.3},  {0.0, 11.3}};
    const double deck = 12.1, ix = COURT_X - 3.6, iz = COURT_Z - 2.4;
    mesh_group_begin(m, "cornice", "trim");
    atrium_ring(m, COURT_X - WALL, COURT_Z - WALL, cornice, 9, 1.0);
    mesh_group_begin(m, "attic", "plaster");
    static const double attic[][2] = {{0.0, 11.3}, {0.0, 12.1}};
    atrium_ring(m, COURT_X - WALL, COURT_Z - WALL, attic, 2, 3.0);
    mesh_group_begin(m, "roof", "wood");
    const double x = COURT_X - WALL, z = COURT_Z - WALL;
    const double piece[4][4] = {{-x, x, -z, -iz}, {-x, x, iz, z}, {-x, -ix, -iz, iz}, {ix, x, -iz, iz}};
    for (int i = 0; i < 4; i++) {
        const double *p = piece[i];
        shape_quad_add(
            m, &(shape_quad){.o = {p[0], deck, p[2]}, .a = {p[1] - p[0], 0, 0}, .b = {0, 0, p[3] - p[2]}, .nu = 4, .uv = 1.6});
    }
    for (int k = 0; k <= LONG_BAYS; k++) {
        double at = (k - 0.5 * LONG_BAYS) * BAY;
        at = k == 0 ? at + 0.6 : k == LONG_BAYS ? at - 0.6 : at;
        shape_box(m, v3_of(at - 0.17, deck - 0.5, -z), v3_of(at + 0.17, deck - 0.02, z), 1.6, SIDE_BACK | SIDE_FRONT);
    }
    /* Frame round the opening; its outer sides are seen through the opening only as its thickness. */
    shape_box(m, v3_of(-ix - 0.12, deck - 0.3, -iz - 0.14), v3_of(ix + 0.12, deck + 0.3, -iz), 1.6, 0);
    shape_box(m, v3_of(-ix - 0.12, deck - 0.3, iz), v3_of(ix + 0.12, deck + 0.3, iz + 0.14), 1.6, 0);
    shape_box(m, v3_of(-ix - 0.12, deck - 0.3, -iz), v3_of(-ix, deck + 0.3, iz), 1.6, SIDE_BACK | SIDE_FRONT);
    shape_box(m, v3_of(ix, deck - 0.3, -iz), v3_of(ix + 0.12, deck + 0.3, iz), 1.6, SIDE_BACK | SIDE_FRONT);
}

void atrium_hall(mesh *m) {
    static const double dado[][2] = {{0.0, 1.2}, {0.05, 1.22}, {0.05, 1.3}, {0.0, 1.34}};
    static const double upper_band[][2] = {{0.0, 7.1}, {0.04, 7.12}, {0.04, 7.2}, {0.0, 7.22}};
    floors(m);
    mesh_group_begin(m, "outer_walls", "ashlar");
    outer_walls(m, 0.0, GALLERY, BAY);
    mesh_group_begin(m, "gallery_walls", "plaster");
    outer_walls(m, GALLERY, 11.0, 3.0);
    mesh_group_begin(m, "wall_bands", "trim");
    atrium_ring(m, OUTER_X, OUTER_Z, dado, 4, 1.0);
    atrium_ring(m, OUTER_X, OUTER_Z, upper_band, 4, 1.0);
    pilasters(m);
    doors(m);
    roof(m);
}
