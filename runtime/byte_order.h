/* Packs and golden hashes are little-endian. Machines that are too use the file's bytes as they lie; where VIT_BIG_ENDIAN
 * (vitrine_pack.h) holds, words are turned into the machine's order: header, table and records as they are checked
 * (pack_read.c, pack_check*.c), whole sections into the arena (open.c), frames and traced buffers as they are hashed. Each
 * caller asks `if (VIT_BIG_ENDIAN)`, so little-endian machines carry none of this; the functions themselves swap on any
 * machine, for tests. */
#ifndef VIT_BYTE_ORDER_H
#define VIT_BYTE_ORDER_H

#include "vitrine_pack.h"

/* Copies `bytes` bytes of words of `word` bytes (2, 4 or 8; divides `bytes`) with each word's bytes reversed; `to` may be
 * `from`, else they do not overlap. Any alignment. Returns `to`. */
void *vit_swap_words(void *to, const void *from, size_t bytes, size_t word);

/* Likewise for what is not all of one word; characters stay. */
const vit_pack_header *vit_swap_header(vit_pack_header *to, const vit_pack_header *from);
const vit_pack_entry *vit_swap_entry(vit_pack_entry *to, const vit_pack_entry *from);

/* vit_swap_words() by words leaves the halves of the one field of two words in the file's order: this swaps them. */
void vit_swap_scene(vit_scene *s);

/* Record `i` of a section as it lies in the file, in the machine's order: the record itself, or a copy that lives as long as
 * the block. */
#define VIT_RECORD(type, records, i)                                                                                           \
    (VIT_BIG_ENDIAN ? (const type *)vit_swap_words(&(type){0}, (records) + (i), sizeof(type), VIT_WORD) : (records) + (i))

/* XXH3-64 of the bytes that vit_swap_words() would give. */
uint64_t vit_hash_swapped(const void *data, size_t bytes, size_t word);

/* XXH3-64 of words of `word` bytes as a little-endian machine has them. */
static inline uint64_t vit_hash_words(const void *data, size_t bytes, size_t word) {
    return VIT_BIG_ENDIAN ? vit_hash_swapped(data, bytes, word) : vit_hash(data, bytes);
}

#endif
