/* pack_check_cache.c: checks tables of the world-space cache: that what is in them is found, and that planes are such. Any
 * code is a value of a point; receivers at points are there. */
#include "pack_check.h"

#define POINT_BITS 0x3fffffffu
#define SIGN 0x80000000u
#define FARTHEST 0x45800000u /* 4096 as a float: 512 times 8 boxes */

typedef struct table {
    const vit_cache_cell *cells;
    vit_u32 count, probes;
    const char *code;
} table;

/* A look-up goes from a key's place on, over smaller keys, until it meets the key. */
static vit_status check_place(const table *t, vit_u32 i, vit_text *why) {
    const vit_u32 key = VIT_RECORD(vit_cache_cell, t->cells, i)->key, tag = VIT_RECORD(vit_cache_cell, t->cells, i)->word[2],
                  mask = t->count - 1, steps = (i - key) & mask;
    if (steps >= t->probes)
        return vit_pack_refuse(why, "section %s: record %u is %u records from its key's place, expected less than %u", t->code,
                               i, steps, t->probes);
    for (vit_u32 k = 0; k < steps; k++) {
        const vit_cache_cell *before = VIT_RECORD(vit_cache_cell, t->cells, (key + k) & mask);
        if (before->key > key || (before->key == key && ((before->word[2] ^ tag) & VIT_CACHE_TAG) == 0))
            return vit_pack_refuse(why, "section %s: record %u is not found behind record %u", t->code, i, (key + k) & mask);
    }
    return VIT_OK;
}

/* What cells of either kind are. `most`: bits that the words of a cell that is not parted may have. */
static vit_status check_cell(const table *t, vit_u32 i, const vit_u32 most[3], vit_text *why) {
    const vit_cache_cell *c = VIT_RECORD(vit_cache_cell, t->cells, i);
    const bool empty = c->key == VIT_CACHE_EMPTY, parted = (c->word[2] & VIT_CACHE_PARTED) == VIT_CACHE_PARTED;
    if (parted && !empty && c->word[1] - SIGN > FARTHEST)
        return vit_pack_refuse(why, "section %s: record %u: its plane is none", t->code, i);
    for (int k = parted && !empty ? 3 : 0; k < 3; k++)
        if (c->word[k] & ~(empty ? 0u : most[k]))
            return vit_pack_refuse(why, "section %s: record %u: bits that no point has are not 0", t->code, i);
    return empty ? VIT_OK : check_place(t, i, why);
}

vit_status vit_pack_check_CACH(const vit_pack *p, vit_text *why) {
    static const vit_u32 most[3] = {POINT_BITS, POINT_BITS, 0xffffffffu};
    const vit_scene *s = p->scene;
    const table t = {p->section[VIT_SECTION_CACH], s->cache_cells, s->cache_probes, "CACH"};
    vit_status status = VIT_OK;
    for (vit_u32 i = 0; i < t.count && status == VIT_OK; i++)
        status = check_cell(&t, i, most, why);
    return status;
}

/* Every index that the pass point_light uses. */
vit_status vit_pack_check_points(const vit_pack *p, vit_text *why) {
    static const vit_u32 most[3] = {0xffffffffu, 0xffffffffu, VIT_CACHE_TAG};
    const vit_scene *s = p->scene;
    const table t = {p->section[VIT_SECTION_RCEL], s->receiver_cells, VIT_CACHE_PROBES, "RCEL"};
    for (vit_u32 i = 0; i < t.count; i++) {
        const vit_status status = check_cell(&t, i, most, why);
        if (status != VIT_OK)
            return status;
        const vit_cache_cell *c = VIT_RECORD(vit_cache_cell, t.cells, i);
        if (c->key == VIT_CACHE_EMPTY || (c->word[2] & VIT_CACHE_PARTED))
            continue;
        for (vit_u32 q = 0; q < VIT_CACHE_POINTS; q++) {
            const vit_u32 point = c->word[1] >> VIT_POINT_BITS * q & VIT_POINT_NONE;
            if (point != VIT_POINT_NONE && (point >= VIT_CACHE_POINTS || c->word[0] >= s->receivers - point))
                return vit_pack_refuse(why, "section RCEL: record %u: receiver %u of %u", i, c->word[0] + point, s->receivers);
        }
    }
    return VIT_OK;
}
