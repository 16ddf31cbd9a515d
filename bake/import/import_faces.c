#include "import/importer.h"
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <stdlib.h>

/* Corners of a polygon, at most: cutting ears takes the square of them and more. */
enum { MAX_CORNERS = 1024 };

static bool in_range(const struct aiMesh *mesh, const struct aiFace *face) {
    for (unsigned k = 0; k < face->mNumIndices; k++)
        if (face->mIndices[k] >= mesh->mNumVertices)
            return false;
    return true;
}

/* Empties the polygons that cannot be cut; says whether any is left. */
static bool sift_polygons(importer *im, const struct aiMesh *mesh) {
    bool any = false;
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        struct aiFace *face = &mesh->mFaces[i];
        if (face->mNumIndices <= 3)
            continue;
        if (face->mNumIndices <= MAX_CORNERS && in_range(mesh, face)) {
            any = true;
            continue;
        }
        im->bad_polygon++;
        face->mNumIndices = 0;
    }
    return any;
}

bool import_triangulate(importer *im) {
    bool any = false;
    for (unsigned i = 0; i < im->ai->mNumMeshes; i++) {
        struct aiMesh *mesh = im->ai->mMeshes[i];
        if (sift_polygons(im, mesh))
            any = true;
        else /* a face without corners counts as one for Assimp, which ends the process when it then finds nothing to cut */
            mesh->mPrimitiveTypes = (mesh->mPrimitiveTypes & ~(unsigned)aiPrimitiveType_POLYGON) | aiPrimitiveType_TRIANGLE;
    }
    if (any)
        im->ai = aiApplyPostProcessing(im->ai, aiProcess_Triangulate);
    return im->ai ? true : import_fail(im, "its polygons cannot be cut into triangles");
}
