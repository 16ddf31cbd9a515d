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
    (void)snprintf(line, sizeof line, "%s -o %s --device host --indirect photons %s", scene_lab_path(l, "scene.cfg"),
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
    assert_non_null(strstr(line, "photons = 3000; radius = 0.6; indirect = \"photons\"; bounces = 5; }"));
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

static void add_box(FILE *f, int *vertices, const double lo[3], const double hi[3]) {
    static const int face[6][4] = {{1, 5, 7, 3}, {2, 4, 8, 6}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 3, 4, 2}, {5, 6, 8, 7}};
    for (int i = 0; i < 8; i++)
        (void)fprintf(f, "v %g %g %g\n", i & 1 ? hi[0] : lo[0], i & 2 ? hi[1] : lo[1], i & 4 ? hi[2] : lo[2]);
    for (int i = 0; i < 6; i++)
        (void)fprintf(f, "f %d %d %d %d\n", *vertices + face[i][0], *vertices + face[i][1], *vertices + face[i][2],
                      *vertices + face[i][3]);
    *vertices += 8;
}

/* A room of 4 m on a field of 120 m in the sun, which comes in by a slit of 5 cm: its light is some 1e-5 of the scene's mean,
 * and all that the picture shows. */
static void a_room_behind_a_slit_is_not_black(void **state) {
    static const double box[][2][3] = {
        {{-60, -1, -60}, {60, 0, 60}},       {{-2.1, 0, -2.1}, {2.1, 0.1, 2.1}}, {{-2.1, 3, -2.1}, {2.1, 3.1, 2.1}},
        {{-2.1, 0.1, -2.1}, {-2, 3, 2.1}},   {{2, 0.1, -2.1}, {2.1, 3, 2.1}},    {{-2, 0.1, -2.1}, {2, 3, -2}},
        {{-2, 0.1, 2}, {-0.025, 3, 2.1}},    {{0.025, 0.1, 2}, {2, 3, 2.1}},     {{-0.025, 0.1, 2}, {0.025, 0.6, 2.1}},
        {{-0.025, 2.6, 2}, {0.025, 3, 2.1}},
    };
    char line[1024];
    scene_lab *l = *state;
    FILE *f = scene_lab_create(l, "slit.obj");
    int vertices = 0;
    for (size_t i = 0; i < sizeof box / sizeof *box; i++)
        add_box(f, &vertices, box[i][0], box[i][1]);
    (void)fclose(f);
    f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(f,
                  "output: { width = 32; height = 24; frames = 1; };\nmeshes = ( { file = \"slit.obj\"; } );\n"
                  "camera: { exposure = \"auto\"; keys = ( { eye = [1.6, 1.8, 1.6]; target = [-1.5, 1.0, -1.5]; fov = 70.0; } "
                  "); };\n"
                  "lights = ( { type = \"directional\"; keys = ( { position = [3.0, 10.0, 8.0]; target = [0.0, 0.0, 0.0]; "
                  "irradiance = [30.0, 28.0, 24.0]; } ); } );\n"
                  "materials = ( { name = \"DefaultMaterial\"; color = [0.6, 0.6, 0.6]; } );\n"
                  "quality: { auto = true; photons = 8000; radius = 0.5; bounces = 10; };\n");
    (void)fclose(f);
    bake(l, "");
    told(l, "quality \"auto\": {", line);
    if (farthest(line) > 0.1)
        fail_msg("%s", line);
    assert_false(scene_lab_said(l, "of the picture is black"));
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
        cmocka_unit_test(a_room_behind_a_slit_is_not_black),
    };
    return cmocka_run_group_tests(tests, set_up, scene_lab_tear_down);
}
