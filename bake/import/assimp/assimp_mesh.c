/* Assimp's meshes as parts that are placed. */
#include "import/assimp/assimp_scene.h"
#include <assimp/mesh.h>
#include <stdlib.h>

/* Its vectors are three floats without a gap. */
_Static_assert(sizeof(struct aiVector3D) == 3 * sizeof(float), "vectors of doubles");
_Static_assert(sizeof(struct aiColor4D) == 4 * sizeof(float), "colours of doubles");

static const float *floats_of(const void *vectors) {
    return vectors;
}

/* The triangles' corners: of faces, those of three, and of what polygons were cut into. */
static uint32_t *corners_of(importer *im, const struct aiMesh *mesh, const polygon_cut *cut, size_t *triangles) {
    uint32_t *corner = calloc(mesh->mNumFaces + cut->triangles + 1, 3 * sizeof *corner), *to = corner;
    if (!corner)
        return NULL;
    for (size_t i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        if (face->mNumIndices == 3)
            for (int k = 0; k < 3; k++)
                *to++ = face->mIndices[k];
        else if (face->mNumIndices > 0) /* emptied by assimp_triangulate() */
            im->m->not_triangles++;
    }
    for (size_t i = 0; i < 3 * cut->triangles; i++)
        *to++ = cut->corner[i];
    *triangles = (size_t)(to - corner) / 3;
    return corner;
}

/* Once a file. */
static bool say_rigid(assimp_scene *a, const struct aiMesh *mesh) {
    const bool morphs = mesh->mNumAnimMeshes > 0 && !a->warned_morph, bones = mesh->mNumBones > 0 && !a->warned_bones;
    a->warned_morph |= morphs;
    a->warned_bones |= bones;
    return (!morphs || import_not_done(a->im, "morph targets are left out: meshes keep their base shape")) &&
           (!bones || import_not_done(a->im, "skins are left out: meshes do not follow their bones"));
}

/* Four floats a vertex; NULL: none, which Assimp has as black without opacity for AMF. */
static const float *colors_of(const struct aiMesh *mesh) {
    const float *color = floats_of(mesh->mColors[0]);
    for (size_t i = 0; color && i < 4 * (size_t)mesh->mNumVertices; i++)
        if (color[i] != 0.0f)
            return color;
    return NULL;
}

bool assimp_place(assimp_scene *a, unsigned index, const double world[12]) {
    const struct aiMesh *mesh = a->ai->mMeshes[index];
    import_count_place(a->im, index, mesh->mName.data);
    if (!mesh->mVertices || !mesh->mFaces || !mesh->mNumVertices || !mesh->mNumFaces)
        return true;
    if (mesh->mMaterialIndex >= a->ai->mNumMaterials)
        return import_fail(a->im, "mesh '%.100s' has material %u of %u", mesh->mName.data, mesh->mMaterialIndex,
                           a->ai->mNumMaterials);
    if (!say_rigid(a, mesh))
        return false;
    if (a->vertex_normals && !mesh->mNormals) {
        a->vertex_normals = false;
        if (!import_not_done(a->im, "mesh '%.100s' and perhaps others: normals by vertex are left out, and others made",
                             mesh->mName.data))
            return false;
    }
    mesh_part part = {.name = mesh->mName.data,
                      .vertices = mesh->mNumVertices,
                      .position = {floats_of(mesh->mVertices), 3},
                      .normal = {floats_of(mesh->mNormals), 3},
                      .color = {a->off_colors ? NULL : colors_of(mesh), 4},
                      .v_up = true, /* Assimp has it so for every format */
                      .material = mesh->mMaterialIndex};
    for (int i = 0; i < IMPORT_UV_SETS && i < AI_MAX_NUMBER_OF_TEXTURECOORDS; i++)
        part.uv[i] = (mesh_floats){floats_of(mesh->mTextureCoords[i]), 3};
    uint32_t *corner = corners_of(a->im, mesh, &a->cuts[index], &part.triangles);
    part.corner = corner;
    const bool fine = corner ? import_place(a->im, index, &part, world) : import_fail(a->im, "out of memory");
    free(corner);
    return fine;
}
