/* pack_check_cache.c: checks the table of the world-space cache: that what is in it is found, and that planes are such. Any
 * code is a value of a point. */
#include "pack_check.h"

#define POINT_BITS 0x3fffffffu
#define SIGN 0x80000000u
#define FARTHEST 0x45800000u /* 4096 as a float: 512 times 8 boxes */

/* A look-up goes from a key's place on, over smaller keys, until it meets the key. */
static vit_status check_place(const vit_scene *s, const vit_cache_cell *cells, vit_u32 i, vit_text *why) {
    const vit_u32 key = VIT_RECORD(vit_cache_cell, cells, i)->key, tag = VIT_RECORD(vit_cache_cell, cells, i)->word[2],
                  mask = s->cache_cells - 1, steps = (i - key) & mask;
    if (steps >= s->cache_probes)
        return vit_pack_refuse(why, "section CACH: record %u is %u records from its key's place, expected less than %u", i,
                               steps, s->cache_probes);
    for (vit_u32 k = 0; k < steps; k++) {
        const vit_cache_cell *before = VIT_RECORD(vit_cache_cell, cells, (key + k) & mask);
        if (before->key > key || (before->key == key && ((before->word[2] ^ tag) & VIT_CACHE_TAG) == 0))
            return vit_pack_refuse(why, "section CACH: record %u is not found behind record %u", i, (key + k) & mask);
    }
    return VIT_OK;
}

vit_status vit_pack_check_CACH(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_cache_cell *cells = p->section[VIT_SECTION_CACH];
    for (vit_u32 i = 0; i < s->cache_cells; i++) {
        const vit_cache_cell *c = VIT_RECORD(vit_cache_cell, cells, i);
        const bool empty = c->key == VIT_CACHE_EMPTY, parted = (c->word[2] & VIT_CACHE_PARTED) == VIT_CACHE_PARTED;
        if (parted && !empty && c->word[1] - SIGN > FARTHEST)
            return vit_pack_refuse(why, "section CACH: record %u: its plane is none", i);
        for (int k = parted && !empty ? 2 : 0; k < 3; k++)
            if (c->word[k] > (empty ? 0u : k < 2 ? POINT_BITS : 0xffffffffu))
                return vit_pack_refuse(why, "section CACH: record %u: bits that no point has are not 0", i);
        const vit_status status = empty ? VIT_OK : check_place(s, cells, i, why);
        if (status != VIT_OK)
            return status;
    }
    return VIT_OK;
}
