#include "pack/effects.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define TOLD 3 /* materials that a reason names */

static const char *const called_when[64] = {
#define X(bit, name, macro, when) [bit] = when,
    VIT_EFFECTS(X)
#undef X
};

void effects_note(effects_reached *reached, uint32_t materials, const uint32_t *words, uint64_t cutout_tests, uint32_t frame) {
    const uint32_t count = EFFECTS_RECORDS(materials);
    for (uint32_t i = 0; i < count; i++) {
        effects_reached *r = &reached[i];
        const uint32_t how = i + 1 < count ? words[i] : cutout_tests > 0 ? VIT_REACHED_VIEW : 0;
        const bool seen = how & VIT_REACHED_VIEW, anew = seen && !(r->how & VIT_REACHED_VIEW);
        if (how == 0 || (!seen && (r->how & VIT_REACHED_VIEW)))
            continue;
        if (r->frames == 0 || anew) {
            r->first = frame;
            r->frames = 0;
        }
        r->last = frame;
        r->frames++;
        r->how |= how;
    }
    for (uint32_t i = 0; i + 1 < count; i++)
        reached[i].how |= words[i];
}

void effects_drop(vit_scene *c, uint64_t effects) {
    uint64_t all = effects;
    for (int i = 0; i < 64; i++)
        if (effects >> i & 1)
            all |= vit_effects_upon((uint64_t)1 << i);
    c->effects &= ~all;
    if (!(c->effects & vit_indirect_makers()))
        c->effects &= ~vit_effects_upon(VIT_BIT(INDIRECT));
    if (!(c->effects & (VIT_BIT(MIRROR) | VIT_BIT(GLASS))))
        c->chain = 0;
    if (!(c->effects & VIT_BIT(GLOSS)))
        c->gloss_rays = 0;
    if (!(c->effects & VIT_BIT(ANTIALIAS))) {
        c->copies = 1;
        c->contrast = 0;
        memset(c->offset, 0, sizeof c->offset);
    }
    if (!(c->effects & VIT_BIT(AREA_LIGHTS)))
        c->area_samples = 0;
    if (!(c->effects & VIT_BIT(SKY_LIGHT)))
        c->sky_samples = 0;
    if (!(c->effects & VIT_BIT(OCCLUSION))) {
        c->cache_cells = c->cache_probes = c->cache_levels = 0;
        c->ambient_radius = c->cache_step = c->cache_detail = c->cache_error = 0;
    }
    if (!(c->effects & VIT_BIT(POINTS))) {
        c->point_levels = 0;
        c->point_step = c->point_detail = 0;
    }
    if (all & (VIT_BIT(AREA_LIGHTS) | VIT_BIT(SKY_LIGHT))) /* what is baked is the light of both together */
        c->effects &= ~vit_effects_upon(VIT_BIT(LIGHTMAP));
    if (!(c->effects & VIT_BIT(LIGHTMAP)))
        c->map_cells = c->map_splits = c->map_receivers = 0;
}

void effects_force(const scene *s, vit_scene *c, effects_decided *out) {
    const uint64_t planned = c->effects;
    /* What may stand idle in a program: it needs nothing that the pack may lack. */
    const uint64_t needs_data = VIT_BIT(SKY_IMAGE) | (planned & VIT_BIT(PHOTONS) ? VIT_BIT(GLOSS) : VIT_BIT(CAUSTICS)) |
                                (planned & VIT_BIT(POINTS) || s->quality.gloss_rays == 0 ? VIT_BIT(GLOSS) : 0);
    const uint64_t idle = (EFFECTS_SETTLED & ~needs_data) | VIT_BIT(AMBIENT);
    if (s->effects_choice == EFFECTS_LISTED)
        effects_drop(c, EFFECTS_NAMED & ~s->effects);
    if (s->effects_choice != EFFECTS_AUTO) {
        c->effects |= idle & (s->effects_choice == EFFECTS_ALL ? idle : s->effects);
        if ((c->effects & (VIT_BIT(MIRROR) | VIT_BIT(GLASS))) && c->chain == 0)
            c->chain = (uint32_t)s->quality.specular_depth;
        if (!(c->effects & VIT_BIT(GGX)))
            c->effects &= ~VIT_BIT(GLOSS);
        if (c->effects & VIT_BIT(GLOSS))
            c->gloss_rays = (uint32_t)s->quality.gloss_rays;
    }
    /* A list may name what needs something that it does not name. */
#define X(effect, needed)                                                                                                      \
    if (!(c->effects & VIT_BIT(needed)))                                                                                       \
        c->effects &= ~VIT_BIT(effect);
    VIT_EFFECT_NEEDS(X)
#undef X
    out->forced_on = s->effects_choice == EFFECTS_AUTO ? 0 : c->effects & EFFECTS_NAMED;
    out->forced_off = planned & ~c->effects;
}

static bool is_positive(const float v[3]) {
    return v[0] > 0.0f || v[1] > 0.0f || v[2] > 0.0f;
}

uint64_t effects_of_material(const vit_material *m, const vit_maps *maps) {
    uint64_t e = m->texture != VIT_NONE ? VIT_BIT(TEXTURES) : 0;
    if (maps->normal != VIT_NONE)
        e |= VIT_BIT(NORMAL_MAPS) | VIT_BIT(TEXTURES) | VIT_BIT(SMOOTH);
    if (m->cutout)
        e |= VIT_BIT(CUTOUT);
    if (is_positive(m->emission))
        e |= VIT_BIT(EMISSION) | (m->lights ? VIT_BIT(AREA_LIGHTS) : 0);
    if (m->kind == VIT_MATTE)
        return e | (is_positive(m->specular) ? VIT_BIT(SPECULAR) | (m->alpha > 0.0f ? VIT_BIT(GGX) | VIT_BIT(GLOSS) : 0) : 0);
    return e | VIT_BIT(CAUSTICS) | (m->kind == VIT_MIRROR ? VIT_BIT(MIRROR) : VIT_BIT(GLASS));
}

/* Rays that an effect is for. */
static uint32_t ways(uint64_t effect) {
    if (effect == VIT_BIT(EMISSION) || effect == VIT_BIT(SKY_IMAGE) || effect == VIT_BIT(GLOSS))
        return VIT_REACHED_VIEW;
    if (effect == VIT_BIT(CAUSTICS))
        return VIT_REACHED_PHOTON | EFFECTS_REACHED_BAKED;
    return VIT_REACHED_VIEW | VIT_REACHED_PHOTON;
}

typedef struct sentence {
    char *text;
    size_t used;
} sentence;

static void say(sentence *s, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void say(sentence *s, const char *format, ...) {
    va_list list;
    va_start(list, format);
    const int n = vsnprintf(s->text + s->used, EFFECTS_REASON - s->used, format, list);
    va_end(list);
    s->used = n > 0 && s->used + (size_t)n < EFFECTS_REASON ? s->used + (size_t)n : EFFECTS_REASON - 1;
}

static void say_frames(sentence *s, const effects_reached *r, uint32_t by, uint32_t frames) {
    if (!(by & r->how & VIT_REACHED_VIEW)) {
        say(s, "met by photons");
        return;
    }
    say(s, "visible in ");
    if (r->frames == frames)
        say(s, "all frames");
    else if (r->first == r->last)
        say(s, "frame %u", r->first);
    else if (r->frames == r->last - r->first + 1)
        say(s, "frames %u-%u", r->first, r->last);
    else
        say(s, "%u of the frames %u-%u", r->frames, r->first, r->last);
}

/* The materials that call for the effect, those that are reached or those that are not. Returns their number. */
static int say_materials(sentence *s, uint64_t effect, const model *m, const effects_looks *looks,
                         const effects_reached *reached, bool which, uint32_t frames) {
    int count = 0;
    for (int i = 0; i < m->material_count; i++) {
        const bool is_reached = reached[i].how & ways(effect);
        if (m->materials[i].triangles == 0 || !(effects_of_material(&looks->materials[i], &looks->maps[i]) & effect) ||
            is_reached != which)
            continue;
        if (count++ >= TOLD)
            continue;
        say(s, "%smaterial '%.60s' (%llu triangle%s)", count > 1 ? "; " : "", m->materials[i].name,
            (unsigned long long)m->materials[i].triangles, m->materials[i].triangles == 1 ? "" : "s");
        if (which) {
            say(s, ", ");
            say_frames(s, &reached[i], ways(effect), frames);
        }
    }
    if (count > TOLD)
        say(s, "; and %d more", count - TOLD);
    return count;
}

/* The record of what the effect acts on that is no material; -1: it acts on materials. */
static int other(uint64_t effect, int materials) {
    switch (effect) {
    case VIT_BIT(SMOOTH):
        return materials;
    case VIT_BIT(SKY_IMAGE):
        return materials + 1;
    case VIT_BIT(CUTOUT):
        return materials + 2;
    default:
        return -1;
    }
}

static const char *what_is_other(uint64_t effect) {
    return effect == VIT_BIT(SMOOTH)      ? "triangles with normals of their own"
           : effect == VIT_BIT(SKY_IMAGE) ? "the sky"
                                          : "cut-out triangles";
}

static bool is_settled(uint64_t effect) {
    return effect & EFFECTS_SETTLED;
}

/* o: the record that says so, or -1. */
static bool is_reached(uint64_t effect, int o, const model *m, const effects_looks *looks, const effects_reached *reached) {
    if (o >= 0)
        return reached[o].how & ways(effect);
    for (int i = 0; i < m->material_count; i++)
        if (m->materials[i].triangles > 0 && (effects_of_material(&looks->materials[i], &looks->maps[i]) & effect) &&
            (reached[i].how & ways(effect)))
            return true;
    return false;
}

static void explain(int bit, const vit_scene *c, const model *m, const effects_looks *looks, const effects_reached *reached,
                    effects_decided *out) {
    const uint64_t effect = (uint64_t)1 << bit;
    const bool forced_on = out->forced_on & effect, forced_off = out->forced_off & effect;
    /* No texel of a cut-out material is tested where cut-outs are left out. */
    const int o = forced_off && effect == VIT_BIT(CUTOUT) ? -1 : other(effect, m->material_count);
    const bool acts = ((c->effects | out->forced_off) & effect) && is_reached(effect, o, m, looks, reached);
    sentence s = {.text = out->reason[bit]};
    if (forced_off && (effect & EFFECTS_NAMED) && (acts || !is_settled(effect)))
        out->missed |= effect;
    if (forced_off)
        say(&s, EFFECTS_FORCED_OFF);
    else if (out->dropped & effect)
        say(&s, "not called for: never reached on the path");
    else if (!(c->effects & effect))
        say(&s, "not called for: would be if ");
    else
        say(&s, forced_on ? "forced on: " : "called for: ");
    if (out->dropped & effect) {
        char names[EFFECTS_REASON] = "";
        sentence of = {.text = names};
        if (say_materials(&of, effect, m, looks, reached, false, c->frames) > 0)
            say(&s, ": %s", names);
    } else if (is_settled(effect) && acts && o >= 0) {
        say(&s, "%s, ", what_is_other(effect));
        say_frames(&s, &reached[o], ways(effect), c->frames);
    } else if (!((effect == VIT_BIT(AREA_LIGHTS) || (is_settled(effect) && acts)) &&
                 say_materials(&s, effect, m, looks, reached, true, c->frames) > 0))
        say(&s, "%s", forced_on && is_settled(effect) ? "nothing on the path calls for it" : called_when[bit]);
}

void effects_settle(vit_scene *c, const model *m, const effects_looks *looks, const effects_reached *reached,
                    effects_decided *out) {
    out->dropped = out->missed = 0;
    for (int bit = 0; bit < 64; bit++) {
        const uint64_t effect = (uint64_t)1 << bit;
        if ((c->effects & effect) && is_settled(effect) && !(out->forced_on & effect) &&
            !is_reached(effect, other(effect, m->material_count), m, looks, reached))
            out->dropped |= effect;
    }
    const uint64_t before = c->effects;
    effects_drop(c, out->dropped);
    out->dropped = before & ~c->effects;
    for (int bit = 0; bit < 64; bit++)
        if (effects_name(bit))
            explain(bit, c, m, looks, reached, out);
}
