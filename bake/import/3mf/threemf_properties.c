/* Groups of properties: base materials (Core 5), colours, texture coordinates, mixtures, layers, metals (Materials 2 to 8). */
#include "common/strict_math.h"
#include "import/3mf/threemf_file.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* "#RRGGBB" or "#RRGGBBAA". */
static bool read_color(const char *text, uint8_t out[4]) {
    const size_t digits = strlen(text) - 1;
    out[3] = 255;
    if (text[0] != '#' || (digits != 6 && digits != 8) || strspn(text + 1, "0123456789abcdefABCDEF") != digits)
        return false;
    for (size_t i = 0; i < digits / 2; i++) {
        unsigned value = 0;
        for (size_t k = 1; k < 3; k++) {
            const char c = text[2 * i + k];
            value = 16 * value + (unsigned)(c <= '9' ? c - '0' : (c | 32) - 'a' + 10);
        }
        out[i] = (uint8_t)value;
    }
    return true;
}

static bool add_color(threemf_file *f, const uint8_t rgba[4], uint32_t name) {
    if (f->color_count >= THREEMF_PAINTED)
        return import_fail(f->im, "has too many colours");
    if (!import_room(f->im, &f->colors, &f->color_room, f->color_count + 1, sizeof *f->colors))
        return false;
    threemf_color *c = &f->colors[f->color_count++];
    *c = (threemf_color){.name = name, .look = THREEMF_NONE};
    memcpy(c->rgba, rgba, sizeof c->rgba);
    return true;
}

static threemf_group *last(threemf_file *f) {
    return &f->groups[f->group_count - 1];
}

/* ---- groups ---- */

static bool read_wrap(threemf_xml *x, const threemf_element *e, const char *name, uint32_t *wrap, bool *none) {
    const char *style = threemf_attribute(e, name);
    *none = style && strcmp(style, "none") == 0;
    if (!style || strcmp(style, "wrap") == 0)
        *wrap = VIT_WRAP_REPEAT;
    else if (strcmp(style, "mirror") == 0)
        *wrap = VIT_WRAP_MIRROR;
    else if (strcmp(style, "clamp") == 0 || *none)
        *wrap = VIT_WRAP_CLAMP;
    else
        return threemf_wrong(x, "%s '%.40s' is none", name, style);
    return true;
}

static bool begin_texture(threemf_xml *x, const threemf_element *e) {
    threemf_group *g = last(x->f);
    const char *path = threemf_attribute(e, "path");
    if (!path)
        return threemf_wrong(x, "<texture2d> has no path");
    return read_wrap(x, e, "tilestyleu", &g->wrap_u, &g->none_u) && read_wrap(x, e, "tilestylev", &g->wrap_v, &g->none_v) &&
           threemf_keep(x->f, path, &g->path);
}

/* Numbers of base materials, which each of the composites mixes. */
static bool read_mixed(threemf_xml *x, const threemf_element *e) {
    threemf_file *f = x->f;
    threemf_group *g = last(f);
    const char *at = threemf_attribute(e, "matindices");
    g->mixed = (uint32_t)f->mixed_count;
    for (uint32_t index; at && *at; g->mixes++) {
        if (!threemf_next_index(&at, &index))
            return threemf_wrong(x, "matindices of <compositematerials> are no indices");
        if (!import_room(f->im, &f->mixed, &f->mixed_room, f->mixed_count + 1, sizeof *f->mixed))
            return false;
        f->mixed[f->mixed_count++] = index;
    }
    return true;
}

/* Of several layers the last is what is seen. */
static bool read_layers(threemf_xml *x, const threemf_element *e) {
    threemf_group *g = last(x->f);
    const char *at = threemf_attribute(e, "pids");
    while (at && *at) {
        if (!threemf_next_index(&at, &g->of))
            return threemf_wrong(x, "pids of <multiproperties> are no ids");
        g->mixes++;
    }
    return g->mixes < 2 || import_not_done(x->f->im, "of <multiproperties> the last layer is shown, and others left out");
}

static bool read_reference(threemf_xml *x, const threemf_element *e, const char *name) {
    const int has = threemf_read_index(x, e, name, &last(x->f)->of);
    return has > 0 || (has == 0 && threemf_wrong(x, "<%.40s> has no %s", e->name, name));
}

bool threemf_begin_group(threemf_xml *x, const threemf_element *e, uint32_t part, threemf_kind kind) {
    threemf_file *f = x->f;
    if (!import_room(f->im, &f->groups, &f->group_room, f->group_count + 1, sizeof *f->groups) ||
        !threemf_add_resource(x, e, part, kind, f->group_count))
        return false;
    const size_t first[] = {[THREEMF_BASES] = f->color_count,
                            [THREEMF_COLORGROUP] = f->color_count,
                            [THREEMF_COMPOSITES] = f->color_count,
                            [THREEMF_COORDINATES] = f->uv_count,
                            [THREEMF_MULTIS] = f->pick_count,
                            [THREEMF_METALS] = f->metal_count,
                            [THREEMF_TEXTURE] = 0};
    threemf_group *g = &f->groups[f->group_count++];
    *g = (threemf_group){.kind = kind,
                         .part = part,
                         .first = (uint32_t)first[kind],
                         .of = THREEMF_NONE,
                         .display = THREEMF_NONE,
                         .look = THREEMF_NONE};
    if (threemf_read_index(x, e, "displaypropertiesid", &g->display) < 0)
        return false;
    switch (kind) {
    case THREEMF_TEXTURE:
        return begin_texture(x, e);
    case THREEMF_COORDINATES:
        return read_reference(x, e, "texid");
    case THREEMF_COMPOSITES:
        return read_reference(x, e, "matid") && read_mixed(x, e);
    case THREEMF_MULTIS:
        return read_layers(x, e);
    default:
        return true;
    }
}

/* ---- what is in them ---- */

static bool add_base(threemf_xml *x, const threemf_element *e) {
    const char *name = threemf_attribute(e, "name"), *color = threemf_attribute(e, "displaycolor");
    uint8_t rgba[4];
    uint32_t kept = THREEMF_NONE;
    if (!color)
        return threemf_wrong(x, "<base> has no displaycolor");
    if (!read_color(color, rgba))
        return threemf_wrong(x, "displaycolor '%.40s' is not #RRGGBB or #RRGGBBAA", color);
    return (!name || !*name || threemf_keep(x->f, name, &kept)) && add_color(x->f, rgba, kept);
}

/* Opaque, whatever it says (Materials 2.1). */
static bool add_group_color(threemf_xml *x, const threemf_element *e) {
    const char *color = threemf_attribute(e, "color");
    uint8_t rgba[4];
    if (!color)
        return threemf_wrong(x, "<color> has no color");
    if (!read_color(color, rgba))
        return threemf_wrong(x, "color '%.40s' is not #RRGGBB or #RRGGBBAA", color);
    if (rgba[3] < 255 && threemf_is_new(x->f, "alpha"))
        import_warn(x->f->im, "alpha of colours is left out: 3MF has them opaque");
    return add_color(x->f, rgba, THREEMF_NONE);
}

static bool add_coordinate(threemf_xml *x, const threemf_element *e) {
    threemf_file *f = x->f;
    const char *u = threemf_attribute(e, "u"), *v = threemf_attribute(e, "v");
    double at[2];
    if (!u || !v || !threemf_next_number(&u, true, &at[0]) || !threemf_next_number(&v, true, &at[1]) || *u || *v)
        return threemf_wrong(x, "<tex2coord> has not two numbers, u and v");
    if (f->uv_count >= THREEMF_NONE - 1)
        return threemf_wrong(x, "has too many texture coordinates");
    if (!import_room(f->im, &f->uv, &f->uv_room, f->uv_count + 1, 2 * sizeof *f->uv))
        return false;
    f->uv[2 * f->uv_count] = (float)at[0];
    f->uv[2 * f->uv_count++ + 1] = (float)at[1];
    return true;
}

/* The group of base materials, which stands before what refers to it (Core 3.4.2). */
static const threemf_group *bases_of(const threemf_file *f, const threemf_group *g) {
    for (size_t i = f->resource_count; i-- > 0;) {
        const threemf_resource *r = &f->resources[i];
        if (r->part == g->part && r->id == g->of)
            return r->kind == THREEMF_BASES ? &f->groups[r->index] : NULL;
    }
    return NULL;
}

/* The nearest sRGB value of 8 bits. */
static uint8_t encode(double linear) {
    unsigned low = 0;
    for (unsigned step = 128; step > 0; step /= 2)
        if (low + step < 256 && srgb_linear((low + step - 0.5) / 255.0) <= linear)
            low += step;
    return (uint8_t)low;
}

/* The mean of its materials' reflectances; the specification does not say in which space they are mixed. */
static bool add_composite(threemf_xml *x, const threemf_element *e) {
    threemf_file *f = x->f;
    const threemf_group *g = last(f), *bases = bases_of(f, g);
    const char *at = threemf_attribute(e, "values");
    double sum = 0.0, mean[4] = {0.0, 0.0, 0.0, 0.0};
    if (!bases || g->mixes == 0)
        return threemf_wrong(x, "<compositematerials> mixes no base materials");
    for (int all = 0; all < 2 && sum <= 0.0; all++) /* those that sum up to 0 are all alike */
        for (uint32_t i = 0; i < g->mixes; i++) {
            const uint32_t index = f->mixed[g->mixed + i];
            double share = all;
            if (!all && at && *at && !threemf_next_number(&at, false, &share))
                return threemf_wrong(x, "values of <composite> are no numbers");
            if (index >= bases->count)
                return threemf_wrong(x, "<compositematerials> mixes a base material %u that is not there", index);
            share = share > 0.0 && share <= 1e9 ? share : 0.0;
            const uint8_t *rgba = f->colors[bases->first + index].rgba;
            sum += share;
            for (int k = 0; k < 4; k++)
                mean[k] += share * (k < 3 ? srgb_linear(rgba[k] / 255.0) : rgba[k] / 255.0);
        }
    uint8_t rgba[4];
    for (int k = 0; k < 4; k++)
        rgba[k] = k < 3 ? encode(mean[k] / sum) : (uint8_t)lround(255.0 * mean[k] / sum);
    return add_color(f, rgba, THREEMF_NONE);
}

/* The index in the last layer; 0 where there is none (Materials 5.1). */
static bool add_multi(threemf_xml *x, const threemf_element *e) {
    threemf_file *f = x->f;
    const threemf_group *g = last(f);
    const char *at = threemf_attribute(e, "pindices");
    uint32_t pick = 0, value;
    for (uint32_t i = 0; at && *at; i++) {
        if (!threemf_next_index(&at, &value))
            return threemf_wrong(x, "pindices of <multi> are no indices");
        if (i + 1 == g->mixes)
            pick = value;
    }
    if (!import_room(f->im, &f->picks, &f->pick_room, f->pick_count + 1, sizeof *f->picks))
        return false;
    f->picks[f->pick_count++] = pick;
    return true;
}

static bool add_metal(threemf_xml *x, const threemf_element *e) {
    static const char *const names[] = {"metallicness", "roughness"};
    threemf_file *f = x->f;
    if (!import_room(f->im, &f->metals, &f->metal_room, f->metal_count + 1, 2 * sizeof *f->metals))
        return false;
    for (int k = 0; k < 2; k++) {
        const char *at = threemf_attribute(e, names[k]);
        double value = k; /* no metal, rough */
        if (at && (!threemf_next_number(&at, true, &value) || *at))
            return threemf_wrong(x, "%s of <pbmetallic> is no number", names[k]);
        f->metals[2 * f->metal_count + (size_t)k] = import_clamp((float)value, 1.0f);
    }
    f->metal_count++;
    return true;
}

bool threemf_add_property(threemf_xml *x, const threemf_element *e) {
    static const struct {
        threemf_kind kind;
        const char *name;
        bool (*add)(threemf_xml *x, const threemf_element *e);
    } known[] = {{THREEMF_BASES, "base", add_base},
                 {THREEMF_COLORGROUP, "color", add_group_color},
                 {THREEMF_COORDINATES, "tex2coord", add_coordinate},
                 {THREEMF_COMPOSITES, "composite", add_composite},
                 {THREEMF_MULTIS, "multi", add_multi},
                 {THREEMF_METALS, "pbmetallic", add_metal}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (known[i].kind == last(x->f)->kind && strcmp(known[i].name, e->name) == 0) {
            last(x->f)->count++;
            return known[i].add(x, e);
        }
    return threemf_leave_out(x->f, e);
}
