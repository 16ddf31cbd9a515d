/* The low-discrepancy points of reference paths: what makes them better than random, and what must be as in random ones. */
#include "reference/sequence.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

/* A (0, 2)-sequence in base 2: of its first 2^n points, each box of 2^-a x 2^-(n-a) holds one. */
static void the_first_points_lie_one_in_each_box(void **state) {
    (void)state;
    for (uint32_t seed = 1; seed <= 20; seed++)
        for (uint32_t n = 0; n <= 10; n++)
            for (uint32_t a = 0; a <= n; a++) {
                unsigned char seen[1024] = {0};
                for (uint32_t i = 0; i < 1u << n; i++) {
                    float u, v;
                    sequence_point(pcg(seed), i, &u, &v);
                    assert_true(u >= 0.0f && u < 1.0f && v >= 0.0f && v < 1.0f);
                    const uint32_t column = (uint32_t)(u * (float)(1u << a)), row = (uint32_t)(v * (float)(1u << (n - a)));
                    seen[column << (n - a) | row]++;
                }
                for (uint32_t i = 0; i < 1u << n; i++)
                    assert_int_equal(seen[i], 1);
            }
}

/* Over seeds, each point alone is anywhere, and one sequence's points tell nothing about another's. */
static void each_point_is_uniform_over_seeds(void **state) {
    (void)state;
    enum { SEEDS = 20000 };
    for (uint32_t i = 0; i < 40; i += 13) {
        double u1 = 0, v1 = 0, uv = 0, uu = 0, next = 0;
        for (uint32_t s = 0; s < SEEDS; s++) {
            float u, v, u2, v2;
            sequence_point(pcg(s), i, &u, &v);
            sequence_point(pcg(s + SEEDS), i, &u2, &v2);
            u1 += (double)u / SEEDS;
            v1 += (double)v / SEEDS;
            uu += (double)u * (double)u / SEEDS;
            uv += (double)u * (double)v / SEEDS;
            next += (double)u * (double)u2 / SEEDS;
        }
        assert_true(fabs(u1 - 0.5) < 0.01 && fabs(v1 - 0.5) < 0.01); /* 5 standard errors of 0.002 */
        assert_true(fabs(uu - 1 / 3.0) < 0.01 && fabs(uv - 0.25) < 0.01 && fabs(next - 0.25) < 0.01);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_first_points_lie_one_in_each_box),
                                       cmocka_unit_test(each_point_is_uniform_over_seeds)};
    return cmocka_run_group_tests_name("sequence", tests, NULL, NULL);
}
