/* A lamp a hand's breadth under the ceiling of a room, of which interpolated indirect light must know: what comes out of the
 * gap changes within its width, less than coarse samples are apart. */
#include "scene_lab.h"

enum { SIDE = 96, FLOATS = 4 * SIDE * SIDE };
#define CEILING 0.875 /* m */

static void write_scene(scene_lab *l, const char *name, double gap) {
    FILE *f = scene_lab_create(l, "lamp.mtl");
    const double y = CEILING - gap;
    (void)fprintf(f, "newmtl lamp\nKd 0.7 0.7 0.7\nKe 17 12 4\n");
    (void)fclose(f);
    f = scene_lab_create(l, "lamp.obj");
    (void)fprintf(f,
                  "mtllib lamp.mtl\nusemtl lamp\nv -0.25 %.17g -0.2\nv 0.25 %.17g -0.2\nv 0.25 %.17g 0.2\nv -0.25 %.17g 0.2\n"
                  "f 1 2 3 4\n",
                  y, y, y, y);
    (void)fclose(f);
    f = scene_lab_create(l, name);
    (void)fprintf(f,
                  "output: { width = %d; height = %d; fps = 1.0; frames = 1; };\n"
                  "meshes = ( { file = \"room.obj\"; }, { file = \"lamp.obj\"; } );\n"
                  "camera: { keys = ( { eye = [0.0, -0.2, 1.3]; target = [0.0, 0.6, 0.0]; fov = 50.0; } ); };\n"
                  "quality: { };\n",
                  SIDE, SIDE);
    (void)fclose(f);
}

/* Squared error over squared mean of what is interpolated from one sample in 16, against all samples' own. */
static double interpolated(scene_lab *l, double gap) {
    static float one[FLOATS], all[FLOATS];
    double square = 0, sum = 0;
    write_scene(l, "gap.cfg", gap);
    scene_lab_indirect(l, "gap.cfg", "--indirect-samples 1", all, FLOATS);
    scene_lab_indirect(l, "gap.cfg", "--indirect-samples 16", one, FLOATS);
    for (int i = 0; i < FLOATS; i++) {
        if (i % 4 == 3)
            continue;
        square += ((double)one[i] - (double)all[i]) * ((double)one[i] - (double)all[i]);
        sum += (double)all[i];
    }
    assert_true(sum > 0);
    return square * (3.0 * SIDE * SIDE) / (sum * sum);
}

static void light_from_a_gap_is_not_interpolated_across_it(void **state) {
    double worst = 0;
    static const double gaps[] = {0.03, 0.05, 0.1}; /* m */
    for (size_t i = 0; i < sizeof gaps / sizeof *gaps; i++) {
        const double e = interpolated(*state, gaps[i]);
        printf("gap of %g m: NMSE %g\n", gaps[i], e);
        worst = e > worst ? e : worst;
    }
    if (!(worst < 0.05))
        fail_msg("NMSE %g of indirect light", worst);
}

/* In the ceiling's very plane it comes out of it, and lights the room as from a millimetre below. */
static void a_lamp_in_its_ceilings_plane_is_no_dark_one(void **state) {
    static float light[FLOATS];
    static const double gaps[] = {0.0, 0.001}; /* m */
    double sum[2] = {0};
    for (int i = 0; i < 2; i++) {
        write_scene(*state, "plane.cfg", gaps[i]);
        scene_lab_indirect(*state, "plane.cfg", "--indirect-samples 1", light, FLOATS);
        for (int k = 0; k < FLOATS; k++)
            sum[i] += k % 4 == 3 ? 0.0 : (double)light[k];
    }
    assert_true(sum[1] > 0);
    if (!(sum[0] > 0.98 * sum[1] && sum[0] < 1.02 * sum[1]))
        fail_msg("%g of the light of a lamp a millimetre lower", sum[0] / sum[1]);
}

int main(void) {
    static const double half[3] = {1.125, CEILING, 1.375};
    static scene_lab lab;
    scene_lab_open(&lab);
    scene_lab_write_room(&lab, "room.obj", half, 0);
    const struct CMUnitTest tests[] = {cmocka_unit_test_prestate(light_from_a_gap_is_not_interpolated_across_it, &lab),
                                       cmocka_unit_test_prestate(a_lamp_in_its_ceilings_plane_is_no_dark_one, &lab)};
    const int failed = cmocka_run_group_tests_name("lamp gap", tests, NULL, NULL);
    scene_lab_close(&lab);
    return failed;
}
