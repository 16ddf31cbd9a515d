/* The scene file's settings for effects: ambient light, sky, directional lights, mirrors, glass, lobes, anti-aliasing. What is
 * hard, and the strategy, are as in test_scene.c: one scene in which no setting has its default, and one scene a mistake. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/scene_effects_files"
#include "pack/copies.h"
#include "scene/scene.h"
#include "test_folder.h"
#include <math.h>

#define NAME FOLDER "/test.cfg"
#define GOOD                                                                                                                   \
    "meshes = ( { file = \"a.obj\"; } );\n"                                                                                    \
    "camera: { keys = ( { eye = (0, 1, 3); target = (0, 1, 0); } ); };\n"
#define SUN(more, keys) GOOD "lights = ( { type = \"directional\"; " more "keys = ( { " keys " } ); } );\n"
#define AIMED "position = (0, 1, 0); target = (0, 0, 0); "
#define MATERIAL(text) GOOD "materials = ( { name = \"m\"; " text "} );\n"
#define QUALITY(text) GOOD "quality: { " text " };\n"

static vit_status read_text(const char *text, scene *s, vit_text *why) {
    put(NAME, text);
    *why = (vit_text){{0}};
    return scene_read(NAME, s, why);
}

static void read_good(const char *text, scene *s) {
    vit_text why;
    const vit_status status = read_text(text, s, &why);
    if (status != VIT_OK)
        print_error("%s\n", why.text);
    assert_int_equal(status, VIT_OK);
}

/* Line 3 is refused, and the error holds `what`. */
static void refuse(const char *text, const char *what) {
    scene s;
    vit_text why;
    assert_int_equal(read_text(text, &s, &why), VIT_BAD_INPUT);
    if (strncmp(why.text, NAME ":3: ", sizeof NAME ":3: " - 1) != 0 || !strstr(why.text, what))
        print_error("expected '%s', got '%s'\n", what, why.text);
    assert_int_equal(strncmp(why.text, NAME ":3: ", sizeof NAME ":3: " - 1), 0);
    assert_non_null(strstr(why.text, what));
}

#define REFUSES(name, what, text)                                                                                              \
    static void name(void **state) {                                                                                           \
        (void)state;                                                                                                           \
        refuse(text, what);                                                                                                    \
    }

static bool is(const double got[3], double x, double y, double z) {
    return fabs(got[0] - x) < 1e-12 && fabs(got[1] - y) < 1e-12 && fabs(got[2] - z) < 1e-12;
}

/* ---- good scenes ---- */

static void every_setting_is_read(void **state) {
    scene s;
    (void)state;
    read_good(
        GOOD
        "ambient = [0.02, 0.03, 0.04];\n"
        "sky: { image = \"sky.hdr\"; scale = 2.5; rotate = -90; light = false; };\n"
        "lights = ( { type = \"directional\"; photons = false; keys = ( { " AIMED "irradiance = (1, 2, 3); },\n"
        "  { time = 1; target = (1, 0, 0); } ); } );\n"
        "materials = ( { name = \"a\"; kind = \"mirror\"; specular = (0.9, 0.8, 0.7); },\n"
        "  { name = \"b\"; kind = \"glass\"; specular = (0.5, 0.5, 1); ior = 1.33; absorption = [0.5, 0.25, 0.0]; },\n"
        "  { name = \"c\"; kind = \"thin_glass\"; }, { name = \"d\"; kind = \"matt\"; exponent = 80; area_light = false; }, "
        "{ name = \"e\"; roughness = 0.5; } );\n"
        "quality: { antialias = 8; antialias_contrast = 0.25; antialias_filter = \"tent\"; light_samples = 64;\n"
        "  sky_samples = 32; specular_depth = 5; lobe = \"ggx\"; gloss_rays = 6; caustics = false; };\n",
        &s);
    assert_true(is(s.ambient, 0.02, 0.03, 0.04));
    assert_string_equal(s.sky.image, FOLDER "/sky.hdr");
    assert_true(s.sky.scale == 2.5 && s.sky.rotate == -90.0 && !s.sky.light);
    assert_true(s.lights[0].kind == VIT_LIGHT_DIRECTIONAL && !s.lights[0].photons && s.lights[0].key_count == 2);
    assert_true(is(s.lights[0].keys[1].power, 1, 2, 3) && is(s.lights[0].keys[1].target, 1, 0, 0));
    const scene_material *m = s.materials;
    assert_true(m[0].has_kind && m[0].kind == VIT_MIRROR && m[0].has_specular && is(m[0].specular, 0.9, 0.8, 0.7));
    assert_true(!m[0].has_ior && !m[0].has_exponent && !m[0].has_absorption && !m[0].has_area_light);
    assert_true(m[1].kind == VIT_GLASS && m[1].has_ior && m[1].ior == 1.33 && m[1].has_absorption &&
                is(m[1].absorption, 0.5, 0.25, 0));
    assert_true(m[2].kind == VIT_THIN_GLASS && m[3].has_kind && m[3].kind == VIT_MATTE && m[3].has_exponent &&
                m[3].exponent == 80.0);
    assert_true(m[3].has_area_light && !m[3].area_light && !m[4].has_kind && !m[3].has_roughness);
    assert_true(m[4].has_roughness && m[4].roughness == 0.5);
    const scene_quality *q = &s.quality;
    assert_true(q->antialias == 8 && q->antialias_contrast == 0.25 && q->tent && q->light_samples == 64 &&
                q->sky_samples == 32);
    assert_true(q->specular_depth == 5 && q->ggx && q->gloss_rays == 6 && !q->caustics);
    scene_free(&s);
}

static void what_is_left_out_has_its_default(void **state) {
    scene s;
    (void)state;
    read_good(GOOD, &s);
    assert_true(is(s.ambient, 0, 0, 0) && !s.sky.image[0] && s.sky.scale == 1.0 && s.sky.rotate == 0.0 && !s.sky.light);
    const scene_quality *q = &s.quality;
    assert_true(q->antialias == 1 && q->antialias_contrast == 0.06 && !q->tent && q->light_samples == 16 &&
                q->sky_samples == 8);
    assert_true(q->specular_depth == 8 && q->caustics);
    scene_free(&s);
}

static void a_sky_lights_if_it_has_an_image_or_is_asked_to(void **state) {
    scene s;
    (void)state;
    read_good(GOOD "sky: { image = \"a.png\"; };\n", &s);
    assert_true(s.sky.light);
    scene_free(&s);
    read_good(GOOD "background = (1, 1, 1); sky: { };\n", &s);
    assert_false(s.sky.light);
    scene_free(&s);
    read_good(GOOD "sky: { light = true; }; background = (0, 0, 1);\n", &s);
    assert_true(s.sky.light);
    scene_free(&s);
}

static void settings_come_back_from_their_own_text(void **state) {
    static const char wish[] =
        "antialias = 16; antialias_contrast = 0.1; antialias_filter = \"tent\"; light_samples = 1024; "
        "sky_samples = 1; specular_depth = 32; caustics = false; kernel = \"flattened\"; flatten = 0.012345678901234567; "
        "radius = 0.12345678901234567; texture_filter = \"trilinear\"; estimate = \"buckets\"; smoothing = \"interpolated\";";
    char text[SCENE_QUALITY], again[SCENE_QUALITY];
    vit_text why;
    scene s;
    (void)state;
    read_good(GOOD, &s);
    scene_quality q = s.quality, back = s.quality;
    assert_int_equal(scene_quality_apply(wish, &q, &why), VIT_OK);
    scene_quality_text(&q, text, sizeof text);
    assert_true(strlen(text) + 100 < sizeof text); /* not cut off */
    assert_int_equal(scene_quality_apply(text, &back, &why), VIT_OK);
    scene_quality_text(&back, again, sizeof again);
    assert_string_equal(text, again);
    assert_true(back.antialias == 16 && back.antialias_contrast == 0.1 && back.tent && back.light_samples == 1024);
    assert_true(back.sky_samples == 1 && back.specular_depth == 32 && !back.caustics);
    scene_free(&s);
}

/* ---- bad scenes ---- */

REFUSES(negative_ambient_light_is_refused, "'ambient' must have its numbers in [0, 1e9], got -1",
        GOOD "ambient = (0, -1, 0);\n")
REFUSES(a_sky_that_is_no_group_is_refused, "sky: must be a group", GOOD "sky = \"a.hdr\";\n")
REFUSES(an_unknown_setting_of_the_sky_is_refused, "sky: unknown setting 'file'", GOOD "sky: { file = \"a.hdr\"; };\n")
REFUSES(a_scale_without_an_image_is_refused, "are for an 'image'", GOOD "sky: { scale = 2.0; };\n")
REFUSES(a_turn_without_an_image_is_refused, "are for an 'image'", GOOD "background = (1, 1, 1); sky: { rotate = 2.0; };\n")
REFUSES(a_negative_scale_of_the_sky_is_refused, "'scale' must be in [0, 1e6]",
        GOOD "sky: { image = \"a.hdr\"; scale = -1; };\n")
REFUSES(a_turn_by_more_than_a_circle_is_refused, "'rotate' must be in [-360, 360]",
        GOOD "sky: { image = \"a\"; rotate = 361; };\n")
REFUSES(light_of_a_black_sky_is_refused, "'light' needs an 'image'", GOOD "sky: { light = true; };\n")
REFUSES(light_that_is_no_switch_is_refused, "true or false", GOOD "sky: { image = \"a.hdr\"; light = 1; };\n")

REFUSES(a_directional_light_without_irradiance_is_refused, "light 1, key 1: the first key needs 'position' and 'irradiance'",
        SUN("", AIMED))
REFUSES(a_directional_light_without_a_target_is_refused, "of a directional light needs a 'target'",
        SUN("", "position = (0, 1, 0); irradiance = (1, 1, 1);"))
REFUSES(a_directional_light_with_power_is_refused, "'power' is for point and spot lights", SUN("", AIMED "power = (1, 1, 1);"))
REFUSES(a_directional_light_that_looks_at_itself_is_refused, "the same point",
        SUN("", "position = (0, 1, 0); target = (0, 1, 0); irradiance = (1, 1, 1);"))
REFUSES(a_directional_light_with_a_cone_is_refused, "are for spot lights", SUN("outer = 20; ", AIMED "irradiance = (1, 1, 1);"))
REFUSES(a_directional_light_with_a_range_is_refused, "'range' and 'falloff' are for point and spot lights",
        SUN("range = 20; ", AIMED "irradiance = (1, 1, 1);"))
REFUSES(negative_irradiance_is_refused, "'irradiance' must have its numbers in", SUN("", AIMED "irradiance = (1, -1, 1);"))
REFUSES(a_point_light_with_irradiance_is_refused, "'irradiance' is for directional lights",
        GOOD "lights = ( { type = \"point\"; keys = ( { position = (0, 1, 0); irradiance = (1, 1, 1); } ); } );\n")

REFUSES(an_unknown_kind_is_refused, "'kind' must be \"matt\", \"mirror\", \"glass\" or \"thin_glass\", got \"metal\"",
        MATERIAL("kind = \"metal\"; "))
REFUSES(a_reflectance_above_1_is_refused, "'specular' must have its numbers in [0, 1], got 1.5",
        MATERIAL("specular = (0, 1.5, 0); "))
REFUSES(an_exponent_below_1_is_refused, "'exponent' must be in [1, 1e4], got 0.5", MATERIAL("exponent = 0.5; "))
REFUSES(an_exponent_above_10000_is_refused, "'exponent' must be in [1, 1e4]", MATERIAL("exponent = 10001; "))
REFUSES(a_roughness_above_1_is_refused, "'roughness' must be in [0, 1], got 1.5", MATERIAL("roughness = 1.5; "))
REFUSES(a_roughness_below_0_is_refused, "'roughness' must be in [0, 1], got -0.1", MATERIAL("roughness = -0.1; "))
REFUSES(a_mirror_with_a_roughness_is_refused, "'roughness' does nothing for this 'kind'",
        MATERIAL("kind = \"mirror\"; roughness = 0.1; "))
REFUSES(two_lobes_are_refused, "'exponent' is of a Phong lobe and 'roughness' of a GGX one: state either",
        MATERIAL("exponent = 10; roughness = 0.1; "))
REFUSES(an_index_of_refraction_below_1_is_refused, "'ior' must be in [1, 10], got 0.9", MATERIAL("ior = 0.9; "))
REFUSES(negative_absorption_is_refused, "'absorption' must have its numbers in",
        MATERIAL("kind = \"glass\"; absorption = (0, 0, -1); "))
REFUSES(a_mirror_with_a_colour_is_refused, "'color' does nothing for this 'kind'",
        MATERIAL("kind = \"mirror\"; color = (1, 1, 1); "))
REFUSES(a_mirror_with_an_exponent_is_refused, "'exponent' does nothing for this 'kind'",
        MATERIAL("kind = \"mirror\"; exponent = 10; "))
REFUSES(a_mirror_with_an_index_is_refused, "'ior' does nothing for this 'kind'", MATERIAL("kind = \"mirror\"; ior = 1.5; "))
REFUSES(glass_that_emits_is_refused, "'emission' does nothing for this 'kind'",
        MATERIAL("kind = \"glass\"; emission = (1, 1, 1); "))
REFUSES(a_pane_that_absorbs_is_refused, "'absorption' does nothing",
        MATERIAL("kind = \"thin_glass\"; absorption = (1, 1, 1); "))
REFUSES(a_mirror_that_is_an_area_light_is_refused, "'area_light' does nothing",
        MATERIAL("kind = \"mirror\"; area_light = true; "))
REFUSES(a_matt_material_with_an_index_is_refused, "'ior' does nothing", MATERIAL("kind = \"matt\"; ior = 1.5; "))

REFUSES(three_samples_a_pixel_are_refused, "'antialias' must be 1, 2, 4, 8 or 16, got 3", QUALITY("antialias = 3;"))
REFUSES(a_contrast_above_1_is_refused, "'antialias_contrast' must be in [0, 1], got 2", QUALITY("antialias_contrast = 2;"))
REFUSES(an_unknown_filter_is_refused, "'antialias_filter' must be \"box\" or \"tent\"",
        QUALITY("antialias_filter = \"gauss\";"))
REFUSES(no_samples_of_area_lights_are_refused, "'light_samples' must be in [1, 1024], got 0", QUALITY("light_samples = 0;"))
REFUSES(too_many_samples_of_the_sky_are_refused, "'sky_samples' must be in [1, 1024], got 1025", QUALITY("sky_samples = 1025;"))
REFUSES(too_many_rays_of_lobes_are_refused, "'gloss_rays' must be in [0, 64], got 65", QUALITY("gloss_rays = 65;"))
REFUSES(chains_of_0_are_refused, "'specular_depth' must be in [1, 32], got 0", QUALITY("specular_depth = 0;"))
REFUSES(caustics_that_are_no_switch_are_refused, "'caustics' must be true or false", QUALITY("caustics = 1;"))

/* ---- places of anti-aliasing's samples ---- */

static void copies_spread_over_the_pixel(void **state) {
    (void)state;
    for (uint32_t n = 1; n <= VIT_MAX_COPIES; n *= 2) {
        float at[VIT_MAX_COPIES][2];
        double mean[2] = {0, 0};
        uint32_t columns = 0, rows = 0;
        copies_place(n, false, at);
        for (uint32_t i = 0; i < n; i++) {
            for (int k = 0; k < 2; k++) {
                assert_true(fabsf(at[i][k]) <= 0.5f);
                mean[k] += (double)at[i][k] / n;
            }
            columns |= 1u << (int)((at[i][0] + 0.5f) * (float)n);
            rows |= 1u << (int)((at[i][1] + 0.5f) * (float)n);
            assert_true(hypotf(at[i][0], at[i][1]) >= hypotf(at[0][0], at[0][1]));
        }
        assert_true(columns == (1u << n) - 1 && rows == columns); /* one in each */
        assert_true(fabs(mean[0]) < 1e-7 && fabs(mean[1]) < 1e-7);
        for (uint32_t i = n; i < VIT_MAX_COPIES; i++)
            assert_true(at[i][0] == 0.0f && at[i][1] == 0.0f);
    }
}

/* Root mean square, over straight edges of all directions and places, of the part of the pixel on one side of the edge less the
 * part of the samples. */
static double edge_error(uint32_t n, float at[VIT_MAX_COPIES][2]) {
    enum { DIRECTIONS = 64, PLACES = 256, DENSE = 64 };
    double squares = 0;
    for (int i = 0; i < DIRECTIONS; i++) {
        const double turn = (i + 0.5) * 3.14159265358979 / DIRECTIONS, x = cos(turn), y = sin(turn);
        int area[PLACES + 1] = {0}, count[PLACES + 1] = {0}; /* before each place of the edge, those since the one before */
        for (int k = 0; k < DENSE * DENSE; k++) {
            const double p = ((k % DENSE + 0.5) / DENSE - 0.5) * x + ((k / DENSE + 0.5) / DENSE - 0.5) * y;
            area[(int)((p / 1.4143 + 0.5) * PLACES)]++;
        }
        for (uint32_t k = 0; k < n; k++)
            count[(int)(((at[k][0] * x + at[k][1] * y) / 1.4143 + 0.5) * PLACES)]++;
        double pixel = 0, samples = 0;
        for (int k = 0; k < PLACES; k++) {
            pixel += area[k] / (double)(DENSE * DENSE);
            samples += count[k] / (double)n;
            squares += (pixel - samples) * (pixel - samples) / (DIRECTIONS * PLACES);
        }
    }
    return sqrt(squares);
}

static void sixteen_copies_are_a_net_that_shows_edges_best(void **state) {
    float at[VIT_MAX_COPIES][2];
    (void)state;
    copies_place(16, false, at);
    for (int wide = 0; wide <= 4; wide++) { /* one in each part of 2^-wide by 2^(wide - 4) */
        uint32_t parts = 0;
        for (int i = 0; i < 16; i++)
            parts |=
                1u << ((int)((at[i][1] + 0.5f) * (float)(16 >> wide)) << wide | (int)((at[i][0] + 0.5f) * (float)(1 << wide)));
        assert_true(parts == 0xffff);
    }
    print_message("rms error of edges: %.5f of a pixel\n", edge_error(16, at));
    assert_true(edge_error(16, at) < 0.031); /* Direct3D's 16: 0.0332 */
}

/* Of n places, the fraction left of x is what a tent has of its area there, but for a place. */
static void a_tents_copies_lie_as_its_weight_does(void **state) {
    float at[VIT_MAX_COPIES][2], box[VIT_MAX_COPIES][2];
    (void)state;
    copies_place(1, true, at);
    assert_true(at[0][0] == 0.0f && at[0][1] == 0.0f);
    copies_place(16, true, at);
    copies_place(16, false, box);
    for (int k = 0; k < 2; k++) {
        double mean = 0, square = 0;
        for (int i = 0; i < 16; i++) {
            const double x = (double)at[i][k], left = x < 0 ? 0.5 * (1 + x) * (1 + x) : 1 - 0.5 * (1 - x) * (1 - x);
            assert_true(fabs(x) < 1 && fabs(left - ((double)box[i][k] + 0.5)) < 1e-6);
            mean += x / 16;
            square += x * x / 16;
        }
        assert_true(fabs(mean) < 1e-6 && fabs(square - 1.0 / 6) < 0.01); /* a tent's variance */
    }
}

int main(void) {
#define T(name) cmocka_unit_test(name)
    const struct CMUnitTest tests[] = {
        T(every_setting_is_read),
        T(what_is_left_out_has_its_default),
        T(a_sky_lights_if_it_has_an_image_or_is_asked_to),
        T(settings_come_back_from_their_own_text),
        T(negative_ambient_light_is_refused),
        T(a_sky_that_is_no_group_is_refused),
        T(an_unknown_setting_of_the_sky_is_refused),
        T(a_scale_without_an_image_is_refused),
        T(a_turn_without_an_image_is_refused),
        T(a_negative_scale_of_the_sky_is_refused),
        T(a_turn_by_more_than_a_circle_is_refused),
        T(light_of_a_black_sky_is_refused),
        T(light_that_is_no_switch_is_refused),
        T(a_directional_light_without_irradiance_is_refused),
        T(a_directional_light_without_a_target_is_refused),
        T(a_directional_light_with_power_is_refused),
        T(a_directional_light_that_looks_at_itself_is_refused),
        T(a_directional_light_with_a_cone_is_refused),
        T(a_directional_light_with_a_range_is_refused),
        T(negative_irradiance_is_refused),
        T(a_point_light_with_irradiance_is_refused),
        T(an_unknown_kind_is_refused),
        T(a_reflectance_above_1_is_refused),
        T(an_exponent_below_1_is_refused),
        T(an_exponent_above_10000_is_refused),
        T(an_index_of_refraction_below_1_is_refused),
        T(negative_absorption_is_refused),
        T(a_mirror_with_a_colour_is_refused),
        T(a_mirror_with_an_exponent_is_refused),
        T(a_roughness_above_1_is_refused),
        T(a_roughness_below_0_is_refused),
        T(a_mirror_with_a_roughness_is_refused),
        T(two_lobes_are_refused),
        T(a_mirror_with_an_index_is_refused),
        T(glass_that_emits_is_refused),
        T(a_pane_that_absorbs_is_refused),
        T(a_mirror_that_is_an_area_light_is_refused),
        T(a_matt_material_with_an_index_is_refused),
        T(three_samples_a_pixel_are_refused),
        T(a_contrast_above_1_is_refused),
        T(an_unknown_filter_is_refused),
        T(no_samples_of_area_lights_are_refused),
        T(too_many_samples_of_the_sky_are_refused),
        T(too_many_rays_of_lobes_are_refused),
        T(chains_of_0_are_refused),
        T(caustics_that_are_no_switch_are_refused),
        T(copies_spread_over_the_pixel),
        T(sixteen_copies_are_a_net_that_shows_edges_best),
        T(a_tents_copies_lie_as_its_weight_does),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
