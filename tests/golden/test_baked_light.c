/* Baked indirect light, from the scene file to the frame, against closed forms.
 *
 * Why this is hard: light must come round corners and not through walls, and neither a cell of the floor nor one that light
 * comes from may lie on both sides of a thin wall that stands on it. Strategy: two rooms that share floor and ceiling, parted
 * by a wall of 1 cm; and a closed room, where all light that a lamp gives is absorbed in the end, whatever its way. */
#include "two_rooms.h"

#define BASIS "--indirect basis --receiver-rays 256"
#define LIVE "--indirect radiosity --receiver-rays 256"
#define AT_ITS_FOOT "fov = 50.0; eye = [1.6, 1.2, 0.0]; target = [0.05, 0.05, 0.0];"

static int set_up(void **state) {
    static scene_lab lab;
    scene_lab_open(&lab);
    FILE *f = rooms_mesh(&lab);
    rooms_box(f, (const double[]){-4.0, 0.0, -2.0}, (const double[]){4.0, 3.0, 2.0}, 0, 0);
    rooms_box(f, (const double[]){-0.005, 0.0, -2.0}, (const double[]){0.005, 3.0, 2.0}, 8, 3);
    (void)fclose(f);
    rooms_scene(&lab, "both.cfg", AT_ITS_FOOT, 100.0, false);
    rooms_scene(&lab, "dim.cfg", AT_ITS_FOOT, 0.0, false);
    rooms_scene(&lab, "both_live.cfg", AT_ITS_FOOT, 100.0, true);
    rooms_scene(&lab, "dim_live.cfg", AT_ITS_FOOT, 0.0, true);
    *state = &lab;
    return 0;
}

static void assert_no_leak(scene_lab *l, const char *with, const char *without, const char *options) {
    static rooms_picture both, dim;
    scene_lab_indirect(l, with, options, both, ROOMS_FLOATS);
    scene_lab_indirect(l, without, options, dim, ROOMS_FLOATS);
    for (int view = DARK; view < ROOMS_VIEWS; view++) {
        const double leak = rooms_leak(both, dim, view);
        print_message("  view %d: %.4f %% of the bright room\n", view, 100.0 * leak);
        assert_true(leak < 0.005);
    }
}

static void nothing_to_speak_of_comes_through_a_thin_wall(void **state) {
    assert_no_leak(*state, "both.cfg", "dim.cfg", BASIS);
}

static void nor_does_light_between_patches(void **state) {
    assert_no_leak(*state, "both_live.cfg", "dim_live.cfg", LIVE);
}

/* A lamp whose power alone changes, and one that stays: the same light where they say the same. */
static void a_light_that_changes_gives_what_one_that_stays_gives(void **state) {
    static const char *const cfg[2] = {"{ position = [-2.0, 2.0, 0.3]; power = [100.0, 90.0, 80.0]; }",
                                       "{ time = 0.0; position = [-2.0, 2.0, 0.3]; power = [100.0, 90.0, 80.0]; },"
                                       "{ time = 2.0; position = [-2.0, 2.0, 0.3]; power = [50.0, 45.0, 40.0]; }"};
    static rooms_picture light[2], live;
    for (int i = 0; i < 2; i++) {
        FILE *f = scene_lab_create(*state, "change.cfg");
        (void)fprintf(f,
                      "output: { width = %d; height = %d; fps = 1.0; frames = %d; };\n"
                      "meshes = ( { file = \"rooms.obj\"; } );\ncamera: { near = 0.1; keys = ("
                      "{ fov = 80.0; eye = [-3.7, 1.5, 1.6]; target = [-0.05, 1.2, -0.4]; } ); };\n"
                      "lights = ( { type = \"point\"; keys = ( %s ); } );\n",
                      ROOMS_SIDE, ROOMS_SIDE, ROOMS_VIEWS, cfg[i]);
        (void)fclose(f);
        scene_lab_indirect(*state, "change.cfg", BASIS, light[i], ROOMS_FLOATS);
        if (i == 1)
            scene_lab_indirect(*state, "change.cfg", LIVE, live, ROOMS_FLOATS);
    }
    const double still = rooms_mean(light[0], 0);
    assert_true(still > 0.01);
    assert_true(fabs(rooms_mean(light[1], 0) / still - 1.0) < 2e-3);
    assert_true(fabs(rooms_mean(light[1], 2) / still - 0.5) < 2e-3);
    print_message("  live: %.4f and %.4f of it\n", rooms_mean(live, 0) / still, rooms_mean(live, 2) / still);
    assert_true(fabs(rooms_mean(live, 0) / still - 1.0) < 0.02);
    assert_true(fabs(rooms_mean(live, 2) / rooms_mean(live, 0) - 0.5) < 1e-4); /* linear in the light */
}

/* A lamp that is moved past a wall, 12 cm off it: much of what is round about comes from a spot smaller than patches are.
 * Against receivers close by each other by many rays: by 64 rays theirs may be off by 3 % themselves. */
static void a_lamp_close_to_a_wall_lights_what_is_round_about(void **state) {
    static rooms_picture light, live;
    FILE *f = scene_lab_create(*state, "close.cfg");
    (void)fprintf(f,
                  "output: { width = %d; height = %d; fps = 1.0; frames = %d; };\nmeshes = ( { file = \"rooms.obj\"; } );\n"
                  "camera: { near = 0.1; keys = ( { fov = 80.0; eye = [-0.3, 1.5, 1.6]; target = [-4.0, 1.2, -0.4]; } ); };\n"
                  "lights = ( { type = \"point\"; keys = ( { position = [-3.88, 1.2, -1.0]; power = [100.0, 90.0, 80.0]; },"
                  "{ time = 2.0; position = [-3.88, 1.8, 0.6]; } ); } );\n",
                  ROOMS_SIDE, ROOMS_SIDE, ROOMS_VIEWS);
    (void)fclose(f);
    scene_lab_indirect(*state, "close.cfg", "--indirect basis --receiver-rays 2048 --receiver-spacing 6", light, ROOMS_FLOATS);
    scene_lab_indirect(*state, "close.cfg", "--indirect radiosity --receiver-rays 256 --patches 512", live, ROOMS_FLOATS);
    for (int view = 0; view < ROOMS_VIEWS; view++)
        print_message("  view %d: %.4f\n", view, rooms_mean(live, view) / rooms_mean(light, view));
    for (int view = 0; view < ROOMS_VIEWS; view++)
        assert_true(fabs(rooms_mean(live, view) / rooms_mean(light, view) - 1.0) < 0.05);
}

/* A yellow room behind a white wall: of a lamp that moves a tenth of what comes round the wall is blue, and as squares, by
 * which the compression goes, a hundredth. Against the same light without a loss that counts: the flux of each channel and
 * frame, and how far pixels are off, over their mean. Were channels not weighted, these would be 2 and 6 %. */
static void a_moving_light_keeps_its_colour(void **state) {
    static rooms_picture by_default, whole;
    scene_lab *l = *state;
    FILE *f = scene_lab_create(l, "tint.mtl");
    (void)fprintf(f, "newmtl yellow\nKd 0.8 0.7 0.15\nnewmtl white\nKd 0.7 0.7 0.7\n");
    (void)fclose(f);
    f = scene_lab_create(l, "tint.obj");
    (void)fprintf(f, "mtllib tint.mtl\nusemtl yellow\n");
    rooms_box(f, (const double[]){-4.0, 0.0, -2.0}, (const double[]){4.0, 3.0, 2.0}, 0, 0);
    (void)fprintf(f, "usemtl white\n");
    rooms_box(f, (const double[]){-0.05, 0.0, -2.0}, (const double[]){0.05, 3.0, 1.0}, 8, 3);
    (void)fclose(f);
    f = scene_lab_create(l, "tint.cfg");
    (void)fprintf(f,
                  "output: { width = %d; height = %d; fps = 1.0; frames = %d; };\nmeshes = ( { file = \"tint.obj\"; } );\n"
                  "camera: { near = 0.1; keys = ( { fov = 80.0; eye = [3.7, 1.5, 1.6]; target = [0.05, 1.2, -0.4]; } ); };\n"
                  "lights = ( { type = \"point\"; keys = ( { position = [-2.0, 2.0, 0.3]; power = [100.0, 90.0, 80.0]; },"
                  "{ time = 2.0; position = [-1.0, 2.0, -1.3]; } ); } );\n",
                  ROOMS_SIDE, ROOMS_SIDE, ROOMS_VIEWS);
    (void)fclose(f);
    scene_lab_indirect(l, "tint.cfg", "--indirect basis --receiver-rays 64", by_default, ROOMS_FLOATS);
    scene_lab_indirect(l, "tint.cfg", "--indirect basis --receiver-rays 64 --basis-error 0", whole, ROOMS_FLOATS);
    for (size_t view = 0; view < ROOMS_VIEWS; view++)
        for (size_t c = 0; c < 3; c++) {
            const size_t pixels = (size_t)ROOMS_SIDE * ROOMS_SIDE;
            double sum = 0.0, right = 0.0, off = 0.0;
            for (size_t i = view * pixels; i < (view + 1) * pixels; i++) {
                sum += (double)by_default[4 * i + c];
                right += (double)whole[4 * i + c];
                off += fabs((double)by_default[4 * i + c] - (double)whole[4 * i + c]);
            }
            print_message("  frame %zu, channel %zu: flux %.4f, off by %.4f\n", view, c, sum / right, off / right);
            assert_true(right > 0.0);
            assert_true(fabs(sum / right - 1.0) < 0.01);
            assert_true(off / right < 0.03);
        }
}

/* Two rooms of our own that a wall parts, with a slit in it `wide` metres wide. */
static void write_slit(scene_lab *l, double wide) {
    FILE *f = rooms_mesh(l);
    rooms_box(f, (const double[]){-4.0, 0.0, -2.0}, (const double[]){0.0, 3.0, 2.0}, 0, 1u << 3);
    rooms_box(f, (const double[]){0.0, 0.0, -2.0}, (const double[]){4.0, 3.0, 2.0}, 8, 1u << 2);
    rooms_box(f, (const double[]){-0.05, 0.0, -2.0}, (const double[]){0.05, 3.0, 0.0}, 16, 3);
    rooms_box(f, (const double[]){-0.05, 0.0, wide}, (const double[]){0.05, 3.0, 2.0}, 24, 3);
    (void)fclose(f);
    f = scene_lab_create(l, "slit.cfg");
    (void)fprintf(
        f,
        "output: { width = %d; height = %d; fps = 1.0; frames = 1; };\nmeshes = ( { file = \"rooms.obj\"; } );\n"
        "camera: { near = 0.1; keys = ( { fov = 80.0; eye = [3.7, 1.5, 1.6]; target = [0.05, 1.2, -0.4]; } ); };\n"
        "lights = ( { type = \"point\"; keys = ( { position = [-2.0, 2.0, 1.3]; power = [100.0, 90.0, 80.0]; } ); } );\n",
        ROOMS_SIDE, ROOMS_SIDE);
    (void)fclose(f);
}

/* Where light gets into the room that is seen by a slit, few of 128 rays find it, and there are more of them; where it gets in
 * by a wide opening, there are not. */
static void light_by_a_slit_is_looked_for_with_more_rays(void **state) {
    static const double wide[2] = {0.02, 1.5};
    for (int i = 0; i < 2; i++) {
        char line[1024];
        write_slit(*state, wide[i]);
        (void)snprintf(line, sizeof line, "%s -o %s --no-check --device host --indirect basis --receiver-rays 128",
                       scene_lab_path(*state, "slit.cfg"), scene_lab_path(*state, "slit.vit"));
        scene_lab_run(*state, "vitrine-bake", line);
        assert_int_equal(i == 0, scene_lab_said(*state, "light gets about by small gaps: 512 rays of each receiver, not "
                                                        "receiver_rays = 128"));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_to_speak_of_comes_through_a_thin_wall),
        cmocka_unit_test(nor_does_light_between_patches),
        cmocka_unit_test(a_light_that_changes_gives_what_one_that_stays_gives),
        cmocka_unit_test(a_lamp_close_to_a_wall_lights_what_is_round_about),
        cmocka_unit_test(a_moving_light_keeps_its_colour),
        cmocka_unit_test(light_by_a_slit_is_looked_for_with_more_rays),
    };
    return cmocka_run_group_tests_name("baked light", tests, set_up, scene_lab_tear_down);
}
