/* Ambient light that surfaces keep from each other, baked and progressive, against a closed form.
 *
 * A floor and a high wall: by Malley's method directions by the cosine are even over the unit disc when they are put down on
 * the floor, and those that meet the wall, at a distance x of it, within the radius R are those whose component towards it is
 * more than x / R. So the open part is 1 - (acos(u) - u sqrt(1 - u^2)) / pi with u = x / R < 1, a segment of the disc, and 1
 * beyond. The camera looks down on the floor beside the wall; where each pixel's ray meets it is computed here.
 *
 * Progressive light adds up: the path looks away after eight frames and comes back, and the first frame back must be as good as
 * the last before. Frames must have the same bits whichever were played before them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "scene_lab.h"

#include <math.h>
#include <stdlib.h>

enum { SIDE = 64, FRAMES = 14, BEFORE = 7, BACK = 12 };
#define EYE_X 1.2
#define EYE_Y 3.0
#define RADIUS 1.0
#define ALBEDO 0.5
#define PI 3.14159265358979

static const char mesh[] = "mtllib half.mtl\nusemtl half\nv -4 0 -9\nv 30 0 -9\nv 30 0 9\nv -4 0 9\n"
                           "v 0 0 -9\nv 0 0 9\nv 0 60 9\nv 0 60 -9\nf 1 4 3 2\nf 5 6 7 8\n";

static void write_scene(scene_lab *l) {
    FILE *f = scene_lab_create(l, "half.mtl");
    (void)fprintf(f, "newmtl half\nKd %g %g %g\n", ALBEDO, ALBEDO, ALBEDO);
    (void)fclose(f);
    f = scene_lab_create(l, "wall.obj");
    (void)fputs(mesh, f);
    (void)fclose(f);
    f = scene_lab_create(l, "wall.cfg");
    (void)fprintf(f,
                  "output: { width = %d; height = %d; fps = 1.0; frames = %d; };\nmeshes = ( { file = \"wall.obj\"; } );\n"
                  "ambient = [1.0, 1.0, 1.0]; ambient_radius = %g;\n"
                  "camera: { keys = ( { time = 0.0; eye = [%.3f, %.3f, 0.0]; target = [%.3f, 0.0, 0.0]; up = [0.0, 0.0, -1.0];"
                  " fov = 45.0; }, { time = %d.0; }, { time = %d.0; eye = [20.0, %.3f, 0.0]; target = [20.0, 0.0, 0.0]; },"
                  " { time = %d.0; }, { time = %d.0; eye = [%.3f, %.3f, 0.0]; target = [%.3f, 0.0, 0.0]; } ); };\n"
                  "quality: { tile = 8; };\n",
                  SIDE, SIDE, FRAMES, RADIUS, EYE_X, EYE_Y, EYE_X, BEFORE, BEFORE + 1, EYE_Y, BACK - 1, BACK, EYE_X, EYE_Y,
                  EYE_X);
    (void)fclose(f);
}

static double open_part(double x) {
    const double u = x / RADIUS;
    return u < 1 ? 1 - (acos(u) - u * sqrt(1 - u * u)) / PI : 1;
}

/* Root of the mean square of the error of a frame's pixels on the floor beside the wall, of all light. */
static double error_of(const float *frame, double *most) {
    double sum = 0;
    int count = 0;
    *most = 0;
    for (int y = 0; y < SIDE; y++)
        for (int i = 0; i < SIDE; i++) {
            const double x = EYE_X + ((i + 0.5) / SIDE * 2 - 1) * tan(PI / 8) * EYE_Y;
            if (x < 0.01) /* the wall */
                continue;
            const double error = (double)frame[4 * (y * SIDE + i)] / ALBEDO - open_part(x);
            sum += error * error;
            count++;
            *most = fmax(*most, fabs(error));
        }
    return sqrt(sum / count);
}

static float pixels[(size_t)FRAMES * SIDE * SIDE * 4];

static const float *frame_of(int frame) {
    return pixels + (size_t)frame * SIDE * SIDE * 4;
}

static void baked_it_is_what_geometry_says(void **state) {
    scene_lab *l = *state;
    double most;
    write_scene(l);
    scene_lab_bake(l, "wall.cfg", "--cache-error 0.01 --explain");
    assert_true(scene_lab_said(l, "ambient light within 1 m by a cache: ") && scene_lab_said(l, " 0 cells dropped)"));
    scene_lab_play(l, "final", pixels, sizeof pixels / sizeof *pixels);
    const double error = error_of(frame_of(0), &most);
    print_message("baked: off by %.4f, at most %.4f\n", error, most);
    assert_true(error < 0.01);
    assert_true(most < 0.05);
    assert_memory_equal(frame_of(0), frame_of(BACK), (size_t)SIDE * SIDE * 4 * sizeof(float));
}

static void a_coarser_cache_is_less_exact(void **state) {
    scene_lab *l = *state;
    double most, fine, coarse;
    write_scene(l);
    scene_lab_bake(l, "wall.cfg", "--cache-error 0.01 --cache-spacing 4");
    scene_lab_play(l, "final", pixels, sizeof pixels / sizeof *pixels);
    fine = error_of(frame_of(0), &most);
    scene_lab_bake(l, "wall.cfg", "--cache-error 0.01 --cache-spacing 32");
    scene_lab_play(l, "final", pixels, sizeof pixels / sizeof *pixels);
    coarse = error_of(frame_of(0), &most);
    assert_true(fine < 0.01 && coarse > 2 * fine && coarse < 0.1);
}

/* Squares of the error of all frames, added to those in `square`; returns the error of the first frame back over that of the
 * last before. */
static double add_squares(scene_lab *l, int spacing, double square[FRAMES]) {
    char options[96];
    double most, error[FRAMES];
    (void)snprintf(options, sizeof options, "--cache progressive --cache-error 0.005 --cache-spacing %d", spacing);
    scene_lab_bake(l, "wall.cfg", options);
    scene_lab_play(l, "final", pixels, sizeof pixels / sizeof *pixels);
    for (int i = 0; i < FRAMES; i++) {
        error[i] = error_of(frame_of(i), &most);
        square[i] += error[i] * error[i];
    }
    print_message("progressive, %d pixels: after 1, 2, 4, 8 frames off by %.4f %.4f %.4f %.4f, back %.4f\n", spacing, error[0],
                  error[1], error[3], error[BEFORE], error[BACK]);
    return error[BACK] / error[BEFORE];
}

/* The default's few dozen points are as good as chance has it, and blur is most of their error: tables of many small boxes,
 * where chance is, are looked at as well, and all together. */
static void progressive_it_gets_better_and_stays_so(void **state) {
    static const int spacings[] = {8, 2, 3, 4};
    scene_lab *l = *state;
    double square[FRAMES] = {0};
    write_scene(l);
    for (size_t i = 0; i < sizeof spacings / sizeof *spacings; i++) {
        assert_true(add_squares(l, spacings[i], square) < 1.05); /* a few rays more, and nothing is forgotten */
        if (i == 0)                                              /* the default */
            assert_true(sqrt(square[BEFORE]) < 0.025);
    }
    /* What rays leave to chance halves its square with twice the frames; what points blur stays. */
    const double after[4] = {square[0], square[1], square[3], square[BEFORE]};
    for (int i = 0; i < 3; i++)
        assert_true(after[i + 1] < 0.75 * after[i]);
    for (int i = 0; i < 2; i++)
        assert_true(after[i] - after[i + 1] > after[i + 1] - after[i + 2] && after[i + 1] > after[i + 2]);
}

static void frames_do_not_depend_on_what_was_played(void **state) {
    scene_lab *l = *state;
    char line[512];
    static const char *const ways[] = {"--frames 7:8", "--frames 12:14 --lanes 1", "--frames 3:6 --loop 2 --lanes 8"};
    write_scene(l);
    scene_lab_bake(l, "wall.cfg", "--cache progressive --cache-error 0.05");
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        (void)snprintf(line, sizeof line, "%s --verify --quiet --device host %s", scene_lab_path(l, "scene.vit"), ways[i]);
        scene_lab_run(l, "vitrine-play", line);
    }
}

/* Where all points are known as well as was asked for, no ray is sent. */
static void rays_end_where_nothing_is_left_to_find_out(void **state) {
    scene_lab *l = *state;
    char line[512];
    write_scene(l);
    scene_lab_bake(l, "wall.cfg", "--cache progressive --cache-error 0.3"); /* of 1 / 12 without any ray, 0.289: at once */
    (void)snprintf(line, sizeof line, "%s --quiet --device host --report %s", scene_lab_path(l, "scene.vit"),
                   scene_lab_path(l, "report.json"));
    scene_lab_run(l, "vitrine-play", line);
    char report[65536];
    read_into(scene_lab_path(l, "report.json"), report, sizeof report);
    const char *pass = strstr(report, "\"cache_sample\""), *next = strstr(report, "\"cache_merge\"");
    assert_true(pass && pass < next);
    const char *rays = strstr(pass, "\"shadow_rays\"");
    assert_true(!rays || rays > next); /* counts of nothing are left out */
}

/* In the first frame each of the pixels, which all show surfaces, sends a ray for a point of its own; counts of all frames do
 * not depend on how lanes are filled. */
static void each_sample_sends_a_ray_and_it_is_counted(void **state) {
    scene_lab *l = *state;
    char line[512], report[65536], counts[2][8192], wanted[64];
    write_scene(l);
    scene_lab_bake(l, "wall.cfg", "--cache progressive --cache-error 0.05");
    for (int i = 0; i < 2; i++) {
        (void)snprintf(line, sizeof line, "%s --quiet --device host --lanes %d --write-work-budget %s",
                       scene_lab_path(l, "scene.vit"), i ? 8 : 1, scene_lab_path(l, "counts"));
        scene_lab_run(l, "vitrine-play", line);
        read_into(scene_lab_path(l, "counts"), counts[i], sizeof counts[i]);
    }
    assert_string_equal(counts[0], counts[1]);
    /* Later frames send them where points are not known well enough yet: fewer and fewer. */
    const char *row = strstr(counts[0], "\ncache_sample shadow_rays ");
    unsigned long long sum = 0, most = 0;
    assert_true(row && sscanf(row, " cache_sample shadow_rays %llu %llu", &sum, &most) == 2);
    print_message("%llu rays in %d frames, %llu in one\n", sum, FRAMES, most);
    assert_true(most == SIDE * SIDE && sum < most * FRAMES / 2);
    (void)snprintf(line, sizeof line, "%s --quiet --device host --frames 0:1 --report %s", scene_lab_path(l, "scene.vit"),
                   scene_lab_path(l, "report.json"));
    scene_lab_run(l, "vitrine-play", line);
    read_into(scene_lab_path(l, "report.json"), report, sizeof report);
    const char *pass = strstr(report, "\"cache_sample\""), *rays = pass ? strstr(pass, "\"shadow_rays\"") : NULL;
    assert_non_null(rays);
    (void)snprintf(wanted, sizeof wanted, "\"shadow_rays\": {\"sum\": %d,", SIDE * SIDE);
    if (strncmp(rays, wanted, strlen(wanted)) != 0)
        fail_msg("expected %s, got %.40s", wanted, rays);
}

/* Photons are counted for their radius before there is a cache. */
static void photons_go_with_it(void **state) {
    scene_lab *l = *state;
    char line[512];
    FILE *f = scene_lab_create(l, "lit.cfg");
    (void)fprintf(f,
                  "output: { width = 16; height = 16; fps = 1.0; frames = 2; };\nmeshes = ( { file = \"wall.obj\"; } );\n"
                  "ambient = [1.0, 1.0, 1.0]; ambient_radius = %g;\n"
                  "camera: { keys = ( { eye = [1.0, 2.0, 0.0]; target = [1.0, 0.0, 0.0]; up = [0.0, 0.0, -1.0]; } ); };\n"
                  "lights = ( { type = \"point\"; keys = ( { position = [0.5, 1.0, 0.0]; power = [10.0, 10.0, 10.0]; },"
                  " { time = 1.0; position = [0.7, 1.0, 0.0]; } ); } );\n",
                  RADIUS);
    (void)fclose(f);
    write_scene(l);
    scene_lab_bake(l, "lit.cfg", "--photons 1000");
    (void)snprintf(line, sizeof line, "%s --verify --quiet --device host", scene_lab_path(l, "scene.vit"));
    scene_lab_run(l, "vitrine-play", line);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(baked_it_is_what_geometry_says),
        cmocka_unit_test(a_coarser_cache_is_less_exact),
        cmocka_unit_test(progressive_it_gets_better_and_stays_so),
        cmocka_unit_test(frames_do_not_depend_on_what_was_played),
        cmocka_unit_test(rays_end_where_nothing_is_left_to_find_out),
        cmocka_unit_test(each_sample_sends_a_ray_and_it_is_counted),
        cmocka_unit_test(photons_go_with_it),
    };
    return cmocka_run_group_tests_name("occlusion", tests, scene_lab_set_up, scene_lab_tear_down);
}
