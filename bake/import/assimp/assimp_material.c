#include "import/assimp/assimp_scene.h"
#include <assimp/material.h>
#include <stdio.h>
#include <string.h>

bool assimp_floats(const struct aiMaterial *ai, const char *key, unsigned type, unsigned index, float *out, unsigned count) {
    float values[16];
    unsigned got = sizeof values / sizeof *values;
    if (aiGetMaterialFloatArray(ai, key, type, index, values, &got) != aiReturn_SUCCESS || got < count)
        return false;
    memcpy(out, values, count * sizeof *out);
    return true;
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

static void read_texture(material_use *use, const struct aiMaterial *ai) {
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
        return;
    }
}

static void read_color(importer *im, material_use *use, const struct aiMaterial *ai) {
    float color[4] = {0.8f, 0.8f, 0.8f, 1.0f};
    if (!assimp_floats(ai, AI_MATKEY_BASE_COLOR, color, 3))
        (void)assimp_floats(ai, AI_MATKEY_COLOR_DIFFUSE, color, 3);
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
    (void)assimp_floats(ai, AI_MATKEY_COLOR_EMISSIVE, color, 3);
    (void)assimp_floats(ai, AI_MATKEY_EMISSIVE_INTENSITY, &strength, 1);
    const bool black = !(color[0] > 0.0f || color[1] > 0.0f || color[2] > 0.0f);
    if (!black &&
        aiGetMaterialTexture(ai, aiTextureType_EMISSIVE, 0, &path, NULL, NULL, NULL, NULL, NULL, NULL) == aiReturn_SUCCESS) {
        import_warn(im, "material '%.100s': emissive textures are not supported; it does not emit", use->m.name);
        return;
    }
    import_emission(im, &use->m, color, strength);
}

/* A number for all of it; an image has to be the colour texture's own alpha. */
static void read_alpha(importer *im, material_use *use, const struct aiMaterial *ai) {
    struct aiString path;
    const float alpha = assimp_opacity(im->reader, ai);
    const bool mapped =
        aiGetMaterialTexture(ai, aiTextureType_OPACITY, 0, &path, NULL, NULL, NULL, NULL, NULL, NULL) == aiReturn_SUCCESS;
    if (mapped && strcmp(path.data, use->image) != 0)
        import_warn(im, "material '%.100s': opacity texture '%.200s' is not the colour texture; it is left out", use->m.name,
                    path.data);
    use->alpha_mapped = mapped && !strcmp(path.data, use->image);
    use->m.alpha = alpha;
    if (((const assimp_scene *)im->reader)->inverse)
        use->alpha_by_letter = assimp_stated_opacity(ai);
    if (alpha < 0.5f || use->alpha_mapped)
        use->m.cutoff = 0.5f;
}

bool assimp_material(importer *im, material_use *use) {
    const assimp_scene *a = im->reader;
    const struct aiMaterial *ai = a->ai->mMaterials[use->source];
    struct aiString name = {.length = 0};
    (void)aiGetMaterialString(ai, AI_MATKEY_NAME, &name);
    (void)snprintf(use->m.name, sizeof use->m.name, "%.*s", SCENE_NAME - 1, name.data);
    read_texture(use, ai);
    read_color(im, use, ai);
    read_emission(im, use, ai);
    read_alpha(im, use, ai);
    return true;
}
