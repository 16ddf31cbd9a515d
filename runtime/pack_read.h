/* pack_read.c: checks a pack and finds its sections. Trusts nothing. */
#ifndef VIT_PACK_READ_H
#define VIT_PACK_READ_H

#include "vitrine.h"
#include "vitrine_pack.h"

typedef struct vit_pack {
    const vit_scene *scene; /* META, in the machine's byte order */
    /* In place, so in the file's byte order (open.c: in the machine's); NULL if empty. */
    const void *section[VIT_SECTION_COUNT];
    size_t bytes[VIT_SECTION_COUNT];
#if VIT_BIG_ENDIAN
    vit_scene swapped; /* where `scene` points: a copy of a vit_pack needs its own */
#endif
} vit_pack;

/* VIT_BAD_INPUT: why->text is "pack: section GEOM: triangle 12: ..." (one line, section and cause). Allocates nothing.
 * After VIT_OK: all sizes, offsets, hashes, indices and floats hold what records.clh and vitrine_pack.h say. */
vit_status vit_pack_read(const void *bytes, size_t size, vit_pack *out, vit_text *why);

#endif
