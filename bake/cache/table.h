/* table.c: the hash table of cells, section CACH. */
#ifndef VIT_CACHE_TABLE_H
#define VIT_CACHE_TABLE_H

#include "vitrine_pack.h"

typedef struct cache_table {
    vit_cache_cell *records; /* a power of two */
    uint32_t count;
    uint32_t filled;  /* records that are not VIT_CACHE_EMPTY */
    uint32_t longest; /* records that a look-up of one in it takes, at most */
    uint32_t dropped; /* cells that found no place within `probes` */
} cache_table;

/* Puts cells into `count` records, a power of two, each at most `probes` - 1 from its key's place. Of two that want a record
 * the one of the smaller key, or of the same key the smaller tag, has it and the other goes on, so that what is in the table,
 * and where, follows from the set of cells alone: the stable matching that deferred acceptance finds in any order (Gale and
 * Shapley, 1962). Who is not in it is dropped: with cells of equal key and tag all but the first, and who is pushed beyond
 * `probes`. VIT_FAILED: out of memory. */
vit_status cache_table_make(const vit_cache_cell *cells, uint32_t cell_count, uint32_t count, uint32_t probes, cache_table *out,
                            vit_text *why);
/* Into a table as small as holds all of them within VIT_CACHE_PROBES, at most 3/4 full. */
vit_status cache_table_fit(const vit_cache_cell *cells, uint32_t cell_count, cache_table *out, vit_text *why);
/* The record of a key and tag; VIT_NONE. */
uint32_t cache_table_find(const cache_table *t, uint32_t key, uint32_t tag);
void cache_table_free(cache_table *t);

#endif
