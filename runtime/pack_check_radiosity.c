/* pack_check_radiosity.c: checks what live radiosity is computed from: every index that its passes use, and weights that give
 * no more light than there is. */
#include "pack_check.h"

#define MOST_WEIGHT 1.001 /* of a patch's points, and of what a receiver sees: 1 but for roundings */

/* Patches share no point, and leave none out but those that fill up the last sixteen. */
vit_status vit_pack_check_PATC(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    vit_u32 end = 0;
    for (vit_u32 i = 0; i < s->patches; i++) {
        const vit_patch *r = VIT_RECORD(vit_patch, (const vit_patch *)p->section[VIT_SECTION_PATC], i);
        if (r->first != end || r->end <= r->first || r->end > s->patch_points)
            return vit_pack_refuse(why, "section PATC: patch %u: points %u to %u of %u, expected from %u on", i, r->first,
                                   r->end, s->patch_points, end);
        if (!all_zero(r->pad, 2))
            return vit_pack_refuse(why, "section PATC: patch %u: padding is not 0", i);
        end = r->end;
    }
    return VIT_OK;
}

static const char *point_fault(const vit_scene *s, const vit_patch_point *q) {
    if (q->patch >= s->patches)
        return "there is no such patch";
    if (!all_finite(q->position, 3) || !is_unit(q->normal))
        return "position is not finite, or normal not a unit vector";
    if (!in_range(q->weight, 0.0f, 1.0f))
        return "weight must be in 0..1";
    if (!all_in_range(q->albedo, 3, 0.0f, VIT_MAX_ALBEDO))
        return "albedo must be in 0..1";
    if (!all_in_range(q->reflect, 3, 0.0f, VIT_MAX_REFLECT))
        return "reflect must be in 0..16";
    return q->pad0 == 0 && q->pad1 == 0 ? 0 : "padding is not 0";
}

vit_status vit_pack_check_PPNT(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_patch_point *points = p->section[VIT_SECTION_PPNT];
    for (vit_u32 i = 0; i < s->patch_points; i++) {
        const char *fault = point_fault(s, VIT_RECORD(vit_patch_point, points, i));
        if (fault)
            return vit_pack_refuse(why, "section PPNT: point %u: %s", i, fault);
    }
    for (vit_u32 i = 0; i < s->patches; i++) {
        const vit_patch *r = VIT_RECORD(vit_patch, (const vit_patch *)p->section[VIT_SECTION_PATC], i);
        const vit_u32 first = r->first, end = r->end;
        double sum = 0.0;
        for (vit_u32 k = first; k < end; k++)
            sum += (double)VIT_RECORD(vit_patch_point, points, k)->weight;
        if (sum > MOST_WEIGHT)
            return vit_pack_refuse(why, "section PPNT: patch %u: weights of its points sum to %g", i, sum);
    }
    return VIT_OK;
}

/* One row's words follow another's. */
vit_status vit_pack_check_GROW(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_gather_row *rows = p->section[VIT_SECTION_GROW];
    const vit_u32 *words = p->section[VIT_SECTION_GATH];
    vit_u32 end = 0;
    for (vit_u32 i = 0; s->patches > 0 && i < s->receivers; i++) {
        const vit_gather_row *r = VIT_RECORD(vit_gather_row, rows, i);
        if (r->first != end || r->ones > VIT_MAX_COLUMNS || r->weighted > s->gather_words ||
            VIT_GATHER_WORDS(r) > s->gather_words - end)
            return vit_pack_refuse(why,
                                   "section GROW: receiver %u: %u columns and %u words from %u on, expected from %u on, of %u",
                                   i, r->ones, r->weighted, r->first, end, s->gather_words);
        if (!in_range(r->scale, 0.0f, 1.0f))
            return vit_pack_refuse(why, "section GROW: receiver %u: scale must be in 0..1", i);
        const double scale = (double)r->scale / VIT_GATHER_ONE;
        uint64_t sum = (uint64_t)r->ones * VIT_GATHER_ONE;
        end += VIT_GATHER_WORDS(r);
        const vit_u32 weighted = r->weighted;
        for (vit_u32 k = end - weighted; k < end; k++)
            sum += *VIT_RECORD(vit_u32, words, k) >> 16;
        if ((double)sum * scale > MOST_WEIGHT)
            return vit_pack_refuse(why, "section GROW: receiver %u: weights sum to %g", i, (double)sum * scale);
    }
    return VIT_OK;
}

/* Columns, of rows that have been checked; and no half of a word in use that none has. */
vit_status vit_pack_check_GATH(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_gather_row *rows = p->section[VIT_SECTION_GROW];
    const vit_u32 *words = p->section[VIT_SECTION_GATH], columns = VIT_PATCH_STRIDE(s) + s->patch_points;
    vit_u32 k = 0;
    for (vit_u32 i = 0; s->patches > 0 && i < s->receivers; i++) {
        const vit_gather_row *r = VIT_RECORD(vit_gather_row, rows, i);
        const vit_u32 ones = (r->ones + 1u) / 2u, end = k + VIT_GATHER_WORDS(r), paired = k + ones;
        const bool odd = r->ones % 2u != 0;
        for (; k < end; k++) {
            const vit_u32 word = *VIT_RECORD(vit_u32, words, k), high = k < paired ? word >> 16 : 0;
            if ((word & 0xffffu) >= columns || high >= columns)
                return vit_pack_refuse(why, "section GATH: word %u: column %u of %u", k,
                                       (word & 0xffffu) >= columns ? word & 0xffffu : high, columns);
            if (odd && k + 1 == paired && high != 0)
                return vit_pack_refuse(why, "section GATH: word %u: padding is not 0", k);
        }
    }
    return VIT_OK;
}

/* Every word is 32 receivers. */
vit_status vit_pack_check_LOOK(const vit_pack *p, vit_text *why) {
    (void)p;
    (void)why;
    return VIT_OK;
}

vit_status vit_pack_check_XFER(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_u32 *words = p->section[VIT_SECTION_XFER];
    vit_text cause = {""};
    if (s->transfer_words == 0)
        return VIT_OK;
    if (vit_transfer_check(words, s->transfer_words, &cause) != VIT_OK)
        return vit_pack_refuse(why, "section XFER: %s", cause.text);
    const vit_transfer h = *VIT_RECORD(vit_transfer, (const vit_transfer *)(const void *)words, 0);
    const vit_u32 sums = h.dense_chunks + h.sparse_chunks + (h.rank > 0);
    if (h.patches != s->patches || h.rank != s->transfer_rank || sums != s->transfer_sums)
        return vit_pack_refuse(why, "section XFER: %u patches, rank %u and %u sums, META says %u, %u and %u", h.patches, h.rank,
                               sums, s->patches, s->transfer_rank, s->transfer_sums);
    return VIT_OK;
}
