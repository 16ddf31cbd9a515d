/* atlas.c: all textures with their mip levels in one buffer of words (see vit_mip in records.clh). */
#ifndef VIT_BAKE_ATLAS_H
#define VIT_BAKE_ATLAS_H

#include "import/model.h"
#include "vitrine_pack.h"

typedef struct atlas {
    vit_u32 *texels; /* words; see vit_mip for the packing */
    uint32_t texel_count;
    vit_texture *textures;
    uint32_t texture_count;
    vit_mip *mips;
    uint32_t mip_count;
    uint32_t *material_texture; /* a model material: index in textures, or VIT_NONE */
    uint32_t *material_normal;  /* the same of its normal map */
    uint32_t width, height;     /* of the packed sheet, texels */
    double occupancy;           /* texels in use, gutters included, over all texels; 0..1 */
} atlas;

/* Packs each (image, wrap_u, wrap_v, cutoff) in use once, and normal maps (image, wrap_u, wrap_v), with box-filtered mips (in
 * linear light; alpha-weighted for cut-outs) down to 1 x 1. */
vit_status atlas_pack(const model *m, atlas *out, vit_text *why);
void atlas_free(atlas *a);

#endif
