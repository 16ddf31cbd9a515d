/* Small files that came out wrong once: light and materials as strangers' exporters write them, in folders of VITRINE_CASES or
 * ../shared/cases, baked and played by the real programs. The right values are worked out by hand beside each. Like files are
 * made by tests of their own (test_lamp_over_floor, test_import_materials, test_import_transparency), so that nothing is lost
 * where the folder is not at hand. */
#include "case_file.h"
#include "scene_lab.h"

#include <math.h>

enum { WIDTH = 64, HEIGHT = 36, WIDE = 240, HIGH = 135 }; /* pixels; the latter as the scene file of the highlights says */

static void bake_aloud(scene_lab *l, const char *file, const char *options) {
    char line[512];
    (void)snprintf(line, sizeof line, "%s -o %s --device host %s", file, scene_lab_path(l, "scene.vit"), options);
    scene_lab_run(l, "vitrine-bake", line);
}

static double middle(scene_lab *l, int width, int height) {
    static float pixels[4 * WIDE * HIGH];
    scene_lab_play(l, "final", pixels, (size_t)4 * (size_t)width * (size_t)height);
    return (double)pixels[4 * (height / 2 * width + width / 2)];
}

/* 5435.14 cd are 7.96 W/sr, two metres over a floor of 0.5: 7.96 * 0.5 / pi / 4 = 0.317. */
static void candela_of_a_blender_lamp(void **state) {
    const char *file = case_file("gltf-light-units/scene.cfg");
    if (!file)
        skip();
    bake_aloud(*state, file, "");
    assert_true(scene_lab_said(*state, "light 'Lamp': 5435.14 cd = 7.96 W/sr"));
    assert_true(fabs(middle(*state, WIDTH, HEIGHT) / 0.317 - 1.0) < 0.01);
}

/* A floor of 0.8, with and without two more materials. */
static void blenders_default_highlight(void **state) {
    double floor[2];
    for (int i = 0; i < 2; i++) {
        const char *file = case_file(i ? "obj-default-ks/m3.cfg" : "obj-default-ks/m1.cfg");
        if (!file)
            skip();
        bake_aloud(*state, file, "");
        assert_true(scene_lab_said(*state, "Ks 0.5, Ns 250: Blender"));
        floor[i] = middle(*state, WIDE, HIGH);
    }
    assert_true(fabs(floor[0] / 0.1152 - 1.0) < 0.01 && fabs(floor[1] / floor[0] - 1.0) < 0.001);
}

static void a_transparency_of_0(void **state) {
    const char *file = case_file("dae-transparency-zero/zero.dae");
    if (!file)
        skip();
    bake_aloud(*state, file, "--frames 1 --size 64x36 --photons 0");
    assert_true(scene_lab_said(*state, "warning: ") && scene_lab_said(*state, "'cutoff' of a material"));
    assert_true(middle(*state, WIDTH, HEIGHT) > 0.2); /* lit to show as 0.5, not the background's 0.1 */
}

static void an_orthographic_camera(void **state) {
    const char *file = case_file("gltf-small/ortho.cfg");
    if (!file)
        skip();
    bake_aloud(*state, file, "--frames 1 --size 64x36 --photons 0");
    assert_true(scene_lab_said(*state, "camera 'C' is orthographic"));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(candela_of_a_blender_lamp),
                                       cmocka_unit_test(blenders_default_highlight), cmocka_unit_test(a_transparency_of_0),
                                       cmocka_unit_test(an_orthographic_camera)};
    return cmocka_run_group_tests_name("cases of light and materials", tests, scene_lab_set_up, scene_lab_tear_down);
}
