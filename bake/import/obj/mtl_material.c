/* Materials: colour, emission, alpha; mtl_shine.c has the rest. */
#include "import/obj/obj_file.h"
#include "common/strict_math.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void mtl_name_of(obj_text text, char out[SCENE_PATH]) {
    (void)snprintf(out, SCENE_PATH, "%.*s", obj_size(text, SCENE_PATH - 1), text.at);
}

static bool same_name(const mtl_map *a, const mtl_map *b) {
    const size_t size = (size_t)(a->name.end - a->name.at);
    return size > 0 && size == (size_t)(b->name.end - b->name.at) && memcmp(a->name.at, b->name.at, size) == 0;
}

/* Its v runs upwards, and ours down: 1 - (s (1 - v) + o). */
static void read_coordinates(material_use *use, const mtl_map *map) {
    const double su = (double)map->scale[0], sv = (double)map->scale[1], ou = (double)map->offset[0],
                 ov = (double)map->offset[1];
    use->has_transform = su != 1.0 || sv != 1.0 || ou != 0.0 || ov != 0.0;
    const double uv[6] = {su, 0.0, ou, 0.0, sv, 1.0 - sv - ov};
    memcpy(use->uv, uv, sizeof uv);
}

static void read_texture(material_use *use, const mtl_map *map) {
    mtl_name_of(map->name, use->image);
    use->m.wrap_u = use->m.wrap_v = map->clamp ? VIT_WRAP_CLAMP : VIT_WRAP_REPEAT;
    read_coordinates(use, map);
}

/* A material has one set of coordinates. What it says of `-bm` is brightness, which directions have none of. */
static void read_normal_map(material_use *use, mtl *m) {
    const mtl_map *map = &m->normal_map, *color = &m->color_map;
    if (obj_is_empty(map->name))
        return;
    if (use->image[0] && (memcmp(map->scale, color->scale, sizeof map->scale) != 0 ||
                          memcmp(map->offset, color->offset, sizeof map->offset) != 0)) {
        m->remarks |= 1u << MTL_NORMAL;
        return;
    }
    mtl_name_of(map->name, use->normal);
    use->m.normal_scale = 1.0f;
    use->m.normal_wrap_u = use->m.normal_wrap_v = map->clamp ? VIT_WRAP_CLAMP : VIT_WRAP_REPEAT;
    if (!use->image[0])
        read_coordinates(use, map);
}

/* Diffuse reflectance, before mtl_shine() has told what of it is not diffuse. Colours of vertices are sRGB, as Blender and
 * MeshLab write them; where no material stands beside them, they are all that there is. */
static void read_color(importer *im, material_use *use, const mtl *m) {
    float color[3];
    memcpy(color, m->color, sizeof color);
    if (use->tinted && !m->defined)
        color[0] = color[1] = color[2] = 1.0f;
    for (int i = 0; i < 3 && use->tinted; i++)
        color[i] *= (float)srgb_linear((double)import_clamp(use->tint[i], 1.0f));
    if (use->image[0] && color[0] == 0.0f && color[1] == 0.0f && color[2] == 0.0f) {
        import_warn(im, "material '%.100s': black times a texture; the texture alone is used", use->m.name);
        color[0] = color[1] = color[2] = 1.0f;
    }
    for (int i = 0; i < 3; i++)
        use->m.albedo[i] = import_clamp(color[i], VIT_MAX_ALBEDO);
}

static bool read_emission(importer *im, material_use *use, const mtl *m) {
    if (!obj_is_empty(m->emission_map.name))
        return import_not_done(im, "material '%.100s': emissive textures are not supported; it does not emit", use->m.name);
    import_emission(im, &use->m, m->emission, 1.0f);
    return true;
}

/* A 0 beside an opacity texture says nothing, since nobody maps what is invisible: the texture is meant. */
static float stated_opacity(const mtl *m) {
    const float alpha = import_clamp(m->opacity, 1.0f);
    return alpha == 0.0f && !obj_is_empty(m->opacity_map.name) ? 1.0f : alpha;
}

/* d is one number for all of it, map_d an image that has to be the colour texture's own alpha. */
static bool read_alpha(importer *im, material_use *use, const mtl *m) {
    const obj_file *o = im->reader;
    const float stated = stated_opacity(m);
    const obj_text map = m->opacity_map.name;
    use->alpha_mapped = same_name(&m->opacity_map, &m->color_map);
    if (!obj_is_empty(map) && !use->alpha_mapped &&
        !import_not_done(im, "material '%.100s': opacity texture '%.*s' is not the colour texture; it is left out", use->m.name,
                         obj_size(map, 200), map.at))
        return false;
    use->m.alpha = o->inverse && !mtl_is_glass(m) ? 1.0f - stated : stated;
    if (o->inverse)
        use->alpha_by_letter = stated;
    if (use->m.alpha < 0.5f || use->alpha_mapped)
        use->m.cutoff = 0.5f;
    return true;
}

/* What of it is not done, once a file. */
static bool remark(obj_file *o, const material_use *use, const mtl *m) {
    static const char *const remarks[] = {
#define X(name, text) text,
        MTL_NOT_DONE(X)
#undef X
    };
    const unsigned fresh = m->remarks & ~o->said;
    if (o->im->warn) /* it is not, while import_transparency.c takes stock */
        o->said |= m->remarks;
    for (int i = 0; i < MTL_REMARKS; i++)
        if (fresh >> i & 1 && !import_not_done(o->im, "%s (material '%.100s' and perhaps others)", remarks[i], use->m.name))
            return false;
    return true;
}

bool mtl_material(importer *im, material_use *use) {
    obj_file *o = im->reader;
    static const char unnamed[] = "DefaultMaterial";
    mtl *m = &o->mtl[use->source];
    const obj_text name =
        use->source < o->materials.count ? o->materials.name[use->source] : (obj_text){unnamed, unnamed + sizeof unnamed - 1};
    (void)snprintf(use->m.name, sizeof use->m.name, "%.*s", obj_size(name, SCENE_NAME - 1), name.at);
    if (!obj_is_empty(m->color_map.name))
        read_texture(use, &m->color_map);
    read_normal_map(use, m);
    read_color(im, use, m);
    return read_emission(im, use, m) && read_alpha(im, use, m) && remark(o, use, m) && mtl_shine(im, use, m);
}

bool mtl_transparency(obj_file *o) {
    const unsigned materials = (unsigned)o->materials.count + 1;
    float *stated = calloc(materials, sizeof *stated);
    uint64_t *of_material = calloc(materials, sizeof *of_material);
    bool any = false, fine = stated && of_material;
    for (unsigned i = 0; fine && i < materials; i++) {
        const float opacity = stated_opacity(&o->mtl[i]);
        any = any || opacity < 1.0f;
        stated[i] = mtl_is_glass(&o->mtl[i]) ? IMPORT_SAYS_SO : opacity;
    }
    if (fine && any) {
        obj_count_triangles(o, of_material);
        o->inverse = import_is_inverse(o->im, of_material, stated, materials);
    }
    fine = fine ? !any || import_transparency(o->im, of_material, materials) : import_fail(o->im, "out of memory");
    free(stated);
    free(of_material);
    return fine;
}
