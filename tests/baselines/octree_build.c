/* The tree from the root down; an octant's triangles are those of its parent that touch it. */
#include "octree.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Of the scene's longest edge: octants are this much larger on each side for the question which triangles touch them, since the
 * walk's distances, halved level after level, are rounded. Far below the edge of a leaf. */
#define OCTREE_MARGIN 0x1p-18

typedef struct octant {
    double lo[3], hi[3];
    uint32_t node, depth;
} octant;

typedef struct builder {
    octree *o;
    const vit_triangle *triangles;
    octree_limits limits;
    double margin;
} builder;

/* Room for `more` beyond `count`; false: none to be had. */
static bool make_room(void **array, uint32_t *room, uint32_t count, uint32_t more, size_t size) {
    if (more <= *room - count)
        return true;
    if (more > 0x7fffffffu - count)
        return false;
    uint32_t wider = *room < 1024 ? 1024 : *room;
    while (wider - count < more)
        wider *= 2;
    void *p = realloc(*array, wider * size);
    if (!p)
        return false;
    *array = p;
    *room = wider;
    return true;
}

static bool add_nodes(octree *o, uint32_t count) {
    void *p = o->nodes;
    const bool done = make_room(&p, &o->node_room, o->node_count, count, sizeof *o->nodes);
    o->nodes = p;
    if (!done)
        return false;
    memset(o->nodes + o->node_count, 0, count * sizeof *o->nodes);
    o->node_count += count;
    return true;
}

static bool make_leaf(octree *o, const octant *at, const uint32_t *list, uint32_t count) {
    void *p = o->index;
    const bool done = make_room(&p, &o->index_room, o->index_count, count, sizeof *o->index);
    o->index = p;
    if (!done)
        return false;
    if (count > 0)
        memcpy(o->index + o->index_count, list, count * sizeof *list);
    o->nodes[at->node] = (octree_node){o->index_count, count};
    o->index_count += count;
    o->leaves++;
    o->empty += count == 0;
    return true;
}

static octant octant_of(const octant *parent, uint32_t child, uint32_t first) {
    octant c = {.node = first + child, .depth = parent->depth + 1};
    for (uint32_t k = 0; k < 3; k++) {
        const double middle = 0.5 * (parent->lo[k] + parent->hi[k]);
        const bool upper = child & 4u >> k;
        c.lo[k] = upper ? middle : parent->lo[k];
        c.hi[k] = upper ? parent->hi[k] : middle;
    }
    return c;
}

static uint32_t choose(const builder *b, const octant *at, const uint32_t *from, uint32_t count, uint32_t *to) {
    double middle[3], half[3];
    uint32_t n = 0;
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5 * (at->lo[k] + at->hi[k]);
        half[k] = 0.5 * (at->hi[k] - at->lo[k]) + b->margin;
    }
    for (uint32_t i = 0; i < count; i++)
        if (octree_touches(middle, half, b->triangles + from[i]))
            to[n++] = from[i];
    return n;
}

static bool grow(const builder *b, const octant *at, const uint32_t *list, uint32_t count) {
    octree *o = b->o;
    if (at->depth > o->depth)
        o->depth = at->depth;
    if (count <= b->limits.leaf || at->depth == b->limits.depth)
        return make_leaf(o, at, list, count);
    const uint32_t first = o->node_count;
    uint32_t *chosen = malloc(count * sizeof *chosen);
    bool done = chosen && add_nodes(o, 8);
    if (done)
        o->nodes[at->node] = (octree_node){first, OCTREE_INNER};
    for (uint32_t c = 0; c < 8 && done; c++) {
        const octant child = octant_of(at, c, first);
        done = grow(b, &child, chosen, choose(b, &child, list, count, chosen));
    }
    free(chosen);
    return done;
}

/* Vertices' box, and a little more: a flat scene, too, has an inside. Returns its longest edge. */
static double find_box(const vit_triangle *t, uint32_t count, octree *o) {
    double longest = 0;
    for (uint32_t k = 0; k < 3; k++) {
        float lo = t->v0[k], hi = lo;
        for (uint32_t i = 0; i < count; i++) {
            lo = fminf(lo, fminf(t[i].v0[k], fminf(t[i].v1[k], t[i].v2[k])));
            hi = fmaxf(hi, fmaxf(t[i].v0[k], fmaxf(t[i].v1[k], t[i].v2[k])));
        }
        o->lo[k] = lo;
        o->hi[k] = hi;
        longest = fmax(longest, (double)hi - (double)lo);
    }
    for (uint32_t k = 0; k < 3; k++) {
        o->lo[k] -= (float)(longest * OCTREE_MARGIN);
        o->hi[k] += (float)(longest * OCTREE_MARGIN);
    }
    return longest;
}

static bool copy_triangles(const vit_triangle *t, uint32_t count, octree *o) {
    o->triangles = calloc(count, sizeof *o->triangles);
    if (!o->triangles)
        return false;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            o->triangles[i].v0[k] = t[i].v0[k];
            o->triangles[i].e1[k] = t[i].v1[k] - t[i].v0[k];
            o->triangles[i].e2[k] = t[i].v2[k] - t[i].v0[k];
        }
    o->triangle_count = count;
    return true;
}

static double seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

bool octree_build(const vit_triangle *triangles, uint32_t count, octree_limits limits, octree *out) {
    const double began = seconds();
    *out = (octree){0};
    builder b = {out, triangles, limits, find_box(triangles, count, out) * OCTREE_MARGIN};
    octant root = {.node = 0};
    for (int k = 0; k < 3; k++) {
        root.lo[k] = (double)out->lo[k];
        root.hi[k] = (double)out->hi[k];
    }
    uint32_t *all = malloc(count * sizeof *all);
    bool done = all && copy_triangles(triangles, count, out) && add_nodes(out, 1);
    for (uint32_t i = 0; i < count && done; i++)
        all[i] = i;
    done = done && grow(&b, &root, all, count);
    free(all);
    if (!done)
        octree_free(out);
    out->build_seconds = seconds() - began;
    return done;
}

void octree_free(octree *o) {
    free(o->nodes);
    free(o->index);
    free(o->triangles);
    *o = (octree){0};
}
