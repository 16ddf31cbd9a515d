/* Light of surfaces and of the sky at view samples, against closed forms.
 *
 * What can go wrong: points on a lamp stand for too much or too little of it, crowd, or are shadowed by the lamp itself; the
 * sky gives the wrong share. A rectangle's irradiance on a point is known (Lambert 1760: half of the radiance times the sum
 * over its edges of the angle that the edge subtends times the cosine between the surface's normal and that of the plane
 * through point and edge); an open plane under an even sky of radiance L gets pi L. Errors of single pixels are those of a sum
 * over so many points, and must fall with their number; means over the picture are means over VIT_PATTERNS times as many. */
#include "catalogue.h"
#include "scene_lab.h"
#include <math.h>

#define PI 3.14159265358979
#define ALBEDO (818.0 * 818.0 / 1023.0 / 1023.0) /* as view samples hold it */
#define HEIGHT 1.0                               /* of the lamp, m */
enum { SIDE = 64, FLOATS = 4 * SIDE * SIDE };

static const double half[2] = {0.4, 0.25}; /* of the lamp, m */

static void write_lamp(scene_lab *l, const char *name, double height) {
    FILE *f = scene_lab_create(l, name);
    (void)fprintf(f,
                  "mtllib soft.mtl\nv -9 0 -9\nv 9 0 -9\nv 9 0 9\nv -9 0 9\nv %g %g %g\nv %g %g %g\nv %g %g %g\nv %g %g %g\n"
                  "usemtl floor\nf 4 3 2 1\nusemtl lamp\nf 5 6 7 8\n",
                  -half[0], height, -half[1], half[0], height, -half[1], half[0], height, half[1], -half[0], height, half[1]);
    (void)fclose(f);
}

static void write_scenes(scene_lab *l) {
    FILE *f = scene_lab_create(l, "soft.mtl");
    (void)fprintf(f, "newmtl floor\nKd %g %g %g\nnewmtl lamp\nKd 0 0 0\nKe 5 5 5\n", ALBEDO, ALBEDO, ALBEDO);
    (void)fclose(f);
    write_lamp(l, "lamp.obj", HEIGHT);
    f = scene_lab_create(l, "plane.obj");
    (void)fprintf(f, "mtllib soft.mtl\nv -9 0 -9\nv 9 0 -9\nv 9 0 9\nv -9 0 9\nusemtl floor\nf 4 3 2 1\n");
    (void)fclose(f);
}

/* From just under the lamp, 90 degrees down: a pixel's edge is 2 * 0.9 / SIDE on the floor. */
static void render_by(scene_lab *l, const char *lightmap, const char *mesh, const char *more, int samples, float *pixels) {
    FILE *f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(
        f,
        "output: { width = %d; height = %d; fps = 1.0; frames = 1; };\nmeshes = ( { file = \"%s\"; } );\n%s\n"
        "camera: { near = 0.1; keys = ( { fov = 90.0; eye = [0.0, 0.9, 0.0]; target = [0.0, 0.0, 0.0]; up = [0.0, 0.0, "
        "-1.0]; } ); };\nquality: { photons = 0; lightmap = \"%s\"; light_samples = %d; sky_samples = %d; };\n",
        SIDE, SIDE, mesh, more, lightmap, samples, samples);
    (void)fclose(f);
    scene_lab_bake(l, "scene.cfg", "");
    scene_lab_play(l, "direct", pixels, FLOATS);
}

static void render(scene_lab *l, const char *mesh, const char *more, int samples, float *pixels) {
    render_by(l, "rays", mesh, more, samples, pixels);
}

/* Irradiance of the lamp at that height, of radiance 1, at (x, 0, z) facing up. */
static double lamp_irradiance(double height, double x, double z) {
    static const int sign[4][2] = {{-1, -1}, {-1, 1}, {1, 1}, {1, -1}};
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        const int *a = sign[i], *b = sign[(i + 1) % 4];
        const double p[3] = {a[0] * half[0] - x, height, a[1] * half[1] - z},
                     q[3] = {b[0] * half[0] - x, height, b[1] * half[1] - z};
        const double n[3] = {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
        const double across = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), along = p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        sum += atan2(across, along) * n[1] / across;
    }
    return 0.5 * fabs(sum);
}

static double place(int pixel) {
    return 0.9 * ((2 * pixel + 1.0) / SIDE - 1);
}

typedef struct errors {
    double rms, mean; /* relative: of pixels, and of their mean */
} errors;

static errors lamp_errors(scene_lab *l, const char *lightmap, int samples) {
    static float pixels[FLOATS];
    double square = 0, sum = 0, truth = 0;
    render_by(l, lightmap, "lamp.obj", "", samples, pixels);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double should = 5 * ALBEDO / PI * lamp_irradiance(HEIGHT, place(i % SIDE), place(i / SIDE)),
                     is = (double)pixels[4 * i];
        square += pow(is / should - 1, 2) / (SIDE * SIDE);
        sum += is;
        truth += should;
    }
    return (errors){sqrt(square), fabs(sum / truth - 1)};
}

static void a_rectangle_lights_as_lambert_says(void **state) {
    static const struct {
        int samples;
        double rms, mean;
    } bounds[] = {{1, 2, 0.01}, {4, 0.4, 0.006}, {16, 0.08, 0.004}, {64, 0.02, 0.002}, {256, 0.004, 0.002}};
    catalogue_point points[sizeof bounds / sizeof *bounds];
    const size_t count = sizeof bounds / sizeof *bounds;
    double last = INFINITY;
    for (size_t i = 0; i < count; i++) {
        const errors e = lamp_errors(*state, "rays", bounds[i].samples);
        char what[96];
        (void)snprintf(what, sizeof what, "rectangle of %d points: pixels against the closed form", bounds[i].samples);
        catalogue_row("soft light", what, e.rms, bounds[i].rms, "relative rms");
        (void)snprintf(what, sizeof what, "rectangle of %d points: mean against the closed form", bounds[i].samples);
        catalogue_row("soft light", what, e.mean, bounds[i].mean, "relative");

        assert_true(e.rms < 0.5 * last); /* random points: 0.5 */
        last = e.rms;
        points[i] = (catalogue_point){bounds[i].samples, e.rms};
    }
    catalogue_sweep("samples", "points on the lamp", "relative error of a pixel, rms", points, count);
}

/* What is baked is off by what interpolation between places may be: quality.lightmap_error. */
static void so_it_does_baked(void **state) {
    const errors e = lamp_errors(*state, "baked", 1);
    catalogue_row("soft light", "rectangle, baked: pixels against the closed form", e.rms, 0.02, "relative rms");
    catalogue_row("soft light", "rectangle, baked: mean against the closed form", e.mean, 0.01, "relative");
}

/* The floor round a lamp that lies close over it, seen from above: light in the gap changes within its width, far less than
 * points on the lamp are apart. Errors are relative to what a sky of the lamp's radiance gives. */
static void a_lamp_close_over_its_floor_lights_as_lambert_says(void **state) {
    static float pixels[FLOATS];
    static const struct {
        const char *lightmap;
        double gap, rms, mean; /* m */
    } bounds[] = {{"rays", 0.01, 0.01, 0.001},
                  {"rays", 0.05, 0.025, 0.001},
                  {"baked", 0.01, 0.025, 0.005},
                  {"baked", 0.05, 0.025, 0.003}};
    for (size_t k = 0; k < sizeof bounds / sizeof *bounds; k++) {
        const double gap = bounds[k].gap, eye = 3, edge = 0.6; /* m; what is seen of the floor */
        write_lamp(*state, "close.obj", gap);
        FILE *f = scene_lab_create(*state, "close.cfg");
        (void)fprintf(
            f,
            "output: { width = %d; height = %d; fps = 1.0; frames = 1; };\nmeshes = ( { file = \"close.obj\"; } );\n"
            "camera: { near = 0.1; keys = ( { fov = %.9g; eye = [0.0, %.2f, 0.0]; target = [0.0, 0.0, 0.0]; up = [0.0, "
            "0.0, -1.0]; } ); };\nquality: { photons = 0; lightmap = \"%s\"; };\n",
            SIDE, SIDE, 2 * atan(edge / eye) * 180 / PI, eye, bounds[k].lightmap);
        (void)fclose(f);
        scene_lab_bake(*state, "close.cfg", "");
        scene_lab_play(*state, "direct", pixels, FLOATS);
        double square = 0, sum = 0;
        int count = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double x = edge * ((2 * (i % SIDE) + 1.0) / SIDE - 1), z = edge * ((2 * (i / SIDE) + 1.0) / SIDE - 1);
            const double hidden = eye / (eye - gap); /* behind the lamp */
            if (fabs(x) < half[0] * hidden && fabs(z) < half[1] * hidden)
                continue;
            const double error = (double)pixels[4 * i] / (5 * ALBEDO) - lamp_irradiance(gap, x, z) / PI;
            square += error * error;
            sum += error;
            count++;
        }
        char what[96];
        (void)snprintf(what, sizeof what, "lamp %g m over its floor, %s: pixels beside it", gap, bounds[k].lightmap);
        catalogue_row("soft light", what, sqrt(square / count), bounds[k].rms, "of the lamp's radiance, rms");
        (void)snprintf(what, sizeof what, "lamp %g m over its floor, %s: mean beside it", gap, bounds[k].lightmap);
        catalogue_row("soft light", what, fabs(sum / count), bounds[k].mean, "of the lamp's radiance");
    }
}

/* A box whose walls all shine: L + albedo L everywhere, in its corners too, where points are too far apart and rays find the
 * walls. The picture's diagonals look at the very edges of the box, where a sample lies in two walls at once: no pixels of
 * these. */
static void a_box_whose_walls_shine_is_lit_alike_up_to_its_corners(void **state) {
    static float pixels[FLOATS];
    FILE *f = scene_lab_create(*state, "box.mtl");
    (void)fprintf(f, "newmtl wall\nKd %g %g %g\nKe 1 1 1\n", ALBEDO, ALBEDO, ALBEDO);
    (void)fclose(f);
    f = scene_lab_create(*state, "box.obj");
    (void)fprintf(f, "mtllib box.mtl\nusemtl wall\n");
    for (int i = 0; i < 8; i++)
        (void)fprintf(f, "v %d %d %d\n", i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    (void)fprintf(f, "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n");
    (void)fclose(f);
    render(*state, "box.obj", "", 64, pixels);
    double square = 0, sum = 0, rim = 0;
    int count = 0, rim_count = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const int x = i % SIDE, y = i / SIDE;
        const double error = ((double)pixels[4 * i] - 1) / ALBEDO - 1;
        const bool at_rim = x < 2 || x >= SIDE - 2;
        if (x == y || x == SIDE - 1 - y)
            continue;
        square += error * error;
        sum += error;
        rim += at_rim ? error : 0;
        count++;
        rim_count += at_rim;
    }
    catalogue_row("soft light", "box whose walls shine, 64 points: pixels", sqrt(square / count), 0.15, "relative rms");
    catalogue_row("soft light", "box whose walls shine, 64 points: mean", fabs(sum / count), 0.0015, "relative");
    catalogue_row("soft light", "box whose walls shine, 64 points: at the rim", fabs(rim / rim_count), 0.02, "relative");
}

static void an_even_sky_lights_a_plane_by_pi(void **state) {
    static float pixels[FLOATS];
    static const struct {
        int samples;
        double rms, mean;
    } bounds[] = {{16, 0.1, 1e-6}, {256, 0.01, 1e-6}};
    for (size_t k = 0; k < 2; k++) {
        double square = 0, sum = 0;
        render(*state, "plane.obj", "background = [3.0, 3.0, 3.0]; sky: { light = true; };", bounds[k].samples, pixels);
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double ratio = (double)pixels[4 * i] / (3 * ALBEDO);
            square += pow(ratio - 1, 2) / (SIDE * SIDE);
            sum += ratio / (SIDE * SIDE);
        }
        char what[96];
        (void)snprintf(what, sizeof what, "even sky of %d directions on a plane: pixels against pi L", bounds[k].samples);
        catalogue_row("soft light", what, sqrt(square), bounds[k].rms, "relative rms");
        (void)snprintf(what, sizeof what, "even sky of %d directions on a plane: mean against pi L", bounds[k].samples);
        catalogue_row("soft light", what, fabs(sum - 1), bounds[k].mean, "relative");
    }
}

/* The sky's picture as view rays see it, against the picture itself: 1 + 0.5 sin of the longitude, 1 + 0.5 y, 1. */
static void a_picture_is_seen_where_it_is(void **state) {
    static float pixels[FLOATS];
    enum { WIDE = 512, HIGH = 256 };
    FILE *f = scene_lab_create(*state, "sky.hdr");
    (void)fprintf(f, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", HIGH, WIDE);
    for (int i = 0; i < WIDE * HIGH; i++) {
        const double angle = 2 * PI * ((i % WIDE + 0.5) / WIDE - 0.5), y = cos(PI * (i / WIDE + 0.5) / HIGH),
                     value[3] = {1 + 0.5 * sin(angle), 1 + 0.5 * y, 1};
        for (int k = 0; k < 3; k++)
            (void)fputc((int)(value[k] * 128 + 0.5), f); /* (c + 0) / 256 * 2^(129 - 128) */
        (void)fputc(129, f);
    }
    (void)fclose(f);
    f = scene_lab_create(*state, "scene.cfg");
    (void)fprintf(f,
                  "output: { width = %d; height = %d; fps = 1.0; frames = 1; };\nmeshes = ( { file = \"plane.obj\"; translate "
                  "= [0.0, -5.0, 40.0]; } );\n"
                  "sky: { image = \"sky.hdr\"; scale = 2.0; rotate = 30.0; light = false; };\n"
                  "camera: { near = 0.1; keys = ( { fov = 90.0; eye = [0.0, 0.0, 0.0]; target = [0.0, 0.0, -1.0]; } ); };\n"
                  "quality: { photons = 0; };\n",
                  SIDE, SIDE);
    (void)fclose(f);
    scene_lab_bake(*state, "scene.cfg", "");
    scene_lab_play(*state, "final", pixels, FLOATS);
    double worst = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double x = (2 * (i % SIDE) + 1.0) / SIDE - 1, y = 1 - (2 * (i / SIDE) + 1.0) / SIDE, l = sqrt(1 + x * x + y * y);
        const double angle = atan2(x, 1) + 30 * PI / 180; /* the picture is turned about y as meshes are: to the left */
        worst = fmax(worst, fabs((double)pixels[4 * i] - 2 * (1 + 0.5 * sin(angle))));
        worst = fmax(worst, fabs((double)pixels[4 * i + 1] - 2 * (1 + 0.5 * y / l)));
        worst = fmax(worst, fabs((double)pixels[4 * i + 2] - 2));
    }
    catalogue_row("soft light", "a sky of 512 x 256 texels as view rays see it", worst, 0.015, "W/(m2 sr)");
}

static int set_up(void **state) {
    static scene_lab lab;
    scene_lab_open(&lab);
    write_scenes(&lab);
    *state = &lab;
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_rectangle_lights_as_lambert_says),
                                       cmocka_unit_test(so_it_does_baked),
                                       cmocka_unit_test(a_lamp_close_over_its_floor_lights_as_lambert_says),
                                       cmocka_unit_test(a_box_whose_walls_shine_is_lit_alike_up_to_its_corners),
                                       cmocka_unit_test(an_even_sky_lights_a_plane_by_pi),
                                       cmocka_unit_test(a_picture_is_seen_where_it_is)};
    return cmocka_run_group_tests_name("soft light", tests, set_up, scene_lab_tear_down);
}
