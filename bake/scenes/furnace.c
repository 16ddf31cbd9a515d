/* A closed cube of 2 m, albedo 0.5 everywhere: each bounce must keep exactly half of the power, and none can leave. */
#include "scenes.h"
#include "shapes.h"

static const mesh_material materials[] = {{"half", {0.5, 0.5, 0.5}, NULL}};

bool furnace_make(const char *dir, scenes_report *report) {
    const v3 x = {2, 0, 0}, y = {0, 2, 0}, z = {0, 0, 2};
    mesh m;
    mesh_init(&m);
    mesh_group_begin(&m, "furnace", "half");
    const shape_quad sides[6] = {
        {.o = {-1, -1, -1}, .a = z, .b = x}, {.o = {-1, 1, -1}, .a = x, .b = z},  {.o = {-1, -1, -1}, .a = x, .b = y},
        {.o = {-1, -1, 1}, .a = y, .b = x},  {.o = {-1, -1, -1}, .a = y, .b = z}, {.o = {1, -1, -1}, .a = z, .b = y},
    };
    for (int i = 0; i < 6; i++) {
        shape_quad q = sides[i];
        q.nu = q.nv = 4;
        shape_quad_add(&m, &q);
    }
    report->file = "furnace.obj";
    report->triangles = m.triangle_count;
    bool good = mesh_write(&m, dir, "furnace", materials, 1);
    mesh_free(&m);
    return good;
}
