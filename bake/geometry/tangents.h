/* tangents.c: tangents of the vertices of what has a normal map. */
#ifndef VIT_BAKE_TANGENTS_H
#define VIT_BAKE_TANGENTS_H

#include "import/model.h"
#include "vitrine_pack.h"

/* Two words for each of the model's triangles, as vit_attributes.tangent has them: 0 where the material has no normal map, or
 * where texture coordinates say nothing of directions; *words is NULL if all are, and else the caller's to free. normals: a
 * word for each vertex, its normal as vit_attributes has it. Tangent spaces are MikkTSpace's (Mikkelsen 2008, "Simulation of
 * Wrinkled Surfaces Revisited"), of which normal maps are made; tests/unit/test_tangents.c has the rules. VIT_FAILED: out of
 * memory. */
vit_status tangents_pack(const model *m, const vit_u32 *normals, vit_u32 **words, vit_text *why);

#endif
