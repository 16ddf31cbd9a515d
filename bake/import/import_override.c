/* What the scene file says of a material besides colour, emission and holes. */
#include "import/importer.h"
#include "import/metallic_roughness.h"
#include <math.h>

#define DEFAULT_EXPONENT 50.0f /* of a lobe, where nothing says it */

static bool is_black(const float c[3]) {
    return !(c[0] > 0.0f || c[1] > 0.0f || c[2] > 0.0f);
}

static bool is_glass(const model_material *m) {
    return m->kind == VIT_GLASS || m->kind == VIT_THIN_GLASS;
}

/* A kind that the mesh did not have starts with that kind's defaults. */
static void change_kind(model_material *m, int kind) {
    const bool shines = kind != VIT_MATTE, glass = kind == VIT_GLASS || kind == VIT_THIN_GLASS, was = is_glass(m);
    if (m->kind == (uint32_t)kind)
        return;
    for (int i = 0; i < 3; i++) {
        if (!glass || !was)
            m->specular[i] = shines ? 1.0f : 0.0f;
        if (kind != VIT_GLASS)
            m->absorption[i] = 0.0f;
        if (shines)
            m->emission[i] = 0.0f;
    }
    m->exponent = 1.0f;
    m->lobe_alpha = 0.0f;
    if (glass)
        import_make_glass(m, (uint32_t)kind, was ? m->ior : 0.0f);
    else
        m->ior = 1.0f;
    m->kind = (uint32_t)kind;
}

void import_override_specular(importer *im, model_material *m, const scene_material *o) {
    if (o->has_kind)
        change_kind(m, o->kind);
    const bool glass = is_glass(m), matt = m->kind == VIT_MATTE;
    const bool lobe = !is_black(m->specular);
    for (int i = 0; i < 3 && o->has_specular; i++)
        m->specular[i] = (float)o->specular[i];
    for (int i = 0; i < 3 && o->has_absorption && m->kind == VIT_GLASS; i++)
        m->absorption[i] = (float)o->absorption[i];
    if (o->has_roughness && matt)
        m->lobe_alpha = specular_alpha((float)o->roughness);
    else if (o->has_exponent && matt)
        m->lobe_alpha = 0.0f;
    if (o->has_exponent && matt)
        m->exponent = (float)o->exponent;
    else if (o->has_specular && matt && !lobe)
        m->exponent = DEFAULT_EXPONENT;
    if (o->has_ior && glass)
        m->ior = (float)o->ior;
    /* A kind that the scene file states has been checked there. */
    if ((o->has_ior && !glass) || (o->has_absorption && m->kind != VIT_GLASS) ||
        ((o->has_color || o->has_emission || o->has_exponent || o->has_roughness) && !matt))
        import_warn(im, "line %d: material '%.100s': a setting does nothing for the kind of material that the mesh makes it",
                    o->line, o->name);
}

void import_settle_specular(model_material *m) {
    float most = 0.0f;
    for (int i = 0; i < 3; i++) {
        if (m->kind != VIT_MATTE)
            m->albedo[i] = m->emission[i] = 0.0f;
        most = fmaxf(most, m->albedo[i] + m->specular[i]);
    }
    if (m->kind != VIT_MATTE || is_black(m->specular)) {
        m->exponent = 1.0f;
        m->lobe_alpha = 0.0f;
    } else if (most > 1.0f)
        for (int i = 0; i < 3; i++) { /* hues stay; rounded down */
            m->albedo[i] *= (1.0f - 0x1p-22f) / most;
            m->specular[i] *= (1.0f - 0x1p-22f) / most;
        }
}
