/* Transparency that would make a file vanish. Transparent materials are left as holes, so a file whose transparency is written
 * the other way round, or means nothing, would lose all that it has: MeshLab's `Tr 1`, Blender 2.4's COLLADA with a
 * <transparency> of 0. */
#include "import/importer.h"
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 256 }; /* of the node tree; import.c refuses deeper ones */
#define NEARLY_ALL 0.9  /* of a file's triangles: nobody exports a model to hide so much of it */

/* Opacity as the file has it. A 0 beside an opacity texture says nothing, since nobody maps what is invisible: the texture is
 * meant. */
static float stated_opacity(const struct aiMaterial *ai) {
    float alpha = 1.0f;
    (void)import_floats(ai, AI_MATKEY_OPACITY, &alpha, 1);
    alpha = import_clamp(alpha, 1.0f);
    return alpha == 0.0f && aiGetMaterialTextureCount(ai, aiTextureType_OPACITY) > 0 ? 1.0f : alpha;
}

float import_opacity(const importer *im, const struct aiMaterial *ai) {
    const float alpha = stated_opacity(ai);
    return im->inverse && !import_is_glass_mtl(ai) ? 1.0f - alpha : alpha;
}

static void count_triangles(const struct aiScene *all, const struct aiNode *node, uint64_t *of_material, int depth) {
    if (!node) /* of a damaged file */
        return;
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        const struct aiMesh *mesh = node->mMeshes[i] < all->mNumMeshes ? all->mMeshes[node->mMeshes[i]] : NULL;
        if (!mesh || mesh->mMaterialIndex >= all->mNumMaterials)
            continue; /* import_mesh() has the words for it */
        for (unsigned k = 0; k < mesh->mNumFaces; k++)
            of_material[mesh->mMaterialIndex] += mesh->mFaces[k].mNumIndices == 3;
    }
    for (unsigned i = 0; depth < DEEPEST && i < node->mNumChildren; i++)
        count_triangles(all, node->mChildren[i], of_material, depth + 1);
}

/* No material in use is opaque by the letter, and some are invisible: the file writes transparency where it means opacity, or
 * the other way round. glTF does not leave that open, and MTL's glass says by `illum` what it is. */
static bool is_inverse(const importer *im, const uint64_t *of_material) {
    bool invisible = false;
    for (unsigned i = 0; i < im->ai->mNumMaterials; i++) {
        const struct aiMaterial *ai = im->ai->mMaterials[i];
        const float alpha = stated_opacity(ai);
        if (of_material[i] == 0 || import_is_glass_mtl(ai))
            continue;
        if (alpha == 1.0f)
            return false;
        invisible = invisible || alpha == 0.0f;
    }
    return invisible && !im->gltf;
}

typedef struct tally {
    uint64_t all, invisible, holes, asked; /* triangles: of alpha 0, of too little alpha, as the scene file asks */
    char name[SCENE_NAME];                 /* of the first hole */
} tally;

/* What becomes of the materials, without a word about them: they are all read again later. */
static bool take_stock(importer *im, const uint64_t *of_material, tally *t) {
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    model_warn_fn *warn = im->warn;
    const uint64_t warnings = im->m->warnings, highlights = im->m->default_highlights, principled = im->m->principled;
    bool fine = true;
    im->warn = NULL;
    for (unsigned i = 0; fine && i < im->ai->mNumMaterials; i++) {
        material_use *use;
        if (of_material[i] == 0)
            continue;
        fine = import_material(im, i, white, &use);
        t->all += of_material[i];
        if (!fine || !use->hole)
            continue;
        if (t->holes == 0)
            memcpy(t->name, use->m.name, sizeof t->name);
        *(use->cutoff_asked ? &t->asked : &t->holes) += of_material[i];
        t->invisible += use->m.alpha == 0.0f && !use->cutoff_asked ? of_material[i] : 0;
    }
    im->warn = warn;
    im->m->warnings = warnings;
    im->m->default_highlights = highlights;
    im->m->principled = principled;
    im->use_count = im->mean_count = 0;
    return fine;
}

/* A COLLADA material of <transparency> 0 is an exporter's opaque one (Autodesk's, Blender 2.4's), whatever others there are:
 * who wants an invisible one leaves it out. */
static bool means_opaque_by_0(const importer *im) {
    return import_has_suffix(im->file, ".dae");
}

static bool settle(importer *im, const uint64_t *of_material) {
    tally t = {.all = 0};
    im->inverse = is_inverse(im, of_material);
    if (!take_stock(im, of_material, &t))
        return false;
    if (im->inverse)
        import_warn(im, "no material is opaque by the letter and some are invisible: transparency is taken the other way round "
                        "('cutoff' of a material in a scene file makes it a hole)");
    if (t.holes > 0 && t.holes + t.asked == t.all)
        im->shown = SHOWN_HOLES;
    else if (t.invisible > 0 && (means_opaque_by_0(im) || (double)t.invisible >= NEARLY_ALL * (double)(t.all - t.asked)))
        im->shown = SHOWN_INVISIBLE;
    if (im->shown != SHOWN_AS_SAID)
        import_warn(im,
                    "%llu of %llu triangles are of transparent materials ('%.100s'): shown opaque, %s "
                    "('cutoff' of a material in a scene file makes it a hole)",
                    (unsigned long long)(im->shown == SHOWN_HOLES ? t.holes : t.invisible), (unsigned long long)t.all, t.name,
                    means_opaque_by_0(im) && im->shown == SHOWN_INVISIBLE ? "as exporters mean a <transparency> of 0"
                                                                          : "or hardly anything would be left");
    return true;
}

bool import_transparency(importer *im) {
    bool any = false;
    for (unsigned i = 0; i < im->ai->mNumMaterials; i++)
        any = any || stated_opacity(im->ai->mMaterials[i]) < 1.0f;
    if (!any)
        return true;
    uint64_t *of_material = calloc(im->ai->mNumMaterials, sizeof *of_material);
    if (!of_material)
        return import_fail(im, "out of memory");
    count_triangles(im->ai, im->ai->mRootNode, of_material, 0);
    const bool fine = settle(im, of_material);
    free(of_material);
    return fine;
}

void import_settle_holes(const importer *im, material_use *use, const struct aiMaterial *ai) {
    const bool matt = use->m.kind == VIT_MATTE;
    if (use->cutoff_asked && im->inverse && matt) /* who asks for holes knows the file */
        use->m.alpha = stated_opacity(ai);
    /* The texture's alpha is at most 1: below the cutoff without it, below with it. */
    use->hole = use->m.alpha < use->m.cutoff;
    if (!use->hole || use->cutoff_asked || im->shown == SHOWN_AS_SAID || (im->shown == SHOWN_INVISIBLE && use->m.alpha > 0.0f))
        return;
    use->hole = false;
    use->m.alpha = 1.0f;
    if (!use->alpha_mapped)
        use->m.cutoff = 0.0f;
}
