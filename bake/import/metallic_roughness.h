/* metallic_roughness.c: glTF's metallic-roughness materials as the kernels know materials: matt, with a Phong lobe, or a
 * mirror. */
#ifndef VIT_BAKE_GLOSSY_H
#define VIT_BAKE_GLOSSY_H

#include "import/model.h"

/* The lobe that has the peak of glTF's (GGX) at normal incidence: (m + 2) / (2 pi) = 1 / (4 pi alpha^2), alpha = roughness^2.
 * The mirrored direction turns twice as far as the half vector, so m is a quarter of what Blinn's lobe would have. At most
 * VIT_MAX_EXPONENT. 0: wider than m = 1, from roughness 0.64 on; no more like a matt surface than a lobe is
 * (tests/numeric/test_specular_mapping.c has the errors). */
float specular_exponent(float roughness);

/* Of glTF's own lobe (GGX): the square of the roughness, VIT_MIN_ALPHA at least. */
float specular_alpha(float roughness);

#define SPECULAR_DIELECTRIC 0.04f

/* Sets kind, albedo, specular and exponent. base: of the material, multiplied by the texture where there is one; mean:
 * likewise, the texture's mean taken for it, since reflectances of lobes and mirrors have no texture; dielectric: reflectance
 * at normal incidence of what is no metal, 0.04 for glTF's index 1.5. Metals (metallic >= 0.9) of roughness <= 0.1 become
 * mirrors, unless they emit; wide lobes matt surfaces of the base colour. */
void specular_from_metallic(model_material *m, const float base[3], const float mean[3], const float dielectric[3],
                            float metallic, float roughness);

/* The same with glTF's own lobe at all roughnesses. */
void specular_facets_from_metallic(model_material *m, const float base[3], const float mean[3], const float dielectric[3],
                                   float metallic, float roughness);

/* Which of the two by quality.lobe, and whether a metal of that roughness shows its surroundings' colour by a lobe. */
typedef void specular_mapping(model_material *m, const float base[3], const float mean[3], const float dielectric[3],
                              float metallic, float roughness);
static inline specular_mapping *specular_mapping_of(bool ggx) {
    return ggx ? specular_facets_from_metallic : specular_from_metallic;
}

static inline bool specular_has_lobe(bool ggx, float roughness) {
    return ggx || specular_exponent(roughness) > 0.0f;
}

#endif
