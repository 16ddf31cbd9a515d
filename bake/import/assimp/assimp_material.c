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

/* In FBX, 3DS and ASE a texture stands in for the colour, which its exporters leave at whatever it was (3ds Max 0.588, Blender
 * 0.8, Maya 0.5), in X3D by its own word (3.3, 17.2.2.3); other formats multiply, or have one of the two. */
static bool stands_in(const assimp_scene *a) {
    static const char *const readers[] = {"Autodesk FBX", "Discreet 3DS", "ASE", "Extensible 3D"};
    for (size_t i = 0; i < sizeof readers / sizeof *readers; i++)
        if (strncmp(assimp_reader(a), readers[i], strlen(readers[i])) == 0)
            return true;
    return false;
}

static void read_color(importer *im, material_use *use, const struct aiMaterial *ai) {
    float color[4] = {0.8f, 0.8f, 0.8f, 1.0f};
    if (!assimp_floats(ai, AI_MATKEY_BASE_COLOR, color, 3))
        (void)assimp_floats(ai, AI_MATKEY_COLOR_DIFFUSE, color, 3);
    /* Assimp's own grey, where the file has no material; and X3D's vertex colours stand in for the material's. */
    if (use->tinted &&
        (strcmp(use->m.name, AI_DEFAULT_MATERIAL_NAME) == 0 || strcmp(assimp_reader(im->reader), "Extensible 3D") == 0))
        color[0] = color[1] = color[2] = 1.0f;
    if (use->image[0] && stands_in(im->reader)) {
        use->has_plain = true;
        for (int i = 0; i < 3; i++)
            use->plain[i] = import_clamp(color[i] * use->tint[i], VIT_MAX_ALBEDO);
        color[0] = color[1] = color[2] = 1.0f;
    }
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
    assimp_scene *a = im->reader;
    const struct aiMaterial *ai = a->ai->mMaterials[use->source];
    struct aiString name = {.length = 0};
    (void)aiGetMaterialString(ai, AI_MATKEY_NAME, &name);
    (void)snprintf(use->m.name, sizeof use->m.name, "%.*s", SCENE_NAME - 1, name.data);
    if (!assimp_color_map(a, use, ai))
        return false;
    read_color(im, use, ai);
    return read_emission(im, use, ai) && read_alpha(im, use, ai) && assimp_other_maps(a, use, ai);
}
