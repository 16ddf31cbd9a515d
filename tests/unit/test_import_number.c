/* Numbers in text: what the parser gives must be what the C library's strtod() and strtof() give, which round correctly, for
 * all that both understand; and the words that exporters write. Strategy: numbers of every length and size, and those that lie
 * halfway between two doubles or floats or just beside. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "import/importer.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double parsed(const char *text, bool single, size_t taken) {
    double value = 0.0;
    const char *end = import_number(text, text + strlen(text), single, &value);
    if (!end || (size_t)(end - text) != taken)
        fail_msg("'%s': %d characters taken of %zu", text, end ? (int)(end - text) : -1, taken);
    return value;
}

static void same_as_library(const char *text) {
    const double d = parsed(text, false, strlen(text)), f = parsed(text, true, strlen(text));
    const double want = strtod(text, NULL), single = (double)strtof(text, NULL);
    if (memcmp(&d, &want, sizeof d) != 0 || memcmp(&f, &single, sizeof f) != 0)
        fail_msg("'%.60s': %a and %a, expected %a and %a", text, d, f, want, single);
}

static uint64_t next(uint64_t *state) {
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return *state >> 33;
}

static void numbers_of_all_lengths_are_rounded_correctly(void **state) {
    uint64_t seed = 1;
    (void)state;
    for (int i = 0; i < 200000; i++) {
        char text[80];
        size_t used = 0;
        const size_t whole = next(&seed) % 22, behind = next(&seed) % 22;
        if (next(&seed) % 2)
            text[used++] = '-';
        for (size_t k = 0; k < whole; k++)
            text[used++] = (char)('0' + next(&seed) % 10);
        text[used++] = '.';
        for (size_t k = 0; k <= behind; k++)
            text[used++] = (char)('0' + next(&seed) % 10);
        text[used] = '\0';
        if (next(&seed) % 2)
            (void)snprintf(text + used, sizeof text - used, "e%d", (int)(next(&seed) % 90) - 45);
        same_as_library(text);
    }
}

/* The exact halfway point behind each float, and with a digit more or less at the end. */
static void halfway_cases_round_once(void **state) {
    uint64_t seed = 7;
    (void)state;
    for (int i = 0; i < 20000; i++) {
        char text[400];
        const uint32_t bits = (uint32_t)(next(&seed) << 1 ^ next(&seed)) & 0x7fffffff;
        float f;
        memcpy(&f, &bits, sizeof f);
        if (!isfinite(f) || f > 1e30f || f < 1e-30f)
            continue;
        const double middle = 0.5 * ((double)f + (double)nextafterf(f, INFINITY));
        (void)snprintf(text, sizeof text, "%.200f", middle);
        same_as_library(text);
        strcat(text, "1");
        same_as_library(text);
        (void)snprintf(text, sizeof text, "%.17g", middle);
        same_as_library(text);
        (void)snprintf(text, sizeof text, "%.9g", (double)f);
        same_as_library(text);
    }
}

static void long_small_and_large_numbers_are_right(void **state) {
    static const char *const texts[] = {"0",
                                        "-0",
                                        "+1",
                                        ".5",
                                        "5.",
                                        "1e5",
                                        "1E+05",
                                        "1e-400",
                                        "1e400",
                                        "-1e400",
                                        "4.9e-324",
                                        "2.4703282292062327e-324",
                                        "2.4703282292062328e-324",
                                        "1.4e-45",
                                        "7e-46",
                                        "7.1e-46",
                                        "1.17549429e-38",
                                        "3.4028235e38",
                                        "3.4028236e38",
                                        "1.7976931348623159e308",
                                        "9007199254740993",
                                        "9007199254740992.999999999999999999",
                                        "0.1e99999999999999999999",
                                        "0e99999999999999999999",
                                        "1e-99999999999999999999",
                                        "123456789012345678901234567890"};
    char text[4000];
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        same_as_library(texts[i]);
    memset(text, '0', 3000);
    memcpy(text + 3000, "1.5", 4);
    same_as_library(text);
    memset(text, '0', 3000);
    memcpy(text, "0.", 2);
    memcpy(text + 3000, "7e2999", 7);
    same_as_library(text);
    /* Halfway, and beyond it by the last of two thousand digits. */
    memset(text, '0', sizeof text);
    memcpy(text, "9007199254740993.", 17);
    text[2000] = '\0';
    same_as_library(text);
    text[1999] = '1';
    same_as_library(text);
}

static void words_and_ends_are_understood(void **state) {
    static const char *const none[] = {"", "-", ".", "e5", "x", "--1", "i", "#"};
    double value;
    (void)state;
    assert_true(isnan(parsed("nan", true, 3)) && isnan(parsed("-NaN", true, 4)) && isnan(parsed("-1.#IND", true, 7)));
    assert_true(isnan(parsed("1.#QNAN0 2", true, 8)) && parsed("-1.#INF00", false, 9) == -(double)INFINITY);
    assert_true(parsed("inf", true, 3) == (double)INFINITY && parsed("-Infinity", true, 9) == -(double)INFINITY);
    assert_true(parsed("0x10", true, 1) == 0.0 && parsed("1,5", false, 1) == 1.0 && parsed("2e", false, 1) == 2.0);
    assert_true(parsed("2e+", false, 1) == 2.0 && parsed("1.5/2", false, 3) == 1.5 && parsed("1 2", false, 1) == 1.0);
    for (size_t i = 0; i < sizeof none / sizeof *none; i++)
        assert_null(import_number(none[i], none[i] + strlen(none[i]), true, &value));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_of_all_lengths_are_rounded_correctly),
        cmocka_unit_test(halfway_cases_round_once),
        cmocka_unit_test(long_small_and_large_numbers_are_right),
        cmocka_unit_test(words_and_ends_are_understood),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
