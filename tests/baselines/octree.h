/* The tree of kernels/METHODS.md, "What we correct": a scene's box cut into eight equal octants, and these again, until few
 * triangles are left in one or the tree is as deep as it may be. Built on the host, walked by octree.cl. A rival for the
 * benches and an oracle for what the BVH and the watertight test repair; nothing of the product uses it. */
#ifndef VIT_BASELINE_OCTREE_H
#define VIT_BASELINE_OCTREE_H

#include "vitrine_pack.h"
#include <stdbool.h>
#include <stdint.h>

#define OCTREE_INNER 0xffffffffu
#define OCTREE_DEEPEST 16 /* octree.cl keeps a frame a level */

/* Inner: count is OCTREE_INNER, first the first of its eight children; child bits: 4 upper half in x, 2 in y, 1 in z.
 * Leaf: `count` entries of `index` from `first`. */
typedef struct octree_node {
    uint32_t first, count;
} octree_node;

/* A vertex and two edges, as Moeller and Trumbore want them. */
typedef struct octree_triangle {
    float v0[4], e1[4], e2[4];
} octree_triangle;

/* The method stops at a depth and at a number of triangles; it states neither. */
typedef struct octree_limits {
    uint32_t depth, leaf; /* 1..OCTREE_DEEPEST; >= 1 */
} octree_limits;

typedef struct octree {
    octree_node *nodes; /* node 0 is the root */
    uint32_t *index;    /* triangles of leaves, ascending in each; a triangle is in every leaf that it touches */
    octree_triangle *triangles;
    uint32_t node_count, node_room, index_count, index_room, triangle_count;
    uint32_t leaves, empty, depth;
    float lo[4], hi[4]; /* the root's box */
    double build_seconds;
} octree;

/* false: out of memory; nothing is left to free. */
bool octree_build(const vit_triangle *triangles, uint32_t count, octree_limits limits, octree *out);
void octree_free(octree *o);

/* Does the triangle touch the box? Separating axes after Akenine-Moeller, JGT 6(1), 2001. */
bool octree_touches(const double middle[3], const double half[3], const vit_triangle *t);

#endif
