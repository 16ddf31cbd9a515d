/* How a file's numbers mean transparency, where they may mean the contrary. */
#include "import/assimp/assimp_scene.h"
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <stdlib.h>

/* Opacity as the file has it. A 0 beside an opacity texture says nothing, since nobody maps what is invisible: the texture is
 * meant. */
float assimp_stated_opacity(const struct aiMaterial *ai) {
    float alpha = 1.0f;
    (void)assimp_floats(ai, AI_MATKEY_OPACITY, &alpha, 1);
    alpha = import_clamp(alpha, 1.0f);
    return alpha == 0.0f && aiGetMaterialTextureCount(ai, aiTextureType_OPACITY) > 0 ? 1.0f : alpha;
}

float assimp_opacity(const assimp_scene *a, const struct aiMaterial *ai) {
    const float alpha = assimp_stated_opacity(ai);
    return a->inverse && !assimp_is_glass(ai) ? 1.0f - alpha : alpha;
}

static void count_triangles(const struct aiScene *all, const struct aiNode *node, uint64_t *of_material, int depth) {
    if (!node) /* of a damaged file */
        return;
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        const struct aiMesh *mesh = node->mMeshes[i] < all->mNumMeshes ? all->mMeshes[node->mMeshes[i]] : NULL;
        if (!mesh || mesh->mMaterialIndex >= all->mNumMaterials)
            continue; /* assimp_mesh.c has the words for it */
        for (unsigned k = 0; k < mesh->mNumFaces; k++)
            of_material[mesh->mMaterialIndex] += mesh->mFaces[k].mNumIndices == 3;
    }
    for (unsigned i = 0; depth < IMPORT_DEPTH && i < node->mNumChildren; i++)
        count_triangles(all, node->mChildren[i], of_material, depth + 1);
}

/* No material in use is opaque by the letter, and some are invisible: the file writes transparency where it means opacity, or
 * the other way round. MTL's glass says by `illum` what it is. */
static bool is_inverse(const assimp_scene *a, const uint64_t *of_material) {
    bool invisible = false;
    for (unsigned i = 0; i < a->ai->mNumMaterials; i++) {
        const struct aiMaterial *ai = a->ai->mMaterials[i];
        const float alpha = assimp_stated_opacity(ai);
        if (of_material[i] == 0 || assimp_is_glass(ai))
            continue;
        if (alpha == 1.0f)
            return false;
        invisible = invisible || alpha == 0.0f;
    }
    return invisible;
}

bool assimp_transparency(assimp_scene *a) {
    bool any = false;
    for (unsigned i = 0; i < a->ai->mNumMaterials; i++)
        any = any || assimp_stated_opacity(a->ai->mMaterials[i]) < 1.0f;
    if (!any)
        return true;
    uint64_t *of_material = calloc(a->ai->mNumMaterials, sizeof *of_material);
    if (!of_material)
        return import_fail(a->im, "out of memory");
    count_triangles(a->ai, a->ai->mRootNode, of_material, 0);
    a->inverse = is_inverse(a, of_material);
    if (a->inverse)
        import_warn(a->im,
                    "no material is opaque by the letter and some are invisible: transparency is taken the other way round "
                    "('cutoff' of a material in a scene file makes it a hole)");
    const bool fine = import_transparency(a->im, of_material, a->ai->mNumMaterials);
    free(of_material);
    return fine;
}
