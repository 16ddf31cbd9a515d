/* Direct light where shadow rays start in delicate places: in the corner of two walls, and on triangles whose normals are bent.
 *
 * Why this is hard: a view ray that meets the very edge of two walls starts its shadow rays in both of them, and which way
 * rounding falls decides whether the pixel is black; and a light that is behind a triangle, though before its bent normal,
 * sends its light past the triangle's edge onto the wrong side. Pictures look right but for a line one pixel wide, or some
 * thousandths too much light. Strategy: corners of several angles at several places and sizes, seen straight along their
 * bisector so that a column of pixels shows the edge alone, and a sheet with bent normals; right values in closed form, in
 * double. */
#include "scene_lab.h"
#include <math.h>
#include <stdint.h>

#define PI 3.14159265358979323846

enum { WIDTH = 33, HEIGHT = 17 }; /* odd, so that a column and a row of pixels go through the middle */

#define FOV 60.0
#define POWER 30.0 /* W */
#define WHITE 0.5  /* reflectance */

static float pixels[WIDTH * HEIGHT * 4];

static void write_materials(scene_lab *l) {
    FILE *f = scene_lab_create(l, "matt.mtl");
    (void)fprintf(f, "newmtl matt\nKd %g %g %g\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n", WHITE, WHITE, WHITE);
    (void)fclose(f);
}

static void write_scene(scene_lab *l, const double eye[3], const double target[3], double fov, const double *light,
                        const char *quality) {
    FILE *f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(f,
                  "output: { width = %d; height = %d; frames = 1; };\nmeshes = ( { file = \"model.obj\"; } );\n"
                  "camera: { keys = ( { eye = [%.12f, %.12f, %.12f]; target = [%.12f, %.12f, %.12f]; fov = %.9f; } ); };\n",
                  WIDTH, HEIGHT, eye[0], eye[1], eye[2], target[0], target[1], target[2], fov);
    if (light)
        (void)fprintf(f,
                      "lights = ( { type = \"point\"; keys = ( { position = [%.12f, %.12f, %.12f]; power = [%.3f, %.3f, %.3f]; "
                      "} ); } );\n",
                      light[0], light[1], light[2], POWER, POWER, POWER);
    (void)fprintf(f, "quality: { photons = 0; %s };\n", quality);
    (void)fclose(f);
}

static void play(scene_lab *l) {
    scene_lab_bake(l, "scene.cfg", "--no-check");
    scene_lab_play(l, "direct", pixels, WIDTH * HEIGHT * 4);
}

/* Radiance of a matt place whose unit normal's cosine with the way to the light is `along` over that way's length. */
static double radiance(const double to[3], const double n[3]) {
    const double d2 = to[0] * to[0] + to[1] * to[1] + to[2] * to[2],
                 cosine = (to[0] * n[0] + to[1] * n[1] + to[2] * n[2]) / sqrt(d2);
    return WHITE / PI * POWER / (4 * PI) / d2 * fmax(cosine, 0);
}

/* ---- corners ---- */

/* Two walls of `size` metres that meet at an angle along a vertical edge through `at`; the bisector goes in direction `turn`.
 */
typedef struct corner {
    double angle, turn, size, at[3]; /* radians, radians, metres, metres */
} corner;

static void write_corner(scene_lab *l, const corner *c) {
    FILE *f = scene_lab_create(l, "model.obj");
    (void)fputs("mtllib matt.mtl\nusemtl matt\n", f);
    for (int wall = -1; wall <= 1; wall++) /* the edge is the middle pair of vertices */
        for (int up = -1; up <= 1; up += 2) {
            const double way = c->turn + wall * c->angle / 2, far = wall ? c->size : 0;
            (void)fprintf(f, "v %.17g %.17g %.17g\n", c->at[0] + far * cos(way), c->at[1] + up * c->size,
                          c->at[2] + far * sin(way));
        }
    (void)fputs("f 1 2 4 3\nf 3 4 6 5\n", f);
    (void)fclose(f);
}

/* Pixels of the edge that show neither wall's light, which must be none. */
static int dark_pixels(scene_lab *l, const corner *c) {
    const double way = 0.6 * c->size, eye[3] = {c->at[0] + way * cos(c->turn), c->at[1], c->at[2] + way * sin(c->turn)};
    const double aside = c->turn + 0.3 * c->angle, off = 0.5 * c->size;
    const double light[3] = {c->at[0] + off * cos(aside), c->at[1] + 0.1 * c->size, c->at[2] + off * sin(aside)};
    write_corner(l, c);
    write_scene(l, eye, c->at, FOV, light, "");
    play(l);
    int wrong = 0;
    for (int y = 0; y < HEIGHT; y++) {
        const double up = (1 - 2 * (y + 0.5) / HEIGHT) * tan(FOV / 360 * PI) * way;
        const double to[3] = {light[0] - c->at[0], light[1] - c->at[1] - up, light[2] - c->at[2]};
        const double got = (double)pixels[(y * WIDTH + WIDTH / 2) * 4];
        double off_by = 1;
        for (int wall = -1; wall <= 1; wall += 2) { /* normals: each wall's direction, turned towards the other */
            const double turn = c->turn + wall * (c->angle / 2 - PI / 2), n[3] = {cos(turn), 0, sin(turn)};
            off_by = fmin(off_by, fabs(got / radiance(to, n) - 1));
        }
        wrong += off_by > 0.01;
    }
    return wrong;
}

static void the_edge_of_two_walls_is_lit_as_one_of_them(void **state) {
    static const double angles[] = {40, 60, 90, 110};
    uint32_t random = 3;
    write_materials(*state);
    for (int i = 0; i < 24; i++) {
        corner c = {.angle = angles[i % 4] * PI / 180};
        double unit[5];
        for (int k = 0; k < 5; k++) {
            random = random * 1664525u + 1013904223u;
            unit[k] = (random >> 8) * 0x1p-24;
        }
        c.turn = i < 8 ? PI / 4 + i / 4 * PI / 2 : 2 * PI * unit[0];
        c.size = 0.2 + 5 * unit[1];
        for (int k = 0; k < 3; k++)
            c.at[k] = 6 * unit[2 + k] - 3;
        const int dark = dark_pixels(*state, &c);
        if (dark)
            fail_msg("corner %d of %.0f degrees, turned by %.3f: %d of %d pixels are wrong", i, angles[i % 4], c.turn, dark,
                     HEIGHT);
    }
}

/* ---- bent normals ---- */

#define BENT (60 * PI / 180) /* of the sheet's normals, towards +x */

/* A sheet of 2 x 2 metres in y = 0, and what else is given. */
static void write_sheet(scene_lab *l, const char *rest) {
    FILE *f = scene_lab_create(l, "model.obj");
    (void)fprintf(
        f, "mtllib matt.mtl\nv -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nvn %.9f %.9f 0\nusemtl matt\nf 1//1 2//1 3//1 4//1\n%s",
        sin(BENT), cos(BENT), rest);
    (void)fclose(f);
}

static double sum_of_pixels(void) {
    double sum = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        sum += (double)pixels[4 * i];
    return sum;
}

/* Straight before the bent normal, and behind the sheet: by so little that shadow rays clear the sheet's edge. */
static void light_from_behind_a_triangle_does_not_come_to_its_front(void **state) {
    static const double eye[3] = {-0.5, 2, 0}, middle[3] = {0}, below[2] = {1e-5, 1e-3};
    write_materials(*state);
    write_sheet(*state, "");
    for (int i = 0; i < 2; i++) {
        write_scene(*state, eye, middle, 30, (const double[]){5, -below[i], 0}, "");
        play(*state);
        assert_true(sum_of_pixels() == 0);
    }
    write_sheet(*state, "v 5 -1 -1\nv 5 -1 1\nv 5 -0.00001 1\nv 5 -0.00001 -1\nusemtl lamp\nf 5 6 7 8\n");
    write_scene(*state, eye, middle, 30, NULL, "light_samples = 64;");
    play(*state);
    assert_true(sum_of_pixels() == 0);
}

/* The eye is behind the bent normal, and before the sheet. */
static void light_does_not_depend_on_where_a_bent_normal_is_seen_from(void **state) {
    static const double middle[3] = {0}, eyes[2][3] = {{-3, 1, 0}, {3, 1, 0}}, light[3] = {2, 1, 0},
                        n[3] = {0.86602540378443865, 0.5, 0};
    write_materials(*state);
    write_sheet(*state, "");
    for (int i = 0; i < 2; i++) {
        write_scene(*state, eyes[i], middle, 20, light, "");
        play(*state);
        const double got = (double)pixels[(HEIGHT / 2 * WIDTH + WIDTH / 2) * 4];
        assert_true(fabs(got / radiance(light, n) - 1) < 0.003);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_edge_of_two_walls_is_lit_as_one_of_them),
        cmocka_unit_test(light_from_behind_a_triangle_does_not_come_to_its_front),
        cmocka_unit_test(light_does_not_depend_on_where_a_bent_normal_is_seen_from),
    };
    return cmocka_run_group_tests(tests, scene_lab_set_up, scene_lab_tear_down);
}
