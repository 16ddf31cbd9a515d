/* What besides matt reflection an MTL material does: a Phong lobe, a mirror, glass. */
#include "import/metallic_roughness.h"
#include "import/assimp/assimp_scene.h"
#include <assimp/ObjMaterial.h>
#include <assimp/material.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static bool is_black(const float c[3]) {
    return !(c[0] > 0.0f || c[1] > 0.0f || c[2] > 0.0f);
}

static float largest(const float c[3]) {
    return fmaxf(c[0], fmaxf(c[1], c[2]));
}

typedef struct mtl {
    int illum; /* Assimp: 1 if the file has none */
    float color[3], ambient[3], specular[3], filter[3], exponent, ior, alpha;
} mtl;

static mtl read_mtl(const struct aiMaterial *ai) {
    mtl m = {.illum = 0, .filter = {1.0f, 1.0f, 1.0f}, .ior = 1.0f, .alpha = 1.0f};
    unsigned one = 1;
    if (aiGetMaterialIntegerArray(ai, AI_MATKEY_OBJ_ILLUM, &m.illum, &one) != aiReturn_SUCCESS)
        m.illum = 0;
    (void)assimp_floats(ai, AI_MATKEY_COLOR_DIFFUSE, m.color, 3);
    (void)assimp_floats(ai, AI_MATKEY_COLOR_AMBIENT, m.ambient, 3);
    (void)assimp_floats(ai, AI_MATKEY_COLOR_SPECULAR, m.specular, 3);
    (void)assimp_floats(ai, AI_MATKEY_COLOR_TRANSPARENT, m.filter, 3);
    (void)assimp_floats(ai, AI_MATKEY_SHININESS, &m.exponent, 1);
    (void)assimp_floats(ai, AI_MATKEY_REFRACTI, &m.ior, 1);
    (void)assimp_floats(ai, AI_MATKEY_OPACITY, &m.alpha, 1);
    for (int i = 0; i < 3; i++) {
        m.specular[i] = import_clamp(m.specular[i], 1.0f);
        m.filter[i] = import_clamp(m.filter[i], 1.0f);
    }
    return m;
}

static bool is_clear_illum(int illum) {
    return illum == 4 || illum == 6 || illum == 7 || illum == 9;
}

bool assimp_is_glass(const struct aiMaterial *ai) {
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

/* Of `map_Ks`, as if it were sRGB; all 1 without one. */
static bool mean_of_highlights(importer *im, const struct aiMaterial *ai, const char *material, float mean[4]) {
    struct aiString path;
    if (aiGetMaterialTexture(ai, aiTextureType_SPECULAR, 0, &path, NULL, NULL, NULL, NULL, NULL, NULL) == aiReturn_SUCCESS &&
        path.length)
        return import_texture_mean(im, path.data, material, true, mean);
    for (int k = 0; k < 4; k++)
        mean[k] = 1.0f;
    return true;
}

static bool read_principled(importer *im, material_use *use, const mtl *m) {
    static const float dielectric[3] = {SPECULAR_DIELECTRIC, SPECULAR_DIELECTRIC, SPECULAR_DIELECTRIC};
    float base[3], mean[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    const float metallic = m->illum == 3 ? m->ambient[0] : 0.0f, roughness = 1.0f - sqrtf(m->exponent / 1000.0f);
    memcpy(base, use->m.albedo, sizeof base);
    if (use->image[0] && metallic > 0.0f && specular_exponent(roughness) > 0.0f &&
        !import_texture_mean(im, use->image, NULL, true, mean))
        return false;
    for (int i = 0; i < 3; i++)
        mean[i] *= base[i];
    specular_from_metallic(&use->m, base, mean, dielectric, metallic, roughness);
    im->m->principled++;
    return true;
}

/* illum: 0, 1 have no highlights; 2 has; 3 and 5 mirror; 4, 6, 7 and 9 are transparent, 6 and 7 with refraction. What programs
 * write is not always meant: a mirror must reflect more than it scatters, glass must be transparent by d or Tf, or have no
 * colour of its own. The Cornell box "Glossy" (illum 2, Ks 0.9 and 0.8, Ns 40) has lobes on sphere and box; Sibenik (illum 1,
 * Ks 0) none, its panes of d 0.5 stay as they are. Of a closed body, Tf is what its two surfaces together let pass. */
bool assimp_shine(importer *im, material_use *use, const struct aiMaterial *ai) {
    mtl m = read_mtl(ai);
    model_material *to = &use->m;
    const bool emits = !is_black(to->emission), refracts = m.illum == 6 || m.illum == 7;
    const bool filters = largest(m.filter) > 0.0f && (m.filter[0] < 1.0f || m.filter[1] < 1.0f || m.filter[2] < 1.0f);
    const bool clear = m.alpha < 1.0f || filters || (is_black(m.color) && !use->image[0]);
    if (is_clear_illum(m.illum) && clear && !emits) {
        const bool body = refracts && m.ior > 1.0f;
        import_make_glass(to, body ? VIT_GLASS : VIT_THIN_GLASS, m.ior > 1.0f ? m.ior : 0.0f);
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
    if (!mean_of_highlights(im, ai, to->name, mean))
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
