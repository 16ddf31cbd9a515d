/* Two rooms of 4 x 4 x 2.7 m side by side, a wall of 0.1 m between them, in it a door that stands ajar. What light the far room
 * gets comes through the gap, and most of it after several reflections: any leak through the wall or the door shows. */
#include "scenes.h"
#include "shapes.h"

#define HALF 4.0 /* of both rooms along x */
#define SIDE 2.0 /* half along z */
#define HIGH 2.7
#define WALL 0.1    /* thickness */
#define DOOR 0.9    /* width of the doorway, about z = 0 */
#define LINTEL 2.05 /* height of the doorway */
#define LEAF 0.04   /* thickness of the door */
#define COSINE 0.8  /* of the angle by which the door is open */
#define SINE 0.6

static const mesh_material materials[] = {
    {"plaster", {0.70, 0.68, 0.64}, NULL},
    {"floor", {0.45, 0.32, 0.20}, NULL},
    {"door", {0.50, 0.28, 0.16}, NULL},
};

/* The face o, a, b of a block, facing along a x b. */
static void face(mesh *m, v3 o, v3 a, v3 b) {
    shape_quad_add(m, &(shape_quad){.o = o, .a = a, .b = b, .nu = 4, .nv = 4});
}

/* A block from o along the right-handed edges a, b, c. */
static void block(mesh *m, v3 o, v3 a, v3 b, v3 c) {
    face(m, o, b, a);
    face(m, v3_add(o, c), a, b);
    face(m, o, c, b);
    face(m, v3_add(o, a), b, c);
    face(m, o, a, c);
    face(m, v3_add(o, b), c, a);
}

static void upright(mesh *m, double x0, double x1, double y0, double y1, double z0, double z1) {
    shape_box(m, v3_of(x0, y0, z0), v3_of(x1, y1, z1), 1, 0);
}

bool rooms_make(const char *dir, scenes_report *report) {
    const double gap = 0.01; /* round the door */
    const v3 hinge = v3_of(WALL / 2, gap, -DOOR / 2);
    mesh m;
    mesh_init(&m);
    mesh_group_begin(&m, "floor", "floor");
    upright(&m, -HALF - WALL, HALF + WALL, -WALL, 0, -SIDE - WALL, SIDE + WALL);
    mesh_group_begin(&m, "walls", "plaster");
    upright(&m, -HALF - WALL, HALF + WALL, HIGH, HIGH + WALL, -SIDE - WALL, SIDE + WALL);
    upright(&m, -HALF - WALL, -HALF, 0, HIGH, -SIDE - WALL, SIDE + WALL);
    upright(&m, HALF, HALF + WALL, 0, HIGH, -SIDE - WALL, SIDE + WALL);
    upright(&m, -HALF, HALF, 0, HIGH, -SIDE - WALL, -SIDE);
    upright(&m, -HALF, HALF, 0, HIGH, SIDE, SIDE + WALL);
    mesh_group_begin(&m, "partition", "plaster");
    upright(&m, -WALL / 2, WALL / 2, 0, HIGH, -SIDE, -DOOR / 2);
    upright(&m, -WALL / 2, WALL / 2, 0, HIGH, DOOR / 2, SIDE);
    upright(&m, -WALL / 2, WALL / 2, LINTEL, HIGH, -DOOR / 2, DOOR / 2);
    mesh_group_begin(&m, "door", "door");
    block(&m, hinge, v3_of(SINE * (DOOR - gap), 0, COSINE * (DOOR - gap)), v3_of(COSINE * LEAF, 0, -SINE * LEAF),
          v3_of(0, LINTEL - 2 * gap, 0));
    report->file = "rooms.obj";
    report->triangles = m.triangle_count;
    bool good = mesh_write(&m, dir, "rooms", materials, sizeof materials / sizeof materials[0]);
    mesh_free(&m);
    return good;
}
