/* Light of an even sky where it is known in closed form: on a step, whose wall hides part of the sky from the ground below.
 *
 * Why this is hard: a sample looks into few directions, so a fair picture needs its neighbours' too, but not across edges.
 * Strategy: each pixel's radiance is known, both next to edges of depth and of normals (the ground at the wall's foot has half
 * the light of the top beside it in the picture) and away from them, where the directions' pattern would show; no pixel may be
 * far off. */
#include "scene_lab.h"
#include <math.h>

enum { WIDTH = 72, HEIGHT = 56, WAY = 60 };

static const double pi = 3.14159265358979323846, step = 1.0, albedo = 0.5;
static const double eye[3] = {1.2, 6.0, 0.0}, fov = 0.7; /* looks straight down, the top of the picture to -z */

static void write_scene(scene_lab *l, const char *quality) {
    FILE *f = scene_lab_create(l, "step.mtl");
    (void)fprintf(f, "newmtl grey\nKd %g %g %g\n", albedo, albedo, albedo);
    (void)fclose(f);
    f = scene_lab_create(l, "step.obj");
    (void)fputs("mtllib step.mtl\nusemtl grey\n", f);
    static const double x[4] = {-WAY, 0, 0, WAY};
    for (int i = 0; i < 4; i++)
        for (int end = -WAY; end <= WAY; end += 2 * WAY)
            (void)fprintf(f, "v %g %g %d\n", x[i], i < 2 ? step : 0, end);
    (void)fputs("f 1 2 4 3\nf 3 4 6 5\nf 5 6 8 7\n", f);
    (void)fclose(f);
    f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(f,
                  "output: { width = %d; height = %d; frames = 1; };\nbackground = [1.0, 1.0, 1.0];\nsky: { light = true; };\n"
                  "meshes = ( { file = \"step.obj\"; } );\n"
                  "camera: { keys = ( { eye = (%g, %g, 0); target = (%g, 0, 0); up = [0.0, 0.0, -1.0]; fov = %.12f; } ); };\n"
                  "quality: { photons = 0; %s };\n",
                  WIDTH, HEIGHT, eye[0], eye[1], eye[0], fov * 180 / pi, quality);
    (void)fclose(f);
}

/* Radiance at a point of the frame, in pixels. A wall of height h, without end, hides (1 - d / sqrt(d2 + h2)) / 2 of the sky's
 * light from the ground at distance d; the ground hides half of it from the wall. */
static double right(double px) {
    const double slope = (2 * px / WIDTH - 1) * tan(fov / 2) * WIDTH / HEIGHT;
    const double top = eye[0] + slope * (eye[1] - step), ground = eye[0] + slope * eye[1];
    if (top < 0)
        return albedo;
    if (ground < 0)
        return albedo / 2;
    return albedo * (1 + ground / sqrt(ground * ground + step * step)) / 2;
}

/* Of 16 classes of pixels, by their places in 4 x 4, mean relative errors: how far these are apart. */
typedef struct classes {
    double sum[16], count[16];
} classes;

static double pattern_of(const classes *c) {
    double least = INFINITY, most = -INFINITY;
    for (int i = 0; i < 16; i++) {
        least = fmin(least, c->sum[i] / c->count[i]);
        most = fmax(most, c->sum[i] / c->count[i]);
    }
    return most - least;
}

/* Worst relative error over pixels that lie `clear` pixels away from edges, or on edges and all, the mean square one, and how
 * much of a pattern of 4 x 4 pixels there is. */
static void check(void **state, const char *quality, double most, double most_nmse, double most_pattern) {
    static float pixels[WIDTH * HEIGHT * 4];
    write_scene(*state, quality);
    scene_lab_bake(*state, "scene.cfg", "");
    scene_lab_play(*state, "direct", pixels, WIDTH * HEIGHT * 4);
    double worst = 0, squares = 0, sum = 0;
    classes pattern = {{0}, {0}};
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double value = right(x + 0.5), got = (double)pixels[(y * WIDTH + x) * 4];
            const bool edge = fabs(right(x) - right(x + 1)) > 0.03; /* a pixel is its centre, or its mean with samples */
            worst = fabs(got / value - 1) > worst && !edge ? fabs(got / value - 1) : worst;
            pattern.sum[y % 4 * 4 + x % 4] += edge ? 0 : got / value - 1;
            pattern.count[y % 4 * 4 + x % 4] += edge ? 0 : 1;
            squares += edge ? 0 : (got / value - 1) * (got / value - 1);
            sum += edge ? 0 : 1;
        }
    print_message("worst pixel %.4f, NMSE %.6f, pattern %.5f\n", worst, squares / sum, pattern_of(&pattern));
    assert_true(sum > 0.9 * WIDTH * HEIGHT);
    assert_true(worst < most);
    assert_true(squares / sum < most_nmse);
    assert_true(pattern_of(&pattern) < most_pattern);
}

#define BY_RAYS "lightmap = \"rays\"; "

static void no_pattern_of_directions_shows_and_no_light_crosses_an_edge(void **state) {
    check(state, BY_RAYS, 0.1, 1e-3, 0.02);
}

static void so_it_is_with_several_samples_a_pixel(void **state) {
    check(state, BY_RAYS "antialias = 4;", 0.15, 1e-3, 0.02);
}

static void so_it_is_with_few_directions(void **state) {
    check(state, BY_RAYS "sky_samples = 4;", 0.2, 4e-3, 0.02);
}

static void baked_it_is_closer_still(void **state) {
    check(state, "lightmap = \"baked\";", 0.05, 1e-4, 0.002);
}

static void so_it_is_baked_with_several_samples_a_pixel(void **state) {
    check(state, "lightmap = \"baked\"; antialias = 4;", 0.05, 1e-4, 0.002);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_pattern_of_directions_shows_and_no_light_crosses_an_edge),
        cmocka_unit_test(so_it_is_with_several_samples_a_pixel),
        cmocka_unit_test(so_it_is_with_few_directions),
        cmocka_unit_test(baked_it_is_closer_still),
        cmocka_unit_test(so_it_is_baked_with_several_samples_a_pixel),
    };
    return cmocka_run_group_tests(tests, scene_lab_set_up, scene_lab_tear_down);
}
