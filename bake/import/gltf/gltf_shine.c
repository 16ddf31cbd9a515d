/* What besides matt reflection a material does: lobes, mirrors and glass by roughness, metalness, transmission. */
#include "common/strict_math.h"
#include "import/gltf/gltf_file.h"
#include "import/metallic_roughness.h"
#include <math.h>
#include <string.h>

#define DEFAULT_IOR 1.5
#define MOST_ABSORPTION 1e9f
#define CLEAR 0.5f /* of light that gets through: more of it than not */

static float largest(const float c[3]) {
    return fmaxf(c[0], fmaxf(c[1], c[2]));
}

static void colour(const json_t *object, const char *key, float out[3]) {
    double values[3];
    for (int i = 0; gltf_numbers(object, key, values, 3) && i < 3; i++)
        out[i] = (float)values[i];
}

/* A volume has an inside; without one it is a pane. Roughness does not blur what is seen through it. */
static void make_glass(material_use *use, const json_t *material, const float mean[3]) {
    const json_t *volume = gltf_extension(material, "KHR_materials_volume"),
                 *index = gltf_extension(material, "KHR_materials_ior");
    const double thickness = gltf_number(volume, "thicknessFactor", 0.0);
    const float distance = (float)gltf_number(volume, "attenuationDistance", 0.0);
    float color[3] = {1.0f, 1.0f, 1.0f};
    colour(volume, "attenuationColor", color);
    import_make_glass(&use->m, thickness > 0.0 ? VIT_GLASS : VIT_THIN_GLASS, (float)gltf_number(index, "ior", DEFAULT_IOR));
    for (int i = 0; i < 3; i++) {
        use->m.specular[i] = mean[i];
        /* Of white light `color` is left after `distance`; infinitely far if the file states none. */
        if (use->m.kind == VIT_GLASS && distance > 0.0f && isfinite(distance))
            use->m.absorption[i] = color[i] > 0.0f
                                       ? import_clamp((float)-strict_log((double)color[i]) / distance, MOST_ABSORPTION)
                                       : MOST_ABSORPTION;
    }
}

/* KHR_materials_pbrSpecularGlossiness. */
static bool read_glossiness(gltf_file *g, material_use *use, const json_t *how) {
    float mean[4], specular[3] = {1.0f, 1.0f, 1.0f};
    const float base[3] = {use->m.albedo[0], use->m.albedo[1], use->m.albedo[2]};
    model_material *m = &use->m;
    colour(how, "specularFactor", specular);
    if (!gltf_texture_mean(g, json_object_get(how, "specularGlossinessTexture"), m->name, true, mean))
        return false;
    const float glossiness = import_clamp((float)gltf_number(how, "glossinessFactor", 1.0) * mean[3], 1.0f);
    const float exponent = specular_exponent(1.0f - glossiness);
    const bool lobe = specular_has_lobe(g->im->s->quality.ggx, 1.0f - glossiness);
    for (int i = 0; i < 3; i++)
        specular[i] = import_clamp(specular[i] * mean[i], 1.0f);
    for (int i = 0; i < 3; i++) {
        m->albedo[i] = lobe ? base[i] * (1.0f - largest(specular)) : base[i];
        m->specular[i] = lobe ? specular[i] : 0.0f;
    }
    m->exponent = exponent > 0.0f ? exponent : 1.0f;
    m->lobe_alpha = g->im->s->quality.ggx ? specular_alpha(1.0f - glossiness) : 0.0f;
    return true;
}

/* Reflectance of what is no metal at normal incidence, by KHR_materials_ior and KHR_materials_specular. */
static bool read_dielectric(gltf_file *g, const material_use *use, const json_t *material, float out[3]) {
    const json_t *how = gltf_extension(material, "KHR_materials_specular");
    const double ior = gltf_number(gltf_extension(material, "KHR_materials_ior"), "ior", DEFAULT_IOR);
    const double root = ior >= 1.0 ? (ior - 1.0) / (ior + 1.0) : ior == 0.0 ? 1.0 : 0.2;
    float color[3] = {1.0f, 1.0f, 1.0f}, part[4], tint[4];
    colour(how, "specularColorFactor", color);
    if (!gltf_texture_mean(g, json_object_get(how, "specularTexture"), use->m.name, false, part) ||
        !gltf_texture_mean(g, json_object_get(how, "specularColorTexture"), use->m.name, true, tint))
        return false;
    const float strength = import_clamp((float)gltf_number(how, "specularFactor", 1.0) * part[3], 1.0f);
    for (int i = 0; i < 3; i++)
        out[i] = import_clamp((float)(root * root) * color[i] * tint[i], 1.0f) * strength;
    return true;
}

/* Most of the light that is not a metal's goes through, and the material does not emit. */
static bool read_clear(gltf_file *g, const material_use *use, const json_t *material, float metallic, bool *clear) {
    const json_t *how = gltf_extension(material, "KHR_materials_transmission");
    float mean[4];
    *clear = false;
    if (!how)
        return true;
    if (!gltf_texture_mean(g, json_object_get(how, "transmissionTexture"), use->m.name, false, mean))
        return false;
    const float part = (float)gltf_number(how, "transmissionFactor", 0.0) * mean[0] * (1.0f - metallic);
    *clear = part >= CLEAR && largest(use->m.emission) <= 0.0f;
    return *clear || !(part > 0.0f) ||
           gltf_remark_once(g, GLTF_SAID_TRANSMISSION,
                            "transmission of less than half of the light, or of what emits, is left out", use->m.name);
}

/* Roughness and metalness may have textures, of which the mean over all texels is taken: lobes have none. */
bool gltf_shine(gltf_file *g, material_use *use, const json_t *material) {
    const json_t *pbr = json_object_get(material, "pbrMetallicRoughness");
    const json_t *old = gltf_extension(material, "KHR_materials_pbrSpecularGlossiness");
    const float base[3] = {use->m.albedo[0], use->m.albedo[1], use->m.albedo[2]};
    float mean[4] = {1.0f, 1.0f, 1.0f, 1.0f}, parts[4], dielectric[3];
    bool glass;
    if (old)
        return read_glossiness(g, use, old);
    if (!gltf_texture_mean(g, json_object_get(pbr, "metallicRoughnessTexture"), use->m.name, false, parts) ||
        !read_dielectric(g, use, material, dielectric))
        return false;
    const float roughness = import_clamp((float)gltf_number(pbr, "roughnessFactor", 1.0) * parts[1], 1.0f);
    const float metallic = import_clamp((float)gltf_number(pbr, "metallicFactor", 1.0) * parts[2], 1.0f);
    if (!read_clear(g, use, material, metallic, &glass))
        return false;
    const bool ggx = g->im->s->quality.ggx;
    if (use->image[0] && (glass || (metallic > 0.0f && specular_has_lobe(ggx, roughness))) &&
        !import_texture_mean(g->im, use->image, NULL, true, mean))
        return false;
    for (int i = 0; i < 3; i++)
        mean[i] *= base[i];
    if (glass)
        make_glass(use, material, mean);
    else
        specular_mapping_of(ggx)(&use->m, base, mean, dielectric, metallic, roughness);
    return true;
}
