/* byte_order.c: turns words of a pack into the other byte order. */
#include "byte_order.h"

#include <string.h>

/* Every field of a record but vit_scene.effects is a word: records.clh. */
#define X(code, type, records) _Static_assert(sizeof(type) % VIT_WORD == 0, #type " must be whole words");
VIT_SECTIONS(X)
#undef X

/* Loops of one width each: compilers make vectors of them. */
#define SWAP_LOOP(type, swap)                                                                                                  \
    for (size_t i = 0; i < bytes; i += sizeof(type)) {                                                                         \
        type x;                                                                                                                \
        memcpy(&x, in + i, sizeof x);                                                                                          \
        x = swap(x);                                                                                                           \
        memcpy(out + i, &x, sizeof x);                                                                                         \
    }

void *vit_swap_words(void *to, const void *from, size_t bytes, size_t word) {
    const unsigned char *in = from;
    unsigned char *out = to;
    if (word == 2)
        SWAP_LOOP(uint16_t, __builtin_bswap16)
    else if (word == 4)
        SWAP_LOOP(uint32_t, __builtin_bswap32)
    else
        SWAP_LOOP(uint64_t, __builtin_bswap64)
    return to;
}

void vit_swap_scene(vit_scene *s) {
    s->effects = s->effects << 32 | s->effects >> 32;
}

#define SWAP_FIELD(name) ((void)vit_swap_words(&to->name, &from->name, sizeof to->name, sizeof to->name))

const vit_pack_header *vit_swap_header(vit_pack_header *to, const vit_pack_header *from) {
    *to = *from;
    SWAP_FIELD(version);
    SWAP_FIELD(sections);
    SWAP_FIELD(size);
    SWAP_FIELD(table_hash);
    return to;
}

const vit_pack_entry *vit_swap_entry(vit_pack_entry *to, const vit_pack_entry *from) {
    *to = *from;
    SWAP_FIELD(record);
    SWAP_FIELD(offset);
    SWAP_FIELD(size);
    SWAP_FIELD(hash);
    return to;
}
