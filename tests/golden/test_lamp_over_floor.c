/* A lamp over a floor, seen straight from above through the real programs: every pixel's radiance is a closed form of where the
 * pixel looks and of what the scene file or the model says of the lamp, so a wrong unit, cone or falloff shows as a figure. */
#include "scene_lab.h"

#include "cost/lights.h"
#include <math.h>

#define PI 3.14159265358979323846
enum { SIDE = 48 }; /* pixels of the frame's edge */
#define FLOATS ((size_t)4 * SIDE * SIDE)
#define HEIGHT 4.0 /* of the camera, m */
#define EDGE 2.4   /* half of what it sees of the floor, m */
#define LAMP 2.0   /* height of the lamp, m */
#define ALBEDO 0.5

/* Radiant intensity, W/sr a unit, of the lamp into the direction whose cosine to straight down is `c`, times falloff at d
 * metres. */
typedef double lamp_form(double c, double d);

/* The scene: `mesh`, and `light` as one of its lights. */
static void write_scene(scene_lab *l, const char *mesh, const char *light, const char *more) {
    FILE *f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(
        f,
        "output: { width = %d; height = %d; frames = 1; };\nmeshes = ( { file = \"%s\"; } );\n"
        "camera: { keys = ( { eye = [0.0, %.1f, 0.0]; target = [0.0, 0.0, 0.0]; up = [0.0, 0.0, -1.0]; fov = %.9g; } ); };\n"
        "lights = ( %s );\n%s\nquality: { photons = 0; };\n",
        SIDE, SIDE, mesh, HEIGHT, 2.0 * atan(EDGE / HEIGHT) * 180.0 / PI, light, more);
    (void)fclose(f);
}

static void write_floor(scene_lab *l) {
    FILE *f = scene_lab_create(l, "floor.mtl");
    (void)fprintf(f, "newmtl floor\nKd %g %g %g\n", ALBEDO, ALBEDO, ALBEDO);
    (void)fclose(f);
    f = scene_lab_create(l, "floor.obj");
    (void)fprintf(f, "mtllib floor.mtl\nusemtl floor\nv -5 0 5\nv 5 0 5\nv 5 0 -5\nv -5 0 -5\nf 1 2 3 4\n");
    (void)fclose(f);
}

/* Every pixel shows ALBEDO / pi times `scale` times the form times the cosine at the floor, within 1/500 of the brightest. */
static void shows(scene_lab *l, double scale, lamp_form *form) {
    static float pixels[FLOATS];
    double most = 0.0, worst = 0.0;
    scene_lab_play(l, "final", pixels, FLOATS);
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double x = EDGE * (2.0 * (i % SIDE + 0.5) / SIDE - 1.0), z = EDGE * (2.0 * (i / SIDE + 0.5) / SIDE - 1.0);
            const double d = sqrt(x * x + z * z + LAMP * LAMP), c = LAMP / d;
            const double due = ALBEDO / PI * scale * form(c, d) * c, is = (double)pixels[4 * i + 1];
            most = fmax(most, due);
            worst = fmax(worst, fabs(is - due));
            if (pass && fabs(is - due) > most / 500.0)
                fail_msg("pixel %d, %d, %g m from the lamp: %g, due %g (worst of all: %g off)", i % SIDE, i / SIDE, d, is, due,
                         worst);
        }
    assert_true(most > 0.0);
}

/* KHR_lights_punctual's window of a range of 2.5 m, by its letter: max(min(1 - (d / range)^4, 1), 0) / d^2. */
static double within_range(double c, double d) {
    (void)c;
    return fmax(fmin(1.0 - pow(d / 2.5, 4.0), 1.0), 0.0) / (d * d);
}

static void a_range_is_khr_lights_punctuals(void **state) {
    scene_lab *l = *state;
    write_floor(l);
    write_scene(l, "floor.obj",
                "{ type = \"point\"; range = 2.5; keys = ( { position = [0.0, 2.0, 0.0]; power = [100.0, 100.0, 100.0]; } ); }",
                "");
    scene_lab_bake(l, "scene.cfg", "");
    shows(l, 100.0 / (4.0 * PI), within_range);
}

static void the_reference_has_that_range_too(void **state) {
    (void)state;
    const vit_light lamp = {.kind = VIT_LIGHT_POINT, .inv_range2 = 1.0f / (2.5f * 2.5f)};
    for (int i = 0; i <= 11; i++) {
        const double d = 2.0 + 0.1 * i;
        assert_true(fabs((double)light_falloff(&lamp, (float)(d * d)) - within_range(1.0, d)) < 1e-6);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_range_is_khr_lights_punctuals),
                                       cmocka_unit_test(the_reference_has_that_range_too)};
    return cmocka_run_group_tests_name("a lamp over a floor", tests, scene_lab_set_up, scene_lab_tear_down);
}
