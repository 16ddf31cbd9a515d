/* A wall of 0.1 m between a bright room and a dark one, and photons of 1 m radius: without more, the light of one room shines
 * into the other through the wall. With zones less than 1 % may.
 *
 * The dark room has a lamp of a thousandth of the power, so that its sides count as lit and are estimated; its own light, which
 * the same scene without the bright lamp gives, is taken away. Means are over the dark room's side of the wall and over all
 * pixels. */
#include "scene_lab.h"
#include <math.h>

#define SIDE 48                     /* pixels of a frame's edge */
enum { BRIGHT, DARK, WALL, VIEWS }; /* frames: the bright room, the dark one, the dark one's side of the wall */
#define FLOATS ((size_t)4 * SIDE * SIDE * VIEWS)
#define SETTINGS "--photons 40000 --radius 1.0"
#define OLD " --zones 0 --effective-area 0"
#define NEW " --zones 1 --effective-area 1"

typedef float picture[FLOATS];

static void quad(FILE *f, int a, int b, int c, int d) {
    (void)fprintf(f, "f %d %d %d %d\n", a, b, c, d);
}

/* A room from x0 to x1, 3 m high and 4 m deep, seen from inside. */
static void write_room(FILE *f, double x0, double x1, int first) {
    for (int i = 0; i < 8; i++)
        (void)fprintf(f, "v %g %g %g\n", i & 1 ? x1 : x0, i & 2 ? 3.0 : 0.0, i & 4 ? 2.0 : -2.0);
    static const int side[6][4] = {{1, 5, 6, 2}, {3, 4, 8, 7}, {1, 3, 7, 5}, {2, 6, 8, 4}, {1, 2, 4, 3}, {5, 7, 8, 6}};
    for (int i = 0; i < 6; i++)
        quad(f, side[i][0] + first, side[i][1] + first, side[i][2] + first, side[i][3] + first);
}

static void write_scene(scene_lab *l, const char *name, double power) {
    FILE *f = scene_lab_create(l, name);
    (void)fprintf(f,
                  "output: { width = %d; height = %d; fps = 1.0; frames = %d; };\nmeshes = ( { file = \"rooms.obj\"; } );\n"
                  "camera: { near = 0.1; keys = ("
                  "{ time = 0.0; fov = 80.0; eye = [-3.7, 1.5, 1.6]; target = [-0.05, 1.2, -0.4]; },"
                  "{ time = 1.0; fov = 80.0; eye = [3.7, 1.5, 1.6]; target = [0.05, 1.2, -0.4]; },"
                  "{ time = 2.0; fov = 60.0; eye = [3.0, 1.5, 0.0]; target = [0.05, 1.5, 0.0]; }); };\n"
                  "lights = ("
                  "{ type = \"point\"; keys = ( { position = [-2.0, 2.0, 0.3]; power = [%g, %g, %g]; } ); },"
                  "{ type = \"point\"; keys = ( { position = [2.0, 2.0, -0.3]; power = [0.1, 0.1, 0.1]; } ); });\n"
                  "quality: { bounces = 4; tile = 16; };\n",
                  SIDE, SIDE, VIEWS, power, power, power);
    (void)fclose(f);
}

static int set_up(void **state) {
    static scene_lab lab;
    scene_lab_open(&lab);
    FILE *f = scene_lab_create(&lab, "rooms.mtl");
    (void)fprintf(f, "newmtl grey\nKd 0.6 0.6 0.6\n");
    (void)fclose(f);
    f = scene_lab_create(&lab, "rooms.obj");
    (void)fprintf(f, "mtllib rooms.mtl\nusemtl grey\n");
    write_room(f, -4.0, -0.05, 0);
    write_room(f, 0.05, 4.0, 8);
    (void)fclose(f);
    write_scene(&lab, "both.cfg", 100.0);
    write_scene(&lab, "dim.cfg", 0.0);
    *state = &lab;
    return 0;
}

static double mean(const picture p, int view) {
    double sum = 0.0;
    for (size_t i = (size_t)view * SIDE * SIDE; i < (size_t)(view + 1) * SIDE * SIDE; i++)
        sum += (double)p[4 * i] + (double)p[4 * i + 1] + (double)p[4 * i + 2];
    return sum / (3.0 * SIDE * SIDE);
}

/* Light of the bright room that arrives in the dark one, over that in the bright one. */
typedef struct leak {
    double wall, room;
} leak;

static double through(const picture both, const picture dim, int view) {
    assert_true(mean(dim, view) > 0.0); /* the dark room is estimated at all */
    return fabs(mean(both, view) - mean(dim, view)) / mean(both, BRIGHT);
}

static leak measure(scene_lab *l, const char *settings) {
    static picture both, dim;
    scene_lab_indirect(l, "both.cfg", settings, both, FLOATS);
    scene_lab_indirect(l, "dim.cfg", settings, dim, FLOATS);
    assert_true(mean(both, BRIGHT) > 0.01);
    const leak found = {through(both, dim, WALL), through(both, dim, DARK)};
    print_message("  %s: wall %.4f %%, room %.4f %%\n", settings, 100.0 * found.wall, 100.0 * found.room);
    return found;
}

static void less_than_a_hundredth_gets_through_with_zones(void **state) {
    const leak l = measure(*state, SETTINGS NEW);
    assert_true(l.wall < 0.01 && l.room < 0.01);
}

static void less_than_a_hundredth_gets_into_buckets_with_zones(void **state) {
    const leak l = measure(*state, SETTINGS NEW " --estimate buckets");
    assert_true(l.wall < 0.01 && l.room < 0.01);
}

/* Or the others would show nothing. */
static void much_gets_through_without_zones(void **state) {
    assert_true(measure(*state, SETTINGS OLD).wall > 0.05);
    assert_true(measure(*state, SETTINGS OLD " --estimate buckets").wall > 0.05);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(less_than_a_hundredth_gets_through_with_zones),
        cmocka_unit_test(less_than_a_hundredth_gets_into_buckets_with_zones),
        cmocka_unit_test(much_gets_through_without_zones),
    };
    return cmocka_run_group_tests_name("thin wall", tests, set_up, scene_lab_tear_down);
}
