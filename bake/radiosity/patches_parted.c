#include "radiosity/patches_parted.h"
#include "common/parallel.h"
#include <stdlib.h>

#define SPLIT_LEAST 0.04f /* of a square of the edge: smaller cells are not looked at for what stands on them */
#define NEAREST 16u       /* cells that a part may belong to the patch of, if it sees them; */
#define FARTHEST 256u     /* if it sees none, four times as many are asked, and so on, where paths met it */
#define MET 4u            /* places of a part from which that is asked, at most */

typedef struct parting {
    const patches_input *in;
    const patch_set *p;
    float edge;
} parting;

static bool parted_cell(void *user, uint32_t cell, separation_cell *out) {
    const parting *s = user;
    const cells *c = &s->p->cells;
    *out = (separation_cell){c->side_of[cell], cells_corners(c, cell), separation_lift(s->in->rays, s->edge)};
    return cells_area(c, s->in->geometry, cell) > SPLIT_LEAST * s->edge * s->edge;
}

bool patches_find_parts(const patches_input *in, float edge, patch_set *p) {
    parting s = {in, p, edge};
    const separations_input parting_input = {.rays = in->rays,
                                             .geometry = in->geometry,
                                             .count = p->cells.count,
                                             .cell = parted_cell,
                                             .user = &s,
                                             .threads = in->threads};
    if (!separations_find(&parting_input, &p->apart))
        return false;
    p->beside = malloc((p->apart.count + 1u) * sizeof *p->beside);
    for (uint32_t i = 0; i < p->apart.count && p->beside; i++)
        p->beside[i][0] = p->beside[i][1] = VIT_NONE;
    return p->beside != NULL;
}

/* A place of the cell in this part, and if there is one a place that others see. */
static patch_point place_in(const patch_set *p, uint32_t cell, uint32_t part) {
    const uint32_t front = p->apart.found[p->apart.of[cell]].places, all = part == 0 ? front : ~front & SEPARATION_EVERYWHERE,
                   seen = all & ~p->apart.alone[cell], among = seen ? seen : all;
    const cell_corners k = cells_corners(&p->cells, cell);
    patch_point at = {.side = p->cells.side_of[cell]};
    separation_place(&k, among ? (uint32_t)__builtin_ctz(among) : 0, &at.b1, &at.b2);
    return at;
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
    patch_point (*met)[2][MET]; /* of what is parted: where paths met either part, */
    uint8_t (*met_count)[2];    /* so many */
} placing;

static int by_x(const void *a, const void *b) {
    const centre *x = a, *y = b;
    if (x->at.x < y->at.x || x->at.x > y->at.x)
        return x->at.x < y->at.x ? -1 : 1;
    return x->cell < y->cell ? -1 : x->cell > y->cell;
}

typedef struct near_cells {
    float distance2[FARTHEST]; /* ascending */
    uint32_t cell[FARTHEST], count;
    uint32_t most;
} near_cells;

/* A cell that is turned away counts as farther off. */
static void offer(const placing *w, const centre *c, vec3 place, vec3 face, near_cells *n) {
    const vec3 way = vec3_sub(c->at, place);
    const float turn = 2.0f - vec3_dot(side_face(w->in->geometry, w->p->cells.side_of[c->cell]), face),
                d2 = vec3_dot(way, way) * turn * turn;
    if (turn > 1.5f || (n->count == n->most && d2 >= n->distance2[n->most - 1]))
        return;
    uint32_t at = n->count < n->most ? n->count++ : n->most - 1;
    for (; at > 0 && n->distance2[at - 1] > d2; at--) {
        n->distance2[at] = n->distance2[at - 1];
        n->cell[at] = n->cell[at - 1];
    }
    n->distance2[at] = d2;
    n->cell[at] = c->cell;
}

static bool may_be_near(const near_cells *n, float along) {
    return n->count < n->most || along * along < n->distance2[n->most - 1];
}

/* The cells nearest to the place that face about the same way. */
static void find_near(const placing *w, vec3 place, vec3 face, near_cells *n) {
    uint32_t low = 0, high = w->count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (w->centres[middle].at.x < place.x)
            low = middle + 1;
        else
            high = middle;
    }
    n->count = 0;
    for (uint32_t up = low, down = low; up < w->count || down > 0;) {
        if (up < w->count && may_be_near(n, w->centres[up].at.x - place.x))
            offer(w, &w->centres[up++], place, face, n);
        else
            up = w->count;
        if (down > 0 && may_be_near(n, w->centres[down - 1].at.x - place.x))
            offer(w, &w->centres[--down], place, face, n);
        else
            down = 0;
    }
}

/* The patch of the nearest cell that faces the same way and can be seen from the place, of the `most` nearest. */
static uint32_t patch_near(const placing *w, const patch_point *at, uint32_t most) {
    const vec3 face = side_face(w->in->geometry, at->side),
               place = vec3_along(side_place(w->in->geometry, at->side, at->b1, at->b2), face, w->lift);
    near_cells n;
    uint32_t asked = 0;
    for (n.most = NEAREST; n.most <= most; n.most *= 4) {
        find_near(w, place, face, &n);
        for (; asked < n.count; asked++) {
            const uint32_t cell = n.cell[asked], side = w->p->cells.side_of[cell];
            const vec3 to =
                vec3_along(cells_center(&w->p->cells, w->in->geometry, cell), side_face(w->in->geometry, side), w->lift);
            if (separation_sees(w->in->rays, place, to))
                return w->p->patch_of[cell];
        }
        if (n.count < n.most)
            break;
    }
    return VIT_NONE;
}

static void place_part(void *user, uint32_t cell) {
    const placing *w = user;
    patch_set *p = w->p;
    const uint32_t apart = p->apart.of[cell];
    if (apart == VIT_NONE || p->patch_of[cell] == VIT_NONE)
        return;
    for (uint32_t part = 0; part < 2; part++) {
        uint32_t *to = &p->beside[apart][part];
        for (uint32_t i = 0; i < w->met_count[apart][part] && *to == VIT_NONE; i++)
            *to = patch_near(w, &w->met[apart][part][i], FARTHEST);
        if (w->met_count[apart][part] == 0) {
            const patch_point any = place_in(p, cell, part);
            *to = patch_near(w, &any, NEAREST);
        }
    }
}

/* The first places of each part that paths met. */
static void keep_met(const patches_met *m, placing *w) {
    for (size_t i = 0; i < m->count; i++) {
        const patch_point *at = m->places + i;
        const uint32_t cell = at->side == VIT_NONE ? VIT_NONE : cells_at(&w->p->cells, at->side, at->b1, at->b2),
                       apart = cell == VIT_NONE ? VIT_NONE : w->p->apart.of[cell];
        if (apart == VIT_NONE)
            continue;
        const bool back = !separations_front(&w->p->apart, cell, side_place(w->in->geometry, at->side, at->b1, at->b2));
        if (w->met_count[apart][back] < MET)
            w->met[apart][back][w->met_count[apart][back]++] = *at;
    }
}

bool patches_place_parts(const patches_input *in, const patches_met *m, float edge, patch_set *p) {
    placing w = {.in = in,
                 .p = p,
                 .lift = separation_lift(in->rays, edge),
                 .centres = malloc((p->cells.count + 1u) * sizeof *w.centres),
                 .met = malloc((p->apart.count + 1u) * sizeof *w.met),
                 .met_count = calloc(p->apart.count + 1u, sizeof *w.met_count)};
    const bool fine = w.centres && w.met && w.met_count;
    if (fine) {
        for (uint32_t i = 0; i < p->cells.count; i++)
            if (p->patch_of[i] != VIT_NONE && p->apart.of[i] == VIT_NONE)
                w.centres[w.count++] = (centre){cells_center(&p->cells, in->geometry, i), i};
        qsort(w.centres, w.count, sizeof *w.centres, by_x);
        keep_met(m, &w);
        parallel_for(in->threads, p->cells.count, place_part, &w);
    }
    free(w.centres);
    free(w.met);
    free(w.met_count);
    return fine;
}
