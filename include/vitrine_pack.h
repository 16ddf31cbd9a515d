/* The pack, `.vit`: one baked scene in one file, usable in place from an mmap. Shared by baker and runtime; not installed.
 *
 *   0        64          64 + 32 n             4096-aligned
 *   +--------+-----------+------------- ... ---+---------+- ... -+---------+
 *   | header | table     | zero bytes          | META    |       | GOLD    |   little-endian throughout
 *   +--------+-----------+------------- ... ---+---------+- ... -+---------+
 *
 *   header   char magic[8] "VITRINE\0" | u32 version | u32 sections n | u64 file size | u64 XXH3-64 of the table | 32 zero
 * bytes entry    char code[4] | u32 record bytes | u64 offset | u64 bytes | u64 XXH3-64 of the section      (VIT_SECTIONS
 * order)
 *
 * Every section is present, exactly once and in the order of VIT_SECTIONS; an empty one has 0 bytes. Sections do not overlap
 * and their offsets ascend; bytes between them are 0; the file ends with the last section. The loader checks all of this,
 * every hash, every count against META, every index and every float. */
#ifndef VITRINE_PACK_H
#define VITRINE_PACK_H

#include "../kernels/cache_cell.clh"
#include "../kernels/counters.clh"
#include "../kernels/records.clh"
#include "../kernels/transfer_code.clh"
#include "vitrine.h"

#define VIT_PACK_MAGIC "VITRINE" /* 8 bytes with its zero */
#define VIT_PACK_VERSION 12u
#define VIT_PACK_ALIGN 4096u
#define VIT_WORD                                                                                                               \
    4u /* bytes of every field of every record but vit_scene.effects, and so what a machine of the other byte order swaps by   \
        */

/* Does this machine have numbers in another order than the file? */
#ifndef __BYTE_ORDER__
#error "say by __BYTE_ORDER__ and __ORDER_BIG_ENDIAN__, as GCC and Clang do, in which order this machine's numbers lie"
#endif
#define VIT_BIG_ENDIAN (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__)

/* X(code, record type, records: an expression over `s`, the vit_scene). The one list of sections.
 * SIDE: a word a side of a triangle, where its cells are in CELL (VIT_SIDE_*). CELL: which zones' photons count there and how
 * much of the kernel lies on surfaces (vit_cell). Both are empty without the effects ZONES and AREA. EMIT: sets of points on
 * area lights, then sets of directions to the sky. SKYT: the sky's picture. MSID: as SIDE, for the
 * lightmap, whose cells are MCEL. RCEL: with the effect POINTS it has as many vit_cache_cell records. XFER: a vit_transfer.
 * MAPS: empty where nothing but colour changes from texel to texel. */
#define VIT_HAS_MAPS(effects) ((effects) & (VIT_BIT(NORMAL_MAPS)))
#define VIT_SECTIONS(X)                                                                                                        \
    X(META, vit_scene, 1u)                                                                                                     \
    X(CAMS, vit_camera, s->frames)                                                                                             \
    X(LITE, vit_light, (uint64_t)s->frames * s->lights)                                                                        \
    X(GEOM, vit_triangle, s->triangles)                                                                                        \
    X(ATTR, vit_attributes, s->triangles)                                                                                      \
    X(BVHN, vit_bvh_node, s->nodes)                                                                                            \
    X(MATL, vit_material, s->materials)                                                                                        \
    X(MAPS, vit_maps, VIT_HAS_MAPS(s->effects) ? s->materials : 0)                                                             \
    X(TEXR, vit_texture, s->textures)                                                                                          \
    X(MIPS, vit_mip, s->mips)                                                                                                  \
    X(ATLS, vit_u32, s->texels)                                                                                                \
    X(SIDE, vit_u32, s->cells || (s->receiver_cells && !s->point_levels) ? 2 * (uint64_t)s->triangles : 0)                     \
    X(CELL, vit_cell, s->cells)                                                                                                \
    X(EMIT, vit_light_sample, VIT_PATTERNS *((uint64_t)s->area_samples + s->sky_samples))                                      \
    X(SKYT, vit_sky_texel, s->sky_size ? (s->sky_size + (uint64_t)2) * (s->sky_size + 2) : 0)                                  \
    X(RCEL, vit_receiver_cell, s->receiver_cells)                                                                              \
    X(RSPL, vit_receiver_split, s->receiver_splits)                                                                            \
    X(RECV, vit_receiver, s->receivers)                                                                                        \
    X(BGRP, vit_basis_group, (uint64_t)s->receivers / VIT_BASIS_GROUP * s->basis_lights)                                       \
    X(BWRD, vit_u32, s->basis_words)                                                                                           \
    X(BCOE, vit_basis_coefficient, s->basis_coefficients)                                                                      \
    X(BFRM, vit_basis_frame, (uint64_t)s->frames * s->basis_lights)                                                            \
    X(PATC, vit_patch, s->patches)                                                                                             \
    X(PPNT, vit_patch_point, s->patch_points)                                                                                  \
    X(GROW, vit_gather_row, s->patches ? s->receivers : 0u)                                                                    \
    X(GATH, vit_u32, s->gather_words)                                                                                          \
    X(LOOK, vit_u32, (uint64_t)VIT_LOOKED_SETS(s) * (s->receivers / 32))                                                       \
    X(CACH, vit_cache_cell, s->cache_cells)                                                                                    \
    X(MSID, vit_u32, s->map_cells ? 2 * (uint64_t)s->triangles : 0)                                                            \
    X(MCEL, vit_receiver_cell, s->map_cells)                                                                                   \
    X(MSPL, vit_receiver_split, s->map_splits)                                                                                 \
    X(MREC, vit_receiver, s->map_receivers)                                                                                    \
    X(XFER, vit_u32, s->transfer_words)                                                                                        \
    X(PHOT, vit_photon, s->baked)                                                                                              \
    X(GOLD, vit_gold, s->frames)

typedef enum vit_section {
#define X(code, type, records) VIT_SECTION_##code,
    VIT_SECTIONS(X)
#undef X
        VIT_SECTION_COUNT
} vit_section;

typedef struct vit_pack_header {
    char magic[8];
    uint32_t version;
    uint32_t sections;
    uint64_t size;
    uint64_t table_hash;
    uint8_t zero[32];
} vit_pack_header;

typedef struct vit_pack_entry {
    char code[4];
    uint32_t record;
    uint64_t offset;
    uint64_t size;
    uint64_t hash;
} vit_pack_entry;

/* Fills the fields of `s` that follow from others (tiles_x, tiles_y, samples, photons, key_bits, key_bits_x .. key_bits_n,
 * levels, level_first, mask_words): the baker calls it, the loader calls it on a copy and compares. All other counts and
 * `effects` must be set before. VIT_BAD_INPUT: a count is out of range or a product overflows; the text begins with the field's
 * name. `why` may be NULL. */
vit_status vit_pack_derive(vit_scene *s, vit_text *why);

/* Where the parts of a coded transfer matrix are, for codec, patches, rank, and the words that sparse entries take. 0: these
 * would be too many words. */
int vit_transfer_lay_out(vit_u32 codec, vit_u32 patches, vit_u32 rank, uint64_t sparse_words, vit_transfer *out);
#define VIT_TRANSFER_MOST_PATCHES 65536u
#define VIT_TRANSFER_MOST_RANK 512u
/* VIT_BAD_INPUT: the words, as a pack has them, are no coded matrix: nothing may be computed from them. The text has no place
 * in it. */
vit_status vit_transfer_check(const vit_u32 *words, size_t count, vit_text *why);

/* The hash of frames in this format. */
static inline vit_u32 *vit_gold_hash(vit_gold *g, vit_format format) {
    switch (format) {
#define X(name, word, bytes, word_bytes, meaning)                                                                              \
    case VIT_FORMAT_##name:                                                                                                    \
        return g->word;
        VIT_FORMATS(X)
#undef X
    }
    return 0;
}

/* The effects that make indirect light, of which a pack with the effect INDIRECT has at least one. */
static inline uint64_t vit_indirect_makers(void) {
#define X(maker, family) | VIT_BIT(maker)
    return 0u VIT_INDIRECT_MAKERS(X);
#undef X
}

/* The effect `bit` and all that make no sense without it. */
static inline uint64_t vit_effects_upon(uint64_t bit) {
#define X(effect, needed)                                                                                                      \
    if (bit & VIT_BIT(needed))                                                                                                 \
        bit |= VIT_BIT(effect);
    VIT_EFFECT_NEEDS(X)
#undef X
    return bit;
}

#endif
