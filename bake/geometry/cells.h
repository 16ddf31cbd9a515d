/* cells.c: sides of triangles divided into cells, as kernels/cells.clh looks them up. */
#ifndef VIT_BAKE_CELLS_H
#define VIT_BAKE_CELLS_H

#include "geometry/bvh.h"
#include "common/kernel_math.h"

typedef struct cells {
    vit_u32 *sides;    /* 2 a triangle: section SIDE */
    vit_cell *cells;   /* section CELL */
    uint32_t *side_of; /* a cell: its side */
    uint32_t count;
} cells;

/* A cell's place: its corners' barycentric weights b1 and b2 in its triangle. */
typedef struct cell_corners {
    float b1[3], b2[3];
} cell_corners;

/* Divides every side into cells whose edges are at most edge(user, side) metres; longer edges if there were more than 2^23
 * cells. Cells are zero. VIT_FAILED: out of memory. */
vit_status cells_divide(const geometry *g, uint32_t triangles, float (*edge)(void *user, uint32_t side), void *user, cells *out,
                        vit_text *why);
void cells_free(cells *c);

/* The cell at barycentric weights b1, b2 of a side; the arithmetic of kernels/cells.clh. */
uint32_t cells_at(const cells *c, uint32_t side, float b1, float b2);
cell_corners cells_corners(const cells *c, uint32_t cell);
/* Cell k of those that a triangle is divided into, `parts` along each edge, in the order of kernels/cells.clh. Its corners in
 * units of 1 / parts of the way from the triangle's first corner to the second (i), and to the third (j). */
void cells_nodes(uint32_t parts, uint32_t k, uint32_t i[3], uint32_t j[3]);
/* Its corners where the triangle has these. */
cell_corners cells_within(const cell_corners *triangle, uint32_t parts, uint32_t k);
vec3 cells_center(const cells *c, const geometry *g, uint32_t cell);
float cells_area(const cells *c, const geometry *g, uint32_t cell); /* m2 */

/* Places on a side, by barycentric weights; on the surface itself. */
vec3 side_place(const geometry *g, uint32_t side, float b1, float b2);
/* Unit normals on that side: geometric, and interpolated as view samples have it. */
vec3 side_face(const geometry *g, uint32_t side);
vec3 side_shading(const geometry *g, uint32_t side, float b1, float b2);
float side_area(const geometry *g, uint32_t side); /* m2 */
bool side_is_dark(const geometry *g, uint32_t side);

#endif
