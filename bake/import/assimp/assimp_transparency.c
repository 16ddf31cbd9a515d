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
    return a->inverse ? 1.0f - alpha : alpha;
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

bool assimp_transparency(assimp_scene *a) {
    const unsigned materials = a->ai->mNumMaterials;
    float *stated = calloc((size_t)materials + 1, sizeof *stated);
    uint64_t *of_material = calloc((size_t)materials + 1, sizeof *of_material);
    bool any = false, fine = stated && of_material;
    for (unsigned i = 0; fine && i < materials; i++) {
        stated[i] = assimp_stated_opacity(a->ai->mMaterials[i]);
        any = any || stated[i] < 1.0f;
    }
    if (fine && any) {
        count_triangles(a->ai, a->ai->mRootNode, of_material, 0);
        a->inverse = import_is_inverse(a->im, of_material, stated, materials);
    }
    fine = fine ? !any || import_transparency(a->im, of_material, materials) : import_fail(a->im, "out of memory");
    free(stated);
    free(of_material);
    return fine;
}
