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
    s->is[cell] = cells_area(&s->p->cells, s->in->geometry, cell) > SPLIT_LEAST * s->edge * s->edge &&
                  separation_find(s->in->rays, s->in->geometry, s->p->cells.side_of[cell], &k, lift_of(s->in, s->edge),
                                  s->found + cell);
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

typedef struct near_cell {
    float distance2;
    uint32_t cell;
} near_cell;

/* The patch of the nearest cell that faces the same way, can be seen from the place, and has a patch. */
static uint32_t patch_near(const patches_input *in, const patch_set *p, vec3 place, vec3 face, float lift) {
    near_cell near[NEAREST];
    uint32_t count = 0;
    for (uint32_t i = 0; i < p->cells.count; i++) {
        if (p->patch_of[i] == VIT_NONE || p->part_of[i] != VIT_NONE)
            continue;
        const vec3 way = vec3_sub(cells_center(&p->cells, in->geometry, i), place);
        const float turn = 2.0f - vec3_dot(side_face(in->geometry, p->cells.side_of[i]), face),
                    d2 = vec3_dot(way, way) * turn * turn;
        if (turn > 1.5f || (count == NEAREST && d2 >= near[NEAREST - 1].distance2))
            continue;
        uint32_t at = count < NEAREST ? count++ : NEAREST - 1;
        for (; at > 0 && near[at - 1].distance2 > d2; at--)
            near[at] = near[at - 1];
        near[at] = (near_cell){d2, i};
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t side = p->cells.side_of[near[i].cell];
        const vec3 to =
            vec3_along(cells_center(&p->cells, in->geometry, near[i].cell), side_face(in->geometry, side), lift);
        if (separation_sees(in->rays, place, to))
            return p->patch_of[near[i].cell];
    }
    return VIT_NONE;
}

static void place_part(void *user, uint32_t cell) {
    const parting *s = user;
    patch_set *p = s->p;
    if (p->part_of[cell] == VIT_NONE || p->patch_of[cell] == VIT_NONE)
        return;
    const vec3 face = side_face(s->in->geometry, p->cells.side_of[cell]);
    const float lift = lift_of(s->in, s->edge);
    for (uint32_t part = 0; part < 2; part++)
        p->parts[p->part_of[cell]].patch[part] =
            patch_near(s->in, p, place_in(s->in, p, cell, part, lift), face, lift);
}

void patches_place_parts(const patches_input *in, float edge, patch_set *p) {
    parting s = {.in = in, .p = p, .edge = edge};
    parallel_for(in->threads, p->cells.count, place_part, &s);
}
