/* Names that are offered for one that there is not: what counts is that the one that was meant comes first, that a line stays a
 * line's length, and that lists of any length and names of any kind do. */
#include "common/names.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

static const char *at(const void *list, int index) {
    return ((const char *const *)list)[index];
}

static void offers(const char *wanted, const char *const *list, int count, const char *text) {
    char got[NAMES_TEXT];
    names_offer(wanted, at, list, count, got);
    assert_string_equal(got, text);
}

static void the_nearest_comes_first(void **state) {
    static const char *const list[] = {"floor", "leftWall", "ceiling", "rightWall", "lamp", "shortBox", "tallBox"};
    (void)state;
    offers("leftwall", list, 7, "; there are 'leftWall', 'rightWall', 'lamp', 'floor', 'ceiling' and more");
    offers("flor", list, 2, "; there are 'floor' and 'leftWall'");
    offers("x", list, 1, "; there is 'floor'");
    offers("x", list, 0, "; there is none");
}

static void names_come_once_and_empty_ones_never(void **state) {
    static const char *const list[] = {"a", "", "a", "b", "a", ""};
    (void)state;
    offers("c", list, 6, "; there are 'a' and 'b'");
    offers("", list + 1, 1, "; there is none");
}

static const char *long_name(const void *list, int index) {
    static char name[128];
    (void)list;
    memset(name, 'a' + index % 26, 127);
    return name;
}

static void long_names_stay_a_lines_length(void **state) {
    char got[NAMES_TEXT], wanted[512];
    (void)state;
    memset(wanted, 'q', sizeof wanted - 1);
    wanted[sizeof wanted - 1] = '\0';
    names_offer(wanted, long_name, NULL, 1, got);
    assert_true(strlen(got) < 64);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_nearest_comes_first),
        cmocka_unit_test(names_come_once_and_empty_ones_never),
        cmocka_unit_test(long_names_stay_a_lines_length),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
