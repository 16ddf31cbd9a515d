/* Pictures of Assimp's materials: the colour texture, and what of the others is left out. */
#include "import/assimp/assimp_scene.h"
#include <assimp/material.h>
#include <stdio.h>
#include <string.h>

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

/* Of X3D Assimp hands on whether it repeats, which is the other way round. */
static uint32_t wrap_of(const assimp_scene *a, enum aiTextureMapMode mode) {
    if (strcmp(assimp_reader(a), "Extensible 3D") == 0)
        return mode == aiTextureMapMode_Wrap ? VIT_WRAP_CLAMP : VIT_WRAP_REPEAT;
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

static bool has_map(const struct aiMaterial *ai, unsigned type, unsigned index, struct aiString *path) {
    return aiGetMaterialTexture(ai, (enum aiTextureType)type, index, path, NULL, NULL, NULL, NULL, NULL, NULL) ==
               aiReturn_SUCCESS &&
           path->length > 0;
}

/* Once a file, of all its materials. */
static bool say_once(assimp_scene *a, assimp_remark remark, const char *text, const char *material) {
    const unsigned bit = 1u << remark;
    if (a->said & bit)
        return true;
    if (a->im->warn) /* it is not, while import_transparency.c takes stock */
        a->said |= bit;
    return import_not_done(a->im, "%s (material '%.100s' and perhaps others)", text, material);
}

/* Formats lay a texture's offset, scale and turn about different points, and Assimp does not say about which. */
static bool check_transform(assimp_scene *a, const material_use *use, const struct aiMaterial *ai, unsigned type) {
    static const float none[5] = {0.0f, 0.0f, 1.0f, 1.0f, 0.0f}; /* offset, scale, turn */
    float t[5];
    return !assimp_floats(ai, _AI_MATKEY_UVTRANSFORM_BASE, type, 0, t, 5) || memcmp(t, none, sizeof t) == 0 ||
           say_once(a, ASSIMP_SAID_TRANSFORM, "offset, scale and rotation of textures are left out", use->m.name);
}

/* A set's number is the file's own; a mesh with one set has that. Assimp tells which it is from 5.4 on. */
static bool check_set(assimp_scene *a, const material_use *use, unsigned set) {
    bool several = false;
    for (unsigned i = 0; i < a->ai->mNumMeshes; i++)
        several = several || a->ai->mMeshes[i]->mTextureCoords[1];
    return !a->other_set || set > 0 || !several ||
           say_once(a, ASSIMP_SAID_SET, "textures have the first coordinates, though the file says others of some",
                    use->m.name);
}

bool assimp_color_map(assimp_scene *a, material_use *use, const struct aiMaterial *ai) {
    static const enum aiTextureType types[2] = {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR};
    for (int i = 0; i < 2; i++) {
        struct aiString path, second;
        enum aiTextureMapMode mode[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
        unsigned set = 0;
        if (aiGetMaterialTexture(ai, types[i], 0, &path, NULL, &set, NULL, NULL, mode, NULL) != aiReturn_SUCCESS ||
            !path.length)
            continue;
        assimp_image_name(a, &path, use->image);
        use->uv_set = set;
        use->m.wrap_u = wrap_of(a, mode[0]);
        use->m.wrap_v = wrap_of(a, mode[1]);
        if (has_map(ai, types[i], 1, &second) && strcmp(path.data, second.data) != 0 &&
            !say_once(a, ASSIMP_SAID_LAYERS, "of several colour textures only the first is shown", use->m.name))
            return false;
        return check_set(a, use, set) && check_transform(a, use, ai, types[i]);
    }
    return true;
}

bool assimp_other_maps(assimp_scene *a, const material_use *use, const struct aiMaterial *ai) {
    static const struct {
        unsigned type;
        assimp_remark remark;
    } maps[] = {{aiTextureType_HEIGHT, ASSIMP_SAID_BUMP},
                {aiTextureType_NORMALS, ASSIMP_SAID_BUMP},
                {aiTextureType_NORMAL_CAMERA, ASSIMP_SAID_BUMP},
                {aiTextureType_DISPLACEMENT, ASSIMP_SAID_BUMP},
                {aiTextureType_SPECULAR, ASSIMP_SAID_SPECULAR},
                {aiTextureType_SHININESS, ASSIMP_SAID_SPECULAR},
                {aiTextureType_REFLECTION, ASSIMP_SAID_SPECULAR},
                {aiTextureType_METALNESS, ASSIMP_SAID_SPECULAR},
                {aiTextureType_DIFFUSE_ROUGHNESS, ASSIMP_SAID_SPECULAR}};
    struct aiString path;
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        if (has_map(ai, maps[i].type, 0, &path) &&
            !say_once(a, maps[i].remark,
                      maps[i].remark == ASSIMP_SAID_BUMP ? "bump, normal and displacement maps are left out"
                                                         : "maps of highlights and reflections are left out",
                      use->m.name))
            return false;
    return true;
}
