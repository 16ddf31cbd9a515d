/* The Cornell box at 2 m: 0.0036 of the published millimetres (Goral et al. 1984; Cornell program of computer graphics). */
#include "scenes.h"
#include "shapes.h"

#define SIZE 2.0
#define CELLS 16 /* a wall's edge; the walls meet vertex on vertex */

static const mesh_material materials[] = {
    {"white", {0.73, 0.73, 0.73}, NULL},
    {"red", {0.63, 0.065, 0.05}, NULL},
    {"green", {0.14, 0.45, 0.091}, NULL},
};

static void wall(mesh *m, const char *object, const char *material, v3 o, v3 a, v3 b) {
    mesh_group_begin(m, object, material);
    shape_quad_add(m, &(shape_quad){.o = o, .a = a, .b = b, .nu = CELLS, .nv = CELLS});
}

/* A block on the floor; `corners` of its top, published in mm, anticlockwise seen from above in a frame whose x runs from right
 * to left and z away from the viewer. */
static void block(mesh *m, const char *object, const double corners[4][2], double height) {
    const double scale = SIZE / 555.0;
    v3 foot[4], up = {0, height * scale, 0};
    for (int i = 0; i < 4; i++)
        foot[i] = v3_of(SIZE / 2 - corners[i][0] * scale, 0, SIZE / 2 - corners[i][1] * scale);
    mesh_group_begin(m, object, "white");
    for (int i = 0; i < 4; i++) {
        v3 a = foot[i], along = v3_sub(foot[(i + 1) & 3], a), inward = v3_sub(foot[(i + 2) & 3], a);
        bool outward = v3_dot(v3_cross(along, up), inward) < 0.0;
        shape_quad q = {.o = a, .a = along, .b = up, .nu = 4, .nv = 8};
        if (!outward) {
            q.o = v3_add(a, along);
            q.a = v3_scale(along, -1);
        }
        shape_quad_add(m, &q);
    }
    v3 o = v3_add(foot[0], up), a = v3_sub(foot[1], foot[0]), b = v3_sub(foot[3], foot[0]);
    bool upward = v3_cross(a, b).y > 0.0;
    shape_quad_add(m, &(shape_quad){.o = o, .a = upward ? a : b, .b = upward ? b : a, .nu = 4, .nv = 4});
}

bool cornell_make(const char *dir, scenes_report *report) {
    static const double low[4][2] = {{130, 65}, {82, 225}, {240, 272}, {290, 114}};
    static const double tall[4][2] = {{423, 247}, {265, 296}, {314, 456}, {472, 406}};
    const double h = SIZE / 2;
    mesh m;
    mesh_init(&m);
    wall(&m, "floor", "white", v3_of(-h, 0, h), v3_of(SIZE, 0, 0), v3_of(0, 0, -SIZE));
    wall(&m, "ceiling", "white", v3_of(-h, SIZE, -h), v3_of(SIZE, 0, 0), v3_of(0, 0, SIZE));
    wall(&m, "back", "white", v3_of(-h, 0, -h), v3_of(SIZE, 0, 0), v3_of(0, SIZE, 0));
    wall(&m, "left", "red", v3_of(-h, 0, h), v3_of(0, 0, -SIZE), v3_of(0, SIZE, 0));
    wall(&m, "right", "green", v3_of(h, 0, -h), v3_of(0, 0, SIZE), v3_of(0, SIZE, 0));
    block(&m, "short_block", low, 165);
    block(&m, "tall_block", tall, 330);
    report->file = "cornell.obj";
    report->triangles = m.triangle_count;
    bool good = mesh_write(&m, dir, "cornell", materials, sizeof materials / sizeof materials[0]);
    mesh_free(&m);
    return good;
}
