/* The table of the world-space cache (bake/cache/table.h): what is in it, and where, follows from the set of cells alone.
 *
 * Why this is hard: linear probing puts what comes later elsewhere, and a bounded one drops it, so that the order of coming
 * shows; a table that is nearly full shows it most. Strategy: the stable matching is defined by cells that choose one after
 * another, the smallest first, each the first free record of its own; that is worked out here plainly, and tables made in many
 * orders must be it, at 50, 90 and 100 % fill and beyond. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "cache/table.h"
#include "common/kernel_math.h"

#include <stdlib.h>
#include <string.h>

enum { RECORDS = 256, MOST = 2 * RECORDS, ORDERS = 50 };

static vit_cache_cell cells[MOST], expected[RECORDS];

static uint32_t tag_of(const vit_cache_cell *c) {
    return c->word[2] & VIT_CACHE_TAG;
}

static int by_key(const void *x, const void *y) {
    const vit_cache_cell *a = x, *b = y;
    return a->key != b->key ? (a->key < b->key ? -1 : 1) : tag_of(a) < tag_of(b) ? -1 : tag_of(a) > tag_of(b);
}

/* Keys that crowd: their places are a quarter of the table's, and every eighth has the key of the one before. */
static void make_cells(uint32_t count) {
    uint32_t random = count;
    for (uint32_t i = 0; i < count; i++) {
        random = pcg(random);
        const uint32_t key = i % 8 == 7 ? cells[i - 1].key : i % 2 ? random : random & ~(uint32_t)(RECORDS * 3 / 4);
        cells[i] = (vit_cache_cell){key == VIT_CACHE_EMPTY ? 0 : key, {i, pcg(i) >> 2, i << 20}};
    }
}

/* Returns how many are left over. */
static uint32_t choose_in_turn(uint32_t count, uint32_t probes) {
    uint32_t left = 0;
    qsort(cells, count, sizeof *cells, by_key);
    for (uint32_t i = 0; i < RECORDS; i++)
        expected[i] = (vit_cache_cell){.key = VIT_CACHE_EMPTY};
    for (uint32_t i = 0; i < count; i++) {
        uint32_t k = 0;
        while (k < probes && expected[(cells[i].key + k) % RECORDS].key != VIT_CACHE_EMPTY)
            k++;
        if (k < probes)
            expected[(cells[i].key + k) % RECORDS] = cells[i];
        else
            left++;
    }
    return left;
}

static void shuffle(uint32_t count, uint32_t seed) {
    for (uint32_t i = count; i > 1; i--) {
        const uint32_t other = (seed = pcg(seed)) % i;
        const vit_cache_cell c = cells[i - 1];
        cells[i - 1] = cells[other];
        cells[other] = c;
    }
}

static void the_order_of_coming_is_the_same(void **state) {
    (void)state;
    static const uint32_t counts[] = {RECORDS / 2, RECORDS * 9 / 10, RECORDS, MOST}, probes[] = {1, 4, 16, 64, RECORDS};
    vit_text why;
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++)
        for (size_t p = 0; p < sizeof probes / sizeof *probes; p++) {
            make_cells(counts[c]);
            const uint32_t left = choose_in_turn(counts[c], probes[p]);
            for (uint32_t order = 0; order < ORDERS; order++) {
                cache_table t;
                shuffle(counts[c], order);
                assert_int_equal(cache_table_make(cells, counts[c], RECORDS, probes[p], &t, &why), VIT_OK);
                assert_memory_equal(t.records, expected, sizeof expected);
                assert_int_equal(t.dropped, left);
                assert_int_equal(t.filled + t.dropped, counts[c]);
                assert_in_range(t.longest, 1, probes[p]);
                cache_table_free(&t);
            }
        }
}

static void what_is_in_it_is_found_and_nothing_else(void **state) {
    (void)state;
    vit_text why;
    cache_table t;
    make_cells(RECORDS * 9 / 10);
    assert_int_equal(cache_table_make(cells, RECORDS * 9 / 10, RECORDS, 16, &t, &why), VIT_OK);
    uint32_t found = 0;
    for (uint32_t i = 0; i < RECORDS * 9 / 10; i++) {
        const uint32_t at = cache_table_find(&t, cells[i].key, tag_of(&cells[i]));
        if (at != VIT_NONE)
            assert_memory_equal(&t.records[at], &cells[i], sizeof *cells);
        found += at != VIT_NONE;
        assert_int_equal(cache_table_find(&t, cells[i].key, tag_of(&cells[i]) ^ 0x80000000u), VIT_NONE);
    }
    assert_int_equal(found, t.filled);
    assert_true(t.dropped > 0);
    cache_table_free(&t);
}

static void a_cell_that_comes_twice_is_there_once(void **state) {
    (void)state;
    vit_text why;
    cache_table t;
    make_cells(16);
    memcpy(cells + 16, cells, 16 * sizeof *cells);
    assert_int_equal(cache_table_make(cells, 32, RECORDS, 64, &t, &why), VIT_OK);
    assert_int_equal(t.filled, 16);
    assert_int_equal(t.dropped, 16);
    cache_table_free(&t);
}

static void a_table_that_fits_drops_nothing(void **state) {
    (void)state;
    vit_text why;
    for (uint32_t count = 0; count <= MOST; count = count * 2 + 1) {
        cache_table t;
        for (uint32_t i = 0; i < count; i++)
            cells[i] = (vit_cache_cell){.key = pcg(i)};
        assert_int_equal(cache_table_fit(cells, count, &t, &why), VIT_OK);
        assert_int_equal(t.filled, count);
        assert_int_equal(t.dropped, 0);
        assert_true(t.count >= 64 && (t.count & (t.count - 1)) == 0 && t.count / 4 * 3 >= count);
        assert_true(t.longest <= VIT_CACHE_PROBES);
        cache_table_free(&t);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_order_of_coming_is_the_same),
        cmocka_unit_test(what_is_in_it_is_found_and_nothing_else),
        cmocka_unit_test(a_cell_that_comes_twice_is_there_once),
        cmocka_unit_test(a_table_that_fits_drops_nothing),
    };
    return cmocka_run_group_tests_name("table of the cache", tests, NULL, NULL);
}
