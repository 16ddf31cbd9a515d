/* Choosing a setting, on made-up results. Stated: the front holds what nothing beats (checked against a plain look at all pairs
 * over random results with ties); the choice is what an exhaustive look finds; a budget that nothing fits is refused with the
 * closest miss; work units are the documented sum; and a scene file's other bytes survive another quality block. */
#include "cost/fit.h"
#include "cost/pareto.h"
#include "cost/images.h"
#include "cost/rewrite.h"
#include "cost/timing.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { COUNT = 40 };

static cost_setting settings[COUNT];
static cost_results results = {.settings = settings, .work_count = 1, .work_names = {"pairs"}};

static uint32_t state;
static uint32_t random_below(uint32_t n) {
    state = state * 1664525u + 1013904223u;
    return (state >> 8) % n;
}

/* Few different values, so that ties abound. */
static void make(uint32_t seed, uint32_t count) {
    state = seed;
    memset(settings, 0, sizeof settings);
    results.count = count;
    for (uint32_t i = 0; i < count; i++) {
        cost_setting *s = &settings[i];
        (void)snprintf(s->name, sizeof s->name, "setting %u", i);
        s->ms = 1 + random_below(12);
        s->ms_p95 = s->ms + random_below(3);
        s->work = 100 + random_below(12);
        s->total.nmse = 0.01 * (1 + random_below(12));
        s->total.relmse = 0.01 * (1 + random_below(12));
        s->elsewhere = random_below(6) == 0;
    }
}

static bool dominated(uint32_t i, bool relmse) {
    for (uint32_t k = 0; k < results.count; k++) {
        const double mine = relmse ? settings[i].total.relmse : settings[i].total.nmse;
        const double other = relmse ? settings[k].total.relmse : settings[k].total.nmse;
        if (!settings[k].elsewhere && settings[k].ms <= settings[i].ms && other <= mine &&
            (settings[k].ms < settings[i].ms || other < mine))
            return true;
    }
    return false;
}

static void nothing_beats_what_is_on_the_front(void **unused) {
    (void)unused;
    for (uint32_t seed = 0; seed < 200; seed++) {
        make(seed, COUNT);
        pareto_mark(&results);
        for (uint32_t i = 0; i < COUNT; i++) {
            assert_false(settings[i].pareto && (settings[i].elsewhere || dominated(i, false)));
            assert_false(settings[i].pareto_relmse && (settings[i].elsewhere || dominated(i, true)));
            for (uint32_t k = 0; k < i && settings[i].pareto; k++) /* the first of equals alone */
                assert_false(settings[k].pareto && settings[k].ms == settings[i].ms &&
                             settings[k].total.nmse == settings[i].total.nmse);
            if (!settings[i].elsewhere && !dominated(i, false)) { /* on it, or the like of one before it */
                bool like = settings[i].pareto;
                for (uint32_t k = 0; k < i; k++)
                    like = like || (settings[k].pareto && settings[k].ms == settings[i].ms &&
                                    settings[k].total.nmse == settings[i].total.nmse);
                assert_true(like);
            }
        }
    }
}

/* The least error within the budget, then the least price, then the first: by looking at all. */
static uint32_t exhaustive(const fit_budget *b) {
    uint32_t best = results.count;
    for (uint32_t i = 0; i < results.count; i++) {
        const double price = b->work ? (double)settings[i].work : settings[i].ms_p95, most = b->work ? (double)b->work : b->ms;
        const double error = b->relmse ? settings[i].total.relmse : settings[i].total.nmse;
        if (settings[i].elsewhere || price > most)
            continue;
        if (best < results.count) {
            const double best_price = b->work ? (double)settings[best].work : settings[best].ms_p95;
            const double best_error = b->relmse ? settings[best].total.relmse : settings[best].total.nmse;
            if (error > best_error || (error == best_error && price >= best_price))
                continue;
        }
        best = i;
    }
    return best;
}

static void the_choice_is_what_an_exhaustive_look_finds(void **unused) {
    uint32_t refused = 0;
    (void)unused;
    for (uint32_t seed = 0; seed < 400; seed++) {
        vit_text why = {""};
        make(seed, 1 + seed % COUNT);
        const fit_budget b = {
            .ms = seed % 2 ? 0 : random_below(15), .work = seed % 2 ? 98 + random_below(14) : 0, .relmse = seed % 3 == 0};
        uint32_t chosen, want = exhaustive(&b);
        const vit_status status = fit_choose(&results, &b, &chosen, &why);
        assert_int_equal(status, want < results.count ? VIT_OK : VIT_BUDGET);
        assert_int_equal(chosen, want);
        assert_true((status == VIT_BUDGET) == (why.text[0] != '\0'));
        refused += status == VIT_BUDGET;
    }
    assert_in_range(refused, 10, 390);
}

static void what_misses_by_least_is_named(void **unused) {
    uint32_t chosen;
    vit_text why = {""};
    (void)unused;
    make(1, 3);
    for (uint32_t i = 0; i < 3; i++)
        settings[i] = (cost_setting){.ms_p95 = 20 + 5 * i, .work = 1000 + i, .total.nmse = 0.1};
    strcpy(settings[0].name, "quick");
    strcpy(settings[1].name, "slow");
    settings[2].elsewhere = true;
    settings[2].ms_p95 = 1;
    assert_int_equal(fit_choose(&results, &(fit_budget){.ms = 15}, &chosen, &why), VIT_BUDGET);
    assert_non_null(strstr(why.text, "'quick', takes 20.00 ms"));
    assert_non_null(strstr(why.text, "5.00 ms too long"));
    assert_int_equal(fit_choose(&results, &(fit_budget){.work = 990}, &chosen, &why), VIT_BUDGET);
    assert_non_null(strstr(why.text, "'quick', takes 1000, 10 too many"));
    results.work_count = 0;
    assert_int_equal(fit_choose(&results, &(fit_budget){.work = 990}, &chosen, &why), VIT_FAILED);
    results.work_count = 1;
}

static void work_units_are_the_weighted_sum_of_what_is_equal_everywhere(void **unused) {
    static const char *const names[] = {"evaluations", "bytes", "box_tests", "unheard_of"};
    vit_statistics s = {.pass_count = 2};
    const vit_statistics *counted = &s;
    (void)unused;
    s.pass_work[0][0] = 10;
    s.pass_work[1][0] = 1;
    const uint64_t evaluations = fit_work_units(counted->pass_work, counted->pass_count, names, 4);
    assert_true(evaluations > 0 && evaluations % 11 == 0);
    s.pass_work[0][1] = s.pass_work[1][1] = 7;    /* bytes of a pass that counts something else: read from caches */
    s.pass_work[0][2] = s.pass_work[0][3] = 1000; /* depends on the lane width; has no weight */
    s.pass_work[2][0] = 1000;                     /* no pass of this setting */
    assert_int_equal(fit_work_units(counted->pass_work, counted->pass_count, names, 4), evaluations);
    s.pass_count = 3;
    s.pass_work[2][0] = 0;
    s.pass_work[2][1] = 9; /* a pass that only moves bytes */
    assert_int_equal(fit_work_units(counted->pass_work, counted->pass_count, names, 4), evaluations + 9);
}

static void medians_percentiles_and_deviations_are_by_rank(void **unused) {
    double odd[] = {5, 1, 3}, even[] = {4, 1, 3, 2}, twenty[20], far[] = {1, 2, 3, 4, 100};
    (void)unused;
    for (int i = 0; i < 20; i++)
        twenty[i] = 20 - i;
    assert_true(timing_median(odd, 3) == 3 && timing_median(even, 4) == 2.5);
    assert_true(timing_percentile(twenty, 20, 95) == 19 && timing_percentile(twenty, 20, 100) == 20 &&
                timing_percentile(twenty, 20, 1) == 1);
    assert_true(timing_percentile(odd, 3, 95) == 5);
    assert_true(timing_deviation(far, 5) == 1); /* |1-3| |2-3| 0 |4-3| 97 */
}

static void a_grid_takes_the_pixels_that_the_reference_takes(void **unused) {
    const images_grid g = {.width = 10, .height = 7, .every = 3};
    float pixels[10 * 7 * 4], out[3 * 16];
    (void)unused;
    for (int i = 0; i < 10 * 7; i++)
        for (int k = 0; k < 4; k++)
            pixels[4 * i + k] = (float)(10 * i + k);
    assert_int_equal(images_across(&g), 3); /* pixels 1, 4, 7 */
    assert_int_equal(images_down(&g), 2);   /* rows 1, 4 */
    images_sample(&g, pixels, 10, 7, out);
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                assert_true(out[3 * (3 * j + i) + k] == (float)(10 * ((3 * j + 1) * 10 + 3 * i + 1) + k));
}

/* A plane of light stays a plane: the middle of a small picture's pixel is the same place in a large one. */
static void a_smaller_picture_is_shown_as_large(void **unused) {
    const images_grid g = {.width = 16, .height = 8, .every = 1};
    float pixels[8 * 4 * 4], out[3 * 16 * 8];
    (void)unused;
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 8; x++)
            for (int k = 0; k < 4; k++)
                pixels[4 * (8 * y + x) + k] = 3.0f * ((float)x + 0.5f) / 8 + ((float)y + 0.5f) / 4;
    images_sample(&g, pixels, 8, 4, out);
    for (int y = 1; y < 7; y++)
        for (int x = 1; x < 15; x++)
            assert_float_equal(out[3 * (16 * y + x)], 3.0f * ((float)x + 0.5f) / 16 + ((float)y + 0.5f) / 8, 1e-5f);
    assert_float_equal(out[0], 3.0f / 16 + 1.0f / 8, 1e-5f); /* the rim is clamped */
}

static void all_but_the_quality_block_stays_byte_for_byte(void **unused) {
    static const struct {
        const char *before, *after;
    } files[] = {
        {"name = \"x\";\nquality: { tile = 8; };\n# end\n", "name = \"x\";\nquality: { tile = 16; };\n# end\n"},
        {"quality = { }\nname = \"a\"", "quality = { tile = 16; }\nname = \"a\""},
        {"# quality: { tile = 8; };\nquality /* { */ :\n { // }\n tile = 8; };",
         "# quality: { tile = 8; };\nquality /* { */ :\n { tile = 16; };"},
        {"name = \"quality: { \\\" }\"; quality: { x = \"}\"; };", "name = \"quality: { \\\" }\"; quality: { tile = 16; };"},
        {"camera: { quality: { a = 1; }; };\nquality: { };\n", "camera: { quality: { a = 1; }; };\nquality: { tile = 16; };\n"},
        {"my_quality: { a = 1; };\n", "my_quality: { a = 1; };\nquality: { tile = 16; };\n"},
        {"name = \"x\"", "name = \"x\"\nquality: { tile = 16; };\n"},
        {"", "quality: { tile = 16; };\n"},
        {"quality = \"auto\"; # chosen\n", "quality = { tile = 16; }; # chosen\n"},
    };
    (void)unused;
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char *out = rewrite_text(files[i].before, "tile = 16; ");
        assert_non_null(out);
        assert_string_equal(out, files[i].after);
        char *again = rewrite_text(out, "tile = 16; ");
        assert_string_equal(again, out);
        free(again);
        free(out);
    }
    assert_null(rewrite_text("quality: { tile = 8;", "tile = 16; "));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_beats_what_is_on_the_front),
        cmocka_unit_test(the_choice_is_what_an_exhaustive_look_finds),
        cmocka_unit_test(what_misses_by_least_is_named),
        cmocka_unit_test(work_units_are_the_weighted_sum_of_what_is_equal_everywhere),
        cmocka_unit_test(medians_percentiles_and_deviations_are_by_rank),
        cmocka_unit_test(a_grid_takes_the_pixels_that_the_reference_takes),
        cmocka_unit_test(a_smaller_picture_is_shown_as_large),
        cmocka_unit_test(all_but_the_quality_block_stays_byte_for_byte),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
