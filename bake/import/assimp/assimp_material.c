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

static const char *file_name(const char *path) {
    const char *slash = strrchr(path, '/'), *back = strrchr(path, '\\');
    return slash && (!back || slash > back) ? slash + 1 : back ? back + 1 : path;
}

/* FBX names the pictures that it holds as files: the whole name goes first, then its last part, by which Assimp would have them
 * looked up. */
static const struct aiTexture *embedded_texture(const struct aiScene *ai, const char *path, unsigned *index) {
    for (int whole = 1; whole >= 0; whole--)
        for (unsigned i = 0; i < ai->mNumTextures; i++) {
            const char *name = ai->mTextures[i]->mFilename.data;
            *index = i;
            if (name[0] && strcmp(whole ? name : file_name(name), whole ? path : file_name(path)) == 0)
                return ai->mTextures[i];
        }
    return NULL;
}

void assimp_image_name(const assimp_scene *a, const struct aiString *path, char out[SCENE_PATH]) {
    unsigned index;
    if (path->data[0] != '*' && embedded_texture(a->ai, path->data, &index))
        (void)snprintf(out, SCENE_PATH, "*%u", index);
    else
        (void)snprintf(out, SCENE_PATH, "%s", path->data);
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

static void read_texture(const assimp_scene *a, material_use *use, const struct aiMaterial *ai) {
    static const enum aiTextureType types[2] = {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR};
    for (int i = 0; i < 2; i++) {
        struct aiString path;
        enum aiTextureMapMode mode[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
        unsigned set = 0;
        if (aiGetMaterialTexture(ai, types[i], 0, &path, NULL, &set, NULL, NULL, mode, NULL) != aiReturn_SUCCESS ||
            !path.length)
            continue;
        assimp_image_name(a, &path, use->image);
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

static bool read_emission(importer *im, material_use *use, const struct aiMaterial *ai) {
    struct aiString path;
    float color[3] = {0.0f, 0.0f, 0.0f}, strength = 1.0f;
    (void)assimp_floats(ai, AI_MATKEY_COLOR_EMISSIVE, color, 3);
    (void)assimp_floats(ai, AI_MATKEY_EMISSIVE_INTENSITY, &strength, 1);
    const bool black = !(color[0] > 0.0f || color[1] > 0.0f || color[2] > 0.0f);
    if (!black &&
        aiGetMaterialTexture(ai, aiTextureType_EMISSIVE, 0, &path, NULL, NULL, NULL, NULL, NULL, NULL) == aiReturn_SUCCESS)
        return import_not_done(im, "material '%.100s': emissive textures are not supported; it does not emit", use->m.name);
    import_emission(im, &use->m, color, strength);
    return true;
}

/* A number for all of it; an image has to be the colour texture's own alpha. */
static bool read_alpha(importer *im, material_use *use, const struct aiMaterial *ai) {
    struct aiString path;
    char name[SCENE_PATH] = "";
    const float alpha = assimp_opacity(im->reader, ai);
    const bool mapped =
        aiGetMaterialTexture(ai, aiTextureType_OPACITY, 0, &path, NULL, NULL, NULL, NULL, NULL, NULL) == aiReturn_SUCCESS;
    if (mapped)
        assimp_image_name(im->reader, &path, name);
    use->alpha_mapped = mapped && !strcmp(name, use->image);
    if (mapped && !use->alpha_mapped &&
        !import_not_done(im, "material '%.100s': opacity texture '%.200s' is not the colour texture; it is left out",
                         use->m.name, path.data))
        return false;
    use->m.alpha = alpha;
    if (((const assimp_scene *)im->reader)->inverse)
        use->alpha_by_letter = assimp_stated_opacity(ai);
    if (alpha < 0.5f || use->alpha_mapped)
        use->m.cutoff = 0.5f;
    return true;
}

bool assimp_material(importer *im, material_use *use) {
    const assimp_scene *a = im->reader;
    const struct aiMaterial *ai = a->ai->mMaterials[use->source];
    struct aiString name = {.length = 0};
    (void)aiGetMaterialString(ai, AI_MATKEY_NAME, &name);
    (void)snprintf(use->m.name, sizeof use->m.name, "%.*s", SCENE_NAME - 1, name.data);
    read_texture(a, use, ai);
    read_color(im, use, ai);
    return read_emission(im, use, ai) && read_alpha(im, use, ai);
}
