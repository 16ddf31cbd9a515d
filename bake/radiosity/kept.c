#include "radiosity/kept.h"

static bool same(double a, double b) {
    return !(a < b) && !(a > b);
}

static bool is_of(const baked_kept_one *o, const baked_input *in, uint64_t effects) {
    const baked_input *k = &o->in;
    return o->asked > 0 && o->effects == effects && k->frames == in->frames && k->width == in->width &&
           k->height == in->height && k->still_count == in->still_count && k->moving_count == in->moving_count &&
           k->live == in->live && k->points == in->points && same(k->point_spacing, in->point_spacing) &&
           k->reflections == in->reflections && same(k->spacing, in->spacing) && same(k->error, in->error) &&
           k->receiver_rays == in->receiver_rays && k->within == in->within && k->panes == in->panes;
}

static bool copy(const baked *from, const baked_input *in, baked *to) {
    const receivers *r = &from->receivers;
    const basis *b = &from->basis;
    *to = *from;
    to->still = receivers_copied(from->still, r->count, sizeof *from->still);
    to->points.table.records =
        receivers_copied(from->points.table.records, from->points.table.count, sizeof *from->points.table.records);
    to->frames = receivers_copied(from->frames, (size_t)in->frames * from->lights, sizeof *from->frames);
    to->basis.groups = receivers_copied(b->groups, (size_t)b->group_count * from->lights, sizeof *b->groups);
    to->basis.words = receivers_copied(b->words, b->word_count, sizeof *b->words);
    to->basis.coefficients = receivers_copied(b->coefficients, b->coefficient_count, sizeof *b->coefficients);
    if (receivers_copy(r, from->placed, &to->receivers) && !to->still == !from->still && !to->frames == !from->frames &&
        !to->points.table.records == !from->points.table.records && !to->basis.groups == !b->groups &&
        !to->basis.words == !b->words && !to->basis.coefficients == !b->coefficients)
        return true;
    baked_free(to);
    return false;
}

bool baked_kept_get(baked_kept *k, const baked_input *in, uint64_t effects, baked *out) {
    for (int i = 0; i < BAKED_KEPT; i++)
        if (is_of(k->one + i, in, effects) && copy(&k->one[i].baked, in, out)) {
            k->one[i].asked = ++k->asked;
            k->found++;
            return true;
        }
    return false;
}

void baked_kept_put(baked_kept *k, const baked_input *in, uint64_t effects, const baked *b) {
    baked_kept_one *o = k->one;
    for (int i = 1; i < BAKED_KEPT; i++)
        o = k->one[i].asked < o->asked ? k->one + i : o;
    baked_free(&o->baked);
    *o = (baked_kept_one){.in = *in, .effects = effects};
    if (copy(b, in, &o->baked))
        o->asked = ++k->asked;
}

void baked_kept_free(baked_kept *k) {
    for (int i = 0; i < BAKED_KEPT; i++)
        baked_free(&k->one[i].baked);
    *k = (baked_kept){0};
}
