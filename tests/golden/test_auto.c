/* Quality "auto": the baker chooses settings by its own check. What it chose is held to a second look: the same settings,
 * stated in a block, must be found right by the check of the whole pack, and the defaults must not, or there was nothing to
 * choose. */
#include "scene_lab.h"
#include <math.h>

/* A closed room of 2 m with a dim lamp, its walls 5 cm thick, and a bright lamp outside in a larger one: photons shine in
 * through walls. */
static void write_scene(scene_lab *l, const char *quality) {
    FILE *f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(
        f,
        "output: { width = 48; height = 48; frames = 1; };\nmeshes = ( { file = \"room.obj\"; scale = 1.05; }, { file = "
        "\"room.obj\"; }, { file = \"room.obj\"; scale = 2.0; } );\n"
        "camera: { keys = ( { eye = [0.7, 0.5, 0.7]; target = [-0.5, -0.2, -0.5]; fov = 70.0; } ); };\n"
        "lights = ( { type = \"point\"; keys = ( { position = [0.0, 0.5, 0.2]; power = [0.2, 0.2, 0.2]; } ); },"
        "{ type = \"point\"; keys = ( { position = [1.5, 0.5, 0.2]; power = [300.0, 300.0, 300.0]; } ); } );\n"
        "materials = ( { name = \"DefaultMaterial\"; color = [0.5, 0.5, 0.5]; } );\n%s",
        quality);
    (void)fclose(f);
}

/* scene_lab_bake() checks nothing, and so chooses nothing. */
static void bake(scene_lab *l, const char *options) {
    char line[1024];
    (void)snprintf(line, sizeof line, "%s -o %s --device host %s", scene_lab_path(l, "scene.cfg"),
                   scene_lab_path(l, "scene.vit"), options);
    scene_lab_run(l, "vitrine-bake", line);
}

/* The line of the choice or of the check. */
static void told(scene_lab *l, const char *what, char line[1024]) {
    FILE *f = fopen(scene_lab_path(l, "out.txt"), "r");
    assert_non_null(f);
    do
        if (!fgets(line, 1024, f))
            fail_msg("nothing says '%s'", what);
    while (!strstr(line, what));
    (void)fclose(f);
}

static double farthest(const char *line) {
    double flux[4], most = 0.0;
    const char *at = strstr(line, "flux ");
    assert_non_null(at);
    assert_int_equal(sscanf(at, "flux %lf %lf %lf, dark half %lf", flux, flux + 1, flux + 2, flux + 3), 4);
    for (int i = 0; i < 4; i++)
        most = fmax(most, fabs(flux[i] - 1.0));
    return most;
}

static void what_is_chosen_is_right_with_any_number_of_threads_and_the_defaults_are_not(void **state) {
    char one[1024], three[1024];
    scene_lab *l = *state;
    write_scene(l, "quality: { };\n");
    bake(l, "");
    told(l, "warning: the picture differs from path tracing", one);
    assert_true(farthest(one) > 0.05);
    write_scene(l, "quality = \"auto\";\n");
    bake(l, "--threads 1");
    told(l, "quality \"auto\": {", one);
    if (farthest(one) > 0.05)
        fail_msg("%s", one);
    assert_non_null(strstr(one, "zones = true; "));
    bake(l, "--threads 3");
    told(l, "quality \"auto\": {", three);
    assert_string_equal(one, three);
}

static void what_is_stated_stays(void **state) {
    char line[1024];
    scene_lab *l = *state;
    write_scene(l, "quality: { auto = true; bounces = 5; photons = 3000; zones = false; };\n");
    bake(l, "--radius 0.6 --effective-area 0 --guiding 0");
    told(l, "quality \"auto\"", line); /* a warning: these settings cannot be right */
    assert_non_null(strstr(line, "photons = 3000; radius = 0.6; bounces = 5; }"));
    assert_non_null(strstr(line, "warning"));
    write_scene(l, "quality: { photons = 3000; };\n"); /* a block says all itself */
    bake(l, "");
    assert_false(scene_lab_said(l, "quality \"auto\""));
    bake(l, "--quality auto --zones 0 --effective-area 0 --radius 0.6");
    told(l, "quality \"auto\"", line);
    assert_non_null(strstr(line, "photons = 3000; "));
    write_scene(l, "");
    bake(l, "--quality stated");
    assert_false(scene_lab_said(l, "quality \"auto\""));
    bake(l, "--no-check");
    assert_false(scene_lab_said(l, "quality \"auto\""));
}

static int set_up(void **state) {
    static const double half[3] = {1.0, 1.0, 1.0};
    scene_lab_set_up(state);
    scene_lab_write_room(*state, "room.obj", half, 0.0);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_chosen_is_right_with_any_number_of_threads_and_the_defaults_are_not),
        cmocka_unit_test(what_is_stated_stays),
    };
    return cmocka_run_group_tests(tests, set_up, scene_lab_tear_down);
}
