/* What the baker says of its own picture: right pictures are said to be right, wrong ones are warned of with a figure and the
 * setting that mends them, black and white ones with the reason. Whole lines are compared, so that figures are the same with
 * any number of threads; the figures themselves are held to what is known: no photons leave all indirect light out, photons a
 * metre wide shine through walls. */
#include "scene_lab.h"
#include <math.h>

static const char camera[] =
    "camera: { keys = ( { eye = [0.7, 0.5, 0.7]; target = [-0.5, -0.2, -0.5]; fov = 70.0; exposure = %s; } ); };\n";
static const char point[] = "lights = ( { type = \"point\"; keys = ( { position = [%s, 0.5, 0.2]; power = [%s]; } ); } );\n";

/* A closed room of 2 m; `rest`: whatever else. */
static void write_scene(scene_lab *l, const char *exposure, const char *at, const char *power, const char *rest) {
    FILE *f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(f, "output: { width = 48; height = 48; frames = 2; };\nmeshes = ( { file = \"room.obj\"; } );\n");
    (void)fprintf(f, camera, exposure);
    if (power)
        (void)fprintf(f, point, at, power);
    (void)fputs(rest, f);
    (void)fclose(f);
}

/* scene_lab_bake() checks nothing. */
static void bake(scene_lab *l, const char *options) {
    char line[512];
    (void)snprintf(line, sizeof line, "%s -o %s --device host --quality stated --indirect photons %s",
                   scene_lab_path(l, "scene.cfg"), scene_lab_path(l, "scene.vit"), options);
    scene_lab_run(l, "vitrine-bake", line);
}

static void says(scene_lab *l, const char *text, bool wanted) {
    char said[4096];
    if (scene_lab_said(l, text) == wanted)
        return;
    read_into(scene_lab_path(l, "out.txt"), said, sizeof said);
    fail_msg("%s'%s' in\n%s", wanted ? "no " : "", text, said);
}

/* The line that tells figures. */
static void figures(scene_lab *l, char line[512]) {
    FILE *f = fopen(scene_lab_path(l, "out.txt"), "r");
    assert_non_null(f);
    do
        assert_non_null(fgets(line, 512, f));
    while (!strstr(line, "dark half"));
    (void)fclose(f);
}

#define GREY "materials = ( { name = \"DefaultMaterial\"; color = [0.5, 0.5, 0.5]; } );\n"
#define FINE                                                                                                                   \
    "quality: { photons = 20000; bounces = 10; radius = 0.3; indirect_samples = 1; zones = true; effective_area = true; };\n"

static void a_right_picture_is_said_to_be_right(void **state) {
    scene_lab *l = *state;
    write_scene(l, "1.0", "0.3", "10.0, 10.0, 10.0", GREY FINE);
    bake(l, "");
    says(l, "warning", false);
    says(l, "checked against path tracing at 400 pixels of 2 frames: flux ", true);
    bake(l, "--quiet");
    says(l, "checked", false);
    bake(l, "--no-check");
    says(l, "checked", false);
}

static void what_is_left_out_is_warned_of_with_the_setting_that_mends_it(void **state) {
    char line[512];
    double flux[4];
    scene_lab *l = *state;
    write_scene(l, "1.0", "0.3", "10.0, 10.0, 10.0", GREY FINE);
    bake(l, "--quiet --photons 0");
    says(l, "warning: the picture differs from path tracing", true);
    says(l, "photons", true);
    figures(l, line);
    assert_int_equal(sscanf(strstr(line, "flux"), "flux %lf %lf %lf, dark half %lf", flux, flux + 1, flux + 2, flux + 3), 4);
    for (int i = 0; i < 3; i++) /* in a closed room of albedo 1/2 every reflection has half of the light before it: half is
                                   indirect, on the mean */
        if (flux[i] < 0.35 || flux[i] > 0.65)
            fail_msg("%s", line);
    bake(l, "--quiet --bounces 2");
    says(l, "bounces = 2 leaves", true);
}

static void light_that_leaks_through_a_wall_is_warned_of(void **state) {
    scene_lab *l = *state; /* the camera's room has a dim lamp, the one around it a bright one */
    FILE *f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(f, "output: { width = 48; height = 48; frames = 1; };\nmeshes = ( { file = \"room.obj\"; scale = 1.05; }, { "
                     "file = \"room.obj\"; }, "
                     "{ file = \"room.obj\"; scale = 3.0; } );\n");
    (void)fprintf(f, camera, "1.0");
    (void)fprintf(f,
                  "lights = ( { type = \"point\"; keys = ( { position = [0.0, 0.5, 0.2]; power = [0.2, 0.2, 0.2]; } ); },"
                  "{ type = \"point\"; keys = ( { position = [2.0, 0.5, 0.2]; power = [300.0, 300.0, 300.0]; } ); } );\n" GREY
                  "quality: { bounces = 10; radius = 0.5; };\n");
    (void)fclose(f);
    bake(l, "--quiet");
    says(l, "zones = true and effective_area = true", true);
    bake(l, "--quiet --zones 1");
    says(l, "zones = true", false);
}

/* A wall of 8 mm stands between it and the lamp, on a floor that goes on beneath it: what comes through is less than shows. */
static void a_room_that_no_light_reaches_is_black_and_right(void **state) {
    scene_lab *l = *state;
    FILE *f = scene_lab_create(l, "two.obj");
    const double x[4] = {0.0, 3.0, 3.008, 6.008};
    (void)fprintf(f, "mtllib room.mtl\nusemtl grey\n");
    for (int i = 0; i < 16; i++)
        (void)fprintf(f, "v %g %g %d\n", x[i / 4], i & 1 ? 2.5 : 0.0, i & 2 ? 3 : 0);
    (void)fprintf(f, "f 1 2 4 3\nf 13 15 16 14\nf 1 3 15 13\nf 2 14 16 4\nf 1 13 14 2\nf 3 4 16 15\n" /* the rooms */
                     "f 5 7 8 6\nf 9 10 12 11\nf 5 9 11 7\nf 6 8 12 10\nf 5 6 10 9\nf 7 11 12 8\n");  /* the wall */
    (void)fclose(f);
    f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(
        f, "output: { width = 160; height = 120; frames = 1; };\nmeshes = ( { file = \"two.obj\"; } );\n"
           "camera: { keys = ( { eye = [5.8, 2.3, 0.2]; target = [3.0, 1.0, 1.6]; fov = 70.0; } ); };\n"
           "lights = ( { type = \"point\"; keys = ( { position = [1.5, 2.2, 1.5]; power = [120.0, 110.0, 100.0]; } ); } );\n");
    (void)fclose(f);
    bake(l, "--quiet --indirect basis");
    says(l, "no light reaches what the camera sees", true);
    says(l, "inf", false);
}

static void the_figures_are_the_same_with_any_number_of_threads(void **state) {
    char one[512], three[512];
    scene_lab *l = *state;
    write_scene(l, "1.0", "0.3", "10.0, 10.0, 10.0",
                "materials = ( { name = \"DefaultMaterial\"; specular = [0.3, 0.3, 0.3]; } );\n");
    bake(l, "--threads 1");
    figures(l, one);
    bake(l, "--threads 3");
    figures(l, three);
    assert_string_equal(one, three);
}

static void black_and_white_pictures_are_warned_of_with_the_reason(void **state) {
    static const struct {
        const char *exposure, *at, *power, *rest, *says;
    } scenes[] = {
        {"1.0", "9.0", "10.0, 10.0, 10.0", "", "100 % of the picture is black: no light reaches what the camera sees"},
        {"1.0", "9.0", "10.0, 10.0, 10.0", "quality: { zones = true; effective_area = true; };\n",
         "no light reaches what the camera sees"},
        {"1.0", "0.3", NULL, "", "100 % of the picture is black: the scene has no lights"},
        {"1.0", "0.3", "0.0, 0.0, 0.0", "", "100 % of the picture is black: the scene has no lights"},
        {"1e-6", "0.3", "10.0, 10.0, 10.0", "", "100 % of the picture is black, underexposed: its median is "},
        {"1000.0", "0.3", "10.0, 10.0, 10.0", "", "100 % of the picture's surfaces are white, overexposed: its median is "},
        {"1.0", "0.3", "10.0, 10.0, 10.0",
         "materials = ( { name = \"DefaultMaterial\"; kind = \"mirror\"; specular = [0.9, 0.9, 0.9]; } );\n",
         "100 % of the picture is black: the camera sees no surface that could be lit"},
    };
    scene_lab *l = *state;
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        write_scene(l, scenes[i].exposure, scenes[i].at, scenes[i].power, scenes[i].rest);
        bake(l, "--quiet");
        says(l, scenes[i].says, true);
    }
    write_scene(l, "1.0", "0.3", "10.0, 10.0, 10.0", "");
    bake(l, "--quiet");
    says(l, "of the picture is", false);
}

/* The exposure that is suggested is one that does. */
static void a_suggested_exposure_shows_the_picture(void **state) {
    scene_lab *l = *state;
    write_scene(l, "2000.0", "0.3", "10.0, 10.0, 10.0", "");
    bake(l, "--quiet");
    char said[4096], exposure[32] = "";
    read_into(scene_lab_path(l, "out.txt"), said, sizeof said);
    const char *at = strstr(said, "exposure = ");
    assert_non_null(at);
    assert_int_equal(sscanf(at, "exposure = %31s", exposure), 1);
    write_scene(l, exposure, "0.3", "10.0, 10.0, 10.0", "");
    bake(l, "--quiet");
    says(l, "of the picture is", false);
}

/* "auto" shows the median as 0.18 whatever the light's power, twice the light is half the exposure, and threads change nothing.
 */
static void an_automatic_exposure_follows_the_light(void **state) {
    static const char *const powers[] = {"0.01, 0.01, 0.01", "10.0, 10.0, 10.0", "20.0, 20.0, 20.0"};
    static float pixels[4 * 48 * 48 * 2];
    double found[3], again;
    scene_lab *l = *state;
    for (int i = 0; i < 3; i++) {
        char said[512] = "";
        write_scene(l, "1.0", "0.3", powers[i], GREY "quality: { bounces = 10; };\n");
        bake(l, "--exposure auto --threads 3");
        FILE *f = fopen(scene_lab_path(l, "out.txt"), "r");
        assert_non_null(f);
        while (!strstr(said, "exposure \"auto\": "))
            assert_non_null(fgets(said, sizeof said, f));
        (void)fclose(f);
        assert_int_equal(sscanf(strstr(said, "\": "), "\": %lf", found + i), 1);
        scene_lab_play(l, "final", pixels, sizeof pixels / sizeof *pixels);
        int above = 0;
        for (size_t k = 0; k < sizeof pixels / sizeof *pixels; k += 4)
            above += pixels[k + 1] > 0.18f;
        if (above < 48 * 48 * 2 * 4 / 10 || above > 48 * 48 * 2 * 6 / 10)
            fail_msg("power %s, exposure %g: %d pixels are above the grey", powers[i], found[i], above);
    }
    assert_true(found[0] > 900.0 * found[1] && found[0] < 1100.0 * found[1]);
    assert_true(found[1] > 1.95 * found[2] && found[1] < 2.05 * found[2]);
    again = found[2];
    bake(l, "--exposure auto --threads 1 --quiet");
    scene_lab_play(l, "final", pixels, sizeof pixels / sizeof *pixels);
    const float first = pixels[1];
    char line[64];
    (void)snprintf(line, sizeof line, "--exposure %.17g --quiet", again);
    bake(l, line);
    scene_lab_play(l, "final", pixels, sizeof pixels / sizeof *pixels);
    assert_true(fabsf(pixels[1] - first) < 1e-4f);
}

static int set_up(void **state) {
    static const double half[3] = {1.0, 1.0, 1.0};
    scene_lab_set_up(state);
    scene_lab_write_room(*state, "room.obj", half, 0.0);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_right_picture_is_said_to_be_right),
        cmocka_unit_test(what_is_left_out_is_warned_of_with_the_setting_that_mends_it),
        cmocka_unit_test(light_that_leaks_through_a_wall_is_warned_of),
        cmocka_unit_test(a_room_that_no_light_reaches_is_black_and_right),
        cmocka_unit_test(the_figures_are_the_same_with_any_number_of_threads),
        cmocka_unit_test(black_and_white_pictures_are_warned_of_with_the_reason),
        cmocka_unit_test(a_suggested_exposure_shows_the_picture),
        cmocka_unit_test(an_automatic_exposure_follows_the_light),
    };
    return cmocka_run_group_tests(tests, set_up, scene_lab_tear_down);
}
