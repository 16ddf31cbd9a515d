/* What besides matt reflection a mesh file's material does: a Phong lobe, a mirror, glass. */
#include "import/metallic_roughness.h"
#include "import/importer.h"
#include "common/strict_math.h"
#include <assimp/GltfMaterial.h>
#include <assimp/ObjMaterial.h>
#include <assimp/material.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define DEFAULT_EXPONENT 50.0f /* of a lobe, and index of glass, where nothing says either */
#define DEFAULT_IOR 1.5f
#define MOST_ABSORPTION 1e9f

static bool is_black(const float c[3]) {
    return !(c[0] > 0.0f || c[1] > 0.0f || c[2] > 0.0f);
}

static bool is_glass(const model_material *m) {
    return m->kind == VIT_GLASS || m->kind == VIT_THIN_GLASS;
}

static float largest(const float c[3]) {
    return fmaxf(c[0], fmaxf(c[1], c[2]));
}

/* Glass is no hole: what the file says of its opacity was another way to say glass. */
static void make_glass(model_material *m, uint32_t kind, float ior) {
    m->kind = kind;
    m->ior = ior >= VIT_MIN_IOR ? fminf(ior, VIT_MAX_IOR) : DEFAULT_IOR;
    m->alpha = 1.0f;
    m->cutoff = 0.0f;
}

/* ---- MTL ---- */

typedef struct mtl {
    int illum; /* Assimp: 1 if the file has none */
    float color[3], ambient[3], specular[3], filter[3], exponent, ior, alpha;
} mtl;

static mtl read_mtl(const struct aiMaterial *ai) {
    mtl m = {.illum = 0, .filter = {1.0f, 1.0f, 1.0f}, .ior = 1.0f, .alpha = 1.0f};
    unsigned one = 1;
    if (aiGetMaterialIntegerArray(ai, AI_MATKEY_OBJ_ILLUM, &m.illum, &one) != aiReturn_SUCCESS)
        m.illum = 0;
    (void)import_floats(ai, AI_MATKEY_COLOR_DIFFUSE, m.color, 3);
    (void)import_floats(ai, AI_MATKEY_COLOR_AMBIENT, m.ambient, 3);
    (void)import_floats(ai, AI_MATKEY_COLOR_SPECULAR, m.specular, 3);
    (void)import_floats(ai, AI_MATKEY_COLOR_TRANSPARENT, m.filter, 3);
    (void)import_floats(ai, AI_MATKEY_SHININESS, &m.exponent, 1);
    (void)import_floats(ai, AI_MATKEY_REFRACTI, &m.ior, 1);
    (void)import_floats(ai, AI_MATKEY_OPACITY, &m.alpha, 1);
    for (int i = 0; i < 3; i++) {
        m.specular[i] = import_clamp(m.specular[i], 1.0f);
        m.filter[i] = import_clamp(m.filter[i], 1.0f);
    }
    return m;
}

static bool is_clear_illum(int illum) {
    return illum == 4 || illum == 6 || illum == 7 || illum == 9;
}

bool import_is_glass_mtl(const struct aiMaterial *ai) {
    return is_clear_illum(read_mtl(ai).illum);
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
           (m->illum == 3 ? metallic > 0.0f && metallic <= 1.0f && !is_black(m->color) : m->illum == 2 && metallic == 1.0f);
}

static bool read_principled(importer *im, material_use *use, const mtl *m) {
    float base[3], mean[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    const float metallic = m->illum == 3 ? m->ambient[0] : 0.0f, roughness = 1.0f - sqrtf(m->exponent / 1000.0f);
    memcpy(base, use->m.albedo, sizeof base);
    if (use->image[0] && metallic > 0.0f && specular_exponent(roughness) > 0.0f &&
        !import_texture_mean(im, use->image, NULL, true, mean))
        return false;
    for (int i = 0; i < 3; i++)
        mean[i] *= base[i];
    specular_from_metallic(&use->m, base, mean, metallic, roughness);
    im->m->principled++;
    return true;
}

/* illum: 0, 1 have no highlights; 2 has; 3 and 5 mirror; 4, 6, 7 and 9 are transparent, 6 and 7 with refraction. What programs
 * write is not always meant: a mirror must reflect more than it scatters, glass must be transparent by d or Tf, or have no
 * colour of its own. The Cornell box "Glossy" (illum 2, Ks 0.9 and 0.8, Ns 40) has lobes on sphere and box; Sibenik (illum 1,
 * Ks 0) none, its panes of d 0.5 stay as they are. Of a closed body, Tf is what its two surfaces together let pass. */
static bool read_specular_mtl(importer *im, material_use *use, const struct aiMaterial *ai) {
    mtl m = read_mtl(ai);
    model_material *to = &use->m;
    const bool emits = !is_black(to->emission), refracts = m.illum == 6 || m.illum == 7;
    const bool filters = largest(m.filter) > 0.0f && (m.filter[0] < 1.0f || m.filter[1] < 1.0f || m.filter[2] < 1.0f);
    const bool clear = m.alpha < 1.0f || filters || (is_black(m.color) && !use->image[0]);
    if (is_clear_illum(m.illum) && clear && !emits) {
        const bool body = refracts && m.ior > 1.0f;
        make_glass(to, body ? VIT_GLASS : VIT_THIN_GLASS, m.ior > 1.0f ? m.ior : DEFAULT_IOR);
        for (int i = 0; i < 3; i++)
            to->specular[i] = is_black(m.filter) ? 1.0f : body ? sqrtf(m.filter[i]) : m.filter[i];
        return true;
    }
    float mean[4];
    if (m.illum < 2 || is_black(m.specular))
        return true;
    const bool mapped = aiGetMaterialTextureCount(ai, aiTextureType_SPECULAR) > 0;
    const char *program = m.illum == 3 || mapped ? NULL : default_of(&m);
    if (program) {
        if (im->m->default_highlights++ == 0)
            (void)snprintf(im->m->default_highlight, sizeof im->m->default_highlight, "Ks %g, Ns %g: %s", (double)m.specular[0],
                           (double)m.exponent, program);
        return true;
    }
    if (!mapped && is_principled(&m))
        return read_principled(im, use, &m);
    if (!import_texture_mean_of(im, ai, aiTextureType_SPECULAR, 0, to->name, mean))
        return false;
    for (int i = 0; i < 3; i++)
        m.specular[i] *= mean[i];
    if ((m.illum == 3 || m.illum == 5) && !emits && largest(m.specular) >= largest(m.color)) {
        to->kind = VIT_MIRROR;
        memcpy(to->specular, m.specular, sizeof to->specular);
    } else if (m.exponent >= 1.0f) {
        memcpy(to->specular, m.specular, sizeof to->specular);
        to->exponent = fminf(m.exponent, VIT_MAX_EXPONENT);
    }
    return true;
}

/* ---- glTF ---- */

/* KHR_materials_transmission. */
static bool is_transmissive(const model_material *m, const struct aiMaterial *ai) {
    float part = 0.0f;
    (void)import_floats(ai, AI_MATKEY_TRANSMISSION_FACTOR, &part, 1);
    return part >= 0.5f && is_black(m->emission);
}

/* A volume has an inside; without one it is a pane. Roughness does not blur what is seen through it. */
static void read_glass(material_use *use, const struct aiMaterial *ai, const float mean[3]) {
    float thickness = 0.0f, ior = DEFAULT_IOR, color[3] = {1.0f, 1.0f, 1.0f}, distance = 0.0f;
    (void)import_floats(ai, AI_MATKEY_VOLUME_THICKNESS_FACTOR, &thickness, 1);
    (void)import_floats(ai, AI_MATKEY_REFRACTI, &ior, 1);
    (void)import_floats(ai, AI_MATKEY_VOLUME_ATTENUATION_COLOR, color, 3);
    (void)import_floats(ai, AI_MATKEY_VOLUME_ATTENUATION_DISTANCE, &distance, 1);
    make_glass(&use->m, thickness > 0.0f ? VIT_GLASS : VIT_THIN_GLASS, ior);
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
static void make_specular(model_material *m, const float base[3], const float specular[3], float glossiness) {
    const float exponent = specular_exponent(1.0f - glossiness);
    for (int i = 0; i < 3; i++) {
        m->albedo[i] = exponent > 0.0f ? base[i] * (1.0f - largest(specular)) : base[i];
        m->specular[i] = exponent > 0.0f ? specular[i] : 0.0f;
    }
    m->exponent = exponent > 0.0f ? exponent : 1.0f;
}

/* Roughness and metalness may have textures, of which the mean over all texels is taken: lobes have none. */
static bool read_specular_gltf(importer *im, material_use *use, const struct aiMaterial *ai) {
    float base[3], mean[4], parts[4], metallic = 1.0f, roughness = 1.0f, glossiness, specular[3] = {1.0f, 1.0f, 1.0f};
    memcpy(base, use->m.albedo, sizeof base);
    if (import_floats(ai, AI_MATKEY_GLOSSINESS_FACTOR, &glossiness, 1)) {
        (void)import_floats(ai, AI_MATKEY_COLOR_SPECULAR, specular, 3);
        if (!import_texture_mean_of(im, ai, aiTextureType_SPECULAR, 0, use->m.name, mean))
            return false;
        for (int i = 0; i < 3; i++)
            specular[i] = import_clamp(specular[i] * mean[i], 1.0f);
        make_specular(&use->m, base, specular, import_clamp(glossiness * mean[3], 1.0f));
        return true;
    }
    (void)import_floats(ai, AI_MATKEY_METALLIC_FACTOR, &metallic, 1);
    (void)import_floats(ai, AI_MATKEY_ROUGHNESS_FACTOR, &roughness, 1);
    if (!import_texture_mean_of(im, ai, AI_MATKEY_GLTF_PBRMETALLICROUGHNESS_METALLICROUGHNESS_TEXTURE, use->m.name, parts))
        return false;
    roughness = import_clamp(roughness * parts[1], 1.0f);
    metallic = import_clamp(metallic * parts[2], 1.0f);
    const bool glass = is_transmissive(&use->m, ai);
    mean[0] = mean[1] = mean[2] = 1.0f;
    if (use->image[0] && (glass || (metallic > 0.0f && specular_exponent(roughness) > 0.0f)) &&
        !import_texture_mean(im, use->image, NULL, true, mean))
        return false;
    for (int i = 0; i < 3; i++)
        mean[i] *= base[i];
    if (glass)
        read_glass(use, ai, mean);
    else
        specular_from_metallic(&use->m, base, mean, metallic, roughness);
    return true;
}

bool import_shine(importer *im, material_use *use, const struct aiMaterial *ai) {
    return im->gltf ? read_specular_gltf(im, use, ai) : read_specular_mtl(im, use, ai);
}

/* ---- the scene file ---- */

/* A kind that the mesh did not have starts with that kind's defaults. */
static void change_kind(model_material *m, int kind) {
    const bool shines = kind != VIT_MATTE, glass = kind == VIT_GLASS || kind == VIT_THIN_GLASS, was = is_glass(m);
    if (m->kind == (uint32_t)kind)
        return;
    for (int i = 0; i < 3; i++) {
        if (!glass || !was)
            m->specular[i] = shines ? 1.0f : 0.0f;
        if (kind != VIT_GLASS)
            m->absorption[i] = 0.0f;
        if (shines)
            m->emission[i] = 0.0f;
    }
    m->exponent = 1.0f;
    if (glass)
        make_glass(m, (uint32_t)kind, was ? m->ior : DEFAULT_IOR);
    else
        m->ior = 1.0f;
    m->kind = (uint32_t)kind;
}

void import_override_specular(importer *im, model_material *m, const scene_material *o) {
    if (o->has_kind)
        change_kind(m, o->kind);
    const bool glass = is_glass(m), matt = m->kind == VIT_MATTE;
    const bool lobe = !is_black(m->specular);
    for (int i = 0; i < 3 && o->has_specular; i++)
        m->specular[i] = (float)o->specular[i];
    for (int i = 0; i < 3 && o->has_absorption && m->kind == VIT_GLASS; i++)
        m->absorption[i] = (float)o->absorption[i];
    if (o->has_exponent && matt)
        m->exponent = (float)o->exponent;
    else if (o->has_specular && matt && !lobe)
        m->exponent = DEFAULT_EXPONENT;
    if (o->has_ior && glass)
        m->ior = (float)o->ior;
    /* A kind that the scene file states has been checked there. */
    if ((o->has_ior && !glass) || (o->has_absorption && m->kind != VIT_GLASS) ||
        ((o->has_color || o->has_emission || o->has_exponent) && !matt))
        import_warn(im, "line %d: material '%.100s': a setting does nothing for the kind of material that the mesh makes it",
                    o->line, o->name);
}

void import_settle_specular(model_material *m) {
    float most = 0.0f;
    for (int i = 0; i < 3; i++) {
        if (m->kind != VIT_MATTE)
            m->albedo[i] = m->emission[i] = 0.0f;
        most = fmaxf(most, m->albedo[i] + m->specular[i]);
    }
    if (m->kind != VIT_MATTE || is_black(m->specular))
        m->exponent = 1.0f;
    else if (most > 1.0f)
        for (int i = 0; i < 3; i++) { /* hues stay; rounded down */
            m->albedo[i] *= (1.0f - 0x1p-22f) / most;
            m->specular[i] *= (1.0f - 0x1p-22f) / most;
        }
}
