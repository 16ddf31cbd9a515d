/* Bundles: at 8 and 16 lanes, 8 x 8 pixels go down the tree together, and nodes are skipped for all of them by bounds of their
 * rays (kernels/bundle.clh). At one lane each ray goes alone and by its own tests.
 *
 * A bound that is too tight loses hits only where a ray passes a box's edge by an ulp, which no demo scene need show. So there
 * are many small frames of wild cameras and lights: in the open and inside balls, next to surfaces, in their planes, along
 * axes, far away, with wide and narrow views. Every buffer after every pass must be that of one lane: the triangle and distance
 * of each pixel, and the light in it. */
#include "scene_lab.h"
#include "test_packs.h"

#define FRAMES 160

static uint32_t seed;

static double number(double lo, double hi) {
    seed = seed * 1664525u + 1013904223u;
    return lo + (hi - lo) * (double)(seed >> 8) / 16777216.0;
}

/* Some coordinates on whole numbers, where floor tiles have their edges and boxes their planes. */
static double coordinate(double reach) {
    const double x = number(-reach, reach);
    return number(0, 1) < 0.3 ? (double)(int)x : x;
}

static void write_keys(FILE *f, int light) {
    for (int i = 0; i < FRAMES; i++) {
        static const double reaches[] = {1.0, 3.0, 8.0, 40.0};
        const double reach = reaches[i % 4], x = coordinate(reach), y = i % 5 == 0 ? number(0.0, 1e-3) : number(0.0, reach),
                     z = coordinate(reach);
        double at[3] = {coordinate(4.0), number(0.0, 2.0), coordinate(4.0)};
        if (i % 7 == 0) { /* along an axis */
            at[0] = i % 2 ? x : at[0];
            at[1] = y;
            at[2] = i % 2 ? at[2] : z;
        }
        if (at[0] == x && at[2] == z)
            at[i % 2 ? 2 : 0] += 1.0;
        if (light)
            (void)fprintf(f, "%s{ time = %d.0; position = [%.9f, %.9f, %.9f]; power = [50.0, 40.0, 30.0]; }", i ? ", " : "", i,
                          x, y, z);
        else
            (void)fprintf(f, "%s{ time = %d.0; eye = [%.9f, %.9f, %.9f]; target = [%.9f, %.9f, %.9f]; fov = %.3f; }",
                          i ? ", " : "", i, x, y, z, at[0], at[1], at[2], i % 11 == 0 ? 2.0 : number(15.0, 120.0));
    }
}

static void write_scene(scene_lab *l, const char *mesh, uint32_t start, int lights) {
    char here[512];
    FILE *f = scene_lab_create(l, "wild.cfg");
    assert_non_null(getcwd(here, sizeof here));
    seed = start;
    (void)fprintf(f,
                  "output: { width = 76; height = 53; fps = 1.0; frames = %d; };\nmeshes = ( { file = \"%s/" TEST_SCENES
                  "/%s\"; } );\n",
                  FRAMES, here, mesh);
    (void)fprintf(f, "camera: { near = 0.001; keys = ( ");
    write_keys(f, 0);
    (void)fprintf(f, " ); };\nlights = ( ");
    for (int i = 0; i < lights; i++) {
        (void)fprintf(f, "%s{ type = \"point\"; keys = ( ", i ? ", " : "");
        write_keys(f, 1);
        (void)fprintf(f, " ); }");
    }
    (void)fprintf(f, " );\nquality: { photons = 0; tile = 8; };\n");
    (void)fclose(f);
}

/* What the trace prints: a line a pass and frame. */
static char *trace(scene_lab *l, const char *options) {
    char line[512];
    (void)snprintf(line, sizeof line, "%s --trace --quiet --device host %s", scene_lab_path(l, "scene.vit"), options);
    scene_lab_run(l, "vitrine-play", line);
    size_t size;
    char *text = read_file(scene_lab_path(l, "out.txt"), &size);
    assert_true(size > FRAMES * 40);
    return text;
}

static void assert_alike(scene_lab *l, const char *mesh, uint32_t start, int lights) {
    write_scene(l, mesh, start, lights);
    scene_lab_bake(l, "wild.cfg", "");
    char *alone = trace(l, "--lanes 1"), *eight = trace(l, "--lanes 8"), *sixteen = trace(l, "--lanes 16");
    assert_string_equal(alone, eight);
    assert_string_equal(alone, sixteen);
    free(alone);
    free(eight);
    free(sixteen);
}

static void wild_views_of_balls_are_those_of_rays_alone(void **state) {
    for (uint32_t start = 1; start <= 3; start++)
        assert_alike(*state, "balls.obj", start, 2);
}

static void wild_views_of_a_room_are_those_of_rays_alone(void **state) {
    assert_alike(*state, "cornell.obj", 7, 1);
}

static void wild_views_of_columns_and_cloth_are_those_of_rays_alone(void **state) {
    assert_alike(*state, "atrium.obj", 11, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wild_views_of_balls_are_those_of_rays_alone),
        cmocka_unit_test(wild_views_of_a_room_are_those_of_rays_alone),
        cmocka_unit_test(wild_views_of_columns_and_cloth_are_those_of_rays_alone),
    };
    return cmocka_run_group_tests_name("bundles", tests, scene_lab_set_up, scene_lab_tear_down);
}
