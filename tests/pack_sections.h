/* A pack's sections in place, as the baker had them: for tests of what the baker's side does with them. */
#ifndef VIT_TESTS_PACK_SECTIONS_H
#define VIT_TESTS_PACK_SECTIONS_H

#include "pack/pack_write.h"

/* The pack must be a good one: nothing is checked. */
static inline pack_sections pack_sections_of(const void *pack) {
    const unsigned char *bytes = pack;
    const vit_pack_entry *table = (const vit_pack_entry *)(const void *)(bytes + sizeof(vit_pack_header));
    pack_sections s;
    for (int i = 0; i < VIT_SECTION_COUNT; i++)
        s.data[i] = bytes + table[i].offset;
    return s;
}

#endif
