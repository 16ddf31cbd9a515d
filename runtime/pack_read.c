/* pack_read.c: checks the container of a pack (header, table, places, hashes), then has each section's contents checked.
 * Nothing is used before it is checked; no arithmetic on numbers of the file can wrap. */
#include "pack_read.h"
#include "byte_order.h"
#include "pack_check.h"

#include <string.h>

/* Layouts are the same for every compiler only as long as this holds; ATLS is a plain array of words. */
#define X(code, type, records)                                                                                                 \
    _Static_assert(sizeof(type) == 4 || sizeof(type) == 8 || sizeof(type) % 16 == 0,                                           \
                   #type " must be 4, 8 or a multiple of 16 bytes");
VIT_SECTIONS(X)
#undef X
_Static_assert(sizeof(vit_pack_header) == 64 && sizeof(vit_pack_entry) == 32, "as drawn in vitrine_pack.h");

static const char codes[VIT_SECTION_COUNT][5] = {
#define X(code, type, records) #code,
    VIT_SECTIONS(X)
#undef X
};

static const uint32_t record_bytes[VIT_SECTION_COUNT] = {
#define X(code, type, records) sizeof(type),
    VIT_SECTIONS(X)
#undef X
};

#define TABLE_END (sizeof(vit_pack_header) + VIT_SECTION_COUNT * sizeof(vit_pack_entry))

/* Whole words by memcmp against a block of zeros: gaps may be large. */
static bool bytes_are_zero(const unsigned char *bytes, size_t size) {
    static const unsigned char zeros[256];
    for (size_t done = 0; done < size;) {
        size_t step = size - done < sizeof zeros ? size - done : sizeof zeros;
        if (memcmp(bytes + done, zeros, step) != 0)
            return false;
        done += step;
    }
    return true;
}

static vit_status check_header(const vit_pack_header *file, size_t size, vit_text *why) {
    if (size < sizeof *file)
        return vit_pack_refuse(why, "header: the file has %zu bytes, a header has %zu", size, sizeof *file);
    const vit_pack_header *h = VIT_BIG_ENDIAN ? vit_swap_header(&(vit_pack_header){0}, file) : file;
    if (memcmp(h->magic, VIT_PACK_MAGIC, sizeof h->magic) != 0)
        return vit_pack_refuse(why, "header: not a Vitrine pack");
    if (h->version != VIT_PACK_VERSION)
        return vit_pack_refuse(why, "header: version %u, this program reads version %u", h->version, VIT_PACK_VERSION);
    if (h->sections != VIT_SECTION_COUNT)
        return vit_pack_refuse(why, "header: %u sections, expected %d", h->sections, VIT_SECTION_COUNT);
    if (h->size != size)
        return vit_pack_refuse(why, "header: the pack has %llu bytes, the file %zu", (unsigned long long)h->size, size);
    if (!bytes_are_zero(h->zero, sizeof h->zero))
        return vit_pack_refuse(why, "header: reserved bytes are not 0");
    if (size < TABLE_END)
        return vit_pack_refuse(why, "header: the file ends inside the section table");
    if (vit_hash(file + 1, TABLE_END - sizeof *file) != h->table_hash)
        return vit_pack_refuse(why, "header: the hash of the section table does not match");
    return VIT_OK;
}

/* Place of section `i`, which may begin no earlier than `end`, the end of what lies before it. */
static vit_status check_place(const unsigned char *bytes, size_t size, const vit_pack_entry *e, int i, uint64_t end,
                              vit_text *why) {
    if (memcmp(e->code, codes[i], sizeof e->code) != 0)
        return vit_pack_refuse(why, "section %s: not at its place in the section table", codes[i]);
    if (e->record != record_bytes[i])
        return vit_pack_refuse(why, "section %s: records of %u bytes, expected %u", codes[i], e->record, record_bytes[i]);
    if (e->offset % VIT_PACK_ALIGN != 0)
        return vit_pack_refuse(why, "section %s: offset %llu is not a multiple of %u", codes[i], (unsigned long long)e->offset,
                               VIT_PACK_ALIGN);
    if (e->offset > size || e->size > size - e->offset)
        return vit_pack_refuse(why, "section %s: runs beyond the end of the file", codes[i]);
    if (e->offset < end)
        return vit_pack_refuse(why, "section %s: overlaps what lies before it", codes[i]);
    if (!bytes_are_zero(bytes + end, (size_t)(e->offset - end)))
        return vit_pack_refuse(why, "section %s: the gap before it is not 0", codes[i]);
    if (vit_hash(bytes + e->offset, (size_t)e->size) != e->hash)
        return vit_pack_refuse(why, "section %s: the hash does not match", codes[i]);
    return VIT_OK;
}

static vit_status check_places(const unsigned char *bytes, size_t size, vit_pack *out, vit_text *why) {
    const vit_pack_entry *table = (const vit_pack_entry *)(const void *)(bytes + sizeof(vit_pack_header));
    uint64_t end = TABLE_END;
    for (int i = 0; i < VIT_SECTION_COUNT; i++) {
        const vit_pack_entry *e = VIT_BIG_ENDIAN ? vit_swap_entry(&(vit_pack_entry){0}, &table[i]) : &table[i];
        vit_status status = check_place(bytes, size, e, i, end, why);
        if (status != VIT_OK)
            return status;
        end = e->offset + e->size;
        out->bytes[i] = (size_t)e->size;
        out->section[i] = e->size > 0 ? bytes + e->offset : 0;
    }
    if (end != size)
        return vit_pack_refuse(why, "header: %llu bytes follow the last section", (unsigned long long)(size - end));
    return VIT_OK;
}

/* META has passed its check, so no count exceeds 2^32 and no product here wraps. */
static vit_status check_sizes(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const uint64_t expected[VIT_SECTION_COUNT] = {
#define X(code, type, records) records,
        VIT_SECTIONS(X)
#undef X
    };
    for (int i = 0; i < VIT_SECTION_COUNT; i++)
        if (p->bytes[i] != expected[i] * record_bytes[i])
            return vit_pack_refuse(why, "section %s: %zu bytes, but META counts %llu records of %u", codes[i], p->bytes[i],
                                   (unsigned long long)expected[i], record_bytes[i]);
    return VIT_OK;
}

/* META first, since sizes follow from its counts; with all the others it passes once more. */
static vit_status check_contents(const vit_pack *p, vit_text *why) {
    vit_status status = vit_pack_check_META(p, why);
    if (status == VIT_OK)
        status = check_sizes(p, why);
#define X(code, type, records)                                                                                                 \
    if (status == VIT_OK)                                                                                                      \
        status = vit_pack_check_##code(p, why);
    VIT_SECTIONS(X)
#undef X
    return status == VIT_OK ? vit_pack_check_brightness(p, why) : status;
}

/* The scene lives as long as the pack in memory, or as `out`. */
static void keep_scene(vit_pack *out, const vit_scene *s) {
#if VIT_BIG_ENDIAN
    out->swapped = *s;
    s = &out->swapped;
#endif
    out->scene = s;
}

vit_status vit_pack_read(const void *bytes, size_t size, vit_pack *out, vit_text *why) {
    *out = (vit_pack){0};
    if (!bytes || (uintptr_t)bytes % 8 != 0)
        return vit_pack_refuse(why, "header: the pack must be in memory, 8-byte aligned");
    vit_pack found = {0};
    vit_status status = check_header(bytes, size, why);
    if (status == VIT_OK)
        status = check_places(bytes, size, &found, why);
    if (status != VIT_OK)
        return status;
    if (found.bytes[VIT_SECTION_META] != sizeof(vit_scene))
        return vit_pack_refuse(why, "section META: %zu bytes, expected %zu", found.bytes[VIT_SECTION_META], sizeof(vit_scene));
    const vit_scene *s = VIT_RECORD(vit_scene, (const vit_scene *)found.section[VIT_SECTION_META], 0);
    if (VIT_BIG_ENDIAN)
        vit_swap_scene((vit_scene *)(uintptr_t)s); /* which is a copy then */
    found.scene = s;
    status = check_contents(&found, why);
    if (status != VIT_OK)
        return status;
    *out = found;
    keep_scene(out, s);
    return VIT_OK;
}
