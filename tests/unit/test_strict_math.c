/* The baker's elementary functions are as good as the C library's, and their bits are these on every machine. */
#include "common/strict_math.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#define LARGEST_ERROR 6.0 /* units in the last place */

static double last_place(double x) {
    return nextafter(fabs(x), INFINITY) - fabs(x);
}

typedef double one_function(double x);

static void agrees(const char *name, one_function *ours, one_function *theirs, double from, double to, double least) {
    double worst = 0.0, at = 0.0;
    for (int i = 0; i <= 20000; i++) {
        const double x = from + (to - from) * i / 20000.0, right = theirs(x);
        const double error = fabs(ours(x) - right) / fmax(last_place(right), least);
        if (error > worst) {
            worst = error;
            at = x;
        }
    }
    print_message("%s: %.2f units in the last place at %.17g\n", name, worst, at);
    if (!(worst <= LARGEST_ERROR))
        fail_msg("%s(%.17g) is %.17g, and not %.17g", name, at, ours(at), theirs(at));
}

static double power_of_srgb(double c) {
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

/* Near the zeros of sin and cos the argument's own rounding counts: 2^-53 there. */
static void they_agree_with_the_c_library(void **state) {
    (void)state;
    agrees("sin", strict_sin, sin, -8.0, 8.0, 0x1p-53);
    agrees("cos", strict_cos, cos, -8.0, 8.0, 0x1p-53);
    agrees("sin of many turns", strict_sin, sin, -1000.0, 1000.0, 0x1p-53);
    agrees("tan", strict_tan, tan, -1.5, 1.5, 0x1p-53);
    agrees("atan", strict_atan, atan, -1.2, 1.2, 0.0);
    agrees("atan of the steep", strict_atan, atan, 1.0, 3000.0, 0.0);
    agrees("log", strict_log, log, 0.01, 30.0, 0x1p-53);
    agrees("log of the tiny", strict_log, log, 1e-300, 1e-299, 0.0);
    agrees("sRGB", srgb_linear, power_of_srgb, 0.0, 1.0, 0.0);
}

static void places_that_must_be_exact_are(void **state) {
    (void)state;
    assert_true(strict_sin(0.0) == 0.0 && strict_cos(0.0) == 1.0 && strict_tan(0.0) == 0.0 && strict_atan(0.0) == 0.0);
    assert_true(strict_log(1.0) == 0.0 && srgb_linear(0.0) == 0.0 && srgb_linear(1.0) == 1.0);
    assert_true(strict_sin(-0.3) == -strict_sin(0.3) && strict_cos(-0.3) == strict_cos(0.3) &&
                strict_atan(-3.0) == -strict_atan(3.0));
}

/* FNV-1a over the bits of many results. */
static void their_bits_are_these_everywhere(void **state) {
    (void)state;
    static one_function *const all[] = {strict_sin, strict_cos, strict_tan, strict_atan, strict_log, srgb_linear};
    uint64_t sum = 0xcbf29ce484222325u;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        for (int i = 1; i <= 1000; i++) {
            const double y = all[k](i / 1000.0);
            uint64_t bits;
            memcpy(&bits, &y, sizeof bits);
            sum = (sum ^ bits) * 0x100000001b3u;
        }
    assert_int_equal(sum, 0x46478a72f5703d91u);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(they_agree_with_the_c_library),
        cmocka_unit_test(places_that_must_be_exact_are),
        cmocka_unit_test(their_bits_are_these_everywhere),
    };
    return cmocka_run_group_tests_name("strict math", tests, NULL, NULL);
}
