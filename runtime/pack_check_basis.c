/* pack_check_basis.c: checks what light that moves does to receivers: every index that the pass relight uses. */
#include "pack_check.h"

#define MOST_KNOTS (1u << 24) /* times VIT_BASIS_RANK within 32 bits, as the kernel counts */

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
