#include "import/importer.h"
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
static bool sift_polygons(importer *im, const struct aiMesh *mesh) {
    bool quads = false;
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        struct aiFace *face = &mesh->mFaces[i];
        if (face->mNumIndices <= 3)
            continue;
        if (face->mNumIndices <= IMPORT_CORNERS && in_range(mesh, face)) {
            quads |= face->mNumIndices == 4;
            continue;
        }
        im->bad_polygon++;
        face->mNumIndices = 0;
    }
    return quads;
}

bool import_triangulate(importer *im) {
    bool quads = false;
    im->cut_count = im->ai->mNumMeshes;
    im->cuts = calloc((size_t)im->cut_count + 1, sizeof *im->cuts);
    if (!im->cuts)
        return import_fail(im, "out of memory");
    for (unsigned i = 0; i < im->ai->mNumMeshes; i++) {
        struct aiMesh *mesh = im->ai->mMeshes[i];
        if (sift_polygons(im, mesh))
            quads = true;
        else /* a face without corners counts as one for Assimp, which ends the process when it then finds nothing to cut */
            mesh->mPrimitiveTypes = (mesh->mPrimitiveTypes & ~(unsigned)aiPrimitiveType_POLYGON) | aiPrimitiveType_TRIANGLE;
        if (!import_cut(im, mesh, &im->cuts[i]))
            return false;
    }
    if (quads)
        im->ai = aiApplyPostProcessing(im->ai, aiProcess_Triangulate);
    return im->ai ? true : import_fail(im, "its polygons cannot be cut into triangles");
}

void import_free_cuts(importer *im) {
    for (unsigned i = 0; im->cuts && i < im->cut_count; i++)
        free(im->cuts[i].corner);
    free(im->cuts);
    im->cuts = NULL;
}
