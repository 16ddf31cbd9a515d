#include "import/importer.h"
#include "common/triangle.h"
#include <assimp/mesh.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct instance {
    const struct aiMesh *mesh;
    const polygon_cut *cut;
    const double *world; /* 3 x 4 */
    bool mirrored;       /* its determinant is negative */
    float *position;     /* 3 a vertex of the mesh, in the world */
    uint32_t *vertex;    /* a vertex of the mesh: its index in the model, VIT_NONE so far */
    uint32_t *corner;    /* 3 a surviving triangle: vertices of the mesh */
    size_t triangles;
    float *smooth; /* 9 a surviving triangle; NULL if the mesh has normals */
} instance;

static double determinant(const double m[12]) {
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) + m[2] * (m[4] * m[9] - m[5] * m[8]);
}

/* By the normal, as vit_triangle has it. */
typedef enum shape { SHAPE_GOOD, SHAPE_FLAT, SHAPE_NOT_FINITE } shape;
static shape triangle_shape(const float *a, const float *b, const float *c) {
    float n[3];
    triangle_normal(a, b, c, n);
    const float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    if (!isfinite(square)) /* any NaN or infinity among the nine ends up here, and what would overflow later */
        return SHAPE_NOT_FINITE;
    /* Also what is so thin that the normal could not be normalised in float: areas below 1e-19 m2. */
    return square < FLT_MIN ? SHAPE_FLAT : SHAPE_GOOD;
}

static void place_vertices(importer *im, instance *in) {
    const struct aiMesh *mesh = in->mesh;
    for (size_t i = 0; i < mesh->mNumVertices; i++) {
        const struct aiVector3D *v = &mesh->mVertices[i];
        for (size_t k = 0; k < 3; k++) {
            const double *row = in->world + 4 * k;
            const double far =
                fmax(fmax(fabs(row[0] * (double)v->x), fabs(row[1] * (double)v->y)), fabs(row[2] * (double)v->z));
            if (far <= (double)IMPORT_FAR) /* what lies farther out is dropped */
                im->m->step = fmax(im->m->step, far * 0x1p-23);
            in->position[3 * i + k] = (float)(row[0] * (double)v->x + row[1] * (double)v->y + row[2] * (double)v->z + row[3]);
        }
        in->vertex[i] = VIT_NONE;
    }
}

/* A vertex so far out that areas would not fit a float; infinity and NaN are told of otherwise. */
static bool is_far(importer *im, const instance *in, const uint32_t v[3]) {
    bool far = false;
    for (int k = 0; k < 9; k++) {
        const float x = fabsf(in->position[3 * (size_t)v[k / 3] + (size_t)(k % 3)]);
        if (!isfinite(x))
            return false;
        if (x > IMPORT_FAR) {
            far = true;
            im->farthest = fmax(im->farthest, (double)x);
        }
    }
    return far;
}

/* Keeps the triangle if it has an area, counts it otherwise. */
static void sift_triangle(importer *im, instance *in, const unsigned *corner) {
    const struct aiMesh *mesh = in->mesh;
    const uint32_t v[3] = {corner[0], corner[in->mirrored ? 2 : 1], corner[in->mirrored ? 1 : 2]};
    if (v[0] >= mesh->mNumVertices || v[1] >= mesh->mNumVertices || v[2] >= mesh->mNumVertices) {
        im->bad_index++;
        return;
    }
    if (is_far(im, in, v)) {
        im->too_far++;
        return;
    }
    switch (triangle_shape(in->position + 3 * (size_t)v[0], in->position + 3 * (size_t)v[1], in->position + 3 * (size_t)v[2])) {
    case SHAPE_NOT_FINITE:
        im->not_finite++;
        break;
    case SHAPE_FLAT:
        im->m->degenerate++;
        break;
    case SHAPE_GOOD:
        memcpy(in->corner + 3 * in->triangles++, v, sizeof v);
        break;
    }
}

static void sift_faces(importer *im, instance *in) {
    const struct aiMesh *mesh = in->mesh;
    for (size_t i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        if (face->mNumIndices == 0) /* emptied by import_triangulate() */
            continue;
        if (face->mNumIndices == 3)
            sift_triangle(im, in, face->mIndices);
        else
            im->m->not_triangles++;
    }
    for (size_t i = 0; i < in->cut->triangles; i++)
        sift_triangle(im, in, in->cut->corner + 3 * i);
}

/* Normal of vertex `v` of the mesh in the world: by the cofactors of the matrix, which is its inverse transpose up to a
 * factor and needs no inverse. False if the mesh has none that is of any use there. */
static bool vertex_normal(const instance *in, uint32_t v, float out[3]) {
    const struct aiVector3D *a = &in->mesh->mNormals[v];
    const double *m = in->world, n[3] = {(double)a->x, (double)a->y, (double)a->z};
    double w[3], square = 0.0;
    for (int i = 0; i < 3; i++) {
        const double *p = m + 4 * ((i + 1) % 3), *q = m + 4 * ((i + 2) % 3);
        w[i] = (p[1] * q[2] - p[2] * q[1]) * n[0] + (p[2] * q[0] - p[0] * q[2]) * n[1] + (p[0] * q[1] - p[1] * q[0]) * n[2];
        if (in->mirrored)
            w[i] = -w[i];
        square += w[i] * w[i];
    }
    const double length = sqrt(square);
    for (int i = 0; i < 3; i++)
        out[i] = (float)(w[i] / length);
    return length > 0.0 && isfinite(length);
}

static void face_normal(const instance *in, const uint32_t *corner, float out[3]) {
    const float *a = in->position + 3 * (size_t)corner[0], *b = in->position + 3 * (size_t)corner[1];
    const float *c = in->position + 3 * (size_t)corner[2];
    double e[3], f[3], n[3];
    for (int i = 0; i < 3; i++) {
        e[i] = (double)b[i] - (double)a[i];
        f[i] = (double)c[i] - (double)a[i];
    }
    for (int i = 0; i < 3; i++)
        n[i] = e[(i + 1) % 3] * f[(i + 2) % 3] - e[(i + 2) % 3] * f[(i + 1) % 3];
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; i++)
        out[i] = (float)(n[i] / length);
}

/* v = 0 is the first row of the image here; Assimp has it at the bottom for every format, glTF included. */
static void vertex_uv(const instance *in, const material_use *use, uint32_t v, float out[2]) {
    out[0] = out[1] = 0.0f;
    if (use->uv_set >= AI_MAX_NUMBER_OF_TEXTURECOORDS || !in->mesh->mTextureCoords[use->uv_set])
        return;
    const struct aiVector3D *a = &in->mesh->mTextureCoords[use->uv_set][v];
    double u = (double)a->x, w = 1.0 - (double)a->y;
    if (use->has_transform) {
        const double *t = use->uv, was = u;
        u = t[0] * was + t[1] * w + t[2];
        w = t[3] * was + t[4] * w + t[5];
    }
    out[0] = isfinite((float)u) ? (float)u : 0.0f;
    out[1] = isfinite((float)w) ? (float)w : 0.0f;
}

bool import_make_room(importer *im, size_t more, size_t triangles) {
    model *m = im->m;
    if (triangles > VIT_MAX_TRIANGLES - m->triangles)
        return import_fail(im, "more than %u triangles", VIT_MAX_TRIANGLES);
    const size_t vertices = m->vertices + more;
    size_t room[3] = {im->vertex_room, im->vertex_room, im->triangle_room};
    if (!import_room(im, &m->position, &room[0], vertices, 3 * sizeof *m->position) ||
        !import_room(im, &m->normal, &room[1], vertices, 3 * sizeof *m->normal) ||
        !import_room(im, &m->uv, &im->vertex_room, vertices, 2 * sizeof *m->uv) ||
        !import_room(im, &m->index, &room[2], m->triangles + triangles, 3 * sizeof *m->index) ||
        !import_room(im, &m->material, &im->triangle_room, m->triangles + triangles, sizeof *m->material))
        return false;
    return true;
}

static uint32_t add_vertex(model *m, const instance *in, const material_use *use, uint32_t v, const float normal[3]) {
    const size_t at = m->vertices;
    memcpy(m->position + 3 * at, in->position + 3 * (size_t)v, 3 * sizeof *m->position);
    memcpy(m->normal + 3 * at, normal, 3 * sizeof *m->normal);
    vertex_uv(in, use, v, m->uv + 2 * at);
    return m->vertices++;
}

/* A vertex is shared by the mesh's triangles if the mesh has a normal for it; where we made the normals, each corner is one. */
static void add_triangles(importer *im, instance *in, const material_use *use, uint32_t material) {
    model *m = im->m;
    for (size_t t = 0; t < in->triangles; t++) {
        const uint32_t *corner = in->corner + 3 * t;
        for (size_t k = 0; k < 3; k++) {
            const uint32_t v = corner[k];
            float normal[3];
            uint32_t index = in->smooth ? VIT_NONE : in->vertex[v];
            if (index == VIT_NONE) {
                if (in->smooth)
                    memcpy(normal, in->smooth + 9 * t + 3 * k, sizeof normal);
                else if (!vertex_normal(in, v, normal))
                    face_normal(in, corner, normal);
                index = in->vertex[v] = add_vertex(m, in, use, v, normal);
            }
            m->index[3 * (size_t)m->triangles + k] = index;
        }
        m->material[m->triangles++] = material;
    }
    m->materials[material].triangles += in->triangles;
}

/* A vertex colour multiplies the albedo if it is the same all over the mesh. */
static void constant_color(importer *im, const struct aiMesh *mesh, float tint[3]) {
    const struct aiColor4D *c = mesh->mColors[0];
    tint[0] = tint[1] = tint[2] = 1.0f;
    if (!c)
        return;
    for (unsigned i = 0; i < mesh->mNumVertices; i++)
        if (!(c[i].r == c[0].r && c[i].g == c[0].g && c[i].b == c[0].b)) {
            if (!im->warned_colors)
                import_warn(im, "vertex colours that vary over a mesh are left out");
            im->warned_colors = true;
            return;
        }
    tint[0] = c[0].r;
    tint[1] = c[0].g;
    tint[2] = c[0].b;
}

static bool add_instance(importer *im, instance *in) {
    const struct aiMesh *mesh = in->mesh;
    float tint[3];
    material_use *use;
    uint32_t material;
    place_vertices(im, in);
    sift_faces(im, in);
    if (in->triangles == 0)
        return true;
    constant_color(im, mesh, tint);
    if (!import_material(im, mesh->mMaterialIndex, tint, &use))
        return false;
    if (use->hole) {
        if (im->clear == 0)
            memcpy(im->clear_name, use->m.name, sizeof im->clear_name);
        im->clear += in->triangles;
        return true;
    }
    if (!mesh->mNormals) {
        in->smooth = calloc(in->triangles, 9 * sizeof *in->smooth);
        if (!in->smooth || !import_normals(in->position, in->corner, in->triangles, in->smooth))
            return import_fail(im, "out of memory");
    }
    if (!import_material_index(im, use, &material) || !import_make_room(im, 3 * in->triangles, in->triangles))
        return false;
    const bool has_uv = use->uv_set < AI_MAX_NUMBER_OF_TEXTURECOORDS && mesh->mTextureCoords[use->uv_set];
    if (im->m->materials[material].image >= 0 && !has_uv && !use->warned_uv) {
        import_warn(im, "material '%.100s': mesh '%.100s' and perhaps others have no texture coordinates", use->m.name,
                    mesh->mName.data);
        use->warned_uv = true;
    }
    add_triangles(im, in, use, material);
    return true;
}

/* Once a file. */
static void say_rigid(importer *im, const struct aiMesh *mesh) {
    if (mesh->mNumAnimMeshes > 0 && !im->warned_morph)
        import_warn(im, "morph targets are left out: meshes keep their base shape");
    if (mesh->mNumBones > 0 && !im->warned_bones)
        import_warn(im, "skins are left out: meshes do not follow their bones");
    im->warned_morph |= mesh->mNumAnimMeshes > 0;
    im->warned_bones |= mesh->mNumBones > 0;
}

bool import_mesh(importer *im, unsigned index, const double world[12]) {
    const struct aiMesh *mesh = im->ai->mMeshes[index];
    const polygon_cut *cut = &im->cuts[index];
    if (!mesh->mVertices || !mesh->mFaces || !mesh->mNumVertices || !mesh->mNumFaces)
        return true;
    if (mesh->mMaterialIndex >= im->ai->mNumMaterials)
        return import_fail(im, "mesh '%.100s' has material %u of %u", mesh->mName.data, mesh->mMaterialIndex,
                           im->ai->mNumMaterials);
    say_rigid(im, mesh);
    instance in = {.mesh = mesh, .cut = cut, .world = world, .mirrored = determinant(world) < 0.0};
    in.position = calloc(mesh->mNumVertices, 3 * sizeof *in.position);
    in.vertex = calloc(mesh->mNumVertices, sizeof *in.vertex);
    in.corner = calloc(mesh->mNumFaces + cut->triangles, 3 * sizeof *in.corner);
    const bool fine = in.position && in.vertex && in.corner ? add_instance(im, &in) : import_fail(im, "out of memory");
    free(in.position);
    free(in.vertex);
    free(in.corner);
    free(in.smooth);
    return fine;
}
