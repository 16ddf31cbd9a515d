/* Which sides hang together: within a patch of triangles that lie beside each other in leaf order, by hash tables on the
 * stack, so that it takes no memory and any thread may do it. Corners are the same if their coordinates are. */
#include "dark_sides/parts.h"
#include <string.h>

#define SLOTS (4u * PATCH_TRIANGLES) /* a power of two, for up to 3 * PATCH_TRIANGLES corners or edges */

_Static_assert((SLOTS & (SLOTS - 1)) == 0 && SLOTS > 3 * PATCH_TRIANGLES, "a table is never full");

typedef struct edge {
    uint16_t a, b;      /* corners, a < b */
    uint16_t side[2];   /* the sides that are fronts where the edge goes from a to b */
    uint16_t triangles; /* that share it; more than 2: none are neighbours */
} edge;

static uint32_t mixed(uint32_t x) {
    x = (x ^ x >> 16) * 0x85ebca6bu;
    x = (x ^ x >> 13) * 0xc2b2ae35u;
    return x ^ x >> 16;
}

/* The number of the corner, in the order in which corners are met. */
static uint16_t corner_of(const float *corners[SLOTS], uint16_t numbers[SLOTS], uint16_t *count, const float p[3]) {
    uint32_t word[3], h = 0;
    for (int k = 0; k < 3; k++) {
        const float x = p[k] + 0.0f; /* -0 and 0 are one place */
        memcpy(&word[k], &x, sizeof x);
        h = mixed(h ^ word[k]);
    }
    uint32_t at = h & (SLOTS - 1);
    for (; corners[at]; at = (at + 1) & (SLOTS - 1))
        if (!(corners[at][0] < p[0] || corners[at][0] > p[0] || corners[at][1] < p[1] || corners[at][1] > p[1] ||
              corners[at][2] < p[2] || corners[at][2] > p[2]))
            return numbers[at];
    corners[at] = p;
    return numbers[at] = (*count)++;
}

static void note_edge(edge edges[SLOTS], uint32_t triangle, uint16_t from, uint16_t to) {
    const bool ahead = from < to;
    const uint16_t a = ahead ? from : to, b = ahead ? to : from;
    uint32_t at = mixed((uint32_t)a << 16 | b) & (SLOTS - 1);
    while (edges[at].triangles > 0 && (edges[at].a != a || edges[at].b != b))
        at = (at + 1) & (SLOTS - 1);
    edge *e = edges + at;
    if (e->triangles < 2) {
        e->a = a;
        e->b = b;
        e->side[e->triangles] = (uint16_t)(2 * triangle + !ahead);
    }
    e->triangles++;
}

static uint16_t root_of(uint16_t group[PATCH_SIDES], uint16_t side) {
    while (group[side] != side)
        side = group[side] = group[group[side]];
    return side;
}

static void link(dark_sides_patch *p, uint16_t a, uint16_t b) {
    const uint16_t x = root_of(p->group, a), y = root_of(p->group, b);
    p->group[x > y ? x : y] = x > y ? y : x;
}

void patch_link(const geometry *g, uint32_t first, uint32_t count, dark_sides_patch *out) {
    const float *corners[SLOTS] = {NULL};
    uint16_t numbers[SLOTS], corner_count = 0;
    edge edges[SLOTS];
    memset(edges, 0, sizeof edges);
    out->first = first;
    out->count = count;
    for (uint32_t i = 0; i < 2 * count; i++)
        out->group[i] = (uint16_t)i;
    for (uint32_t i = 0; i < count; i++) {
        const vit_triangle *t = g->triangles + first + i;
        const uint16_t c[3] = {corner_of(corners, numbers, &corner_count, t->v0),
                               corner_of(corners, numbers, &corner_count, t->v1),
                               corner_of(corners, numbers, &corner_count, t->v2)};
        for (uint16_t k = 0; k < 3; k++)
            if (c[k] != c[(k + 1) % 3])
                note_edge(edges, i, c[k], c[(k + 1) % 3]);
    }
    for (uint32_t i = 0; i < SLOTS; i++) { /* fronts of neighbours run along their edge in opposite directions */
        const edge *e = edges + i;
        if (e->triangles != 2 || e->side[0] / 2 == e->side[1] / 2)
            continue;
        link(out, e->side[0], e->side[1] ^ 1);
        link(out, e->side[0] ^ 1, e->side[1]);
    }
    for (uint32_t i = 0; i < 2 * count; i++)
        out->group[i] = root_of(out->group, (uint16_t)i);
}
