/* pack_check.c: checks the sections of plain records: every index and every float that a kernel will use. */
#include "pack_check.h"

vit_status vit_pack_check_CAMS(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_camera *cameras = p->section[VIT_SECTION_CAMS];
    for (vit_u32 i = 0; i < s->frames; i++) {
        const vit_camera *c = VIT_RECORD(vit_camera, cameras, i);
        if (!all_finite(c->eye, 3) || !all_finite(c->corner, 3) || !all_finite(c->right, 3) || !all_finite(c->down, 3))
            return vit_pack_refuse(why, "section CAMS: camera %u: a vector is not finite", i);
        if (!is_unit(c->forward))
            return vit_pack_refuse(why, "section CAMS: camera %u: forward is not a unit vector", i);
        if (!in_range(c->exposure, 0.0f, VIT_MAX_EXPOSURE))
            return vit_pack_refuse(why, "section CAMS: camera %u: exposure must be in 0..%g", i, (double)VIT_MAX_EXPOSURE);
        if (!(c->pad0 == 0.0f && c->pad1 == 0.0f && c->pad2 == 0.0f && c->pad3 == 0.0f))
            return vit_pack_refuse(why, "section CAMS: camera %u: padding is not 0", i);
    }
    return VIT_OK;
}

/* A photon's power over its disc, as kernels/photons.cl has it, at the light's range, where falloff WINDOW makes most of it. */
double vit_pack_photon_bound(const vit_scene *s, const vit_light *l) {
    if (l->path_count == 0)
        return 0;
    double most = 0;
    for (int k = 0; k < 3; k++)
        most = l->intensity[k] > most ? l->intensity[k] : most;
    if (l->falloff == VIT_FALLOFF_WINDOW)
        most /= l->inv_range2;
    if (l->kind == VIT_LIGHT_DIRECTIONAL)
        most *= (double)l->spot_scale * l->spot_scale;
    return most * 8.0 / l->path_count / ((double)s->radius * s->radius * VIT_PHOTON_CAP * VIT_PHOTON_CAP);
}

static const char *light_fault(const vit_scene *s, const vit_light *l) {
    const bool spot = l->kind == VIT_LIGHT_SPOT;
    if (l->kind > VIT_LIGHT_DIRECTIONAL)
        return "unknown kind";
    if (l->falloff != VIT_FALLOFF_INVERSE_SQUARE && l->falloff != VIT_FALLOFF_WINDOW)
        return "unknown falloff";
    if (!all_finite(l->position, 3) || !all_finite(l->direction, 3))
        return "position or direction is not finite";
    if (l->kind != VIT_LIGHT_POINT && !is_unit(l->direction))
        return "direction is not a unit vector";
    if (!in_range(l->cos_outer, -1.0f, 1.0f))
        return "cos_outer must be in -1..1";
    if (!all_finite(&l->spot_scale, 1) || !all_finite(&l->spot_offset, 1))
        return "spot_scale or spot_offset is not finite";
    if (!all_in_range(l->intensity, 3, 0.0f, VIT_MAX_INTENSITY))
        return "intensity must be in 0..1e15";
    if (!in_range(l->inv_range2, 0.0f, FLT_MAX))
        return "inv_range2 must be finite and >= 0";
    if (spot && !(s->effects & VIT_BIT(SPOT)))
        return "a spot light without the effect SPOT";
    if (l->kind == VIT_LIGHT_DIRECTIONAL && !(s->effects & VIT_BIT(DIRECTIONAL)))
        return "a directional light without the effect DIRECTIONAL";
    if (l->kind == VIT_LIGHT_DIRECTIONAL && (!(l->spot_scale > 0.0f) || l->inv_range2 > 0.0f))
        return "a directional light with a range, or without the radius of its photons' disc";
    if (l->inv_range2 > 0.0f && !(s->effects & VIT_BIT(RANGE)))
        return "a range without the effect RANGE";
    if (l->falloff == VIT_FALLOFF_WINDOW && !(l->inv_range2 > 0.0f))
        return "falloff WINDOW without a range";
    if (!(vit_pack_photon_bound(s, l) <= VIT_MAX_PHOTON))
        return "its photons' power over the square of the radius is more than 1e30";
    if ((uint64_t)l->path_first + l->path_count > s->paths)
        return "paths run beyond the scene's";
    if (l->path_first % 16 != 0 || l->path_count % 16 != 0) /* a packet of paths has one light, at any number of lanes */
        return "paths are not multiples of 16";
    return all_zero(l->pad, 3) ? 0 : "padding is not 0";
}

/* Photon path p of a frame belongs to exactly one light: ranges that neither overlap nor leave a path out. */
static vit_status check_path_ranges(const vit_scene *s, const vit_light *lights, vit_text *why) {
    uint64_t sum = 0;
    for (vit_u32 i = 0; i < s->lights; i++) {
        const vit_light *a = VIT_RECORD(vit_light, lights, i);
        sum += a->path_count;
        for (vit_u32 j = 0; j < i; j++) {
            const vit_light *b = VIT_RECORD(vit_light, lights, j);
            if (a->path_first < b->path_first + b->path_count && b->path_first < a->path_first + a->path_count &&
                a->path_count != 0 && b->path_count != 0)
                return vit_pack_refuse(why, "section LITE: lights %u and %u share photon paths", j, i);
        }
    }
    if (sum != s->paths)
        return vit_pack_refuse(why, "section LITE: the lights have %llu photon paths, META says %u", (unsigned long long)sum,
                               s->paths);
    return VIT_OK;
}

vit_status vit_pack_check_LITE(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_light *lights = p->section[VIT_SECTION_LITE];
    for (vit_u32 frame = 0; frame < s->frames; frame++)
        for (vit_u32 i = 0; i < s->lights; i++) {
            const vit_light *first = VIT_RECORD(vit_light, lights, i);
            const vit_light *l = VIT_RECORD(vit_light, lights, (size_t)frame * s->lights + i);
            const char *fault = light_fault(s, l);
            if (fault)
                return vit_pack_refuse(why, "section LITE: frame %u, light %u: %s", frame, i, fault);
            if (l->path_first != first->path_first || l->path_count != first->path_count)
                return vit_pack_refuse(why, "section LITE: frame %u, light %u: paths differ from frame 0", frame, i);
        }
    return check_path_ranges(s, lights, why);
}

vit_status vit_pack_check_ATTR(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_attributes *attributes = p->section[VIT_SECTION_ATTR];
    for (vit_u32 i = 0; i < s->triangles; i++) {
        const vit_attributes *a = VIT_RECORD(vit_attributes, attributes, i);
        const vit_u32 material = a->material & VIT_MATERIAL_INDEX;
        if (material >= s->materials)
            return vit_pack_refuse(why, "section ATTR: triangle %u: material %u of %u", i, material, s->materials);
        if (a->material & ~(VIT_MATERIAL_INDEX | VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK | VIT_TRIANGLE_SMOOTH))
            return vit_pack_refuse(why, "section ATTR: triangle %u: unknown flags 0x%x", i, a->material);
        if (!all_finite(a->uv[0], 2) || !all_finite(a->uv[1], 2) || !all_finite(a->uv[2], 2))
            return vit_pack_refuse(why, "section ATTR: triangle %u: a texture coordinate is not finite", i);
    }
    return VIT_OK;
}

static const char *specular_fault(const vit_material *m) {
    if (m->kind > VIT_THIN_GLASS)
        return "unknown kind";
    if (!all_in_range(m->specular, 3, 0.0f, 1.0f))
        return "specular must be in 0..1";
    if (!in_range(m->exponent, 1.0f, VIT_MAX_EXPONENT))
        return "exponent must be in 1..1e4";
    if (!in_range(m->ior, VIT_MIN_IOR, VIT_MAX_IOR))
        return "ior must be in 1..10";
    if (!all_in_range(m->absorption, 3, 0.0f, FLT_MAX))
        return "absorption must be finite and >= 0";
    if (m->lights > 1)
        return "lights must be 0 or 1";
    if (!in_range(m->near2, 0.0f, m->lights ? FLT_MAX : 0.0f))
        return "near2 must be finite and >= 0, and 0 where nothing shines";
    return m->alpha == 0.0f || in_range(m->alpha, VIT_MIN_ALPHA, 1.0f) ? 0 : "alpha must be 0, or in 1/128..1";
}

vit_status vit_pack_check_MATL(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_material *materials = p->section[VIT_SECTION_MATL];
    for (vit_u32 i = 0; i < s->materials; i++) {
        const vit_material *m = VIT_RECORD(vit_material, materials, i);
        if (!all_in_range(m->albedo, 3, 0.0f, VIT_MAX_ALBEDO))
            return vit_pack_refuse(why, "section MATL: material %u: albedo must be in 0..%g", i, (double)VIT_MAX_ALBEDO);
        if (!all_in_range(m->emission, 3, 0.0f, VIT_MAX_RADIANCE))
            return vit_pack_refuse(why, "section MATL: material %u: emission must be in 0..%g", i, (double)VIT_MAX_RADIANCE);
        if (m->texture != VIT_NONE && m->texture >= s->textures)
            return vit_pack_refuse(why, "section MATL: material %u: texture %u of %u", i, m->texture, s->textures);
        if (m->cutout > 1)
            return vit_pack_refuse(why, "section MATL: material %u: cutout must be 0 or 1, got %u", i, m->cutout);
        if (m->cutout && m->texture == VIT_NONE)
            return vit_pack_refuse(why, "section MATL: material %u: cut out by no texture", i);
        const char *fault = specular_fault(m);
        if (fault)
            return vit_pack_refuse(why, "section MATL: material %u: %s", i, fault);
    }
    return VIT_OK;
}

vit_status vit_pack_check_MAPS(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_maps *maps = p->section[VIT_SECTION_MAPS];
    for (vit_u32 i = 0; VIT_HAS_MAPS(s->effects) && i < s->materials; i++) {
        const vit_maps *m = VIT_RECORD(vit_maps, maps, i);
        if (m->normal != VIT_NONE && m->normal >= s->textures)
            return vit_pack_refuse(why, "section MAPS: material %u: texture %u of %u", i, m->normal, s->textures);
        if (!in_range(m->normal_scale, -VIT_MAX_NORMAL_SCALE, VIT_MAX_NORMAL_SCALE))
            return vit_pack_refuse(why, "section MAPS: material %u: normal_scale must be in -%g..%g", i,
                                   (double)VIT_MAX_NORMAL_SCALE, (double)VIT_MAX_NORMAL_SCALE);
        if (!all_zero(m->pad, 2))
            return vit_pack_refuse(why, "section MAPS: material %u: padding is not 0", i);
    }
    return VIT_OK;
}

vit_status vit_pack_check_TEXR(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_texture *textures = p->section[VIT_SECTION_TEXR];
    for (vit_u32 i = 0; i < s->textures; i++) {
        const vit_texture *t = VIT_RECORD(vit_texture, textures, i);
        if (t->mip_count == 0)
            return vit_pack_refuse(why, "section TEXR: texture %u: no mip level", i);
        if ((uint64_t)t->first_mip + t->mip_count > s->mips)
            return vit_pack_refuse(why, "section TEXR: texture %u: mip levels run beyond the %u of META", i, s->mips);
        if (t->wrap_u > VIT_WRAP_MIRROR || t->wrap_v > VIT_WRAP_MIRROR)
            return vit_pack_refuse(why, "section TEXR: texture %u: unknown wrap mode", i);
    }
    return VIT_OK;
}

vit_status vit_pack_check_MIPS(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_mip *mips = p->section[VIT_SECTION_MIPS];
    for (vit_u32 i = 0; i < s->mips; i++) {
        const vit_mip *m = VIT_RECORD(vit_mip, mips, i);
        if (m->width < 1 || m->width > 16384 || m->height < 1 || m->height > 16384)
            return vit_pack_refuse(why, "section MIPS: mip %u: %u x %u texels, edges must be in 1..16384", i, m->width,
                                   m->height);
        if (m->pitch < m->width + 2)
            return vit_pack_refuse(why, "section MIPS: mip %u: pitch %u leaves no gutter beside %u texels", i, m->pitch,
                                   m->width);
        /* The gutter's corners are texels (-1, -1) and (width, height). Products of 32-bit numbers fit 64 bits. */
        const uint64_t before = (uint64_t)m->pitch + 1, last = m->offset + (uint64_t)m->height * m->pitch + m->width;
        if (m->offset < before || last >= s->texels)
            return vit_pack_refuse(why, "section MIPS: mip %u: runs beyond the atlas of %u texels", i, s->texels);
    }
    return VIT_OK;
}

/* Every word is a texel. */
vit_status vit_pack_check_ATLS(const vit_pack *p, vit_text *why) {
    (void)p;
    (void)why;
    return VIT_OK;
}

vit_status vit_pack_check_SIDE(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_u32 cells = s->cells > 0           ? s->cells          /* effects ZONES and AREA, */
                          : s->point_levels == 0 ? s->receiver_cells /* or receivers on surfaces */
                                                 : 0;
    return vit_pack_check_sides(p, VIT_SECTION_SIDE, cells, why);
}

vit_status vit_pack_check_CELL(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_cell *cells = p->section[VIT_SECTION_CELL];
    for (vit_u32 i = 0; i < s->cells; i++) {
        const vit_cell *c = VIT_RECORD(vit_cell, cells, i);
        for (int k = 0; k < 3; k++)
            if ((c->word >> 9 * k & 511u) < VIT_CELL_AREA_LEAST)
                return vit_pack_refuse(why, "section CELL: cell %u: an area is too small", i);
    }
    return VIT_OK;
}

vit_status vit_pack_check_EMIT(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_light_sample *area_lights = p->section[VIT_SECTION_EMIT];
    const uint64_t area = VIT_PATTERNS * (uint64_t)s->area_samples, count = area + VIT_PATTERNS * (uint64_t)s->sky_samples;
    for (uint64_t i = 0; i < count; i++) {
        const vit_light_sample *e = VIT_RECORD(vit_light_sample, area_lights, i);
        const float *unit = i < area ? e->normal : e->position;
        if (!all_finite(e->position, 3) || !is_unit(unit))
            return vit_pack_refuse(why,
                                   "section EMIT: point %llu: position is not finite, or normal or direction not a unit vector",
                                   (unsigned long long)i);
        if (i < area ? !in_range(e->radius2, FLT_MIN, FLT_MAX) : !all_in_range(&e->radius2, 1, 0.0f, 0.0f))
            return vit_pack_refuse(why, "section EMIT: point %llu: radius2 must be > 0 on surfaces, and 0 in the sky",
                                   (unsigned long long)i);
        if (!in_range(e->near2, 0.0f, i < area ? FLT_MAX : 0.0f))
            return vit_pack_refuse(why, "section EMIT: point %llu: near2 must be finite and >= 0, and 0 in the sky",
                                   (unsigned long long)i);
        if (!all_in_range(e->power, 3, 0.0f, VIT_MAX_INTENSITY))
            return vit_pack_refuse(why, "section EMIT: point %llu: power must be in 0..1e15", (unsigned long long)i);
    }
    return VIT_OK;
}

vit_status vit_pack_check_SKYT(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_sky_texel *texels = p->section[VIT_SECTION_SKYT];
    for (uint64_t i = 0; i < (s->sky_size ? (s->sky_size + (uint64_t)2) * (s->sky_size + 2) : 0); i++)
        if (!all_in_range(VIT_RECORD(vit_sky_texel, texels, i)->radiance, 3, 0.0f, VIT_MAX_RADIANCE))
            return vit_pack_refuse(why, "section SKYT: texel %llu: radiance must be in 0..%g", (unsigned long long)i,
                                   (double)VIT_MAX_RADIANCE);
    return VIT_OK;
}

static const char *photon_fault(const vit_scene *s, const vit_photon *p) {
    if (!all_finite(p->position, 3) || !all_finite(p->direction, 3) || !all_finite(&p->radius2, 1) ||
        !all_finite(&p->inv_radius2, 1))
        return "position, direction or radius is not finite";
    if (!all_in_range(p->power, 3, 0.0f, VIT_MAX_PHOTON))
        return "power must be in 0..1e30";
    const vit_u32 zone = p->zone & (s->effects & VIT_BIT(ZONES) && p->radius2 > 0.0f ? ~(p->zone & (0u - p->zone)) : ~0u);
    if (zone != 0 || (p->zone == 0 && s->effects & VIT_BIT(ZONES) && p->radius2 > 0.0f))
        return "zone is not one bit, or not 0 without zones";
    if (p->radius2 < 0.0f)
        return all_in_range(p->power, 3, 0.0f, 0.0f) ? 0 : "an empty slot has power";
    if (!is_unit(p->direction))
        return "direction is not a unit vector";
    const double product = (double)p->radius2 * p->inv_radius2;
    return product >= 1 - 1e-4 && product <= 1 + 1e-4 ? 0 : "inv_radius2 is not 1 / radius2";
}

vit_status vit_pack_check_PHOT(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_photon *photons = p->section[VIT_SECTION_PHOT];
    for (vit_u32 i = 0; i < s->baked; i++) {
        const char *fault = photon_fault(s, VIT_RECORD(vit_photon, photons, i));
        if (fault)
            return vit_pack_refuse(why, "section PHOT: photon %u: %s", i, fault);
    }
    return VIT_OK;
}

vit_status vit_pack_check_GOLD(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_gold *golds = p->section[VIT_SECTION_GOLD];
    for (vit_u32 i = 0; i < s->frames; i++)
        if (!all_zero(VIT_RECORD(vit_gold, golds, i)->pad, 4))
            return vit_pack_refuse(why, "section GOLD: frame %u: padding is not 0", i);
    return VIT_OK;
}
