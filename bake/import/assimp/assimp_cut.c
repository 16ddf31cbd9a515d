/* Polygons of five corners and more: cut by our own hand, and alike for all releases of Assimp, of which 5.3 loses parts of
 * those that are not convex. */
#include "import/assimp/assimp_scene.h"
#include <stdlib.h>

bool assimp_cut(assimp_scene *a, const struct aiMesh *mesh, polygon_cut *out) {
    size_t triangles = 0, polygons = 0;
    for (unsigned i = 0; i < mesh->mNumFaces; i++)
        if (mesh->mFaces[i].mNumIndices > 4) {
            polygons++;
            triangles += mesh->mFaces[i].mNumIndices - 2;
        }
    if (polygons == 0 || !mesh->mVertices)
        return true;
    const mesh_floats position = {&mesh->mVertices[0].x, 3};
    uint32_t *to = out->corner = calloc(triangles, 3 * sizeof *out->corner);
    if (!to)
        return import_fail(a->im, "out of memory");
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        struct aiFace *face = &mesh->mFaces[i];
        if (face->mNumIndices <= 4)
            continue;
        const unsigned more = face->mNumIndices - 2;
        import_cut_polygon(&position, face->mIndices, face->mNumIndices, to);
        for (unsigned k = 0; k < 3 * more; k++)
            to[k] = face->mIndices[to[k]];
        to += 3 * more;
        out->triangles += more;
        face->mNumIndices = 0;
    }
    return true;
}
