/* Materials (3.9): colour, emission, alpha; gltf_shine.c has the rest. */
#include "import/gltf/gltf_file.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static void floats(const json_t *object, const char *key, float *out, size_t count) {
    double values[4];
    for (size_t i = 0; gltf_numbers(object, key, values, count) && i < count; i++)
        out[i] = (float)values[i];
}

/* What has the colour: the metallic-roughness model, or the older one, for which the former is a stand-in. */
static const json_t *base_of(const json_t *material, const char **factor, const char **texture) {
    const json_t *old = gltf_extension(material, "KHR_materials_pbrSpecularGlossiness");
    *factor = old ? "diffuseFactor" : "baseColorFactor";
    *texture = old ? "diffuseTexture" : "baseColorTexture";
    return old ? old : json_object_get(material, "pbrMetallicRoughness");
}

static void read_texture(gltf_file *g, material_use *use, const json_t *info) {
    gltf_texture t;
    if (!gltf_find_texture(g, info, &t))
        return;
    memcpy(use->image, t.image, sizeof use->image);
    use->m.wrap_u = t.wrap_u;
    use->m.wrap_v = t.wrap_v;
    use->uv_set = t.uv_set;
    use->has_transform = t.has_transform;
    memcpy(use->uv, t.uv, sizeof use->uv);
}

float gltf_opacity(const json_t *material) {
    const char *factor, *texture, *mode = gltf_text(material, "alphaMode", "OPAQUE");
    float color[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    const bool masks = strcmp(mode, "MASK") == 0;
    if (!masks && strcmp(mode, "BLEND") != 0)
        return 1.0f;
    const json_t *base = base_of(material, &factor, &texture);
    floats(base, factor, color, 4);
    const double cutoff = gltf_number(material, "alphaCutoff", 0.5);
    return masks && cutoff > 1.0 ? 0.0f : import_clamp(color[3], 1.0f);
}

/* alphaMode says what alpha means. MASK cuts out, all of it where the cutoff is above 1 (3.9.4); BLEND, which is not simulated,
 * becomes a cut-out or a hole. */
static void read_alpha(material_use *use, const json_t *material) {
    const char *mode = gltf_text(material, "alphaMode", "OPAQUE");
    const bool masks = strcmp(mode, "MASK") == 0;
    const double cutoff = masks ? gltf_number(material, "alphaCutoff", 0.5) : 0.5;
    if (!masks && strcmp(mode, "BLEND") != 0)
        return;
    use->m.alpha = gltf_opacity(material);
    use->alpha_mapped = true;
    use->m.cutoff = import_clamp((float)cutoff, 1.0f);
    use->cutoff_asked = cutoff > 1.0;
}

static bool read_emission(gltf_file *g, material_use *use, const json_t *material) {
    const json_t *strong = gltf_extension(material, "KHR_materials_emissive_strength");
    float color[3] = {0.0f, 0.0f, 0.0f};
    gltf_texture t;
    floats(material, "emissiveFactor", color, 3);
    const bool black = !(color[0] > 0.0f || color[1] > 0.0f || color[2] > 0.0f);
    if (!black && gltf_find_texture(g, json_object_get(material, "emissiveTexture"), &t))
        return import_not_done(g->im, "material '%.100s': emissive textures are not supported; it does not emit", use->m.name);
    import_emission(g->im, &use->m, color, (float)gltf_number(strong, "emissiveStrength", 1.0));
    return true;
}

/* A material has one set of texture coordinates. */
static bool same_coordinates(const material_use *use, const gltf_texture *t) {
    return use->uv_set == t->uv_set && use->has_transform == t->has_transform &&
           (!t->has_transform || memcmp(use->uv, t->uv, sizeof use->uv) == 0);
}

/* Without a colour texture the coordinates are the normal map's. */
static bool read_normal_map(gltf_file *g, material_use *use, const json_t *material) {
    const json_t *info = json_object_get(material, "normalTexture");
    const double scale = gltf_number(info, "scale", 1.0);
    gltf_texture t;
    if (!info || scale == 0.0 || !gltf_find_texture(g, info, &t))
        return true;
    if (!use->image[0]) {
        use->uv_set = t.uv_set;
        use->has_transform = t.has_transform;
        memcpy(use->uv, t.uv, sizeof use->uv);
    } else if (!same_coordinates(use, &t))
        return gltf_remark_once(g, GLTF_SAID_NORMALS, "normal maps with other coordinates than the colour are left out",
                                use->m.name);
    memcpy(use->normal, t.image, sizeof use->normal);
    use->m.normal_scale = fminf(fmaxf((float)scale, -VIT_MAX_NORMAL_SCALE), VIT_MAX_NORMAL_SCALE);
    use->m.normal_wrap_u = t.wrap_u;
    use->m.normal_wrap_v = t.wrap_v;
    return true;
}

/* What of it is not done, once a file. */
static bool remark(gltf_file *g, const material_use *use, const json_t *material) {
    return !gltf_extension(material, "KHR_materials_unlit") ||
           gltf_remark_once(g, GLTF_SAID_UNLIT, "unlit materials are lit like any other", use->m.name);
}

bool gltf_material(importer *im, material_use *use) {
    gltf_file *g = im->reader;
    const json_t *material = gltf_item(g, "materials", use->source);
    const char *factor, *texture;
    const json_t *base = base_of(material, &factor, &texture);
    float color[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    (void)snprintf(use->m.name, sizeof use->m.name, "%.*s", SCENE_NAME - 1, gltf_text(material, "name", ""));
    read_texture(g, use, json_object_get(base, texture));
    floats(base, factor, color, 4);
    for (int i = 0; i < 3; i++)
        use->m.albedo[i] = import_clamp(color[i] * use->tint[i], VIT_MAX_ALBEDO);
    read_alpha(use, material);
    return read_normal_map(g, use, material) && read_emission(g, use, material) && remark(g, use, material) &&
           gltf_shine(g, use, material);
}
