/* Lines through measured points, against points made from a known law; and which settings are played. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include "cost/converge.h"
#include "cost/knobs.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void a_power_law_is_found(void **state) {
    double x[6], y[6];
    (void)state;
    for (int i = 0; i < 6; i++) {
        x[i] = 100 * pow(3, i);
        y[i] = 2.5 * pow(x[i], -0.4);
    }
    const converge_line l = converge_fit(x, y, 6);
    assert_int_equal(l.points, 6);
    assert_true(fabs(l.slope + 0.4) < 1e-12 && l.slope_error < 1e-12 && fabs(l.at_one - 2.5) < 1e-10);
}

/* Four points at log x = -1.5, -0.5, 0.5, 1.5 and log y = 1, -1, -1, 1: no slope, squared residuals 4 over 2 degrees of freedom
 * and sum of squares 5. */
static void its_standard_error_is_that_of_the_residuals(void **state) {
    const double x[4] = {exp(-1.5), exp(-0.5), exp(0.5), exp(1.5)}, y[4] = {exp(1), exp(-1), exp(-1), exp(1)};
    (void)state;
    const converge_line l = converge_fit(x, y, 4);
    assert_true(fabs(l.slope) < 1e-12 && fabs(l.slope_error - sqrt(2.0 / 5)) < 1e-12 && fabs(l.at_one - 1) < 1e-12);
}

static void what_has_no_logarithm_is_left_out(void **state) {
    const double x[5] = {1, 10, 100, 1000, 0}, y[5] = {1, -2, 0.01, 0.001, 7}, few[3] = {1, 0, -1}, same[3] = {2, 2, 2};
    (void)state;
    const converge_line l = converge_fit(x, y, 5);
    assert_int_equal(l.points, 3);
    assert_true(fabs(l.slope + 1) < 1e-12);
    assert_true(isnan(converge_fit(same, x, 3).slope));
    assert_true(isnan(converge_fit(x, few, 3).slope) && isnan(converge_fit(x, few, 3).at_one));
}

static void check_list(int photons, uint32_t steps, uint32_t own) {
    const scene_quality base = {.photons = photons,
                                .bounces = 4,
                                .radius = 0,
                                .tile = 16,
                                .buckets = true,
                                .raw = true,
                                .indirect_samples = 4,
                                .zones = true};
    const converge_plan how = {steps, 0.25};
    knob_list l;
    vit_text why = {""};
    assert_int_equal(converge_list(&how, &base, 0.5, &l, &why), VIT_OK);
    assert_int_equal(l.count, 2 * steps);
    assert_int_equal(l.settings[own].quality.photons, photons);
    assert_true(fabs(l.settings[own].quality.radius - 0.5) < 1e-12);
    for (uint32_t i = 0; i < steps; i++) {
        const scene_quality *q = &l.settings[i].quality, *partner = &l.settings[steps + i].quality;
        assert_true(q->photons <= CONVERGE_MOST_PATHS && partner->photons <= CONVERGE_MOST_PATHS);
        assert_false(q->buckets || q->raw);
        assert_true(q->zones && q->indirect_samples == 1 && q->tile == 16);
        assert_true(partner->radius == q->radius && partner->photons != q->photons);
        assert_true(partner->bounce_sequence != q->bounce_sequence);
        assert_string_not_equal(l.settings[i].name, l.settings[steps + i].name);
        if (i > 0) {
            assert_true(fabs(q->photons / (double)l.settings[i - 1].quality.photons - CONVERGE_GROWTH) < 0.05);
            assert_true(fabs(q->radius / l.settings[i - 1].quality.radius - pow(CONVERGE_GROWTH, -how.shrink)) < 1e-12);
        }
    }
    knobs_close(&l);
}

static void the_scenes_own_setting_is_among_the_steps(void **state) {
    (void)state;
    check_list(17000, 6, 3);
    check_list(17000, 5, 2);
    check_list(40000, 6, 3);
    check_list(200000, 6, 4);
    check_list(900000, 6, 5);
}

static void a_scene_without_indirect_light_has_nothing_to_converge(void **state) {
    const scene_quality none = {.photons = 0, .bounces = 4}, direct = {.photons = 1000, .bounces = 1};
    const converge_plan how = {5, CONVERGE_SHRINK};
    knob_list l;
    vit_text why = {""};
    (void)state;
    assert_int_equal(converge_list(&how, &none, 0.5, &l, &why), VIT_BAD_INPUT);
    assert_non_null(strstr(why.text, "no indirect light"));
    assert_int_equal(converge_list(&how, &direct, 0.5, &l, &why), VIT_BAD_INPUT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_power_law_is_found),
        cmocka_unit_test(its_standard_error_is_that_of_the_residuals),
        cmocka_unit_test(what_has_no_logarithm_is_left_out),
        cmocka_unit_test(the_scenes_own_setting_is_among_the_steps),
        cmocka_unit_test(a_scene_without_indirect_light_has_nothing_to_converge),
    };
    return cmocka_run_group_tests_name("converge", tests, NULL, NULL);
}
