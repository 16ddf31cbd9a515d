/* Who makes indirect light where the scene leaves it to the baker (indirect = "auto"). Each rule is met by a room of its own,
 * and the figure that the baker decided by is one that is known: of a lamp in the middle of a cube a sixth of the light goes to
 * each side, so that a floor which is a mirror sends so much on. What is asked for is made, whatever the rules say;
 * and where the baker's look at its picture finds the basis wrong and photons less so, photons are taken after all. */
#include "scene_lab.h"
#include "pack_sections.h"
#include <math.h>

#define STILL "{ position = [0.0, 0.0, 0.0]; power = [10.0, 10.0, 10.0]; }"

/* The cube with a floor of a material of its own; frames: of the path, a second each. */
static void write_scene(scene_lab *l, const char *floor, int frames, const char *keys, const char *rest) {
    FILE *f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(f,
                  "output: { width = 24; height = 24; fps = 1.0; frames = %d; };\nmeshes = ( { file = \"cube.obj\"; } );\n"
                  "camera: { keys = ( { eye = [0.7, 0.5, 0.7]; target = [-0.5, -0.2, -0.5]; fov = 70.0; } ); };\n"
                  "lights = ( { type = \"point\"; keys = ( %s ); } );\nmaterials = ( { name = \"floor\"; %s } );\n%s",
                  frames, keys, floor, rest);
    (void)fclose(f);
}

static void bake(scene_lab *l, const char *options) {
    char line[1024];
    (void)snprintf(line, sizeof line, "%s -o %s --device host --no-check --receiver-rays 32 --photons 1000 %s",
                   scene_lab_path(l, "scene.cfg"), scene_lab_path(l, "scene.vit"), options);
    scene_lab_run(l, "vitrine-bake", line);
}

/* What the baker said of its choice; and the player has what the baker said. */
static void chosen(scene_lab *l, const char *maker, char line[512]) {
    FILE *f = fopen(scene_lab_path(l, "out.txt"), "r");
    char start[64], of_player[64], play[256];
    assert_non_null(f);
    do
        if (!fgets(line, 512, f))
            fail_msg("nothing is said of the choice");
    while (!strstr(line, "indirect = \"auto\": "));
    (void)fclose(f);
    (void)snprintf(start, sizeof start, "indirect = \"auto\": %s, since ", maker);
    if (!strstr(line, start))
        fail_msg("not '%s': %s", start, line);
    (void)snprintf(play, sizeof play, "%s --device host --report --frames 0", scene_lab_path(l, "scene.vit"));
    scene_lab_run(l, "vitrine-play", play);
    (void)snprintf(of_player, sizeof of_player, "indirect light: %s\n", maker);
    assert_true(scene_lab_said(l, of_player));
}

/* The floor's part of the lamp's light, in per cent, as the baker says it. */
static double part(const char *line) {
    double found = -1.0;
    for (const char *at = line; at && found < 0.0; at = strpbrk(at + 1, "0123456789"))
        if (strstr(at, " % of the light") && sscanf(at, "%lf %% of the light", &found) != 1)
            found = -1.0;
    return found;
}

#define MIRROR(share) "kind = \"mirror\"; specular = [" #share ", " #share ", " #share "];"

static void matt_surfaces_and_still_lights_are_baked(void **state) {
    char line[512];
    write_scene(*state, "", 2, STILL, "");
    bake(*state, ""); /* "auto" is the default */
    chosen(*state, "basis", line);
    assert_non_null(strstr(line, "lights are still\n"));
}

static void what_mirrors_send_on_decides_and_is_measured(void **state) {
    char line[512], three[512];
    write_scene(*state, MIRROR(0.6), 2, STILL, "");
    bake(*state, "--indirect auto --threads 1");
    chosen(*state, "photons", line);
    const double right = 100.0 * (0.6 / 6.0) / (5.0 / 6.0 + 0.6 / 6.0);
    if (fabs(part(line) / right - 1.0) > 0.01)
        fail_msg("%g: %s", right, line);
    bake(*state, "--indirect auto --threads 3");
    chosen(*state, "photons", three);
    assert_string_equal(line, three);
    write_scene(*state, MIRROR(0.03), 2, STILL, ""); /* so little does not count */
    bake(*state, "--indirect auto");
    chosen(*state, "basis", line);
    assert_true(fabs(part(line) / (100.0 * (0.03 / 6.0) / (5.0 / 6.0 + 0.03 / 6.0)) - 1.0) < 0.01);
    write_scene(*state, MIRROR(0.6), 2, STILL, ""); /* nor what is not asked for */
    bake(*state, "--indirect auto --caustics 0");
    chosen(*state, "basis", line);
}

static void lights_that_move_are_baked_as_long_as_knots_suffice(void **state) {
    char line[512], keys[8192] = "";
    size_t used = 0;
    write_scene(*state, "", 8, STILL ", { time = 7.0; position = [0.5, 0.0, 0.0]; }", "");
    bake(*state, "--indirect auto");
    chosen(*state, "basis", line);
    for (int i = 0; i < 80; i++) /* to and fro, every frame elsewhere */
        used += (size_t)snprintf(keys + used, sizeof keys - used, "%s{ time = %d.0; position = [%.1f, %.3f, 0.0]; %s}",
                                 i ? ", " : "", i, i % 2 ? 0.8 : -0.8, i / 100.0, i ? "" : "power = [10.0, 10.0, 10.0]; ");
    write_scene(*state, "", 80, keys, "");
    bake(*state, "--indirect auto --patches 32");
    chosen(*state, "radiosity", line);
    assert_non_null(strstr(line, "of the scene's size between two places"));
    bake(*state, "--indirect auto --patches 32 --basis-bytes 1e6");
    chosen(*state, "photons", line);
    assert_non_null(strstr(line, "of the scene's size between two places"));
    assert_non_null(strstr(line, "light between patches may take "));
}

static void irradiance_has_a_bound_in_bytes(void **state) {
    char line[512];
    write_scene(*state, "", 2, STILL, "");
    bake(*state, "--indirect auto --basis-bytes 1e6");
    chosen(*state, "photons", line);
    assert_non_null(strstr(line, "basis_bytes = 1e+06"));
    assert_null(strstr(line, "patches")); /* still light takes as much by radiosity */
}

/* 12 bytes in each of 97 states of 196 608 receivers, 229 MB; radiosity has 64 states, 4 bytes for each ray of a receiver, and
 * 12 for each pair of patches: 177 MB, or 945. */
static void radiosity_is_taken_where_irradiance_is_too_much(void **state) {
    char line[512];
    write_scene(*state, "", 200,
                STILL ", { time = 60.0; position = [0.8, 0.0, 0.0]; }, { time = 130.0; position = [-0.8, 0.2, 0.0]; } ); }, "
                      "{ type = \"point\"; keys = ( " STILL ", { time = 60.0; position = [0.0, 0.0, 0.8]; }, "
                      "{ time = 130.0; position = [0.2, 0.0, -0.8]; }",
                "");
    bake(*state, "--indirect auto --patches 32 --basis-bytes 2e8");
    chosen(*state, "radiosity", line);
    assert_non_null(strstr(line, "may take 2.29e+08 bytes; basis_bytes = 2e+08\n"));
    bake(*state, "--indirect auto --patches 8000 --basis-bytes 2e8");
    chosen(*state, "photons", line);
    assert_non_null(strstr(line, "light between patches may take 9.47e+08 bytes"));
}

/* Hits of a path that the pack counts. */
static uint32_t bounces_of(scene_lab *l) {
    size_t size;
    void *bytes = read_file(scene_lab_path(l, "scene.vit"), &size);
    const uint32_t bounces = ((const vit_scene *)pack_sections_of(bytes).data[VIT_SECTION_META])->bounces;
    free(bytes);
    return bounces;
}

/* With quality stated, too, and then all reflections count where they cost a frame nothing, but for what the scene says. */
static void what_is_asked_for_is_made(void **state) {
    static const char *const makers[] = {"photons", "basis", "radiosity", "radiosity"};
    static const uint32_t bounces[] = {4, 32, 32, 3};
    scene_lab *l = *state;
    for (int i = 0; i < 4; i++) {
        char line[128];
        write_scene(l, i ? MIRROR(0.6) : "", 2, i < 2 ? STILL : STILL ", { time = 1.0; position = [0.1, 0.0, 0.0]; }",
                    i < 3 ? "quality: { tile = 16; };\n" : "quality: { bounces = 3; };\n");
        (void)snprintf(line, sizeof line, "--quality stated --patches 64 --indirect %s", makers[i]);
        bake(l, line);
        assert_int_equal(bounces_of(l), bounces[i]);
        assert_false(scene_lab_said(l, "indirect = \"auto\""));
        (void)snprintf(line, sizeof line, "%s --device host --report --frames 0", scene_lab_path(l, "scene.vit"));
        scene_lab_run(l, "vitrine-play", line);
        (void)snprintf(line, sizeof line, "indirect light: %s\n", makers[i]);
        assert_true(scene_lab_said(l, line));
    }
}

static void radiosity_of_lights_that_stay_is_a_basis_and_said(void **state) {
    scene_lab *l = *state;
    write_scene(l, "", 2, STILL, "quality: { tile = 16; };\n");
    bake(l, "--quality stated --receiver-rays 16 --indirect radiosity");
    assert_true(scene_lab_said(
        l, "indirect = \"radiosity\": a basis is baked, since no light moves or changes, or nothing reflects it\n"));
}

/* The line that quality "auto" ends with. */
static void quality_said(scene_lab *l, char line[1024]) {
    FILE *f = fopen(scene_lab_path(l, "out.txt"), "r");
    assert_non_null(f);
    do
        if (!fgets(line, 1024, f))
            fail_msg("nothing is said of the quality");
    while (!strstr(line, "quality \"auto\": "));
    (void)fclose(f);
}

static void bake_checked(scene_lab *l, const char *pack, const char *options) {
    char line[1024];
    (void)snprintf(line, sizeof line, "%s -o %s --device host %s", scene_lab_path(l, "scene.cfg"), scene_lab_path(l, pack),
                   options);
    scene_lab_run(l, "vitrine-bake", line);
}

/* How far a picture's sums are from right, by the line that says so. */
static double off_by(const char *line) {
    double sum[4], worst = 0;
    const char *flux = strstr(line, "flux ");
    assert_non_null(flux);
    assert_int_equal(sscanf(flux, "flux %lf %lf %lf, dark half %lf", sum, sum + 1, sum + 2, sum + 3), 4);
    for (int i = 0; i < 4; i++)
        worst = fmax(worst, fabs(sum[i] - 1));
    return worst;
}

/* Of the first picture that was looked at. */
static double first_off_by(scene_lab *l) {
    char line[1024];
    FILE *f = fopen(scene_lab_path(l, "out.txt"), "r");
    assert_non_null(f);
    do
        if (!fgets(line, 1024, f))
            fail_msg("nothing is said of a first try");
    while (!strstr(line, "tried { indirect = \"basis\"; bounces = 32; }"));
    (void)fclose(f);
    return off_by(line);
}

/* With quality "auto" all reflections count, receivers come closer, half as far apart each time, where the picture is wrong
 * and that helps, and the pack has the light that the check has looked at: its bytes are those of the same settings stated.
 * What is wrong is the noise of few rays. */
static void a_basis_that_is_wrong_is_refined(void **state) {
    char line[1024], options[256];
    int spacing, tries;
    size_t sizes[2];
    scene_lab *l = *state;
    write_scene(l, "", 2, "{ position = [-0.7, -0.992, -0.3]; power = [10.0, 10.0, 10.0]; }", /* 8 mm off the floor */
                "quality: { auto = true; receiver_rays = 16; };\n");
    bake_checked(l, "scene.vit", "--indirect auto");
    quality_said(l, line);
    const char *chosen_settings = strstr(line, "{ indirect = \"basis\"; receiver_spacing = ");
    if (!chosen_settings ||
        sscanf(chosen_settings, "{ indirect = \"basis\"; receiver_spacing = %d; bounces = 32; }, of %d tried", &spacing,
               &tries) != 2)
        fail_msg("%s", line);
    assert_true(tries > 1 && spacing == 16 >> (tries - 1));
    assert_true(first_off_by(l) > 0.05 && off_by(line) < 0.8 * first_off_by(l));
    (void)snprintf(options, sizeof options,
                   "--quality stated --no-check --indirect basis --receiver-spacing %d --bounces 32 --threads 1", spacing);
    bake_checked(l, "stated.vit", options);
    void *chosen_bytes = read_file(scene_lab_path(l, "scene.vit"), sizes),
         *stated_bytes = read_file(scene_lab_path(l, "stated.vit"), sizes + 1);
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(chosen_bytes, stated_bytes, sizes[0]);
    free(chosen_bytes);
    free(stated_bytes);
}

/* Receivers in the room's corners alone cannot tell a lamp's light on a wall; photons can. What is stated stays. */
static void a_basis_that_is_wrong_gives_way_to_photons(void **state) {
    static const char near_a_wall[] = "{ position = [0.0, 0.9, 0.2]; power = [10.0, 10.0, 10.0]; }";
    char line[1024];
    scene_lab *l = *state;
    write_scene(l, "", 1, near_a_wall, "quality: { auto = true; receiver_rays = 16; receiver_spacing = 256.0; };\n");
    bake_checked(l, "scene.vit", "--indirect auto");
    assert_true(scene_lab_said(l, "indirect = \"auto\": photons, since the basis has flux 0."));
    quality_said(l, line);
    assert_null(strstr(line, "basis"));
    bake_checked(l, "scene.vit", "--indirect basis");
    quality_said(l, line);
    assert_non_null(strstr(line, "warning"));
    assert_non_null(strstr(line, "indirect = \"basis\""));
    assert_non_null(strstr(line, "a smaller receiver_spacing than 256"));
}

static int set_up(void **state) {
    static const int side[6][4] = {{1, 2, 4, 3}, {5, 7, 8, 6}, {3, 4, 8, 7}, {1, 3, 7, 5}, {2, 6, 8, 4}, {1, 5, 6, 2}};
    scene_lab_set_up(state);
    FILE *f = scene_lab_create(*state, "cube.mtl");
    (void)fprintf(f, "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl floor\nKd 0.5 0.5 0.5\n");
    (void)fclose(f);
    f = scene_lab_create(*state, "cube.obj");
    (void)fprintf(f, "mtllib cube.mtl\nusemtl wall\n");
    for (int i = 0; i < 8; i++)
        (void)fprintf(f, "v %d %d %d\n", i & 4 ? 1 : -1, i & 2 ? 1 : -1, i & 1 ? 1 : -1);
    for (int i = 0; i < 6; i++)
        (void)fprintf(f, "%sf %d %d %d %d\n", i == 5 ? "usemtl floor\n" : "", side[i][0], side[i][1], side[i][2], side[i][3]);
    (void)fclose(f);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matt_surfaces_and_still_lights_are_baked),
        cmocka_unit_test(what_mirrors_send_on_decides_and_is_measured),
        cmocka_unit_test(lights_that_move_are_baked_as_long_as_knots_suffice),
        cmocka_unit_test(irradiance_has_a_bound_in_bytes),
        cmocka_unit_test(radiosity_is_taken_where_irradiance_is_too_much),
        cmocka_unit_test(what_is_asked_for_is_made),
        cmocka_unit_test(radiosity_of_lights_that_stay_is_a_basis_and_said),
        cmocka_unit_test(a_basis_that_is_wrong_is_refined),
        cmocka_unit_test(a_basis_that_is_wrong_gives_way_to_photons),
    };
    return cmocka_run_group_tests(tests, set_up, scene_lab_tear_down);
}
