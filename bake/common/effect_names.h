/* effect_names.c: effects by name, and which of them a scene's `effects` may name. */
#ifndef VIT_COMMON_EFFECT_NAMES_H
#define VIT_COMMON_EFFECT_NAMES_H

#include "vitrine_pack.h"

/* Effects that only act where rays reach; AREA_LIGHTS acts wherever its light falls. */
#define EFFECTS_SETTLED                                                                                                        \
    (VIT_BIT(TEXTURES) | VIT_BIT(CUTOUT) | VIT_BIT(EMISSION) | VIT_BIT(SMOOTH) | VIT_BIT(SPECULAR) | VIT_BIT(MIRROR) |         \
     VIT_BIT(GLASS) | VIT_BIT(CAUSTICS) | VIT_BIT(SKY_IMAGE) | VIT_BIT(GGX) | VIT_BIT(NORMAL_MAPS) | VIT_BIT(GLOSS))
/* Effects that a scene's `effects` may name, force on and force off: those of surfaces, the sky and pixels. */
#define EFFECTS_NAMED                                                                                                          \
    (EFFECTS_SETTLED | VIT_BIT(AREA_LIGHTS) | VIT_BIT(SKY_LIGHT) | VIT_BIT(AMBIENT) | VIT_BIT(OCCLUSION) | VIT_BIT(ANTIALIAS))

/* Name of the effect of a bit. */
const char *effects_name(int bit);
/* The effect of a name, or 0. */
uint64_t effects_named(const char *name);

#endif
