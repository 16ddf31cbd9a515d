/* Transparency that would make a file vanish. Transparent materials are left as holes, so a file whose transparency is written
 * the other way round, or means nothing, would lose all that it has: MeshLab's `Tr 1`, Blender 2.4's COLLADA with a
 * <transparency> of 0. */
#include "import/importer.h"
#include <string.h>

#define NEARLY_ALL 0.9 /* of a file's triangles: nobody exports a model to hide so much of it */

typedef struct tally {
    uint64_t all, invisible, holes, asked; /* triangles: of alpha 0, of too little alpha, as the scene file asks */
    char name[SCENE_NAME];                 /* of the first hole */
    uint64_t veiled;                       /* triangles of more alpha than a hole has, but not of 1 */
    char veiled_name[SCENE_NAME];
} tally;

static void count_veiled(tally *t, const material_use *use, uint64_t triangles) {
    if (use->m.alpha >= 1.0f || use->m.kind != VIT_MATTE || use->cutoff_asked || triangles == 0)
        return;
    if (t->veiled == 0)
        memcpy(t->veiled_name, use->m.name, sizeof t->veiled_name);
    t->veiled += triangles;
}

/* What becomes of the materials, without a word about them: they are all read again later. */
static bool take_stock(importer *im, const uint64_t *of_material, unsigned materials, tally *t) {
    model_warn_fn *warn = im->warn;
    const uint64_t warnings = im->m->warnings, highlights = im->m->default_highlights, principled = im->m->principled;
    bool fine = true;
    im->warn = NULL;
    for (unsigned i = 0; fine && i < materials; i++) {
        material_use *use;
        if (of_material[i] == 0)
            continue;
        fine = import_material(im, i, NULL, &use);
        t->all += of_material[i];
        if (fine && !use->hole)
            count_veiled(t, use, of_material[i]);
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
    import_forget_materials(im);
    im->mean_count = 0;
    return fine;
}

bool import_is_inverse(importer *im, const uint64_t *of_material, const float *stated, unsigned materials) {
    bool invisible = false;
    for (unsigned i = 0; i < materials; i++) {
        if (of_material[i] == 0 || stated[i] == IMPORT_SAYS_SO)
            continue;
        if (stated[i] == 1.0f)
            return false;
        invisible = invisible || stated[i] == 0.0f;
    }
    if (invisible)
        import_warn(im, "no material is opaque by the letter and some are invisible: transparency is taken the other way round "
                        "('cutoff' of a material in a scene file makes it a hole)");
    return invisible;
}

/* A COLLADA material of <transparency> 0 is an exporter's opaque one (Autodesk's, Blender 2.4's), whatever others there are:
 * who wants an invisible one leaves it out. */
static bool means_opaque_by_0(const importer *im) {
    return import_has_suffix(im->file, ".dae");
}

bool import_transparency(importer *im, const uint64_t *of_material, unsigned materials) {
    tally t = {.all = 0};
    if (!take_stock(im, of_material, materials, &t))
        return false;
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
    return t.veiled == 0 ||
           import_not_done(im,
                           "%llu triangles of half transparent materials ('%.100s') are shown opaque: transparency is not "
                           "simulated ('cutoff' of a material in a scene file makes it a hole, or settles that it is none)",
                           (unsigned long long)t.veiled, t.veiled_name);
}

void import_settle_holes(const importer *im, material_use *use) {
    const bool matt = use->m.kind == VIT_MATTE;
    if (use->cutoff_asked && use->alpha_by_letter >= 0.0f && matt) /* who asks for holes knows the file */
        use->m.alpha = use->alpha_by_letter;
    /* The texture's alpha is at most 1: below the cutoff without it, below with it. */
    use->hole = use->m.alpha < use->m.cutoff;
    if (!use->hole || use->cutoff_asked || im->shown == SHOWN_AS_SAID || (im->shown == SHOWN_INVISIBLE && use->m.alpha > 0.0f))
        return;
    use->hole = false;
    use->m.alpha = 1.0f;
    if (!use->alpha_mapped)
        use->m.cutoff = 0.0f;
}
