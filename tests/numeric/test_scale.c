/* Scenes of all sizes and at all distances from the origin, against the same scene of 2.75 m at the origin.
 *
 * What can go wrong: constants in metres hidden in kernels or baker (a least distance, a near plane, the offset of rays),
 * powers that overflow or vanish, coordinates that are too far apart as floats. The bounds: nothing in the method knows metres,
 * so a power of two changes no bit, and any other scale no more than what the roundings of coordinates do; a scene that
 * `translate` puts far away is moved to the origin and loses nothing; numbers that are large in the mesh file itself have lost
 * their last bits there, before us. Where that shows the baker warns beforehand: the last point without a warning is held to a
 * bound. */
#include "catalogue.h"
#include "pack_sections.h"
#include "reference/reference.h"
#include "scene_lab.h"
#include "tool_run.h"
#include <math.h>

enum { SIDE = 48, FLOATS = 4 * SIDE * SIDE, DIRECT = 3 * SIDE * SIDE };

typedef struct frame {
    float pixels[FLOATS];
    bool warned;
} frame;

/* The room `size` times as large, `in_file` away in the mesh's own numbers and, with camera and light, `away` from the origin.
 * Power goes with the square of the size, so that radiance stays. */
static void render_with(scene_lab *l, const char *options, double size, double in_file, double away, frame *out) {
    const double half[3] = {1.125 * size, 0.875 * size, 1.375 * size};
    scene_lab_write_room(l, "room.obj", half, in_file);
    FILE *f = scene_lab_create(l, "scene.cfg");
    const double x = away + 0.25 * size, y = 0.0, z = away + 0.75 * size, power = 1e-3 * size * size;
    (void)fprintf(
        f,
        "output: { width = %d; height = %d; fps = 1.0; frames = 1; };\n"
        "meshes = ( { file = \"room.obj\"; translate = [%.17e, 0.0, %.17e]; } );\n"
        "camera: { near = %.17e; keys = ( { eye = [%.17e, %.17e, %.17e]; target = [%.17e, %.17e, %.17e]; fov = 70.0; "
        "exposure = 1.0; } ); };\n"
        "lights = ( { type = \"spot\"; inner = 40.0; outer = 60.0; keys = ( { position = [%.17e, %.17e, %.17e]; target = "
        "[%.17e, %.17e, %.17e]; power = [%.17e, %.17e, %.17e]; } ); } );\n"
        "quality: { photons = 2000; radius = %.17e; tile = 8; };\n",
        SIDE, SIDE, away - in_file, away - in_file, 0.125 * size, x, y, z, away - 0.5 * size, -0.25 * size, away - size, x,
        0.5 * size, z, away, -0.875 * size, away, 5 * power, 4 * power, 3 * power, 0.5 * size);
    (void)fclose(f);
    scene_lab_bake(l, "scene.cfg", options);
    out->warned = scene_lab_said(l, "warning:");
    scene_lab_play(l, "final", out->pixels, FLOATS);
}

static void render(scene_lab *l, double size, double in_file, double away, frame *out) {
    render_with(l, "", size, in_file, away, out);
}

/* Squared error over squared mean, of colour without alpha. */
static double nmse(const frame *a, const frame *truth) {
    double error = 0, sum = 0;
    for (size_t i = 0; i < FLOATS; i++) {
        if (i % 4 == 3)
            continue;
        const double d = (double)a->pixels[i] - (double)truth->pixels[i];
        error += isnan(d) ? INFINITY : d * d;
        sum += (double)truth->pixels[i];
    }
    return error / (FLOATS / 4 * 3) / pow(sum / (FLOATS / 4 * 3), 2);
}

static const frame *truth(scene_lab *l) {
    static frame whole;
    static bool made;
    if (!made)
        render(l, 1.0, 0.0, 0.0, &whole);
    made = true;
    assert_false(whole.warned);
    assert_true(isfinite(nmse(&whole, &whole)));
    return &whole;
}

static void a_scale_changes_the_frame_by_roundings_alone(void **state) {
    static frame f;
    static catalogue_point points[32];
    size_t count = 0;
    double worst = 0.0;
    for (int exponent = -8; exponent <= 5; exponent += catalogue_whole() ? 1 : 4) {
        const double size = pow(10.0, exponent);
        render(*state, size, 0.0, 0.0, &f);
        const double error = nmse(&f, truth(*state));
        points[count++] = (catalogue_point){2.75 * size, error};
        assert_false(f.warned);
        if (!(error <= worst))
            worst = error;
    }
    catalogue_sweep("scale", "size of the scene (m)", "NMSE against the same at 2.75 m", points, count);
    catalogue_row("scale", "powers of ten from 1e-8 to 1e5", worst, 3e-13, "NMSE");
}

/* The reference of the pack that render() made last: direct light, which leaves nothing to chance here, times exposure. */
static void render_reference(scene_lab *l, double direct[DIRECT]) {
    reference r;
    vit_text why = {""};
    void *pack = read_file(scene_lab_path(l, "scene.vit"), NULL);
    const pack_sections sections = pack_sections_of(pack);
    const reference_input in = {
        .sections = &sections, .every = 1, .bounces = 1, .target = 1.0, .max_samples = REFERENCE_ROUND, .threads = 1};
    if (reference_render(&in, &r, &why) != VIT_OK)
        fail_msg("reference_render: %s", why.text);
    memcpy(direct, r.direct, DIRECT * sizeof *direct);
    reference_free(&r);
    free(pack);
}

/* Squared difference over squared mean. */
static double apart(const double a[DIRECT], const double b[DIRECT]) {
    double error = 0, sum = 0;
    for (size_t i = 0; i < DIRECT; i++) {
        error += (a[i] - b[i]) * (a[i] - b[i]);
        sum += b[i];
    }
    return isfinite(error) ? error / DIRECT / pow(sum / DIRECT, 2) : INFINITY;
}

static void the_reference_has_the_same_light_at_every_scale(void **state) {
    static float played[FLOATS];
    static double whole[DIRECT], direct[DIRECT], frames[DIRECT];
    static frame f;
    double scales = 0, kernels = 0;
    for (int exponent = 0; exponent >= -24; exponent -= catalogue_whole() ? 4 : 8) {
        render(*state, exp2(exponent), 0.0, 0.0, &f);
        render_reference(*state, direct);
        scene_lab_play(*state, "direct", played, FLOATS);
        for (size_t i = 0; i < DIRECT; i++)
            frames[i] = (double)played[i / 3 * 4 + i % 3];
        if (exponent == 0)
            memcpy(whole, direct, sizeof whole);
        scales = fmax(scales, apart(direct, whole));
        kernels = fmax(kernels, apart(direct, frames));
    }
    render(*state, 1000.0, 0.0, 0.0, &f);
    render_reference(*state, direct);
    catalogue_row("scale", "reference, direct light: 2^-24 to 1 against itself at 1", scales, 0, "NMSE");
    catalogue_row("scale", "the same against the frame, whose albedos have 10 bits", kernels, 5e-6, "NMSE");
    catalogue_row("scale", "reference, direct light: 1000 against 1", apart(direct, whole), 1e-12, "NMSE");
}

static void a_power_of_two_changes_no_bit(void **state) {
    static frame f;
    uint64_t wrong = 0, count = 0;
    for (int exponent = -24; exponent <= 18; exponent += catalogue_whole() ? 2 : 14) {
        render(*state, exp2(exponent), 0.0, 0.0, &f);
        assert_false(f.warned);
        wrong += memcmp(f.pixels, truth(*state)->pixels, sizeof f.pixels) != 0;
        count++;
    }
    catalogue_none("scale", "powers of two that change a bit", wrong, count, "scales");
}

static void zones_areas_and_the_automatic_radius_follow_a_power_of_two(void **state) {
    static const char options[] = "--radius auto --zones 2 --effective-area 1";
    static frame plain, f;
    uint64_t wrong = 0, count = 0;
    render_with(*state, options, 1.0, 0.0, 0.0, &plain);
    for (int exponent = -24; exponent <= 18; exponent += catalogue_whole() ? 6 : 42, count++) {
        render_with(*state, options, exp2(exponent), 0.0, 0.0, &f);
        wrong += memcmp(f.pixels, plain.pixels, sizeof f.pixels) != 0;
    }
    catalogue_none("scale", "the same with zones; areas; automatic radius", wrong, count, "scales");
}

static void distance_from_the_origin_changes_no_bit(void **state) {
    static frame f;
    static catalogue_point moved[32], in_file[32];
    size_t count = 0;
    uint64_t wrong = 0;
    double worst = 0.0;
    for (int exponent = 2; exponent <= 19; exponent += catalogue_whole() ? 1 : 6) {
        const double away = exp2(exponent);
        render(*state, 1.0, 0.0, away, &f);
        moved[count] = (catalogue_point){away, nmse(&f, truth(*state))};
        wrong += memcmp(f.pixels, truth(*state)->pixels, sizeof f.pixels) != 0;
        render(*state, 1.0, away + 0.1, away, &f);
        in_file[count] = (catalogue_point){away, nmse(&f, truth(*state))};
        if (!f.warned && !(in_file[count].y <= worst))
            worst = in_file[count].y;
        count++;
    }
    catalogue_sweep("offset", "distance from the origin by translate (m)", "NMSE against the same at the origin", moved, count);
    catalogue_sweep("offset_in_file", "distance from 0 of the numbers in the mesh file (m)",
                    "NMSE against the same at the origin", in_file, count);
    catalogue_none("far away", "distances to 5e5 m by translate that change a bit", wrong, count, "distances");
    catalogue_row("far away", "the mesh file's own numbers far from 0; where nothing warns", worst, 3e-10, "NMSE");
}

/* Each number is within its own limits; at the least distance in a room of a micrometre they are more than a float holds. */
static void light_that_a_small_scene_cannot_hold_is_refused_by_the_baker(void **state) {
    static const double half[3] = {1e-6, 1e-6, 1e-6};
    static tool_run run;
    scene_lab *l = *state;
    scene_lab_write_room(l, "room.obj", half, 0.0);
    FILE *f = scene_lab_create(l, "bright.cfg");
    (void)fprintf(f, "output: { width = 8; height = 8; fps = 1.0; frames = 1; };\n"
                     "meshes = ( { file = \"room.obj\"; } );\n"
                     "camera: { near = 1e-7; keys = ( { eye = [0.0, 0.0, 0.0]; target = [0.0, 0.0, -1e-6]; fov = 70.0; "
                     "exposure = 1e9; } ); };\n"
                     "lights = ( { type = \"point\"; keys = ( { position = [0.0, 0.0, -5e-7]; power = [1e9, 1e9, 1e9]; } ); "
                     "} );\n"
                     "quality: { photons = 0; };\n");
    (void)fclose(f);
    tool(&run, TOOL_BAKE " %s -o %s --quiet --no-check --device host", scene_lab_path(l, "bright.cfg"),
         scene_lab_path(l, "bright.vit"));
    tool_refuses(&run, "vitrine-bake", VIT_BAD_INPUT, "lights have to be weaker or the scene larger");
    assert_int_not_equal(access(scene_lab_path(l, "bright.vit"), F_OK), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scale_changes_the_frame_by_roundings_alone),
        cmocka_unit_test(the_reference_has_the_same_light_at_every_scale),
        cmocka_unit_test(light_that_a_small_scene_cannot_hold_is_refused_by_the_baker),
        cmocka_unit_test(a_power_of_two_changes_no_bit),
        cmocka_unit_test(zones_areas_and_the_automatic_radius_follow_a_power_of_two),
        cmocka_unit_test(distance_from_the_origin_changes_no_bit),
    };
    return cmocka_run_group_tests_name("scenes of all sizes, at all distances", tests, scene_lab_set_up, scene_lab_tear_down);
}
