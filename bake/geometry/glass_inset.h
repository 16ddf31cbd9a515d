/* glass_inset.c: bodies of glass do not touch what they stand on. */
#ifndef VIT_BAKE_GLASS_GAP_H
#define VIT_BAKE_GLASS_GAP_H

#include "import/model.h"
#include <stdbool.h>

/* Draws the faces of VIT_GLASS in by GLASS_INSET ray offsets, `ray_offset` metres each: a ray that leaves a body starts beyond
 * its face, and so would start beyond a table that the face lies on; which of two faces in one place it meets is up to
 * rounding. A vertex moves by at most 1 / 8 of the least height of its triangles, so that none turns over. Bodies that share
 * vertices' places do not part there, and bodies wound inside out move out. With vertex_bits 16 it is done again on the grid.
 * False: out of memory, and nothing has moved. */
#define GLASS_INSET 1.5
bool glass_inset(model *m, float ray_offset);

#endif
