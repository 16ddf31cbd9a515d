/* A wall of 0.1 m between a bright room and a dark one, and photons of 1 m radius: without more, the light of one room shines
 * into the other through the wall. With zones less than 1 % may.
 *
 * The dark room has a lamp of a thousandth of the power, so that its sides count as lit and are estimated; its own light, which
 * the same scene without the bright lamp gives, is taken away. Means are over the dark room's side of the wall and over all
 * pixels. */
#include "two_rooms.h"

#define SETTINGS "--photons 40000 --radius 1.0"
#define OLD " --zones 0 --effective-area 0"
#define NEW " --zones 1 --effective-area 1"
#define FACING_THE_WALL "fov = 60.0; eye = [3.0, 1.5, 0.0]; target = [0.05, 1.5, 0.0];"

static int set_up(void **state) {
    static scene_lab lab;
    scene_lab_open(&lab);
    FILE *f = rooms_mesh(&lab);
    rooms_box(f, (const double[]){-4.0, 0.0, -2.0}, (const double[]){-0.05, 3.0, 2.0}, 0, 0);
    rooms_box(f, (const double[]){0.05, 0.0, -2.0}, (const double[]){4.0, 3.0, 2.0}, 8, 0);
    (void)fclose(f);
    rooms_scene(&lab, "both.cfg", FACING_THE_WALL, 100.0, false);
    rooms_scene(&lab, "dim.cfg", FACING_THE_WALL, 0.0, false);
    *state = &lab;
    return 0;
}

/* Over that in the bright room, of the dark room's side of the wall and of all it. */
typedef struct leak {
    double wall, room;
} leak;

static leak measure(scene_lab *l, const char *settings) {
    static rooms_picture both, dim;
    scene_lab_indirect(l, "both.cfg", settings, both, ROOMS_FLOATS);
    scene_lab_indirect(l, "dim.cfg", settings, dim, ROOMS_FLOATS);
    const leak found = {rooms_leak(both, dim, WALL), rooms_leak(both, dim, DARK)};
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
