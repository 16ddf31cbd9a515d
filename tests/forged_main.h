/* The end of a program that tests forged packs (unit/test_pack_forged*.c): a test for each fault and each limit, one for any
 * value of any word, and main(). Defined before it: FAULTS(X), LIMITS(X) as forged_pack.h has them, FORGED_KIND, the fixture,
 * FORGED_NAME, the group's name, and FORGED_TESTS, what else there is to run, each with a comma behind it. */
#ifndef VIT_TESTS_FORGED_MAIN_H
#define VIT_TESTS_FORGED_MAIN_H

#include "forged_pack.h"

#define X(place, name, cause, ...)                                                                                             \
    static void spoil_##place##_##name(image *im) {                                                                            \
        __VA_ARGS__;                                                                                                           \
    }
FAULTS(X)
#undef X
#define X(name, ...)                                                                                                           \
    static void limit_##name(image *im) {                                                                                      \
        __VA_ARGS__;                                                                                                           \
    }
LIMITS(X)
#undef X

static fault faults[] = {
#define X(place, name, cause, ...) {FORGED_KIND, #place, cause, spoil_##place##_##name},
    FAULTS(X)
#undef X
};

static fault limits[] = {
#define X(name, ...) {FORGED_KIND, 0, 0, limit_##name},
    LIMITS(X)
#undef X
};

static void any_word_may_have_any_value_without_bringing_the_loader_down(void **state) {
    (void)state;
    any_word_has_any_value(FORGED_KIND, 1000);
}

int main(void) {
    struct CMUnitTest tests[] = {
#define X(place, name, cause, ...)                                                                                             \
    {"a_pack_is_refused_for_" #place "_" #name, a_forged_pack_is_refused_for_its_own_reason, 0, 0, 0},
        FAULTS(X)
#undef X
#define X(name, ...) {"a_pack_is_accepted_with_" #name, a_pack_just_inside_a_limit_is_accepted, 0, 0, 0},
            LIMITS(X)
#undef X
                FORGED_TESTS cmocka_unit_test(any_word_may_have_any_value_without_bringing_the_loader_down),
    };
    const size_t fault_count = sizeof faults / sizeof faults[0], limit_count = sizeof limits / sizeof limits[0];
    for (size_t i = 0; i < fault_count; i++)
        tests[i].initial_state = &faults[i];
    for (size_t i = 0; i < limit_count; i++)
        tests[fault_count + i].initial_state = &limits[i];
    return cmocka_run_group_tests_name(FORGED_NAME, tests, NULL, NULL);
}

#endif
