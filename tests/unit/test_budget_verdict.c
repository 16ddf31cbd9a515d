/* Which frame a time budget is held to, and what is said about it.
 *
 * Strategy: the player's own functions on columns of times that are written here, and on counters of a machine that is not
 * there: nothing is measured. */
#include "../../runtime/play/budget.h"
#include "../../runtime/play/machine_load.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>
#include <cmocka.h>

enum { FRAMES = 20 };

static vit_text noise, why;

/* 18 frames of 10 ms and two of `slow`. */
static vit_status check(double allowed, unsigned asked, double others, double slow) {
    static vit_requirements need = {.pass_count = 1, .passes = {"resolve"}};
    double memory[3 * FRAMES];
    for (int i = 0; i < 3 * FRAMES; i++)
        memory[i] = i % FRAMES < 2 ? slow : 10;
    const report r = {.passes = 1,
                      .room = FRAMES,
                      .frames = FRAMES,
                      .frame_ms = memory,
                      .sorted = memory + FRAMES,
                      .pass_ms = memory + 2 * FRAMES};
    const budget b = {.frame_ms = allowed};
    memset(&noise, 0, sizeof noise);
    memset(&why, 0, sizeof why);
    return budget_check(&b, asked, others, &r, &need, &noise, &why);
}

static void on_a_quiet_machine_slow_frames_decide(void **state) {
    (void)state;
    assert_int_equal(check(15, 0, 0.02, 30), VIT_BUDGET);
    assert_non_null(strstr(why.text, "frame p95 30.000 ms, 15 allowed"));
    assert_non_null(strstr(why.text, "budget by p95: frame p50 10.000, p95 30.000, max 30.000 ms, 2 of 20 frames over"));
    assert_non_null(strstr(why.text, "noisy: p95 is 3.00 times p50"));
    assert_int_equal(check(15, 0, -1, 30), VIT_BUDGET); /* nobody knows */
    assert_null(strstr(why.text, "other programs"));
}

static void on_a_busy_machine_the_median_decides_and_it_is_told(void **state) {
    (void)state;
    assert_int_equal(check(15, 0, 0.4, 30), VIT_OK);
    assert_non_null(strstr(noise.text, "budget by p50"));
    assert_non_null(strstr(noise.text, "other programs had 40 % of the processors, so the median decides"));
    assert_int_equal(check(9, 0, 0.4, 30), VIT_BUDGET);
    assert_non_null(strstr(why.text, "frame p50 10.000 ms, 9 allowed"));
}

static void whoever_asks_for_a_frame_gets_it(void **state) {
    (void)state;
    assert_int_equal(check(15, 95, 0.9, 30), VIT_BUDGET);
    assert_int_equal(check(15, 100, 0.9, 30), VIT_BUDGET);
    assert_int_equal(check(15, 50, 0, 30), VIT_OK);
    assert_null(strstr(noise.text, "so the median decides"));
}

static void steady_times_are_not_called_noisy(void **state) {
    (void)state;
    assert_int_equal(check(15, 0, 0, 11), VIT_OK);
    assert_null(strstr(noise.text, "noisy"));
    assert_non_null(strstr(noise.text, "0 of 20 frames over"));
}

static void the_load_is_what_others_had(void **state) {
    (void)state;
    const machine_load from = {.all = 1000, .busy = 400, .own = 50}, to = {.all = 1200, .busy = 520, .own = 130};
    assert_true(machine_load_others(&from, &to) == 40.0 / 200.0);
    assert_true(machine_load_others(&from, &from) < 0); /* no time has passed */
    const machine_load alone = {.all = 1200, .busy = 470, .own = 130}, none = {0};
    assert_true(machine_load_others(&from, &alone) == 0.0);
    assert_true(machine_load_others(&none, &none) < 0);
    assert_true(machine_load_others(&from, &none) < 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(on_a_quiet_machine_slow_frames_decide),
        cmocka_unit_test(on_a_busy_machine_the_median_decides_and_it_is_told),
        cmocka_unit_test(whoever_asks_for_a_frame_gets_it),
        cmocka_unit_test(steady_times_are_not_called_noisy),
        cmocka_unit_test(the_load_is_what_others_had),
    };
    return cmocka_run_group_tests_name("budget verdict", tests, NULL, NULL);
}
