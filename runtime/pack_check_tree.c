/* pack_check_tree.c: checks the triangles and the BVH over them: after it, a traversal with a stack of VIT_BVH_STACK ends,
 * stays inside both sections and finds every triangle. One depth-first walk, no memory but its own stack.
 *
 * Why the walk ends and visits every node once: an inner child's index is greater than its parent's, so there is no cycle.
 * Leaves must be met in ascending order of their triangles, without gaps, and every inner node holds at least one triangle
 * (only the second child may be missing): a node met twice would bring its triangles a second time and be refused. */
#include "pack_check.h"

#include <string.h>

vit_status vit_pack_check_GEOM(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const vit_triangle *triangles = p->section[VIT_SECTION_GEOM];
    for (vit_u32 i = 0; i < s->triangles; i++) {
        const vit_triangle *t = VIT_RECORD(vit_triangle, triangles, i);
        const float n[3] = {t->nx, t->ny, t->nz};
        if (!all_finite(t->v0, 3) || !all_finite(t->v1, 3) || !all_finite(t->v2, 3))
            return vit_pack_refuse(why, "section GEOM: triangle %u: vertex is not finite", i);
        if (!all_in_range(t->v0, 3, -1e9f, 1e9f) || !all_in_range(t->v1, 3, -1e9f, 1e9f) ||
            !all_in_range(t->v2, 3, -1e9f, 1e9f))
            return vit_pack_refuse(why, "section GEOM: triangle %u: vertex beyond 1e9 m",
                                   i); /* products of edges stay finite */
        if (!all_finite(n, 3))
            return vit_pack_refuse(why, "section GEOM: triangle %u: normal is not finite", i);
        if (all_in_range(n, 3, 0.0f, 0.0f))
            return vit_pack_refuse(why, "section GEOM: triangle %u: normal is 0", i);
    }
    return VIT_OK;
}

/* A child that the walk has yet to enter. */
typedef struct visit {
    vit_u32 child;      /* as in vit_bvh_node */
    vit_u32 depth;      /* inner nodes above it */
    vit_u32 parent;     /* for the error line */
    float lo[3], hi[3]; /* its box; the root's, which nothing states, holds all */
} visit;

typedef struct walk {
    const vit_scene *s;
    const vit_bvh_node *nodes;
    const vit_triangle *triangles;
    vit_text *why;
    vit_u32 visited;                /* inner nodes */
    vit_u32 found;                  /* triangles of the leaves so far, and so the first triangle of the next leaf */
    vit_u32 waiting;                /* entries of `stack` */
    visit stack[VIT_BVH_STACK + 1]; /* an inner node takes one entry and gives two: at most one more than the depth */
} walk;

static bool box_is_empty(const float *lo, const float *hi) {
    return lo[0] > hi[0] && lo[1] > hi[1] && lo[2] > hi[2];
}

static bool box_is_inside(const float *lo, const float *hi, const float *outer_lo, const float *outer_hi) {
    for (int k = 0; k < 3; k++)
        if (!(lo[k] >= outer_lo[k] && hi[k] <= outer_hi[k]))
            return false;
    return true;
}

static float least(float a, float b) {
    return a < b ? a : b;
}
static float most(float a, float b) {
    return a > b ? a : b;
}

/* The box test of the kernels may skip only boxes without a hit, so boxes must hold the triangles as grown by box_pad. */
static bool box_holds_triangle(const visit *v, const vit_triangle *t, float pad) {
    float lo[3], hi[3];
    for (int k = 0; k < 3; k++) {
        lo[k] = least(t->v0[k], least(t->v1[k], t->v2[k])) - pad;
        hi[k] = most(t->v0[k], most(t->v1[k], t->v2[k])) + pad;
    }
    return box_is_inside(lo, hi, v->lo, v->hi);
}

static vit_status enter_leaf(walk *w, const visit *v) {
    const vit_u32 first = v->child & VIT_LEAF_FIRST, count = (v->child >> VIT_LEAF_SHIFT & (VIT_LEAF_MAX - 1)) + 1;
    if ((uint64_t)first + count > w->s->triangles)
        return vit_pack_refuse(w->why, "section BVHN: node %u: leaf of triangles %u..%u of %u", v->parent, first,
                               first + count - 1, w->s->triangles);
    if (box_is_empty(v->lo, v->hi)) /* a missing child */
        return VIT_OK;
    if (first != w->found)
        return vit_pack_refuse(w->why, "section BVHN: node %u: leaf begins at triangle %u, expected %u", v->parent, first,
                               w->found);
    for (vit_u32 i = first; i < first + count; i++)
        if (!box_holds_triangle(v, VIT_RECORD(vit_triangle, w->triangles, i), w->s->box_pad))
            return vit_pack_refuse(w->why, "section BVHN: node %u: box does not hold triangle %u", v->parent, i);
    w->found += count;
    return VIT_OK;
}

/* Child `which` (0 or 1) of the node `n` that `v` leads to. */
static vit_status queue_child(walk *w, const visit *v, const vit_bvh_node *n, int which) {
    const vit_u32 index = v->child;
    visit c = {.child = which ? n->child1 : n->child0, .depth = v->depth + 1, .parent = index};
    memcpy(c.lo, which ? n->lo1 : n->lo0, sizeof c.lo);
    memcpy(c.hi, which ? n->hi1 : n->hi0, sizeof c.hi);
    const bool leaf = c.child & VIT_LEAF_BIT;
    if (!(which == 1 && leaf && box_is_empty(c.lo, c.hi))) {
        if (!all_finite(c.lo, 3) || !all_finite(c.hi, 3) || !box_is_inside(c.lo, c.lo, c.lo, c.hi))
            return vit_pack_refuse(w->why, "section BVHN: node %u: box of child %d is not finite or inside out", index, which);
        if (!box_is_inside(c.lo, c.hi, v->lo, v->hi))
            return vit_pack_refuse(w->why, "section BVHN: node %u: box of child %d leaves its parent's", index, which);
    }
    if (!leaf && (c.child <= index || c.child >= w->s->nodes))
        return vit_pack_refuse(w->why, "section BVHN: node %u: child %d is node %u of %u", index, which, c.child, w->s->nodes);
    w->stack[w->waiting++] = c;
    return VIT_OK;
}

static vit_status enter_node(walk *w, const visit *v) {
    const vit_bvh_node *n = VIT_RECORD(vit_bvh_node, w->nodes, v->child);
    if (v->depth + 1 >= VIT_BVH_STACK)
        return vit_pack_refuse(w->why, "section BVHN: node %u: deeper than %d", v->child, VIT_BVH_STACK - 1);
    if (!all_zero(n->pad, 2))
        return vit_pack_refuse(w->why, "section BVHN: node %u: padding is not 0", v->child);
    w->visited++;
    vit_status status = queue_child(w, v, n, 1); /* last in, first out: child 0 is entered first */
    return status == VIT_OK ? queue_child(w, v, n, 0) : status;
}

vit_status vit_pack_check_BVHN(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    walk w = {.s = s, .nodes = p->section[VIT_SECTION_BVHN], .triangles = p->section[VIT_SECTION_GEOM], .why = why};
    w.stack[w.waiting++] = (visit){.child = 0, .lo = {-FLT_MAX, -FLT_MAX, -FLT_MAX}, .hi = {FLT_MAX, FLT_MAX, FLT_MAX}};
    while (w.waiting > 0) {
        const visit v = w.stack[--w.waiting];
        vit_status status = v.child & VIT_LEAF_BIT ? enter_leaf(&w, &v) : enter_node(&w, &v);
        if (status != VIT_OK)
            return status;
    }
    if (w.found != s->triangles)
        return vit_pack_refuse(why, "section BVHN: leaves hold %u triangles of %u", w.found, s->triangles);
    if (w.visited != s->nodes)
        return vit_pack_refuse(why, "section BVHN: %u nodes of %u are in the tree", w.visited, s->nodes);
    return VIT_OK;
}
