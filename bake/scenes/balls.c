/* Balls on a chequered floor, in the manner of Whitted, "An improved illumination model for shaded display", CACM 23(6), 1980.
 * 4032 triangles: few large ones next to many small ones, curved silhouettes, one light. Materials are named for what they are
 * meant to be. */
#include "scenes.h"
#include "shapes.h"

#define CELLS_X 16 /* of the floor, 1 m each */
#define CELLS_Z 11

static const mesh_material materials[] = {
    {"tile_light", {0.72, 0.70, 0.64}, NULL},    {"tile_dark", {0.16, 0.17, 0.20}, NULL},
    {"mirror_silver", {0.92, 0.92, 0.92}, NULL}, {"mirror_gold", {0.90, 0.70, 0.32}, NULL},
    {"glass_clear", {0.96, 0.97, 0.97}, NULL},   {"glass_green", {0.72, 0.93, 0.78}, NULL},
    {"matt_red", {0.62, 0.08, 0.06}, NULL},      {"matt_blue", {0.09, 0.20, 0.55}, NULL},
    {"matt_yellow", {0.75, 0.58, 0.10}, NULL},   {"matt_green", {0.14, 0.44, 0.16}, NULL},
    {"matt_white", {0.78, 0.78, 0.78}, NULL},
};

/* A ball that rests on the floor. parts: of an edge of the icosahedron; 20 parts^2 triangles. */
typedef struct ball {
    const char *object, *material;
    double x, z, radius; /* metres */
    int parts;
} ball;

static const ball balls[] = {
    {"large_mirror", "mirror_silver", -1.70, -1.35, 1.30, 5}, {"large_glass", "glass_clear", 0.75, 0.90, 0.90, 5},
    {"large_red", "matt_red", 2.65, -1.70, 1.15, 5},          {"blue", "matt_blue", -3.45, 1.05, 0.70, 4},
    {"yellow", "matt_yellow", 0.55, -2.60, 0.75, 4},          {"gold", "mirror_gold", 3.15, 1.10, 0.60, 4},
    {"green_glass", "glass_green", -1.45, 1.80, 0.55, 4},     {"small_green", "matt_green", -0.45, 0.10, 0.32, 3},
    {"small_white", "matt_white", 1.75, 2.30, 0.35, 3},       {"small_mirror", "mirror_silver", -2.55, 2.75, 0.40, 3},
    {"small_glass", "glass_clear", 0.10, 2.75, 0.34, 3},      {"small_red", "matt_red", 4.35, 2.45, 0.30, 3},
};

/* Corners of the icosahedron: cyclic permutations of (0, +-1, +-g), g the golden section. Bits: signs of 1 and of g. */
static v3 corner(int which) {
    const double g = 0.5 * (1.0 + sqrt(5.0)), one = which & 1 ? 1.0 : -1.0, far = which & 2 ? g : -g;
    return which < 4 ? v3_of(0, one, far) : which < 8 ? v3_of(far, 0, one) : v3_of(one, far, 0);
}

/* A face's vertex at i parts towards c[1] and j towards c[2]. Two faces agree on their edge to the bit: the third term is 0. */
static uint32_t vertex_at(mesh *m, const ball *one, const v3 c[3], int i, int j) {
    const v3 p = v3_add(v3_scale(c[0], one->parts - i - j), v3_add(v3_scale(c[1], i), v3_scale(c[2], j))), n = v3_unit(p);
    const v3 middle = v3_of(one->x, one->radius, one->z);
    return mesh_vertex(m, (vertex){.p = v3_add(middle, v3_scale(n, one->radius)), .n = n});
}

static void face(mesh *m, const ball *one, const v3 c[3]) {
    for (int i = 0; i < one->parts; i++)
        for (int j = 0; i + j < one->parts; j++) {
            const uint32_t b = vertex_at(m, one, c, i + 1, j), d = vertex_at(m, one, c, i, j + 1);
            mesh_triangle(m, vertex_at(m, one, c, i, j), b, d);
            if (i + j + 1 < one->parts)
                mesh_triangle(m, b, vertex_at(m, one, c, i + 1, j + 1), d);
        }
}

/* Faces are the triples of corners at edge length 2 of each other. */
static void ball_add(mesh *m, const ball *one) {
    const double near = 4.5; /* squared edges are 4, the next larger distance is 4 g^2 = 10.5 */
    mesh_group_begin(m, one->object, one->material);
    for (int a = 0; a < 12; a++)
        for (int b = a + 1; b < 12; b++)
            for (int c = b + 1; c < 12; c++) {
                const v3 v[3] = {corner(a), corner(b), corner(c)};
                const v3 ab = v3_sub(v[1], v[0]), bc = v3_sub(v[2], v[1]), ca = v3_sub(v[0], v[2]);
                if (v3_dot(ab, ab) < near && v3_dot(bc, bc) < near && v3_dot(ca, ca) < near)
                    face(m, one, v);
            }
}

/* The tiles of one colour. */
static void floor_add(mesh *m, const char *object, const char *material, int colour) {
    mesh_group_begin(m, object, material);
    for (int i = 0; i < CELLS_X; i++)
        for (int k = 0; k < CELLS_Z; k++)
            if (((i + k) & 1) == colour)
                shape_quad_add(m,
                               &(shape_quad){.o = {i - 0.5 * CELLS_X, 0, 0.5 * CELLS_Z - k}, .a = {1, 0, 0}, .b = {0, 0, -1}});
}

bool balls_make(const char *dir, scenes_report *report) {
    mesh m;
    mesh_init(&m);
    floor_add(&m, "floor_light", "tile_light", 0);
    floor_add(&m, "floor_dark", "tile_dark", 1);
    for (size_t i = 0; i < sizeof balls / sizeof balls[0]; i++)
        ball_add(&m, balls + i);
    report->file = "balls.obj";
    report->triangles = m.triangle_count;
    bool good = mesh_write(&m, dir, "balls", materials, sizeof materials / sizeof materials[0]);
    mesh_free(&m);
    return good;
}
