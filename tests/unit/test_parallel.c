/* The baker's pool: every item runs once whatever the threads, sums are whole, and a cancelled run says so. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "common/parallel.h"
#include <stdatomic.h>

enum { MOST = 3000 };

typedef struct counted {
    atomic_uint runs[MOST];
    double last; /* fraction reported */
    volatile sig_atomic_t cancel;
} counted;

static void count(void *user, uint32_t item) {
    counted *c = user;
    atomic_fetch_add(&c->runs[item], 1);
}

static void count_chunk(void *user, uint32_t chunk, uint64_t *sum) {
    count(user, chunk);
    *sum += chunk;
}

static void count_then_cancel(void *user, uint32_t chunk, uint64_t *sum) {
    counted *c = user;
    count_chunk(user, chunk, sum);
    c->cancel = 1;
}

static void note(void *user, double fraction) {
    counted *c = user;
    assert_true(fraction > c->last && fraction <= 1.0);
    c->last = fraction;
}

static void every_item_runs_once(void **state) {
    static const uint32_t counts[] = {0, 1, 15, 64, 1025, MOST};
    (void)state;
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
        for (unsigned threads = 0; threads < 6; threads++) {
            counted c = {.last = 0};
            parallel_for(threads, counts[i], count, &c);
            for (uint32_t k = 0; k < MOST; k++)
                assert_int_equal(atomic_load(&c.runs[k]), k < counts[i]);
        }
}

static void every_chunk_of_a_stride_runs_once_and_sums_are_whole(void **state) {
    (void)state;
    for (unsigned threads = 0; threads < 6; threads++) {
        counted c = {.last = 0};
        uint64_t sum = 5, expected = 5;
        const parallel_work w = {
            .run = count_chunk, .done = note, .user = &c, .first = 2, .step = 3, .count = MOST - 1, .threads = threads};
        assert_true(parallel_run(&w, &sum));
        for (uint32_t k = 0; k < MOST; k++) {
            const bool in = k >= 2 && k < MOST - 1 && (k - 2) % 3 == 0;
            assert_int_equal(atomic_load(&c.runs[k]), in);
            expected += in ? k : 0;
        }
        assert_true(sum == expected);
    }
}

static void a_cancelled_run_says_so_and_stops(void **state) {
    (void)state;
    counted c = {.last = 0};
    uint64_t sum = 0;
    uint32_t ran = 0;
    const parallel_work w = {.run = count_then_cancel, .user = &c, .step = 1, .count = MOST, .threads = 1, .cancel = &c.cancel};
    assert_false(parallel_run(&w, &sum));
    for (uint32_t k = 0; k < MOST; k++)
        ran += atomic_load(&c.runs[k]);
    assert_int_equal(ran, 1);
}

static void threads_are_shared_among_processes(void **state) {
    (void)state;
    assert_int_equal(parallel_threads(3, 8), 3);
    assert_int_equal(parallel_threads(0, 1u << 20), 1);
    assert_true(parallel_threads(100000, 1) <= 256);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_item_runs_once),
        cmocka_unit_test(every_chunk_of_a_stride_runs_once_and_sums_are_whole),
        cmocka_unit_test(a_cancelled_run_says_so_and_stops),
        cmocka_unit_test(threads_are_shared_among_processes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
