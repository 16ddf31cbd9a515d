/* Some of Assimp's readers leave NULL in its lists. They are closed up here, once, so that nobody after has to look. */
#include "import/assimp/assimp_scene.h"

/* Closes up a list of pointers; returns how many are left. */
static unsigned close_up(void **list, unsigned count) {
    unsigned kept = 0;
    for (unsigned i = 0; list && i < count; i++)
        if (list[i])
            list[kept++] = list[i];
    return kept;
}

/* The list's elements are pointers to structs, which C11 lets lie as pointers to void do on every machine that we build for. */
#define CLOSE_UP(list, count) ((count) = close_up((void **)(void *)(list), (count)))

/* Meshes and materials are named by their place, so those lists keep their holes: nodes must not lead into them. */
static void mend_node(assimp_scene *a, struct aiNode *node, int depth) {
    const struct aiScene *ai = a->ai;
    unsigned kept = 0;
    const unsigned children = node->mNumChildren;
    CLOSE_UP(node->mChildren, node->mNumChildren);
    a->lost_nodes += children - node->mNumChildren;
    for (unsigned i = 0; node->mMeshes && i < node->mNumMeshes; i++)
        if (node->mMeshes[i] >= ai->mNumMeshes || ai->mMeshes[node->mMeshes[i]])
            node->mMeshes[kept++] = node->mMeshes[i];
    node->mNumMeshes = kept;
    for (unsigned i = 0; depth < IMPORT_DEPTH && i < node->mNumChildren; i++)
        mend_node(a, node->mChildren[i], depth + 1);
}

static bool whole_mesh(const struct aiMesh *mesh) {
    for (unsigned i = 0; mesh->mFaces && i < mesh->mNumFaces; i++)
        if (mesh->mFaces[i].mNumIndices > 0 && !mesh->mFaces[i].mIndices)
            return false;
    return mesh->mFaces || mesh->mNumFaces == 0;
}

static bool leads_to(const struct aiNode *node, unsigned mesh, int depth) {
    for (unsigned i = 0; i < node->mNumMeshes; i++)
        if (node->mMeshes[i] == mesh)
            return true;
    for (unsigned i = 0; depth < IMPORT_DEPTH && i < node->mNumChildren; i++)
        if (leads_to(node->mChildren[i], mesh, depth + 1))
            return true;
    return false;
}

bool assimp_is_stray(const assimp_scene *a, unsigned mesh) {
    return a->lost_nodes > 0 && a->ai->mMeshes[mesh] && !leads_to(a->ai->mRootNode, mesh, 0);
}

bool assimp_mend_tree(assimp_scene *a) {
    struct aiScene *ai = (struct aiScene *)(uintptr_t)a->ai;
    a->lost_nodes = 0;
    if ((!ai->mMeshes && ai->mNumMeshes > 0) || (!ai->mMaterials && ai->mNumMaterials > 0))
        return import_fail(a->im, "has no list of meshes or materials");
    for (unsigned i = 0; i < ai->mNumMeshes; i++)
        if (ai->mMeshes[i] && !whole_mesh(ai->mMeshes[i]))
            return import_fail(a->im, "mesh %u has faces without corners", i);
    for (unsigned i = 0; i < ai->mNumMaterials; i++)
        if (!ai->mMaterials[i])
            return import_fail(a->im, "material %u of %u is missing", i, ai->mNumMaterials);
    CLOSE_UP(ai->mCameras, ai->mNumCameras);
    CLOSE_UP(ai->mLights, ai->mNumLights);
    for (unsigned i = 0; i < ai->mNumTextures; i++)
        if (!ai->mTextures || !ai->mTextures[i])
            return import_fail(a->im, "embedded image %u is missing", i);
    if (ai->mRootNode)
        mend_node(a, ai->mRootNode, 0);
    return true;
}
