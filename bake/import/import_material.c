#include "import/importer.h"
#include "import/light_units.h"
#include "common/strict_math.h"
#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

bool import_floats(const struct aiMaterial *ai, const char *key, unsigned type, unsigned index, float *out, unsigned count) {
    float values[16];
    unsigned got = sizeof values / sizeof *values;
    if (aiGetMaterialFloatArray(ai, key, type, index, values, &got) != aiReturn_SUCCESS || got < count)
        return false;
    memcpy(out, values, count * sizeof *out);
    return true;
}

float import_clamp(float value, float most) {
    return value > 0.0f ? (value < most ? value : most) : 0.0f; /* NaN is 0 */
}

static uint32_t wrap_of(enum aiTextureMapMode mode) {
    switch (mode) {
    case aiTextureMapMode_Clamp:
    case aiTextureMapMode_Decal:
        return VIT_WRAP_CLAMP;
    case aiTextureMapMode_Mirror:
        return VIT_WRAP_MIRROR;
    default:
        return VIT_WRAP_REPEAT;
    }
}

/* Assimp turns KHR_texture_transform into its own convention (v up, about the image's middle); this undoes it and gives the
 * extension's matrix, offset * rotation * scale, which is meant for v down as ours is. */
static void read_transform(material_use *use, const struct aiMaterial *ai, enum aiTextureType type) {
    float t[5]; /* translation x, y, scaling x, y, rotation: aiUVTransform */
    if (!import_floats(ai, _AI_MATKEY_UVTRANSFORM_BASE, type, 0, t, 5))
        return;
    const double rotation = -(double)t[4], sx = (double)t[2], sy = (double)t[3];
    const double s = strict_sin(rotation), c = strict_cos(rotation);
    const double ox = (double)t[0] - 0.5 * sx * (-c + s + 1.0);
    const double oy = 0.5 * sy * (s + c - 1.0) + 1.0 - sy - (double)t[1];
    const double matrix[6] = {c * sx, s * sy, ox, -s * sx, c * sy, oy};
    for (int i = 0; i < 6; i++)
        if (!isfinite(matrix[i]))
            return;
    memcpy(use->uv, matrix, sizeof matrix);
    use->has_transform = true;
}

static void read_texture(const importer *im, material_use *use, const struct aiMaterial *ai) {
    static const enum aiTextureType types[2] = {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR};
    for (int i = 0; i < 2; i++) {
        struct aiString path;
        enum aiTextureMapMode mode[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
        unsigned set = 0;
        if (aiGetMaterialTexture(ai, types[i], 0, &path, NULL, &set, NULL, NULL, mode, NULL) != aiReturn_SUCCESS ||
            !path.length)
            continue;
        (void)snprintf(use->image, sizeof use->image, "%s", path.data);
        use->uv_set = set;
        use->m.wrap_u = wrap_of(mode[0]);
        use->m.wrap_v = wrap_of(mode[1]);
        if (im->gltf)
            read_transform(use, ai, types[i]);
        return;
    }
}

/* Diffuse reflectance, before import_shine() has told what of it is not diffuse. */
static void read_color(importer *im, material_use *use, const struct aiMaterial *ai) {
    float color[4] = {0.8f, 0.8f, 0.8f, 1.0f}, specular;
    /* In glTF's specular-glossiness extension the base colour is a placeholder. */
    const bool glossy = import_floats(ai, AI_MATKEY_GLOSSINESS_FACTOR, &specular, 1);
    if (glossy || !import_floats(ai, AI_MATKEY_BASE_COLOR, color, 3))
        (void)import_floats(ai, AI_MATKEY_COLOR_DIFFUSE, color, 3);
    if (use->image[0] && color[0] == 0.0f && color[1] == 0.0f && color[2] == 0.0f) {
        import_warn(im, "material '%.100s': black times a texture; the texture alone is used", use->m.name);
        color[0] = color[1] = color[2] = 1.0f;
    }
    for (int i = 0; i < 3; i++)
        use->m.albedo[i] = import_clamp(color[i] * use->tint[i], VIT_MAX_ALBEDO);
}

static void read_emission(importer *im, material_use *use, const struct aiMaterial *ai) {
    struct aiString path;
    float color[3] = {0.0f, 0.0f, 0.0f}, strength = 1.0f;
    (void)import_floats(ai, AI_MATKEY_COLOR_EMISSIVE, color, 3);
    (void)import_floats(ai, AI_MATKEY_EMISSIVE_INTENSITY, &strength, 1);
    const bool black = !(color[0] > 0.0f || color[1] > 0.0f || color[2] > 0.0f);
    if (!black &&
        aiGetMaterialTexture(ai, aiTextureType_EMISSIVE, 0, &path, NULL, NULL, NULL, NULL, NULL, NULL) == aiReturn_SUCCESS) {
        import_warn(im, "material '%.100s': emissive textures are not supported; it does not emit", use->m.name);
        return;
    }
    for (int i = 0; i < 3; i++)
        use->m.emission[i] = import_clamp((float)((double)(color[i] * strength) * light_units_of_emission(im->s)), 1e9f);
    use->m.emits_by_file = !black;
    use->m.states_unit = im->gltf;
}

/* glTF: alphaMode says what alpha means. MASK cuts out; BLEND, which is not simulated, becomes a cut-out or a hole. */
static void read_alpha_gltf(const importer *im, material_use *use, const struct aiMaterial *ai) {
    struct aiString mode = {.length = 0};
    float cutoff = 0.5f;
    (void)aiGetMaterialString(ai, AI_MATKEY_GLTF_ALPHAMODE, &mode);
    const bool mask = !strcmp(mode.data, "MASK");
    if (!mask && strcmp(mode.data, "BLEND") != 0)
        return;
    if (mask)
        (void)import_floats(ai, AI_MATKEY_GLTF_ALPHACUTOFF, &cutoff, 1);
    use->m.alpha = import_opacity(im, ai);
    use->alpha_mapped = true;
    use->m.cutoff = import_clamp(cutoff, 1.0f);
}

/* OBJ and the rest: d is one number for all of it, map_d an image that has to be the colour texture's own alpha. */
static void read_alpha_other(importer *im, material_use *use, const struct aiMaterial *ai) {
    struct aiString path;
    const float alpha = import_opacity(im, ai);
    const bool mapped =
        aiGetMaterialTexture(ai, aiTextureType_OPACITY, 0, &path, NULL, NULL, NULL, NULL, NULL, NULL) == aiReturn_SUCCESS;
    if (mapped && strcmp(path.data, use->image) != 0)
        import_warn(im, "material '%.100s': opacity texture '%.200s' is not the colour texture; it is left out", use->m.name,
                    path.data);
    use->alpha_mapped = mapped && !strcmp(path.data, use->image);
    use->m.alpha = alpha;
    if (alpha < 0.5f || use->alpha_mapped)
        use->m.cutoff = 0.5f;
}

/* What the scene file says beats what the mesh says. */
static void apply_override(importer *im, material_use *use) {
    for (int i = 0; i < im->s->material_count; i++) {
        const scene_material *o = &im->s->materials[i];
        if (strcmp(o->name, use->m.name) != 0)
            continue;
        im->override_used[i] = true;
        for (int k = 0; k < 3 && o->has_color; k++)
            use->m.albedo[k] = import_clamp((float)o->color[k], VIT_MAX_ALBEDO);
        for (int k = 0; k < 3 && o->has_emission; k++)
            use->m.emission[k] = (float)o->emission[k];
        use->m.emits_by_file = use->m.emits_by_file && !o->has_emission;
        import_override_specular(im, &use->m, o);
        if (o->has_area_light)
            use->m.area_light = o->area_light;
        if (o->has_cutoff) {
            use->m.cutoff = (float)o->cutoff;
            use->cutoff_asked = true;
        }
        if (o->has_texture) {
            memcpy(use->image, o->texture, sizeof use->image);
            use->image_resolved = true;
            use->image_line = o->line;
            use->uv_set = 0;
            use->has_transform = false;
            use->m.wrap_u = use->m.wrap_v = VIT_WRAP_REPEAT;
        }
    }
}

bool import_material(importer *im, unsigned ai_index, const float tint[3], material_use **use) {
    for (size_t i = 0; i < im->use_count; i++) {
        *use = &im->uses[i];
        if ((*use)->ai_index == ai_index && !memcmp((*use)->tint, tint, sizeof(*use)->tint))
            return true;
    }
    if (!import_room(im, &im->uses, &im->use_room, im->use_count + 1, sizeof *im->uses))
        return false;
    *use = &im->uses[im->use_count++];
    **use = (material_use){.ai_index = ai_index,
                           .index = -1,
                           .m = {.image = -1, .alpha = 1.0f, .exponent = 1.0f, .ior = 1.0f, .area_light = true}};
    memcpy((*use)->tint, tint, sizeof(*use)->tint);
    const struct aiMaterial *ai = im->ai->mMaterials[ai_index];
    struct aiString name = {.length = 0};
    (void)aiGetMaterialString(ai, AI_MATKEY_NAME, &name);
    (void)snprintf((*use)->m.name, sizeof(*use)->m.name, "%.*s", SCENE_NAME - 1, name.data);
    read_texture(im, *use, ai);
    read_color(im, *use, ai);
    read_emission(im, *use, ai);
    if (im->gltf)
        read_alpha_gltf(im, *use, ai);
    else
        read_alpha_other(im, *use, ai);
    if (!import_shine(im, *use, ai))
        return false;
    apply_override(im, *use);
    import_settle_specular(&(*use)->m);
    import_settle_holes(im, *use, ai);
    return true;
}

static bool has_alpha(const model_image *image, float factor, float cutoff) {
    const size_t texels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; cutoff > 0.0f && i < texels; i++)
        if ((float)image->rgba[4 * i + 3] / 255.0f * factor < cutoff)
            return true;
    return false;
}

/* What is wrong with an image that the scene file names is told of with its line. */
static bool take_texture(importer *im, material_use *use) {
    const char *file = im->file;
    char where[SCENE_PATH + 16];
    (void)snprintf(where, sizeof where, "%.*s:%d", SCENE_PATH - 1, im->s->path, use->image_line);
    im->file = use->image_resolved ? where : file;
    const bool fine = import_texture(im, use->image, use->image_resolved, use->m.name, &use->m.image);
    im->file = file;
    return fine;
}

bool import_material_index(importer *im, material_use *use, uint32_t *index) {
    model *m = im->m;
    if (use->index < 0) {
        const bool seen = use->m.albedo[0] > 0 || use->m.albedo[1] > 0 || use->m.albedo[2] > 0 || use->m.cutoff > 0;
        if (use->image[0] && seen && !take_texture(im, use))
            return false;
        /* Without a hole there is no cut-out to pay for. */
        if (use->m.image < 0 || !has_alpha(&m->images[use->m.image], use->m.alpha, use->m.cutoff))
            use->m.cutoff = 0.0f;
        if (!import_room(im, &m->materials, &im->material_room, (size_t)m->material_count + 1, sizeof *m->materials))
            return false;
        use->index = m->material_count++;
        m->materials[use->index] = use->m;
    }
    *index = (uint32_t)use->index;
    return true;
}
