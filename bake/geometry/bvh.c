/* The BVH: Embree's binned SAH builder makes the topology, we compute every box ourselves and lay the nodes out depth-first.
 * Embree's own boxes are not used: the runtime's nearest hit is a function of ray and triangles alone only if each box holds
 * the whole grown boxes of its triangles, to the bit. For the same reason there are no spatial splits. */
#include "geometry/bvh.h"
#include "common/fail.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#if VIT_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#define LEAF_TRIANGLES 4 /* <= VIT_LEAF_MAX; larger leaves lose more in triangle tests than they save in nodes */
#ifndef EMBREE_DEPTH     /* a test lowers it */
#define EMBREE_DEPTH 56  /* Embree refuses what would be deeper; the median tree takes over */
#endif
#define COORDINATE_LIMIT 1e9f /* metres; keeps areas and squared areas far from overflow in float */

typedef struct box {
    float lo[3], hi[3];
} box;

/* A node as the builders make it. */
typedef struct build_node {
    struct build_node *child[2]; /* both or none */
    uint32_t count;              /* triangles of a leaf */
    uint32_t triangle[LEAF_TRIANGLES];
} build_node;

static box box_empty(void) {
    return (box){{3.0e38f, 3.0e38f, 3.0e38f}, {-3.0e38f, -3.0e38f, -3.0e38f}};
}

static box box_union(box a, const box *b) {
    for (int k = 0; k < 3; k++) {
        a.lo[k] = b->lo[k] < a.lo[k] ? b->lo[k] : a.lo[k];
        a.hi[k] = b->hi[k] > a.hi[k] ? b->hi[k] : a.hi[k];
    }
    return a;
}

/* Box of a triangle grown by pad: the arithmetic that bvh.h promises. */
static box triangle_box(const model *m, uint32_t triangle, float pad) {
    box b = box_empty();
    for (int corner = 0; corner < 3; corner++) {
        const float *p = m->position + 3 * (size_t)m->index[3 * (size_t)triangle + (size_t)corner];
        const box point = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
        b = box_union(b, &point);
    }
    for (int k = 0; k < 3; k++) {
        b.lo[k] -= pad;
        b.hi[k] += pad;
    }
    return b;
}

/* Largest absolute coordinate of the vertices in use, metres. */
static float largest_coordinate(const model *m) {
    float largest = 0.0f;
    for (size_t i = 0; i < 3 * (size_t)m->triangles; i++)
        for (size_t k = 0; k < 3; k++)
            largest = fmaxf(largest, fabsf(m->position[3 * (size_t)m->index[i] + k]));
    return largest;
}

/* Embree's callbacks: only the topology is kept. */
static void *create_node(RTCThreadLocalAllocator allocator, unsigned children, void *user) {
    (void)children;
    (void)user;
    build_node *n = rtcThreadLocalAlloc(allocator, sizeof *n, 16);
    memset(n, 0, sizeof *n);
    return n;
}

static void set_children(void *node, void **children, unsigned count, void *user) {
    (void)user;
    build_node *n = node;
    for (unsigned i = 0; i < count && i < 2; i++)
        n->child[i] = children[i];
}

static void set_bounds(void *node, const struct RTCBounds **bounds, unsigned count, void *user) {
    (void)node;
    (void)bounds;
    (void)count;
    (void)user;
}

static void *create_leaf(RTCThreadLocalAllocator allocator, const struct RTCBuildPrimitive *primitives, size_t count,
                         void *user) {
    build_node *n = create_node(allocator, 0, user);
    n->count = count < LEAF_TRIANGLES ? (uint32_t)count : LEAF_TRIANGLES; /* maxLeafSize says it is never more */
    for (uint32_t i = 0; i < n->count; i++)
        n->triangle[i] = primitives[i].primID;
    return n;
}

/* NULL if Embree cannot, for whatever reason. The tree lives in `tree`; `boxes` has one box a triangle.
 * The SAH takes a node (two box tests for a packet) and a triangle test as equally dear. */
static build_node *embree_tree(RTCBVH tree, const box *boxes, uint32_t count) {
    struct RTCBuildPrimitive *primitives = aligned_alloc(32, count * sizeof *primitives);
    if (!primitives)
        return NULL;
    for (uint32_t i = 0; i < count; i++) {
        const box *b = boxes + i;
        primitives[i] = (struct RTCBuildPrimitive){.lower_x = b->lo[0],
                                                   .lower_y = b->lo[1],
                                                   .lower_z = b->lo[2],
                                                   .upper_x = b->hi[0],
                                                   .upper_y = b->hi[1],
                                                   .upper_z = b->hi[2],
                                                   .geomID = 0,
                                                   .primID = i};
    }
    struct RTCBuildArguments a = rtcDefaultBuildArguments();
    a.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
    a.maxBranchingFactor = 2;
    a.maxDepth = EMBREE_DEPTH;
    a.sahBlockSize = 1;
    a.minLeafSize = 1;
    a.maxLeafSize = LEAF_TRIANGLES;
    a.traversalCost = 1.0f;
    a.intersectionCost = 1.0f;
    a.bvh = tree;
    a.primitives = primitives;
    a.primitiveCount = a.primitiveArrayCapacity = count;
    a.createNode = create_node;
    a.setNodeChildren = set_children;
    a.setNodeBounds = set_bounds;
    a.createLeaf = create_leaf;
    build_node *root = rtcBuildBVH(&a);
    free(primitives);
    return root;
}

/* The tree that never fails: halves at the median, so its depth is ceil(log2(triangles)). */
typedef struct median_item {
    float key;
    uint32_t triangle;
} median_item;

static int by_key(const void *a, const void *b) {
    const median_item *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

static build_node *median_tree(build_node **pool, const box *boxes, median_item *items, uint32_t count) {
    build_node *n = (*pool)++;
    if (count <= LEAF_TRIANGLES) {
        n->count = count;
        for (uint32_t i = 0; i < count; i++)
            n->triangle[i] = items[i].triangle;
        return n;
    }
    box centres = box_empty();
    for (uint32_t i = 0; i < count; i++) {
        const box *b = boxes + items[i].triangle;
        const float c[3] = {b->lo[0] + b->hi[0], b->lo[1] + b->hi[1], b->lo[2] + b->hi[2]};
        const box point = {{c[0], c[1], c[2]}, {c[0], c[1], c[2]}};
        centres = box_union(centres, &point);
    }
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (centres.hi[k] - centres.lo[k] > centres.hi[axis] - centres.lo[axis])
            axis = k;
    for (uint32_t i = 0; i < count; i++)
        items[i].key = boxes[items[i].triangle].lo[axis] + boxes[items[i].triangle].hi[axis];
    qsort(items, count, sizeof *items, by_key);
    n->child[0] = median_tree(pool, boxes, items, count / 2);
    n->child[1] = median_tree(pool, boxes, items + count / 2, count - count / 2);
    return n;
}

typedef struct tree_size {
    uint32_t inner, depth;
} tree_size;

static tree_size measure(const build_node *n) {
    if (!n->child[0] || !n->child[1])
        return (tree_size){0, 0};
    const tree_size a = measure(n->child[0]), b = measure(n->child[1]);
    return (tree_size){a.inner + b.inner + 1, (a.depth > b.depth ? a.depth : b.depth) + 1};
}

static int by_number(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

typedef struct layout {
    bvh *out;
    const box *boxes;
    uint32_t next_node, next_triangle;
} layout;

/* Lays out the subtree of `n`, sets its child word and returns its box. Ascending triangles within a leaf make the order
 * independent of how Embree's threads partitioned them. */
static box flatten(layout *l, const build_node *n, vit_u32 *child) {
    if (!n->child[0] || !n->child[1]) {
        uint32_t *order = l->out->order + l->next_triangle;
        box b = box_empty();
        for (uint32_t i = 0; i < n->count; i++) {
            order[i] = n->triangle[i];
            b = box_union(b, l->boxes + order[i]);
        }
        qsort(order, n->count, sizeof *order, by_number);
        *child = VIT_LEAF_BIT | (n->count - 1u) << VIT_LEAF_SHIFT | l->next_triangle;
        l->next_triangle += n->count;
        return b;
    }
    *child = l->next_node++;
    vit_bvh_node *node = l->out->nodes + *child;
    const box b0 = flatten(l, n->child[0], &node->child0), b1 = flatten(l, n->child[1], &node->child1);
    memcpy(node->lo0, b0.lo, sizeof b0.lo);
    memcpy(node->hi0, b0.hi, sizeof b0.hi);
    memcpy(node->lo1, b1.lo, sizeof b1.lo);
    memcpy(node->hi1, b1.hi, sizeof b1.hi);
    return box_union(b0, &b1);
}

/* A scene of one leaf still gets a root: its second child is a leaf of an empty box. */
static void flatten_single_leaf(layout *l, const build_node *leaf) {
    vit_bvh_node *root = l->out->nodes;
    const box b = flatten(l, leaf, &root->child0), none = box_empty();
    memcpy(root->lo0, b.lo, sizeof b.lo);
    memcpy(root->hi0, b.hi, sizeof b.hi);
    memcpy(root->lo1, none.lo, sizeof none.lo);
    memcpy(root->hi1, none.hi, sizeof none.hi);
    root->child1 = VIT_LEAF_BIT;
}

static vit_status out_of_memory(vit_text *why) {
    return bake_fail(why, VIT_FAILED, "BVH: out of memory");
}

static vit_status lay_out(const build_node *root, const box *boxes, uint32_t triangles, bvh *out, vit_text *why) {
    const tree_size size = measure(root);
    out->node_count = size.inner ? size.inner : 1;
    out->depth = size.depth ? size.depth : 1;
    out->nodes = calloc(out->node_count, sizeof *out->nodes);
    out->order = malloc(triangles * sizeof *out->order);
    if (!out->nodes || !out->order)
        return out_of_memory(why);
    layout l = {.out = out, .boxes = boxes};
    vit_u32 first;
    if (size.inner)
        flatten(&l, root, &first);
    else
        flatten_single_leaf(&l, root);
    return VIT_OK;
}

static vit_status lay_out_median(const box *boxes, uint32_t triangles, bvh *out, vit_text *why) {
    build_node *pool = calloc(2 * (size_t)triangles, sizeof *pool), *next = pool;
    /* A model has a triangle. NOLINTNEXTLINE(clang-analyzer-optin.portability.UnixAPI) */
    median_item *items = calloc(triangles, sizeof *items);
    vit_status status = VIT_FAILED;
    if (pool && items) {
        for (uint32_t i = 0; i < triangles; i++)
            items[i].triangle = i;
        const build_node *root = median_tree(&next, boxes, items, triangles);
        status = lay_out(root, boxes, triangles, out, why);
    } else
        out_of_memory(why);
    free(items);
    free(pool);
    return status;
}

static vit_status lay_out_tree(const box *boxes, uint32_t triangles, unsigned threads, bvh *out, vit_text *why) {
    char config[32] = "";
    if (threads)
        snprintf(config, sizeof config, "threads=%u", threads);
    RTCDevice device = rtcNewDevice(config);
    if (!device) {
        return bake_fail(why, VIT_FAILED, "BVH: Embree makes no device (error %d)", (int)rtcGetDeviceError(NULL));
    }
    RTCBVH tree = rtcNewBVH(device);
    const build_node *root = tree ? embree_tree(tree, boxes, triangles) : NULL;
    vit_status status;
    if (root && measure(root).depth < VIT_BVH_STACK)
        status = lay_out(root, boxes, triangles, out, why);
    else
        status = lay_out_median(boxes, triangles, out, why);
    if (tree)
        rtcReleaseBVH(tree);
    rtcReleaseDevice(device);
    return status;
}

static double seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

vit_status bvh_build(const model *m, unsigned threads, bvh *out, vit_text *why) {
    const double start = seconds();
    *out = (bvh){0};
    const float largest = largest_coordinate(m);
    if (m->triangles < 1 || m->triangles > VIT_MAX_TRIANGLES || !(largest <= COORDINATE_LIMIT)) {
        return bake_fail(why, VIT_BAD_INPUT, "model: %u triangles, largest coordinate %g m; needs 1..%u and at most %g m",
                         m->triangles, (double)largest, VIT_MAX_TRIANGLES, (double)COORDINATE_LIMIT);
    }
    out->box_pad = fmaxf(largest * 0x1p-20f, 0x1p-100f);
    box *boxes = malloc(m->triangles * sizeof *boxes);
    if (!boxes)
        return out_of_memory(why);
    for (uint32_t i = 0; i < m->triangles; i++)
        boxes[i] = triangle_box(m, i, out->box_pad);
    const vit_status status = lay_out_tree(boxes, m->triangles, threads, out, why);
    free(boxes);
    out->build_seconds = seconds() - start;
    if (status != VIT_OK)
        bvh_free(out);
    return status;
}

void bvh_free(bvh *b) {
    free(b->nodes);
    free(b->order);
    *b = (bvh){0};
}
