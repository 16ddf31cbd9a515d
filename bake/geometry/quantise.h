/* quantise.c: a model as it would be with its vertices stored in fewer bits, to see what they buy. */
#ifndef VIT_BAKE_QUANTISE_H
#define VIT_BAKE_QUANTISE_H

#include "import/model.h"

/* vertex_bits 16: positions go to the nearest of 65536 steps of the scene's box along each axis, so vertices that were equal
 * stay so; triangles without area after that are dropped and added to out->degenerate. normal_bits 8: normals as octahedral
 * pairs of signed bytes. Any other number: as they are. *out borrows from *m all but positions, normals, indices and materials,
 * and lives no longer; free with model_quantise_free(). VIT_BAD_INPUT: no triangle is left. VIT_FAILED: out of memory. */
vit_status model_quantise(const model *m, int vertex_bits, int normal_bits, model *out, vit_text *why);
void model_quantise_free(model *m);

#endif
