/* Scenes far from the origin: the baker moves them before anything becomes a float, so a frame has the bits of the same scene
 * at the origin, as long as the numbers in the mesh files are small and the distance is in `translate`. Where the files' own
 * numbers are large, precision is gone before we see them, and the baker says so. */
#include "scene_lab.h"

#define SIDE 48
#define FLOATS ((size_t)4 * SIDE * SIDE)

static const double half[3] = {1.1, 0.9, 1.3};

/* `in_file`: how far away the mesh's own numbers are; `away`: how far everything is. */
static void write_scene(scene_lab *l, const char *name, const char *mesh, double in_file, double away) {
    FILE *f = scene_lab_create(l, name);
    const double x = away + 0.25, y = -away, z = away + 0.75;
    (void)fprintf(
        f,
        "output: { width = %d; height = %d; fps = 1.0; frames = 2; };\n"
        "meshes = ( { file = \"%s\"; translate = [%.9f, %.9f, %.9f]; } );\n"
        "camera: { near = 0.1; keys = ( { eye = [%.9f, %.9f, %.9f]; target = [%.9f, %.9f, %.9f]; fov = 70.0; } ); };\n"
        "lights = ( { type = \"spot\"; inner = 40.0; outer = 60.0; keys = ( { position = [%.9f, %.9f, %.9f]; target = "
        "[%.9f, "
        "%.9f, %.9f]; power = [50.0, 40.0, 30.0]; }, { time = 1.0; position = [%.9f, %.9f, %.9f]; } ); } );\n"
        "quality: { photons = 2000; radius = 0.5; tile = 8; };\n",
        SIDE, SIDE, mesh, away - in_file, y, away - in_file, x, y, z, away - 0.5, y - 0.25, away - 1.0, x, y + 0.5, z, away,
        y - 0.875, away, away - 0.5, y + 0.5, z);
    (void)fclose(f);
}

static void play(scene_lab *l, const char *scene, float *pixels) {
    scene_lab_indirect(l, scene, "", pixels, 2 * FLOATS);
}

static void a_scene_far_away_has_the_bits_that_it_has_at_the_origin(void **state) {
    static const double away[] = {64.0, 4096.0, 524288.0};
    static float near[2 * FLOATS], far[2 * FLOATS];
    scene_lab *l = *state;
    scene_lab_write_room(l, "room.obj", half, 0.0);
    write_scene(l, "near.cfg", "room.obj", 0.0, 0.0);
    play(l, "near.cfg", near);
    double sum = 0.0;
    for (size_t i = 0; i < 2 * FLOATS; i++)
        sum += (double)near[i];
    assert_true(sum > 1.0);
    for (size_t i = 0; i < sizeof away / sizeof away[0]; i++) {
        write_scene(l, "far.cfg", "room.obj", 0.0, away[i]);
        play(l, "far.cfg", far);
        assert_memory_equal(near, far, sizeof near);
    }
}

static void says(scene_lab *l, const char *scene, const char *text, bool wanted) {
    char line[256];
    (void)snprintf(line, sizeof line, "%s -o %s --no-check --device host", scene_lab_path(l, scene),
                   scene_lab_path(l, "scene.vit"));
    scene_lab_run(l, "vitrine-bake", line);
    if (scene_lab_said(l, text) != wanted)
        fail_msg("%s: %s'%s'", scene, wanted ? "no " : "", text);
}

static void numbers_far_from_0_in_a_file_are_worth_a_warning(void **state) {
    scene_lab *l = *state;
    scene_lab_write_room(l, "room.obj", half, 0.0);
    scene_lab_write_room(l, "away.obj", half, 4096.0);
    write_scene(l, "near.cfg", "room.obj", 0.0, 0.0);
    write_scene(l, "far.cfg", "away.obj", 4096.0, 4096.0);
    says(l, "near.cfg", "warning", false);
    says(l, "near.cfg", "moved by", false);
    says(l, "far.cfg", "moved by", true);
    says(l, "far.cfg", "warning: positions in the mesh files", true);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scene_far_away_has_the_bits_that_it_has_at_the_origin),
        cmocka_unit_test(numbers_far_from_0_in_a_file_are_worth_a_warning),
    };
    return cmocka_run_group_tests_name("far scenes", tests, scene_lab_set_up, scene_lab_tear_down);
}
