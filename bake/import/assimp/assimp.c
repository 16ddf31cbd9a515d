#include "import/assimp/assimp.h"
#include "import/assimp/assimp_scene.h"
#include <assimp/cimport.h>
#include <stdlib.h>
#include <string.h>

static void place_of(const double parent[12], const struct aiMatrix4x4 *m, double out[12]) {
    const double own[12] = {(double)m->a1, (double)m->a2, (double)m->a3, (double)m->a4, (double)m->b1, (double)m->b2,
                            (double)m->b3, (double)m->b4, (double)m->c1, (double)m->c2, (double)m->c3, (double)m->c4};
    import_multiply(parent, own, out);
}

static bool add_node(assimp_scene *a, const struct aiNode *node, const double parent[12], int depth) {
    double world[12];
    if (depth > IMPORT_DEPTH)
        return import_fail(a->im, "nodes are nested deeper than %d", IMPORT_DEPTH);
    place_of(parent, &node->mTransformation, world);
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        if (node->mMeshes[i] >= a->ai->mNumMeshes)
            return import_fail(a->im, "node '%.100s' has mesh %u of %u", node->mName.data, node->mMeshes[i], a->ai->mNumMeshes);
        if (!assimp_place(a, node->mMeshes[i], world))
            return false;
    }
    if (!assimp_cameras(a, node, world) || !assimp_lights(a, node, world))
        return false;
    for (unsigned i = 0; i < node->mNumChildren; i++)
        if (!add_node(a, node->mChildren[i], world, depth + 1))
            return false;
    return true;
}

/* Meshes whose nodes Assimp has lost stand where the root does: in RAW files that is where they belong. */
static bool add_strays(assimp_scene *a, const double place[12]) {
    unsigned strays = 0;
    double world[12];
    place_of(place, &a->ai->mRootNode->mTransformation, world);
    for (unsigned i = 0; i < a->ai->mNumMeshes; i++)
        if (assimp_is_stray(a, i)) {
            strays++;
            if (!assimp_place(a, i, world))
                return false;
        }
    return strays == 0 || import_has_suffix(a->im->file, ".raw") ||
           import_not_done(a->im, "the mesh reader has lost the places of %u meshes; they stand at the origin", strays);
}

/* What Assimp says, in one line. */
static bool fail_by_assimp(importer *im) {
    const char *text = aiGetErrorString();
    if (text && strstr(text, "bad_alloc"))
        return import_fail(im, "takes more memory than a file of its size is given");
    return import_fail(im, "%.250s", text && *text ? text : "cannot be understood");
}

static bool add_scene(assimp_scene *a, const scene_mesh *mesh) {
    double place[12];
    a->im->embedded = a->ai->mNumTextures;
    if (!a->ai->mRootNode)
        return import_fail(a->im, "has no nodes");
    return assimp_say_lost(a) && assimp_frame(a, mesh, place) && import_begin_meshes(a->im, a->ai->mNumMeshes) &&
           assimp_transparency(a) && add_node(a, a->ai->mRootNode, place, 0) && add_strays(a, place);
}

static bool read_scene(assimp_scene *a, const scene_mesh *mesh) {
    struct aiFileIO io = assimp_files(a);
    /* Polygons become triangles later; everything else is done here, so that it is the same for all releases of Assimp. */
    a->ai = aiImportFileEx(a->im->file, 0, &io);
    if (!a->ai)
        return fail_by_assimp(a->im);
    const bool fine = assimp_mend_tree(a) && assimp_triangulate(a) && add_scene(a, mesh);
    assimp_free_cuts(a);
    if (a->ai && !a->im->to_parent) /* the child is thrown away whole: some readers' trees do not survive being freed */
        aiReleaseImport(a->ai);
    return fine;
}

static bool read(importer *im, const scene_mesh *mesh) {
    assimp_scene *a = calloc(1, sizeof *a);
    if (!a)
        return import_fail(im, "out of memory");
    a->im = im;
    im->reader = a;
    const bool fine = read_scene(a, mesh);
    im->reader = NULL;
    free(a);
    return fine;
}

/* Assimp keeps embedded images as their file's bytes (height 0) or as BGRA texels. */
static const char *embedded_image(importer *im, unsigned index, model_image *out) {
    const struct aiTexture *t = ((const assimp_scene *)im->reader)->ai->mTextures[index];
    if (t->mHeight == 0)
        return import_decode(im, (const uint8_t *)t->pcData, t->mWidth, out);
    if (t->mWidth < 1 || t->mWidth > IMPORT_EDGE || t->mHeight > IMPORT_EDGE)
        return "is larger than 16384 pixels";
    const size_t texels = (size_t)t->mWidth * t->mHeight;
    out->width = (int)t->mWidth;
    out->height = (int)t->mHeight;
    out->rgba = malloc(4 * texels);
    for (size_t i = 0; out->rgba && i < texels; i++) {
        out->rgba[4 * i + 0] = t->pcData[i].r;
        out->rgba[4 * i + 1] = t->pcData[i].g;
        out->rgba[4 * i + 2] = t->pcData[i].b;
        out->rgba[4 * i + 3] = t->pcData[i].a;
    }
    return out->rgba ? NULL : "does not fit in memory";
}

/* It is asked last, and takes what it can. */
static bool is_any(const uint8_t *head, size_t size) {
    (void)head;
    (void)size;
    return false;
}

static const char *const suffixes[] = {NULL};
static const char *const cannot[] = {"animations",
                                     "morph targets and skins",
                                     "highlights, mirrors and glass",
                                     "bump, normal and emissive maps",
                                     "vertex colours that vary",
                                     NULL};
const import_format assimp_format = {.name = "Assimp",
                                     .suffixes = suffixes,
                                     .cannot = cannot,
                                     .finds_frame = true,
                                     .is_it = is_any,
                                     .read = read,
                                     .material = assimp_material,
                                     .image = embedded_image};
