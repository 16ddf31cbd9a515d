#include "cache/table.h"
#include "common/fail.h"
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define MOST_RECORDS (1u << 26)
#define LEAST_RECORDS 64u

static uint32_t tag_of(const vit_cache_cell *c) {
    return c->word[2] & VIT_CACHE_TAG;
}

/* Has `a` the record that both want? */
static bool comes_first(const vit_cache_cell *a, const vit_cache_cell *b) {
    return a->key != b->key ? a->key < b->key : tag_of(a) < tag_of(b);
}

static void insert(cache_table *t, uint32_t probes, const vit_cache_cell *cell) {
    vit_cache_cell mine = *cell;
    const uint32_t mask = t->count - 1;
    for (uint32_t steps = 0; steps < probes; steps++) {
        const uint32_t at = (mine.key + steps) & mask;
        const vit_cache_cell there = t->records[at];
        if (there.key == VIT_CACHE_EMPTY) {
            t->records[at] = mine;
            return;
        }
        if (there.key == mine.key && tag_of(&there) == tag_of(&mine))
            break;
        if (comes_first(&mine, &there)) {
            t->records[at] = mine;
            mine = there;
            steps = (at - mine.key) & mask; /* it goes on from here */
        }
    }
    t->dropped++;
}

vit_status cache_table_make(const vit_cache_cell *cells, uint32_t cell_count, uint32_t count, uint32_t probes, cache_table *out,
                            vit_text *why) {
    *out = (cache_table){.count = count, .records = malloc(count * sizeof *out->records)};
    if (!out->records)
        return bake_fail(why, VIT_FAILED, "out of memory");
    for (uint32_t i = 0; i < count; i++)
        out->records[i] = (vit_cache_cell){.key = VIT_CACHE_EMPTY};
    for (uint32_t i = 0; i < cell_count; i++)
        insert(out, probes < count ? probes : count, cells + i);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t key = out->records[i].key, steps = (i - key) & (count - 1);
        if (key == VIT_CACHE_EMPTY)
            continue;
        out->filled++;
        out->longest = steps + 1 > out->longest ? steps + 1 : out->longest;
    }
    return VIT_OK;
}

vit_status cache_table_fit(const vit_cache_cell *cells, uint32_t cell_count, cache_table *out, vit_text *why) {
    uint32_t count = LEAST_RECORDS;
    while (count / 4 * 3 < cell_count && count < MOST_RECORDS)
        count *= 2;
    for (;; count *= 2) {
        const vit_status status = cache_table_make(cells, cell_count, count, VIT_CACHE_PROBES, out, why);
        if (status != VIT_OK || out->dropped == 0 || count >= MOST_RECORDS || count / 16 > cell_count)
            return status;
        cache_table_free(out);
    }
}

uint32_t cache_table_find(const cache_table *t, uint32_t key, uint32_t tag) {
    const uint32_t mask = t->count - 1;
    for (uint32_t i = 0; i < t->longest; i++) {
        const vit_cache_cell *c = &t->records[(key + i) & mask];
        if (c->key > key)
            return VIT_NONE;
        if (c->key == key && tag_of(c) == tag)
            return (key + i) & mask;
    }
    return VIT_NONE;
}

void cache_table_free(cache_table *t) {
    free(t->records);
    memset(t, 0, sizeof *t);
}
