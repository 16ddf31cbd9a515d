/* pack_check_basis.c: checks what is baked for receivers: every index that the passes relight and estimate use. */
#include "pack_check.h"

#define MOST_KNOTS (1u << 24) /* times VIT_BASIS_RANK within 32 bits, as the kernel counts */

static vit_status check_receivers(const vit_scene *s, const vit_u32 receiver[3], const char *code, vit_u32 i, vit_text *why) {
    for (int k = 0; k < 3; k++)
        if (receiver[k] >= s->receivers)
            return vit_pack_refuse(why, "section %s: record %u: receiver %u of %u", code, i, receiver[k], s->receivers);
    return VIT_OK;
}

/* The least cell that a divided one from `first` on has; `end`: none is divided. */
static vit_u32 least_part(const vit_receiver_cell *cells, vit_u32 first, vit_u32 end) {
    vit_u32 least = end;
    for (vit_u32 i = first; i < end; i++) {
        const vit_receiver_cell *c = VIT_RECORD(vit_receiver_cell, cells, i);
        if (VIT_RECEIVER_IS_DIVIDED(c->split) && c->receiver[0] < least)
            least = c->receiver[0];
    }
    return least;
}

/* Its cells must be those from `first` on and before `end`. */
static vit_status check_divided(const vit_receiver_cell *c, vit_u32 i, vit_u32 first, vit_u32 end, vit_text *why) {
    const vit_u32 parts = c->split & ~VIT_RECEIVER_DIVIDED;
    if (parts < 1 || parts > VIT_RECEIVER_PARTS)
        return vit_pack_refuse(why, "section RCEL: record %u: %u parts, expected 1..%u", i, parts, VIT_RECEIVER_PARTS);
    if (c->receiver[0] <= i || c->receiver[0] < first || (uint64_t)c->receiver[0] + (uint64_t)parts * parts > end)
        return vit_pack_refuse(why, "section RCEL: record %u: its cells must be among those from record %u on and before %u", i,
                               first, end);
    if (c->receiver[1] != 0 || c->receiver[2] != 0)
        return vit_pack_refuse(why, "section RCEL: record %u: padding is not 0", i);
    return VIT_OK;
}

static vit_status check_cell(const vit_scene *s, const vit_receiver_cell *c, vit_u32 i, vit_text *why) {
    const vit_status status = check_receivers(s, c->receiver, "RCEL", i, why);
    if (status == VIT_OK && c->split != VIT_NONE && c->split >= s->receiver_splits)
        return vit_pack_refuse(why, "section RCEL: record %u: split %u of %u", i, c->split, s->receiver_splits);
    return status;
}

/* Level after level: cells of those that are divided lie in the next, and after the last none is. */
vit_status vit_pack_check_RCEL(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_receiver_cell *cells = p->section[VIT_SECTION_RCEL];
    const vit_u32 count = s->receiver_cells;
    vit_u32 first = 0;
    for (int level = 0; first < count; level++) {
        const vit_u32 next = least_part(cells, first, count), end = least_part(cells, next, count);
        for (vit_u32 i = first; i < next; i++) {
            const vit_receiver_cell *c = VIT_RECORD(vit_receiver_cell, cells, i);
            const bool divided = VIT_RECEIVER_IS_DIVIDED(c->split);
            if (divided && level >= VIT_RECEIVER_LEVELS)
                return vit_pack_refuse(why, "section RCEL: record %u: divided more than %d times", i, VIT_RECEIVER_LEVELS);
            const vit_status status = divided ? check_divided(c, i, next, end, why) : check_cell(s, c, i, why);
            if (status != VIT_OK)
                return status;
        }
        if (next <= first)
            return vit_pack_refuse(why, "section RCEL: a divided cell's cells begin at record %u, expected behind %u", next,
                                   first);
        first = next;
    }
    return VIT_OK;
}

vit_status vit_pack_check_RSPL(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_receiver_split *splits = p->section[VIT_SECTION_RSPL];
    for (vit_u32 i = 0; i < s->receiver_splits; i++) {
        const vit_receiver_split *c = VIT_RECORD(vit_receiver_split, splits, i);
        const vit_status status = check_receivers(s, c->receiver, "RSPL", i, why);
        if (status != VIT_OK)
            return status;
        if (!is_unit(c->normal) || !all_finite(&c->offset, 1))
            return vit_pack_refuse(why, "section RSPL: record %u: its normal is not a unit vector, or its offset not finite",
                                   i);
        if (c->pad != 0)
            return vit_pack_refuse(why, "section RSPL: record %u: padding is not 0", i);
    }
    return VIT_OK;
}

vit_status vit_pack_check_RECV(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_receiver *receivers = p->section[VIT_SECTION_RECV];
    for (vit_u32 i = 0; i < s->receivers; i++) {
        const vit_receiver *r = VIT_RECORD(vit_receiver, receivers, i);
        if (!all_in_range(r->irradiance, 3, 0.0f, VIT_MAX_PHOTON) || r->pad != 0)
            return vit_pack_refuse(why, "section RECV: receiver %u: irradiance must be in 0..%g, and padding 0", i,
                                   (double)VIT_MAX_PHOTON);
    }
    return VIT_OK;
}

/* One past the last knot that any frame uses of the lights' row l. */
static vit_u32 knots_of(const vit_pack *p, vit_u32 l) {
    const vit_scene *s = p->scene;
    vit_u32 most = 0;
    for (vit_u32 f = 0; f < s->frames; f++) {
        const vit_basis_frame *at =
            VIT_RECORD(vit_basis_frame, (const vit_basis_frame *)p->section[VIT_SECTION_BFRM], (size_t)f * s->basis_lights + l);
        const vit_u32 end = at->knot + 1 + (at->weight > 0.0f ? 1u : 0u);
        most = end > most ? end : most;
    }
    return most;
}

/* BFRM has not been checked yet when BGRP is: both are looked at here, and frames first. */
vit_status vit_pack_check_BGRP(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_basis_group *groups = p->section[VIT_SECTION_BGRP];
    const vit_status status = vit_pack_check_BFRM(p, why);
    if (status != VIT_OK)
        return status;
    const vit_u32 count = s->receivers / VIT_BASIS_GROUP;
    for (vit_u32 l = 0; l < s->basis_lights; l++) {
        const uint64_t knots = knots_of(p, l);
        for (vit_u32 g = 0; g < count; g++) {
            const vit_u32 i = g * s->basis_lights + l;
            const vit_basis_group *b = VIT_RECORD(vit_basis_group, groups, i);
            if (b->rank > VIT_BASIS_RANK || b->pad != 0)
                return vit_pack_refuse(why, "section BGRP: record %u: rank must be in 0..%u, and padding 0", i, VIT_BASIS_RANK);
            if ((uint64_t)b->first_word + (uint64_t)b->rank * (VIT_BASIS_GROUP / 2) > s->basis_words)
                return vit_pack_refuse(why, "section BGRP: record %u: vectors run beyond the %u words of META", i,
                                       s->basis_words);
            if (b->first_coefficient + knots * b->rank > s->basis_coefficients)
                return vit_pack_refuse(why, "section BGRP: record %u: coefficients run beyond the %u of META", i,
                                       s->basis_coefficients);
        }
    }
    return VIT_OK;
}

/* Every word is two numbers. */
vit_status vit_pack_check_BWRD(const vit_pack *p, vit_text *why) {
    (void)p;
    (void)why;
    return VIT_OK;
}

vit_status vit_pack_check_BCOE(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_basis_coefficient *coefficients = p->section[VIT_SECTION_BCOE];
    for (vit_u32 i = 0; i < s->basis_coefficients; i++) {
        const vit_basis_coefficient *c = VIT_RECORD(vit_basis_coefficient, coefficients, i);
        if (!all_in_range(c->rgb, 3, -VIT_MAX_PHOTON, VIT_MAX_PHOTON) || c->pad != 0)
            return vit_pack_refuse(why, "section BCOE: record %u: must be in -%g..%g, and padding 0", i, (double)VIT_MAX_PHOTON,
                                   (double)VIT_MAX_PHOTON);
    }
    return VIT_OK;
}

/* Lights ascend within a frame: one that came twice would shine with twice its intensity. A light that lights no receiver has
 * knots but no coefficients. */
vit_status vit_pack_check_BFRM(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_basis_frame *frames = p->section[VIT_SECTION_BFRM];
    vit_u32 least = 0;
    for (uint64_t i = 0; i < (uint64_t)s->frames * s->basis_lights; i++) {
        const vit_basis_frame *at = VIT_RECORD(vit_basis_frame, frames, i);
        least = i % s->basis_lights == 0 ? 0 : least;
        if (at->light < least || at->light >= s->lights)
            return vit_pack_refuse(why, "section BFRM: record %llu: light %u, expected one of %u..%u", (unsigned long long)i,
                                   at->light, least, s->lights - 1);
        if (at->knot > MOST_KNOTS || !in_range(at->weight, 0.0f, 1.0f) || at->pad != 0)
            return vit_pack_refuse(why, "section BFRM: record %llu: knot %u or weight %g is out of range, or padding not 0",
                                   (unsigned long long)i, at->knot, (double)at->weight);
        least = at->light + 1;
    }
    return VIT_OK;
}

static double largest(const float c[3]) {
    double most = 0.0;
    for (int k = 0; k < 3; k++) {
        const double v = c[k] < 0.0f ? -(double)c[k] : (double)c[k];
        most = v > most ? v : most;
    }
    return most;
}

/* As if all coefficients were the largest, and all vectors' numbers too. */
double vit_pack_basis_bound(const vit_pack *p, double *still) {
    const vit_scene *s = p->scene;
    double coefficient = 0.0;
    *still = 0.0;
    for (vit_u32 i = 0; i < s->receivers; i++) {
        const double e = largest(VIT_RECORD(vit_receiver, (const vit_receiver *)p->section[VIT_SECTION_RECV], i)->irradiance);
        *still = e > *still ? e : *still;
    }
    for (vit_u32 i = 0; i < s->basis_coefficients; i++) {
        const double c =
            largest(VIT_RECORD(vit_basis_coefficient, (const vit_basis_coefficient *)p->section[VIT_SECTION_BCOE], i)->rgb);
        coefficient = c > coefficient ? c : coefficient;
    }
    return coefficient * 32768.0 * VIT_BASIS_RANK;
}
