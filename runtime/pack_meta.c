/* pack_meta.c: checks META, on which all other checks stand: counts, derived fields, floats, effects. */
#include "pack_check.h"

#include <stddef.h>
#include <string.h>

#define MAX_NODES (1u << 26)
#define MAX_LIST (1u << 28)
#define MAX_SLICE (1u << 24) /* slice numbers pass through floats, exact up to here */

static vit_status check_derived(const vit_scene *s, vit_text *why) {
    vit_scene derived = *s;
    vit_text cause = {""};
    if (vit_pack_derive(&derived, &cause) != VIT_OK)
        return vit_pack_refuse(why, "section META: %s", cause.text);
#define FIELD(name)                                                                                                            \
    { #name, offsetof(vit_scene, name), sizeof s->name }
    static const struct {
        const char *name;
        size_t offset, size;
    } fields[] = {FIELD(tiles_x),    FIELD(tiles_y),    FIELD(samples),    FIELD(photons),
                  FIELD(key_bits),   FIELD(key_bits_x), FIELD(key_bits_y), FIELD(key_bits_z),
                  FIELD(key_bits_n), FIELD(levels),     FIELD(mask_words), FIELD(level_first)};
#undef FIELD
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++)
        if (memcmp((const char *)s + fields[i].offset, (const char *)&derived + fields[i].offset, fields[i].size) != 0)
            return vit_pack_refuse(why, "section META: %s does not follow from the counts", fields[i].name);
    return VIT_OK;
}

static vit_status check_floats(const vit_scene *s, vit_text *why) {
    const float least = FLT_MIN; /* positive, and not subnormal: its inverse is finite */
    const bool small = s->effects & VIT_BIT(SMALL_SAMPLES), open = s->effects & VIT_BIT(OCCLUSION),
               live = s->effects & VIT_BIT(LIVE_CACHE), points = s->effects & VIT_BIT(POINTS);
    const struct {
        const char *name;
        float value, least, most;
    } floats[] = {
        {"fps", s->fps, least, 1000.0f},
        {"radius", s->radius, s->effects & VIT_BIT(PHOTONS) ? VIT_MIN_RADIUS : 0.0f, 1.0f / VIT_MIN_RADIUS},
        {"flatten", s->flatten, 0.0f, FLT_MAX},
        {"ray_offset", s->ray_offset, 0.0f, FLT_MAX},
        {"box_pad", s->box_pad, 0.0f, FLT_MAX},
        {"slice_near", s->slice_near, least, FLT_MAX},
        {"slice_scale", s->slice_scale, least, FLT_MAX},
        {"grid_low x", s->grid_low[0], small ? -FLT_MAX : 0.0f, small ? FLT_MAX : 0.0f},
        {"grid_low y", s->grid_low[1], small ? -FLT_MAX : 0.0f, small ? FLT_MAX : 0.0f},
        {"grid_low z", s->grid_low[2], small ? -FLT_MAX : 0.0f, small ? FLT_MAX : 0.0f},
        {"grid_step", s->grid_step, small ? least : 0.0f, small ? FLT_MAX / 65536 : 0.0f},
        {"contrast", s->contrast, 0.0f, 1.0f},
        {"most_reflected", s->most_reflected, 0.0f, s->effects & VIT_BIT(TRANSFER) ? VIT_MAX_PHOTON : 0.0f},
        {"ambient_radius", s->ambient_radius, open ? least : 0.0f, open ? FLT_MAX : 0.0f},
        {"cache_step", s->cache_step, open ? least : 0.0f, open ? FLT_MAX : 0.0f},
        {"cache_detail", s->cache_detail, 0.0f, open ? FLT_MAX : 0.0f},
        {"cache_error", s->cache_error, live ? least : 0.0f, live ? 1.0f : 0.0f},
        {"point_step", s->point_step, points ? least : 0.0f, points ? FLT_MAX : 0.0f},
        {"point_detail", s->point_detail, 0.0f, points ? FLT_MAX : 0.0f},
        {"ambient red", s->ambient[0], 0.0f, VIT_MAX_RADIANCE},
        {"ambient green", s->ambient[1], 0.0f, VIT_MAX_RADIANCE},
        {"ambient blue", s->ambient[2], 0.0f, VIT_MAX_RADIANCE},
        {"background red", s->background[0], 0.0f, VIT_MAX_RADIANCE},
        {"background green", s->background[1], 0.0f, VIT_MAX_RADIANCE},
        {"background blue", s->background[2], 0.0f, VIT_MAX_RADIANCE},
    };
    for (size_t i = 0; i < sizeof floats / sizeof floats[0]; i++)
        if (!in_range(floats[i].value, floats[i].least, floats[i].most))
            return vit_pack_refuse(why, "section META: %s must be in %g..%g, got %g", floats[i].name, (double)floats[i].least,
                                   (double)floats[i].most, (double)floats[i].value);
    for (int i = 0; i < VIT_MAX_COPIES; i++)
        if (!all_in_range(s->offset[i], 2, -1.0f, 1.0f))
            return vit_pack_refuse(why, "section META: offset %d must be in -1..1", i);
    return s->gloss_pad[0] == 0 && s->gloss_pad[1] == 0 && s->gloss_pad[2] == 0
               ? VIT_OK
               : vit_pack_refuse(why, "section META: padding is not 0");
}

/* An effect makes no sense without the one that it refines. */
static vit_status check_needs(const vit_scene *s, vit_text *why) {
    static const struct {
        const char *name;
        vit_u64 bit;
        const char *needed_name;
        vit_u64 needed;
    } needs[] = {
#define X(effect, needed) {#effect, VIT_BIT(effect), #needed, VIT_BIT(needed)},
        VIT_EFFECT_NEEDS(X)
#undef X
    };
    for (size_t i = 0; i < sizeof needs / sizeof needs[0]; i++)
        if ((s->effects & needs[i].bit) && !(s->effects & needs[i].needed))
            return vit_pack_refuse(why, "section META: effect %s without %s", needs[i].name, needs[i].needed_name);
    return VIT_OK;
}

/* Baked places, and what makes their light. */
static vit_status check_receivers(const vit_scene *s, vit_text *why) {
    const vit_u64 e = s->effects;
    const bool basis = e & VIT_BIT(BASIS), relight = e & VIT_BIT(RELIGHT), live = e & VIT_BIT(RADIOSITY),
               transfer = e & VIT_BIT(TRANSFER), rank = e & VIT_BIT(LOW_RANK), some = basis || live,
               points = e & VIT_BIT(POINTS);
    if ((e & VIT_BIT(PHOTONS)) && some)
        return vit_pack_refuse(why, "section META: effects PHOTONS and %s exclude each other", basis ? "BASIS" : "RADIOSITY");
    if (basis && live)
        return vit_pack_refuse(why, "section META: effects BASIS and RADIOSITY exclude each other");
    if ((s->receivers > 0) != some || (s->receiver_cells > 0) != some || (s->receiver_splits > 0 && !some))
        return vit_pack_refuse(why,
                               "section META: %u receivers, %u cells and %u splits contradict the effects BASIS and RADIOSITY",
                               s->receivers, s->receiver_cells, s->receiver_splits);
    if ((s->point_levels > 0) != points || (points && (s->receiver_splits > 0 || s->receiver_cells & (s->receiver_cells - 1))))
        return vit_pack_refuse(why, "section META: %u levels, %u cells and %u splits contradict the effect POINTS",
                               s->point_levels, s->receiver_cells, s->receiver_splits);
    if ((s->basis_lights > 0) != relight || ((s->basis_words > 0 || s->basis_coefficients > 0) && !relight))
        return vit_pack_refuse(why, "section META: %u lights, %u words and %u coefficients contradict the effect RELIGHT",
                               s->basis_lights, s->basis_words, s->basis_coefficients);
    const bool lights = s->live[0] || s->live[1];
    if ((s->patches > 0) != live || (s->patch_points > 0) != live || lights != live || (s->gather_words > 0 && !live))
        return vit_pack_refuse(why, "section META: %u patches, %u points and %u words contradict the effect RADIOSITY",
                               s->patches, s->patch_points, s->gather_words);
    if ((s->looked_frames > 0) != live)
        return vit_pack_refuse(why, "section META: looked_frames %u contradicts the effect RADIOSITY", s->looked_frames);
    for (vit_u32 i = 0; i < 64; i++)
        if ((s->live[i / 32] >> i % 32 & 1) && i >= s->lights)
            return vit_pack_refuse(why, "section META: light %u of %u is live", i, s->lights);
    if ((s->transfer_words > 0) != transfer || (s->transfer_sums > 0) != transfer || (s->transfer_rank > 0) != rank)
        return vit_pack_refuse(why,
                               "section META: %u words, %u sums and a rank of %u contradict the effects TRANSFER and "
                               "LOW_RANK",
                               s->transfer_words, s->transfer_sums, s->transfer_rank);
    return VIT_OK;
}

static vit_status check_lightmap(const vit_scene *s, vit_text *why) {
    const bool map = s->effects & VIT_BIT(LIGHTMAP);
    if (map && !(s->effects & (VIT_BIT(SKY_LIGHT) | VIT_BIT(AREA_LIGHTS))))
        return vit_pack_refuse(why, "section META: effect LIGHTMAP without SKY_LIGHT and AREA_LIGHTS");
    if ((s->map_receivers > 0) != map || (s->map_cells > 0) != map || (s->map_splits > 0 && !map))
        return vit_pack_refuse(why,
                               "section META: lightmap of %u receivers, %u cells and %u splits contradicts the effect LIGHTMAP",
                               s->map_receivers, s->map_cells, s->map_splits);
    return VIT_OK;
}

static vit_status check_effects(const vit_scene *s, vit_text *why) {
#define X(bit, name, macro, reason) | VIT_BIT(macro)
    const vit_u64 known = 0u VIT_EFFECTS(X);
#undef X
    const vit_u64 e = s->effects;
    if (e & ~known)
        return vit_pack_refuse(why, "section META: unknown effects 0x%llx", (unsigned long long)(e & ~known));
    vit_status status = check_needs(s, why);
    if (status != VIT_OK)
        return status;
    const bool photons = e & VIT_BIT(PHOTONS), list = e & VIT_BIT(LIST), buckets = e & VIT_BIT(BUCKETS);
    if (list && buckets)
        return vit_pack_refuse(why, "section META: effects LIST and BUCKETS exclude each other");
    if ((e & VIT_BIT(NEAREST)) && (e & VIT_BIT(TRILINEAR)))
        return vit_pack_refuse(why, "section META: effects NEAREST and TRILINEAR exclude each other");
    if (photons && !list && !buckets)
        return vit_pack_refuse(why, "section META: effect PHOTONS without LIST or BUCKETS");
    if ((e & VIT_BIT(INDIRECT)) && !(e & vit_indirect_makers()))
        return vit_pack_refuse(why, "section META: effect INDIRECT without what makes indirect light");
    if ((s->lights > 0) != ((e & VIT_BIT(LIGHTS)) != 0))
        return vit_pack_refuse(why, "section META: %u lights contradict the effect LIGHTS", s->lights);
    if ((s->paths > 0) != ((e & VIT_BIT(TRACED)) != 0))
        return vit_pack_refuse(why, "section META: %u paths contradict the effect TRACED", s->paths);
    if ((s->cells > 0) != ((e & (VIT_BIT(ZONES) | VIT_BIT(AREA))) != 0))
        return vit_pack_refuse(why, "section META: %u cells contradict the effects ZONES and AREA", s->cells);
    if ((status = check_receivers(s, why)) != VIT_OK)
        return status;
    status = check_lightmap(s, why);
    if (status != VIT_OK)
        return status;
    if ((s->area_samples > 0) != ((e & VIT_BIT(AREA_LIGHTS)) != 0) || (s->sky_samples > 0) != ((e & VIT_BIT(SKY_LIGHT)) != 0))
        return vit_pack_refuse(why, "section META: %u and %u points on lights contradict the effects AREA_LIGHTS and SKY_LIGHT",
                               s->area_samples, s->sky_samples);
    if (s->sky_size == 0 && (e & VIT_BIT(SKY_IMAGE)))
        return vit_pack_refuse(why, "section META: the effect SKY_IMAGE without a sky");
    if ((s->gloss_rays > 0) != ((e & VIT_BIT(GLOSS)) != 0))
        return vit_pack_refuse(why, "section META: %u rays of lobes contradict the effect GLOSS", s->gloss_rays);
    if ((s->chain > 0) != ((e & (VIT_BIT(MIRROR) | VIT_BIT(GLASS))) != 0))
        return vit_pack_refuse(why, "section META: chains of %u contradict the effects MIRROR and GLASS", s->chain);
    if ((s->copies > 1) != ((e & VIT_BIT(ANTIALIAS)) != 0))
        return vit_pack_refuse(why, "section META: %u copies contradict the effect ANTIALIAS", s->copies);
    const bool cached = e & VIT_BIT(OCCLUSION);
    if ((s->cache_cells > 0) != cached || (s->cache_probes > 0) != cached || (s->cache_levels > 0) != cached)
        return vit_pack_refuse(why,
                               "section META: %u cells, %u probes and %u levels of a cache contradict the effect OCCLUSION",
                               s->cache_cells, s->cache_probes, s->cache_levels);
    if (s->baked > 0 && !photons)
        return vit_pack_refuse(why, "section META: %u baked photons without the effect PHOTONS", s->baked);
    return VIT_OK;
}

static vit_status check_bounds(const vit_scene *s, vit_text *why) {
    const vit_u32 root = s->effects & VIT_BIT(PHOTONS) ? 1 : 0; /* the hierarchy always has one */
    if (s->max_nodes < root || s->max_nodes > MAX_NODES)
        return vit_pack_refuse(why, "section META: max_nodes must be in %u..%u, got %u", root, MAX_NODES, s->max_nodes);
    if (s->max_list > MAX_LIST)
        return vit_pack_refuse(why, "section META: max_list must be in 0..%u, got %u", MAX_LIST, s->max_list);
    if (s->slice_first > MAX_SLICE)
        return vit_pack_refuse(why, "section META: slice_first must be in 0..%u, got %u", MAX_SLICE, s->slice_first);
    return VIT_OK;
}

vit_status vit_pack_check_META(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    vit_status status = check_derived(s, why);
    if (status == VIT_OK)
        status = check_floats(s, why);
    if (status == VIT_OK)
        status = check_effects(s, why);
    if (status == VIT_OK)
        status = check_bounds(s, why);
    return status;
}
