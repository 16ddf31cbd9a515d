#include "radiosity/patches_parted.h"
#include "common/parallel.h"
#include <stdlib.h>

#define LIFT 0.04f        /* in edges: how far above the surface places look at each other */
#define SPLIT_LEAST 0.04f /* of a square of the edge: smaller cells are not looked at for what stands on them */
#define NEAREST 16u       /* cells that a part may belong to the patch of, if it sees them */

static float lift_of(const patches_input *in, float edge) {
    return float_max(edge * LIFT, 2.0f * in->rays->s->ray_offset);
}

typedef struct parting {
    const patches_input *in;
    patch_set *p;
    separation *found;
    bool *is;
    float edge;
} parting;

static void find_part(void *user, uint32_t cell) {
    const parting *s = user;
    const cell_corners k = cells_corners(&s->p->cells, cell);
    s->is[cell] =
        cells_area(&s->p->cells, s->in->geometry, cell) > SPLIT_LEAST * s->edge * s->edge &&
        separation_find(s->in->rays, s->in->geometry, s->p->cells.side_of[cell], &k, lift_of(s->in, s->edge), s->found + cell);
}

bool patches_find_parts(const patches_input *in, float edge, patch_set *p) {
    const uint32_t count = p->cells.count;
    parting s = {.in = in,
                 .p = p,
                 .edge = edge,
                 .found = malloc((count + 1u) * sizeof *s.found),
                 .is = malloc((count + 1u) * sizeof *s.is)};
    p->part_of = malloc((count + 1u) * sizeof *p->part_of);
    bool fine = s.found && s.is && p->part_of;
    if (fine) {
        parallel_for(in->threads, count, find_part, &s);
        for (uint32_t i = 0; i < count; i++)
            p->part_of[i] = s.is[i] ? p->part_count++ : VIT_NONE;
        p->parts = malloc((p->part_count + 1u) * sizeof *p->parts);
        fine = p->parts != NULL;
        for (uint32_t i = 0; i < count && fine; i++)
            if (s.is[i])
                p->parts[p->part_of[i]] = (patch_part){.apart = s.found[i], .patch = {VIT_NONE, VIT_NONE}};
    }
    free(s.found);
    free(s.is);
    return fine;
}

/* A place of the cell in this part, and if there is one a place that others see. */
static vec3 place_in(const patches_input *in, const patch_set *p, uint32_t cell, uint32_t part, float lift) {
    const separation *s = &p->parts[p->part_of[cell]].apart;
    const uint32_t side = p->cells.side_of[cell], own = part == 0 ? s->places : ~s->places,
                   all = own & ((1u << SEPARATION_PLACES) - 1u), among = all & ~s->alone ? all & ~s->alone : all;
    const cell_corners k = cells_corners(&p->cells, cell);
    float b1, b2;
    separation_place(&k, among ? (uint32_t)__builtin_ctz(among) : 0, &b1, &b2);
    return vec3_along(side_place(in->geometry, side, b1, b2), side_face(in->geometry, side), lift);
}

/* Cells that have a patch, along x: what is nearest lies about its place in this list. */
typedef struct centre {
    vec3 at;
    uint32_t cell;
} centre;

typedef struct placing {
    const patches_input *in;
    patch_set *p;
    centre *centres;
    uint32_t count;
    float lift;
} placing;

static int by_x(const void *a, const void *b) {
    const centre *x = a, *y = b;
    if (x->at.x < y->at.x || x->at.x > y->at.x)
        return x->at.x < y->at.x ? -1 : 1;
    return x->cell < y->cell ? -1 : x->cell > y->cell;
}

typedef struct near_cells {
    float distance2[NEAREST]; /* ascending */
    uint32_t cell[NEAREST], count;
} near_cells;

/* A cell that is turned away counts as farther off. */
static void offer(const placing *w, const centre *c, vec3 place, vec3 face, near_cells *n) {
    const vec3 way = vec3_sub(c->at, place);
    const float turn = 2.0f - vec3_dot(side_face(w->in->geometry, w->p->cells.side_of[c->cell]), face),
                d2 = vec3_dot(way, way) * turn * turn;
    if (turn > 1.5f || (n->count == NEAREST && d2 >= n->distance2[NEAREST - 1]))
        return;
    uint32_t at = n->count < NEAREST ? n->count++ : NEAREST - 1;
    for (; at > 0 && n->distance2[at - 1] > d2; at--) {
        n->distance2[at] = n->distance2[at - 1];
        n->cell[at] = n->cell[at - 1];
    }
    n->distance2[at] = d2;
    n->cell[at] = c->cell;
}

static bool may_be_near(const near_cells *n, float along) {
    return n->count < NEAREST || along * along < n->distance2[NEAREST - 1];
}

/* The patch of the nearest cell that faces the same way and can be seen from the place. */
static uint32_t patch_near(const placing *w, vec3 place, vec3 face) {
    uint32_t low = 0, high = w->count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (w->centres[middle].at.x < place.x)
            low = middle + 1;
        else
            high = middle;
    }
    near_cells n = {.count = 0};
    for (uint32_t up = low, down = low; up < w->count || down > 0;) {
        if (up < w->count && may_be_near(&n, w->centres[up].at.x - place.x))
            offer(w, &w->centres[up++], place, face, &n);
        else
            up = w->count;
        if (down > 0 && may_be_near(&n, w->centres[down - 1].at.x - place.x))
            offer(w, &w->centres[--down], place, face, &n);
        else
            down = 0;
    }
    for (uint32_t i = 0; i < n.count; i++) {
        const uint32_t side = w->p->cells.side_of[n.cell[i]];
        const vec3 to =
            vec3_along(cells_center(&w->p->cells, w->in->geometry, n.cell[i]), side_face(w->in->geometry, side), w->lift);
        if (separation_sees(w->in->rays, place, to))
            return w->p->patch_of[n.cell[i]];
    }
    return VIT_NONE;
}

static void place_part(void *user, uint32_t cell) {
    const placing *w = user;
    patch_set *p = w->p;
    if (p->part_of[cell] == VIT_NONE || p->patch_of[cell] == VIT_NONE)
        return;
    const vec3 face = side_face(w->in->geometry, p->cells.side_of[cell]);
    for (uint32_t part = 0; part < 2; part++)
        p->parts[p->part_of[cell]].patch[part] = patch_near(w, place_in(w->in, p, cell, part, w->lift), face);
}

bool patches_place_parts(const patches_input *in, float edge, patch_set *p) {
    placing w = {.in = in, .p = p, .lift = lift_of(in, edge), .centres = malloc((p->cells.count + 1u) * sizeof *w.centres)};
    if (!w.centres)
        return false;
    for (uint32_t i = 0; i < p->cells.count; i++)
        if (p->patch_of[i] != VIT_NONE && p->part_of[i] == VIT_NONE)
            w.centres[w.count++] = (centre){cells_center(&p->cells, in->geometry, i), i};
    qsort(w.centres, w.count, sizeof *w.centres, by_x);
    parallel_for(in->threads, p->cells.count, place_part, &w);
    free(w.centres);
    return true;
}
