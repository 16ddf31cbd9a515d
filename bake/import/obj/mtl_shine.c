/* What besides matt reflection an MTL material does: a Phong lobe, a mirror, glass. */
#include "import/metallic_roughness.h"
#include "import/obj/obj_file.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static bool is_black(const float c[3]) {
    return !(c[0] > 0.0f || c[1] > 0.0f || c[2] > 0.0f);
}

static float largest(const float c[3]) {
    return fmaxf(c[0], fmaxf(c[1], c[2]));
}

bool mtl_is_glass(const mtl *m) {
    return m->illum == 4.0f || m->illum == 6.0f || m->illum == 7.0f || m->illum == 9.0f;
}

/* Highlights that programs write for a material that nobody gave one. Each is known by both numbers, so that what others chose
 * stays. */
static const struct {
    float specular, exponent; /* Ks, all channels; Ns */
    const char *program;
} defaults[] = {
    {0.5f, 250.0f, "Blender"},     /* from 3.1: roughness 0.5, Ns = 1000 (1 - roughness)^2 */
    {0.5f, 360.0f, "Blender"},     /* roughness 0.4 */
    {0.5f, 225.0f, "Blender"},     /* 2.8 to 3.0: roughness 0.5, Ns = (30 (1 - roughness))^2 */
    {0.5f, 324.0f, "Blender"},     /* roughness 0.4: 323.999994 */
    {0.5f, 96.078431f, "Blender"}, /* to 2.7: hardness 50 */
    {0.5f, 18.0f, "Maya"},         /* phong */
    {0.9f, 10.0f, "3ds Max"},      /* specular colour and glossiness of a material whose specular level is 0 */
    {0.898039f, 10.0f, "3ds Max"}, /* the same, in bytes */
    {0.4f, 10.0f, "Assimp"},       /* of COLLADA without a highlight */
};

static bool is_grey(const float c[3], float level) {
    for (int i = 0; i < 3; i++)
        if (!(fabsf(c[i] - level) < 1e-4f))
            return false;
    return true;
}

/* The program whose default the highlight is, or NULL. It depends on the material alone. */
static const char *default_of(const mtl *m) {
    for (size_t i = 0; i < sizeof defaults / sizeof defaults[0]; i++)
        if (is_grey(m->specular, defaults[i].specular) &&
            fabsf(m->exponent - defaults[i].exponent) < 1e-4f * defaults[i].exponent)
            return defaults[i].program;
    return NULL;
}

/* Blender writes its Principled shader: Ks is a level, 0.5 of which means 4 % of dielectric reflection, and Ka is 1, or with
 * illum 3 the metalness. Known by what its users leave: that level and the index. */
static bool is_principled(const mtl *m) {
    const float metallic = m->ambient[0];
    const bool untouched = is_grey(m->specular, 0.5f) && (fabsf(m->ior - 1.45f) < 1e-4f || fabsf(m->ior - 1.5f) < 1e-4f);
    return untouched && m->exponent >= 0.0f && m->exponent <= 1000.0f && is_grey(m->ambient, metallic) &&
           (m->illum == 3.0f ? metallic > 0.0f && metallic <= 1.0f && !is_black(m->color)
                             : m->illum == 2.0f && metallic == 1.0f);
}

/* Of a map's texels, times what is in `mean` already; nothing happens without a map. */
static bool multiply_mean(importer *im, const mtl_map *map, const char *material, bool srgb, float mean[4]) {
    char name[SCENE_PATH];
    float own[4];
    if (obj_is_empty(map->name))
        return true;
    mtl_name_of(map->name, name);
    if (!import_texture_mean(im, name, material, srgb, own))
        return false;
    for (int k = 0; k < 4; k++)
        mean[k] *= own[k];
    return true;
}

/* The metallic-roughness model, of glTF's numbers. */
static bool shade(importer *im, material_use *use, const mtl *m, float metallic, float roughness) {
    static const float dielectric[3] = {SPECULAR_DIELECTRIC, SPECULAR_DIELECTRIC, SPECULAR_DIELECTRIC};
    const bool ggx = im->s->quality.ggx;
    float base[3], mean[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    memcpy(base, use->m.albedo, sizeof base);
    if (metallic > 0.0f && specular_has_lobe(ggx, roughness) && !multiply_mean(im, &m->color_map, NULL, true, mean))
        return false;
    for (int i = 0; i < 3; i++)
        mean[i] *= base[i];
    specular_mapping_of(ggx)(&use->m, base, mean, dielectric, metallic, roughness);
    return true;
}

static bool read_principled(importer *im, material_use *use, const mtl *m) {
    im->m->principled++;
    return shade(im, use, m, m->illum == 3.0f ? m->ambient[0] : 0.0f, 1.0f - sqrtf(m->exponent / 1000.0f));
}

static bool has_roughness(const mtl *m) {
    return m->has & (MTL_HAS_ROUGHNESS | MTL_HAS_METALLIC) || !obj_is_empty(m->roughness_map.name) ||
           !obj_is_empty(m->metallic_map.name);
}

/* Pr and Pm, and the means of their maps, which are factors where there is a number, too. */
static bool read_roughness(importer *im, material_use *use, const mtl *m) {
    float roughness[4] = {m->has & MTL_HAS_ROUGHNESS || obj_is_empty(m->roughness_map.name) ? m->roughness : 1.0f};
    float metallic[4] = {m->has & MTL_HAS_METALLIC || obj_is_empty(m->metallic_map.name) ? m->metallic : 1.0f};
    return multiply_mean(im, &m->roughness_map, use->m.name, false, roughness) &&
           multiply_mean(im, &m->metallic_map, use->m.name, false, metallic) &&
           shade(im, use, m, import_clamp(metallic[0], 1.0f), import_clamp(roughness[0], 1.0f));
}

/* illum: 0, 1 have no highlights; 2 has; 3 and 5 mirror; 4, 6, 7 and 9 are transparent, 6 and 7 with refraction. What programs
 * write is not always meant: a mirror must reflect more than it scatters, glass must be transparent by d or Tf, or have no
 * colour of its own. The Cornell box "Glossy" (illum 2, Ks 0.9 and 0.8, Ns 40) has lobes on sphere and box; Sibenik (illum 1,
 * Ks 0) none, its panes of d 0.5 stay as they are. Of a closed body, Tf is what its two surfaces together let pass. */
static bool is_glass(const material_use *use, const mtl *m) {
    const float *f = m->filter;
    const bool filters = largest(f) > 0.0f && (f[0] < 1.0f || f[1] < 1.0f || f[2] < 1.0f);
    return mtl_is_glass(m) && is_black(use->m.emission) &&
           (m->opacity < 1.0f || filters || (is_black(m->color) && !use->image[0]));
}

static void make_glass(model_material *to, const mtl *m) {
    const bool body = (m->illum == 6.0f || m->illum == 7.0f) && m->ior > 1.0f;
    import_make_glass(to, body ? VIT_GLASS : VIT_THIN_GLASS, m->ior > 1.0f ? m->ior : 0.0f);
    for (int i = 0; i < 3; i++)
        to->specular[i] = is_black(m->filter) ? 1.0f : body ? sqrtf(m->filter[i]) : m->filter[i];
}

/* A mirror or a lobe, of Ks and the mean of map_Ks. */
static bool reflect(importer *im, model_material *to, const mtl *m) {
    float mean[4] = {m->specular[0], m->specular[1], m->specular[2], 1.0f};
    if (!multiply_mean(im, &m->specular_map, to->name, true, mean))
        return false;
    const bool mirror = (m->illum == 3.0f || m->illum == 5.0f) && is_black(to->emission) && largest(mean) >= largest(m->color);
    if (mirror)
        to->kind = VIT_MIRROR;
    else if (m->exponent >= 1.0f)
        to->exponent = fminf(m->exponent, VIT_MAX_EXPONENT);
    if (mirror || m->exponent >= 1.0f)
        memcpy(to->specular, mean, sizeof to->specular);
    return true;
}

bool mtl_shine(importer *im, material_use *use, const mtl *lines) {
    mtl m = *lines;
    for (int i = 0; i < 3; i++) {
        m.specular[i] = import_clamp(m.specular[i], 1.0f);
        m.filter[i] = import_clamp(m.filter[i], 1.0f);
    }
    if (is_glass(use, &m)) {
        make_glass(&use->m, &m);
        return true;
    }
    if (has_roughness(&m))
        return read_roughness(im, use, &m);
    if (!(m.illum >= 2.0f) || is_black(m.specular))
        return true;
    const bool mapped = !obj_is_empty(m.specular_map.name);
    const char *program = m.illum == 3.0f || mapped ? NULL : default_of(&m);
    if (program) {
        if (im->m->default_highlights++ == 0)
            (void)snprintf(im->m->default_highlight, sizeof im->m->default_highlight, "Ks %g, Ns %g: %s", (double)m.specular[0],
                           (double)m.exponent, program);
        return true;
    }
    return !mapped && is_principled(&m) ? read_principled(im, use, &m) : reflect(im, &use->m, &m);
}
