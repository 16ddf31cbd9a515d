#include "import/metallic_roughness.h"
#include "vitrine_pack.h"
#include <math.h>

#define METAL 0.9f /* what counts as one, and as smooth, where mirrors are concerned */
#define SMOOTH 0.1f

float specular_exponent(float roughness) {
    const double alpha = (double)roughness * (double)roughness;
    const double m = alpha > 0.0 ? 0.5 / (alpha * alpha) - 2.0 : (double)VIT_MAX_EXPONENT;
    return m < 1.0 ? 0.0f : (float)fmin(m, (double)VIT_MAX_EXPONENT);
}

float specular_alpha(float roughness) {
    return fmaxf(roughness * roughness, VIT_MIN_ALPHA);
}

void specular_from_metallic(model_material *m, const float base[3], const float mean[3], const float dielectric[3],
                            float metallic, float roughness) {
    const bool emits = m->emission[0] > 0 || m->emission[1] > 0 || m->emission[2] > 0;
    const bool mirror = metallic >= METAL && roughness <= SMOOTH && !emits;
    const float exponent = specular_exponent(roughness);
    const float most = fmaxf(dielectric[0], fmaxf(dielectric[1], dielectric[2]));
    m->kind = mirror ? VIT_MIRROR : VIT_MATTE;
    m->exponent = mirror || exponent == 0.0f ? 1.0f : exponent;
    for (int i = 0; i < 3; i++) {
        const float at_normal = dielectric[i] + (mean[i] - dielectric[i]) * metallic;
        m->specular[i] = mirror ? mean[i] : exponent > 0.0f ? at_normal : 0.0f;
        m->albedo[i] = mirror || exponent == 0.0f ? base[i] : base[i] * (1.0f - metallic) * (1.0f - most);
    }
}

void specular_facets_from_metallic(model_material *m, const float base[3], const float mean[3], const float dielectric[3],
                                   float metallic, float roughness) {
    const float most = fmaxf(dielectric[0], fmaxf(dielectric[1], dielectric[2]));
    specular_from_metallic(m, base, mean, dielectric, metallic, roughness);
    if (m->kind != VIT_MATTE)
        return;
    m->lobe_alpha = specular_alpha(roughness);
    for (int i = 0; i < 3; i++) {
        m->specular[i] = dielectric[i] + (mean[i] - dielectric[i]) * metallic;
        m->albedo[i] = base[i] * (1.0f - metallic) * (1.0f - most);
    }
}
