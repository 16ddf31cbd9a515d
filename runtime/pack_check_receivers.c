/* pack_check_receivers.c: checks baked places, of indirect light and of the lightmap: every index that the pass samples uses.
 */
#include "pack_check.h"

/* Baked places of one kind. */
typedef struct places {
    const vit_receiver_cell *cells;
    const vit_receiver_split *splits;
    const vit_receiver *receivers;
    vit_u32 cell_count, split_count, receiver_count;
    bool by_rays; /* cells may say that rays have to find their light */
} places;

static places of_indirect(const vit_pack *p) {
    const vit_scene *s = p->scene;
    return (places){.cells = p->section[VIT_SECTION_RCEL],
                    .splits = p->section[VIT_SECTION_RSPL],
                    .receivers = p->section[VIT_SECTION_RECV],
                    .cell_count = s->receiver_cells,
                    .split_count = s->receiver_splits,
                    .receiver_count = s->receivers};
}

static places of_lightmap(const vit_pack *p) {
    const vit_scene *s = p->scene;
    return (places){.cells = p->section[VIT_SECTION_MCEL],
                    .splits = p->section[VIT_SECTION_MSPL],
                    .receivers = p->section[VIT_SECTION_MREC],
                    .cell_count = s->map_cells,
                    .split_count = s->map_splits,
                    .receiver_count = s->map_receivers,
                    .by_rays = s->effects & VIT_BIT(LIGHTMAP_RAYS)};
}

vit_status vit_pack_check_sides(const vit_pack *p, vit_section section, vit_u32 cells, vit_text *why) {
    const vit_u32 *sides = p->section[section];
    for (uint64_t i = 0; cells > 0 && i < 2 * (uint64_t)p->scene->triangles; i++) {
        const vit_u32 side = *VIT_RECORD(vit_u32, sides, i);
        const uint64_t parts = side >> VIT_SIDE_PARTS_SHIFT, first = side & VIT_SIDE_CELL;
        if (parts < 1 || first + parts * parts > cells)
            return vit_pack_refuse(why, "section %s: side %llu: %llu parts from cell %llu on, of %u cells",
                                   section == VIT_SECTION_SIDE ? "SIDE" : "MSID", (unsigned long long)i,
                                   (unsigned long long)parts, (unsigned long long)first, cells);
    }
    return VIT_OK;
}

vit_status vit_pack_check_MSID(const vit_pack *p, vit_text *why) {
    return vit_pack_check_sides(p, VIT_SECTION_MSID, p->scene->map_cells, why);
}

static vit_status check_receivers(const places *s, const vit_u32 receiver[3], const char *code, vit_u32 i, vit_text *why) {
    for (int k = 0; k < 3; k++)
        if (receiver[k] >= s->receiver_count)
            return vit_pack_refuse(why, "section %s: record %u: receiver %u of %u", code, i, receiver[k], s->receiver_count);
    return VIT_OK;
}

/* The least cell that a divided one from `first` on has; `end`: none is divided. */
static vit_u32 least_part(const vit_receiver_cell *cells, vit_u32 first, vit_u32 end) {
    vit_u32 least = end;
    for (vit_u32 i = first; i < end; i++) {
        const vit_receiver_cell *c = VIT_RECORD(vit_receiver_cell, cells, i);
        if (VIT_RECEIVER_IS_DIVIDED(c->split) && c->split != VIT_RECEIVER_BY_RAYS && c->receiver[0] < least)
            least = c->receiver[0];
    }
    return least;
}

/* Its cells must be those from `first` on and before `end`. */
static vit_status check_divided(const char *code, const vit_receiver_cell *c, vit_u32 i, const vit_u32 among[2],
                                vit_text *why) {
    const vit_u32 parts = c->split & ~VIT_RECEIVER_DIVIDED;
    if (parts < 1 || parts > VIT_RECEIVER_PARTS)
        return vit_pack_refuse(why, "section %s: record %u: %u parts, expected 1..%u", code, i, parts, VIT_RECEIVER_PARTS);
    if (c->receiver[0] <= i || c->receiver[0] < among[0] || (uint64_t)c->receiver[0] + (uint64_t)parts * parts > among[1])
        return vit_pack_refuse(why, "section %s: record %u: its cells must be among those from record %u on and before %u",
                               code, i, among[0], among[1]);
    if (c->receiver[1] != 0 || c->receiver[2] != 0)
        return vit_pack_refuse(why, "section %s: record %u: padding is not 0", code, i);
    return VIT_OK;
}

static vit_status check_cell(const char *code, const places *s, const vit_receiver_cell *c, vit_u32 i, vit_text *why) {
    if (s->by_rays && c->split == VIT_RECEIVER_BY_RAYS) {
        if (c->receiver[0] != 0 || c->receiver[1] != 0 || c->receiver[2] != 0)
            return vit_pack_refuse(why, "section %s: record %u: padding is not 0", code, i);
        return VIT_OK;
    }
    const vit_status status = check_receivers(s, c->receiver, code, i, why);
    if (status == VIT_OK && c->split != VIT_NONE && c->split >= s->split_count)
        return vit_pack_refuse(why, "section %s: record %u: split %u of %u", code, i, c->split, s->split_count);
    return status;
}

/* Level after level: cells of those that are divided lie in the next, and after the last none is. */
static vit_status check_cells(const char *code, const places *s, vit_text *why) {
    const vit_u32 count = s->cell_count;
    vit_u32 first = 0;
    for (int level = 0; first < count; level++) {
        const vit_u32 next = least_part(s->cells, first, count), among[2] = {next, least_part(s->cells, next, count)};
        for (vit_u32 i = first; i < next; i++) {
            const vit_receiver_cell *c = VIT_RECORD(vit_receiver_cell, s->cells, i);
            const bool divided = VIT_RECEIVER_IS_DIVIDED(c->split) && !(s->by_rays && c->split == VIT_RECEIVER_BY_RAYS);
            if (divided && level >= VIT_RECEIVER_LEVELS)
                return vit_pack_refuse(why, "section %s: record %u: divided more than %d times", code, i, VIT_RECEIVER_LEVELS);
            const vit_status status = divided ? check_divided(code, c, i, among, why) : check_cell(code, s, c, i, why);
            if (status != VIT_OK)
                return status;
        }
        if (next <= first)
            return vit_pack_refuse(why, "section %s: a divided cell's cells begin at record %u, expected behind %u", code, next,
                                   first);
        first = next;
    }
    return VIT_OK;
}

vit_status vit_pack_check_RCEL(const vit_pack *p, vit_text *why) {
    if (p->scene->effects & VIT_BIT(POINTS))
        return vit_pack_check_points(p, why);
    const places s = of_indirect(p);
    return check_cells("RCEL", &s, why);
}

vit_status vit_pack_check_MCEL(const vit_pack *p, vit_text *why) {
    const places s = of_lightmap(p);
    return check_cells("MCEL", &s, why);
}

static vit_status check_splits(const char *code, const places *s, vit_text *why) {
    for (vit_u32 i = 0; i < s->split_count; i++) {
        const vit_receiver_split *c = VIT_RECORD(vit_receiver_split, s->splits, i);
        const vit_status status = check_receivers(s, c->receiver, code, i, why);
        if (status != VIT_OK)
            return status;
        if (!is_unit(c->normal) || !all_finite(&c->offset, 1))
            return vit_pack_refuse(why, "section %s: record %u: its normal is not a unit vector, or its offset not finite",
                                   code, i);
        if (c->pad != 0)
            return vit_pack_refuse(why, "section %s: record %u: padding is not 0", code, i);
    }
    return VIT_OK;
}

vit_status vit_pack_check_RSPL(const vit_pack *p, vit_text *why) {
    const places s = of_indirect(p);
    return check_splits("RSPL", &s, why);
}

vit_status vit_pack_check_MSPL(const vit_pack *p, vit_text *why) {
    const places s = of_lightmap(p);
    return check_splits("MSPL", &s, why);
}

static vit_status check_light(const char *code, const places *s, vit_text *why) {
    for (vit_u32 i = 0; i < s->receiver_count; i++) {
        const vit_receiver *r = VIT_RECORD(vit_receiver, s->receivers, i);
        if (!all_in_range(r->irradiance, 3, 0.0f, VIT_MAX_PHOTON) || r->pad != 0)
            return vit_pack_refuse(why, "section %s: receiver %u: irradiance must be in 0..%g, and padding 0", code, i,
                                   (double)VIT_MAX_PHOTON);
    }
    return VIT_OK;
}

vit_status vit_pack_check_RECV(const vit_pack *p, vit_text *why) {
    const places s = of_indirect(p);
    return check_light("RECV", &s, why);
}

vit_status vit_pack_check_MREC(const vit_pack *p, vit_text *why) {
    const places s = of_lightmap(p);
    return check_light("MREC", &s, why);
}
