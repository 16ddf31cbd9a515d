/* Baked indirect light, from the scene file to the frame, against closed forms.
 *
 * Why this is hard: light must come round corners and not through walls, and neither a cell of the floor nor one that light
 * comes from may lie on both sides of a thin wall that stands on it. Strategy: two rooms that share floor and ceiling, parted
 * by a wall of 1 cm; and a closed room, where all light that a lamp gives is absorbed in the end, whatever its way. */
#include "scene_lab.h"
#include <math.h>

#define SIDE 48                     /* pixels of a frame's edge */
enum { BRIGHT, DARK, FOOT, VIEWS }; /* frames: the bright room, the dark one, floor and foot of its wall */
#define FLOATS ((size_t)4 * SIDE * SIDE * VIEWS)
#define BASIS "--indirect basis --receiver-rays 256"

typedef float picture[FLOATS];

/* A box of 8 vertices from `first` + 1 on; which of its faces to leave out, as bits. */
static void write_box(FILE *f, const double lo[3], const double hi[3], int first, unsigned without) {
    static const int face[6][4] = {{1, 5, 6, 2}, {3, 4, 8, 7}, {1, 3, 7, 5}, {2, 6, 8, 4}, {1, 2, 4, 3}, {5, 7, 8, 6}};
    for (int i = 0; i < 8; i++)
        (void)fprintf(f, "v %g %g %g\n", i & 1 ? hi[0] : lo[0], i & 2 ? hi[1] : lo[1], i & 4 ? hi[2] : lo[2]);
    for (int i = 0; i < 6; i++)
        if (!(without >> i & 1))
            (void)fprintf(f, "f %d %d %d %d\n", face[i][0] + first, face[i][1] + first, face[i][2] + first, face[i][3] + first);
}

static void write_rooms(scene_lab *l, const char *name, double power) {
    FILE *f = scene_lab_create(l, name);
    (void)fprintf(f,
                  "output: { width = %d; height = %d; fps = 1.0; frames = %d; };\nmeshes = ( { file = \"rooms.obj\"; } );\n"
                  "camera: { near = 0.1; keys = ("
                  "{ time = 0.0; fov = 80.0; eye = [-3.7, 1.5, 1.6]; target = [-0.05, 1.2, -0.4]; },"
                  "{ time = 1.0; fov = 80.0; eye = [3.7, 1.5, 1.6]; target = [0.05, 1.2, -0.4]; },"
                  "{ time = 2.0; fov = 50.0; eye = [1.6, 1.2, 0.0]; target = [0.05, 0.05, 0.0]; }); };\n"
                  "lights = ("
                  "{ type = \"point\"; keys = ( { position = [-2.0, 2.0, 0.3]; power = [%g, %g, %g]; } ); },"
                  "{ type = \"point\"; keys = ( { position = [2.0, 2.0, -0.3]; power = [0.1, 0.1, 0.1]; } ); });\n",
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
    write_box(f, (const double[]){-4.0, 0.0, -2.0}, (const double[]){4.0, 3.0, 2.0}, 0, 0);
    write_box(f, (const double[]){-0.005, 0.0, -2.0}, (const double[]){0.005, 3.0, 2.0}, 8, 3);
    (void)fclose(f);
    write_rooms(&lab, "both.cfg", 100.0);
    write_rooms(&lab, "dim.cfg", 0.0);
    *state = &lab;
    return 0;
}

static double mean(const picture p, int view) {
    double sum = 0.0;
    for (size_t i = (size_t)view * SIDE * SIDE; i < (size_t)(view + 1) * SIDE * SIDE; i++)
        sum += (double)p[4 * i] + (double)p[4 * i + 1] + (double)p[4 * i + 2];
    return sum / (3.0 * SIDE * SIDE);
}

/* The dark room has a lamp of a thousandth, so that it counts as lit; what that gives alone is taken away. */
static void nothing_to_speak_of_comes_through_a_thin_wall(void **state) {
    static picture both, dim;
    scene_lab_indirect(*state, "both.cfg", BASIS, both, FLOATS);
    scene_lab_indirect(*state, "dim.cfg", BASIS, dim, FLOATS);
    assert_true(mean(both, BRIGHT) > 0.01);
    for (int view = DARK; view < VIEWS; view++) {
        assert_true(mean(dim, view) > 0.0);
        const double leak = fabs(mean(both, view) - mean(dim, view)) / mean(both, BRIGHT);
        print_message("  view %d: %.4f %% of the bright room\n", view, 100.0 * leak);
        assert_true(leak < 0.005);
    }
}

/* A lamp whose power alone changes, and one that stays: the same light where they say the same. */
static void a_light_that_changes_gives_what_one_that_stays_gives(void **state) {
    static const char *const cfg[2] = {"{ position = [-2.0, 2.0, 0.3]; power = [100.0, 90.0, 80.0]; }",
                                       "{ time = 0.0; position = [-2.0, 2.0, 0.3]; power = [100.0, 90.0, 80.0]; },"
                                       "{ time = 2.0; position = [-2.0, 2.0, 0.3]; power = [50.0, 45.0, 40.0]; }"};
    static picture light[2];
    for (int i = 0; i < 2; i++) {
        FILE *f = scene_lab_create(*state, "change.cfg");
        (void)fprintf(f,
                      "output: { width = %d; height = %d; fps = 1.0; frames = %d; };\n"
                      "meshes = ( { file = \"rooms.obj\"; } );\ncamera: { near = 0.1; keys = ("
                      "{ fov = 80.0; eye = [-3.7, 1.5, 1.6]; target = [-0.05, 1.2, -0.4]; } ); };\n"
                      "lights = ( { type = \"point\"; keys = ( %s ); } );\n",
                      SIDE, SIDE, VIEWS, cfg[i]);
        (void)fclose(f);
        scene_lab_indirect(*state, "change.cfg", BASIS, light[i], FLOATS);
    }
    const double still = mean(light[0], 0);
    assert_true(still > 0.01);
    assert_true(fabs(mean(light[1], 0) / still - 1.0) < 2e-3);
    assert_true(fabs(mean(light[1], 2) / still - 0.5) < 2e-3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_to_speak_of_comes_through_a_thin_wall),
        cmocka_unit_test(a_light_that_changes_gives_what_one_that_stays_gives),
    };
    return cmocka_run_group_tests_name("baked light", tests, set_up, scene_lab_tear_down);
}
