#include "import/assimp/assimp_scene.h"
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <stdlib.h>

static bool in_range(const struct aiMesh *mesh, const struct aiFace *face) {
    for (unsigned k = 0; k < face->mNumIndices; k++)
        if (face->mIndices[k] >= mesh->mNumVertices)
            return false;
    return true;
}

/* Empties the polygons that cannot be cut; says whether any quad is left, which Assimp is to cut. */
static bool sift_polygons(assimp_scene *a, const struct aiMesh *mesh) {
    bool quads = false;
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        struct aiFace *face = &mesh->mFaces[i];
        if (face->mNumIndices <= 3)
            continue;
        if (face->mNumIndices <= IMPORT_CORNERS && in_range(mesh, face)) {
            quads |= face->mNumIndices == 4;
            continue;
        }
        a->im->bad_polygon++;
        face->mNumIndices = 0;
    }
    return quads;
}

bool assimp_triangulate(assimp_scene *a) {
    bool quads = false;
    a->cut_count = a->ai->mNumMeshes;
    a->cuts = calloc((size_t)a->cut_count + 1, sizeof *a->cuts);
    if (!a->cuts)
        return import_fail(a->im, "out of memory");
    for (unsigned i = 0; i < a->ai->mNumMeshes; i++) {
        struct aiMesh *mesh = a->ai->mMeshes[i];
        if (sift_polygons(a, mesh))
            quads = true;
        else /* a face without corners counts as one for Assimp, which ends the process when it then finds nothing to cut */
            mesh->mPrimitiveTypes = (mesh->mPrimitiveTypes & ~(unsigned)aiPrimitiveType_POLYGON) | aiPrimitiveType_TRIANGLE;
        if (!assimp_cut(a, mesh, &a->cuts[i]))
            return false;
    }
    if (quads)
        a->ai = aiApplyPostProcessing(a->ai, aiProcess_Triangulate);
    return a->ai ? true : import_fail(a->im, "its polygons cannot be cut into triangles");
}

void assimp_free_cuts(assimp_scene *a) {
    for (unsigned i = 0; a->cuts && i < a->cut_count; i++)
        free(a->cuts[i].corner);
    free(a->cuts);
    a->cuts = NULL;
}
