/* bvh.c: a binary BVH by Embree's builder, flattened; geometry.c: triangles and attributes in its leaf order. */
#ifndef VIT_BAKE_BVH_H
#define VIT_BAKE_BVH_H

#include "import/model.h"
#include "vitrine_pack.h"

typedef struct bvh {
    vit_bvh_node *nodes; /* node 0 is the root; children have greater indices */
    uint32_t node_count; /* >= 1 */
    uint32_t *order;     /* leaf order: order[i] = triangle of the model */
    uint32_t depth;      /* inner nodes on the longest way down; < VIT_BVH_STACK */
    float box_pad;       /* see vit_scene.box_pad */
    double build_seconds;
} bvh;

/* Builds over triangle boxes grown by box_pad = 2^-20 of the largest absolute coordinate (at least 2^-100), computed in float
 * as the kernels do: lo = min of vertices - pad, hi = max + pad. Every child box lies in its parent's exactly. The result does
 * not depend on `threads` (0: all cores). Triangles of a leaf are in ascending model order. */
vit_status bvh_build(const model *m, unsigned threads, bvh *out, vit_text *why);
void bvh_free(bvh *b);

typedef struct geometry {
    vit_triangle *triangles; /* model.triangles records, leaf order */
    vit_attributes *attributes;
    float ray_offset; /* geometry_ray_offset() */
    float box_pad;    /* the bvh's */
} geometry;

/* Writes the records in leaf order; oct-encodes normals (error bound stated in octahedral.h and tested). */
vit_status geometry_pack(const model *m, const bvh *b, geometry *out, vit_text *why);
void geometry_free(geometry *g);
/* How far rays leave a surface of the model, vit_scene.ray_offset, metres. */
float geometry_ray_offset(const model *m);

#endif
