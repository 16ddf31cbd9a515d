#include "radiosity/receivers.h"
#include "common/fail.h"
#include "radiosity/receivers_parts.h"
#include <stdlib.h>
#include <string.h>

#define WELD 0.35f       /* of the spacing: corners closer than that, with like normals, share a receiver */
#define WELD_LEAST 0.08f /* likewise, at least */
#define NORMAL_STEPS 12  /* of the octahedral square each way, for like normals */
#define PULLED_IN 0.04f  /* of the way to the cell's middle: corners lie on edges, where others' surfaces begin */
#define REACH 0.5f       /* spacings: as near as that records say what light a receiver has */
#define HARDLY_SEEN 3.0f /* spacings: corners of cells that no ray of a camera met share receivers as near as that */
#define GROWTH 1.1f
#define SHRINKS 0.25f
#define ROUNDS 4       /* of growth, at most */
#define UNSEEN_PART 8u /* of the receivers wanted at most, for sides that no ray met */

static float cell_edge(void *user, uint32_t side) {
    const placing *p = user;
    return p->seen[side] ? p->spacing[side] : INFINITY;
}

/* 2. Corners of cells share receivers. */

static uint32_t new_receiver(placing *p, uint32_t side, float b1, float b2, float reach) {
    receivers *o = p->out;
    if (o->count == p->room) {
        const uint32_t room = p->room ? 2 * p->room : 4096;
        receiver *more = realloc(o->receivers, room * sizeof *more);
        if (!more) {
            p->failed = true;
            return 0;
        }
        o->receivers = more;
        p->room = room;
    }
    o->receivers[o->count] = (receiver){.side = side, .b1 = b1, .b2 = b2, .reach = reach};
    return o->count++;
}

static bool grow_table(placing *p) {
    const uint32_t slots = p->slots ? 2 * p->slots : 65536u;
    uint64_t *keys = malloc(slots * sizeof *keys);
    uint32_t *found = malloc(slots * sizeof *found);
    if (!keys || !found) {
        free(keys);
        free(found);
        return false;
    }
    memset(found, 0xff, slots * sizeof *found);
    for (uint32_t i = 0; i < p->slots; i++) {
        if (p->found[i] == VIT_NONE)
            continue;
        uint32_t at = (uint32_t)(p->keys[i] >> 32) & (slots - 1);
        while (found[at] != VIT_NONE)
            at = (at + 1) & (slots - 1);
        keys[at] = p->keys[i];
        found[at] = p->found[i];
    }
    free(p->keys);
    free(p->found);
    p->keys = keys;
    p->found = found;
    p->slots = slots;
    return true;
}

static uint64_t mixed(uint64_t h, uint32_t word) {
    h = (h ^ word) * 0x9e3779b97f4a7c15u;
    return h ^ h >> 29;
}

/* What gets a receiver at each of its corners: a cell, or a part of one. */
typedef struct cornered {
    uint32_t side;
    cell_corners at;
    float weld;          /* corners nearer to each other may be one, m */
    float reach;         /* receiver.reach */
    float lift;          /* how far above the surface places look at each other, m */
    bool seen;           /* or nothing need be looked at */
    bool only;           /* of its side */
    const uint32_t *own; /* a corner: the receiver that it has already, or VIT_NONE */
} cornered;

/* Edge of the cubes within which corners are one, m: WELD spacings where triangles are smaller than that; where they are larger
 * less than the height of a cell, so that no cell's corners fall together. */
static float weld_of(const placing *p, uint32_t side) {
    const geometry *g = p->in->geometry;
    const vit_triangle *t = g->triangles + side / 2;
    const vec3 a = vec3_load(t->v0), b = vec3_load(t->v1), c = vec3_load(t->v2);
    const vec3 e[3] = {vec3_sub(b, a), vec3_sub(c, b), vec3_sub(a, c)};
    const float longest = sqrtf(float_max(float_max(vec3_dot(e[0], e[0]), vec3_dot(e[1], e[1])), vec3_dot(e[2], e[2])));
    const float parts = (float)(p->cells.sides[side] >> VIT_SIDE_PARTS_SHIFT),
                high = 2.0f * side_area(g, side) / (longest * parts);
    const float all = p->spacing[side] * WELD;
    return longest < 0.5f * p->spacing[side] ? all : float_min(float_max(high * WELD, p->spacing[side] * WELD_LEAST), all);
}

/* Which corners are one: the cube that holds the place, and the square that holds the normal. Cubes' borders are where no
 * coordinate is that a person would choose. */
static uint64_t corner_key(const placing *p, const cornered *c, int corner) {
    const geometry *g = p->in->geometry;
    const vec3 at = side_place(g, c->side, c->at.b1[corner], c->at.b2[corner]),
               n = side_shading(g, c->side, c->at.b1[corner], c->at.b2[corner]);
    const double off = 0.3819660112501051;
    int level;
    float x, y;
    frexp((double)c->weld, &level);
    const double edge = ldexp(1.0, level - 1);
    octahedral_place(n, &x, &y);
    uint64_t h = mixed(0, (uint32_t)level);
    h = mixed(h, (uint32_t)(int64_t)floor((double)at.x / edge + off));
    h = mixed(h, (uint32_t)(int64_t)floor((double)at.y / edge + off));
    h = mixed(h, (uint32_t)(int64_t)floor((double)at.z / edge + off));
    h = mixed(h, (uint32_t)(int)floorf((x + 1.0f) * (0.5f * NORMAL_STEPS)) * 64u +
                     (uint32_t)(int)floorf((y + 1.0f) * (0.5f * NORMAL_STEPS)));
    return mixed(h, 1u);
}

static vec3 lifted(const placing *p, uint32_t side, float b1, float b2, float lift) {
    return vec3_along(side_place(p->in->geometry, side, b1, b2), side_face(p->in->geometry, side), lift);
}

/* Is there nothing right above the place, as something that is sunk into the surface? */
static bool is_open(const placing *p, uint32_t side, float b1, float b2, float lift) {
    const float offset = p->in->rays->s->ray_offset;
    return separation_sees(p->in->rays, lifted(p, side, b1, b2, offset), lifted(p, side, b1, b2, lift + offset));
}

/* The receiver of a corner: the one that is there already if it can be seen from the place, else a new one at the pulled-in
 * corner. */
static uint32_t corner_receiver(placing *p, const cornered *c, int corner, const float in[2], vec3 from) {
    uint32_t known = c->own ? c->own[corner] : VIT_NONE, at = 0;
    if (p->failed || (p->out->count * 2u >= p->slots && !grow_table(p))) {
        p->failed = true;
        return 0;
    }
    if (known == VIT_NONE) {
        const uint64_t key = corner_key(p, c, corner);
        at = (uint32_t)(key >> 32) & (p->slots - 1);
        while (p->found[at] != VIT_NONE && p->keys[at] != key)
            at = (at + 1) & (p->slots - 1);
        if (p->found[at] == VIT_NONE) {
            p->keys[at] = key;
            return p->found[at] = new_receiver(p, c->side, in[0], in[1], c->reach);
        }
        known = p->found[at];
    }
    const receiver *r = p->out->receivers + known;
    if (!c->seen || !p->met[c->side] || separation_sees(p->in->rays, from, lifted(p, r->side, r->b1, r->b2, c->lift)))
        return known;
    return new_receiver(p, c->side, in[0], in[1], c->reach);
}

/* 3. What stands on a cell. */

static float lift_of(const placing *p, uint32_t side, uint32_t parts) {
    return separation_lift(p->in->rays, p->spacing[side] / (float)parts);
}

static bool parted_cell(void *user, uint32_t cell, separation_cell *out) {
    const placing *p = user;
    const uint32_t side = p->cells.side_of[cell];
    *out = (separation_cell){side, cells_corners(&p->cells, cell), lift_of(p, side, 1)};
    return p->met[side] && p->looked_at[cell];
}

static bool parted_part(void *user, uint32_t part, separation_cell *out) {
    const placing *p = user;
    const receiver_piece *piece = p->pieces + p->end + part;
    *out = (separation_cell){piece->side, piece->at, lift_of(p, piece->side, piece->finer)};
    return true;
}

static bool find_parted(placing *p, uint32_t count, bool (*cell)(void *, uint32_t, separation_cell *), separations *out) {
    const separations_input in = {
        .rays = p->in->rays, .geometry = p->in->geometry, .count = count, .cell = cell, .user = p, .threads = p->in->threads};
    return separations_find(&in, out);
}

/* The place of those in `places` that is nearest to a corner; or the cell's middle. */
static void place_for(const placing *p, const cornered *c, int corner, uint32_t places, float out[2]) {
    const cell_corners *k = &c->at;
    const vec3 want = side_place(p->in->geometry, c->side, k->b1[corner], k->b2[corner]);
    float least = INFINITY;
    out[0] = (k->b1[0] + k->b1[1] + k->b1[2]) / 3.0f;
    out[1] = (k->b2[0] + k->b2[1] + k->b2[2]) / 3.0f;
    for (uint32_t i = 0; i < SEPARATION_PLACES; i++) {
        float u, v;
        if (!(places >> i & 1))
            continue;
        separation_place(k, i, &u, &v);
        const vec3 way = vec3_sub(side_place(p->in->geometry, c->side, u, v), want);
        const float d2 = vec3_dot(way, way);
        if (d2 < least) {
            least = d2;
            out[0] = u;
            out[1] = v;
        }
    }
}

/* Receivers of the part that holds `places`: a corner's own if the places see it, else one at the place that is nearest to the
 * corner. */
static void take_corners(placing *p, const cornered *c, uint32_t places, vit_u32 out[3]) {
    const cell_corners *k = &c->at;
    const float m1 = (k->b1[0] + k->b1[1] + k->b1[2]) / 3.0f, m2 = (k->b2[0] + k->b2[1] + k->b2[2]) / 3.0f;
    for (int i = 0; i < 3; i++) {
        const float in[2] = {k->b1[i] + (m1 - k->b1[i]) * PULLED_IN, k->b2[i] + (m2 - k->b2[i]) * PULLED_IN};
        float at[2] = {p->at[c->side][0], p->at[c->side][1]}; /* of an only cell the place that a camera sees */
        if (!c->seen || !c->only)
            place_for(p, c, i, places, at);
        const vec3 from = lifted(p, c->side, at[0], at[1], c->lift);
        if (!c->seen || (separation_sees(p->in->rays, from, lifted(p, c->side, in[0], in[1], c->lift)) &&
                         is_open(p, c->side, in[0], in[1], c->lift)))
            out[i] = corner_receiver(p, c, i, in, from);
        else
            out[i] = new_receiver(p, c->side, at[0], at[1], c->reach);
    }
}

static bool make_room_for_split(placing *p) {
    receivers *o = p->out;
    if (o->split_count < p->split_room)
        return true;
    const uint32_t room = p->split_room ? 2 * p->split_room : 256;
    vit_receiver_split *more = realloc(o->splits, room * sizeof *more);
    if (!more)
        return false;
    o->splits = more;
    p->split_room = room;
    return true;
}

/* Both readings of a cell, or of a part of one; which of those that were looked at. */
static bool take(placing *p, const cornered *c, const separations *s, uint32_t which, vit_receiver_cell *out) {
    receivers *o = p->out;
    const separation *apart = s->of[which] == VIT_NONE ? NULL : s->found + s->of[which];
    const uint32_t alone = s->alone[which], buried = s->buried[which], front = apart ? apart->places : SEPARATION_EVERYWHERE,
                   back = SEPARATION_EVERYWHERE & ~front;
    out->split = VIT_NONE;
    /* Where all places are inside of something, what there is outside of it is narrow: it is lit as the rest. */
    if (apart && (!(front & ~buried) || !(back & ~buried))) {
        const uint32_t open = front & ~buried ? front : back;
        take_corners(p, c, open & ~alone ? open & ~alone : open, out->receiver);
        return !p->failed;
    }
    take_corners(p, c, front & ~alone ? front & ~alone : front, out->receiver);
    if (!apart)
        return !p->failed;
    if (!make_room_for_split(p))
        return false;
    vit_receiver_split *t = o->splits + o->split_count;
    *t = (vit_receiver_split){.offset = apart->offset};
    memcpy(t->normal, apart->normal, sizeof t->normal);
    take_corners(p, c, back & ~alone ? back & ~alone : back, t->receiver);
    out->split = o->split_count++;
    return !p->failed;
}

static bool take_cell(placing *p, const separations *s, uint32_t cell) {
    const uint32_t side = p->cells.side_of[cell];
    const float weld = p->looked_at[cell] ? weld_of(p, side) : float_min(p->spacing[side] * HARDLY_SEEN, p->unseen);
    const bool hardly = !p->looked_at[cell] || !p->met[side];
    const float reach = p->spacing[side] * (hardly ? HARDLY_SEEN : REACH);
    const cornered c = {.side = side,
                        .at = cells_corners(&p->cells, cell),
                        .weld = p->seen[side] ? weld : p->unseen,
                        .reach = p->seen[side] ? reach : p->unseen,
                        .lift = lift_of(p, side, 1),
                        .seen = p->seen[side],
                        .only = p->cells.sides[side] >> VIT_SIDE_PARTS_SHIFT == 1};
    return take(p, &c, s, cell, p->out->cells + cell);
}

/* Parts have the piece's own receivers at its corners, and share those between them, and with neighbours' parts. */
static bool take_parts(placing *p, const separations *s, uint32_t piece) {
    const receiver_piece *of = p->pieces + piece;
    vit_receiver_cell *whole = p->out->cells + piece;
    uint32_t node[RECEIVER_NODES][RECEIVER_NODES], own[3];
    memset(node, 0xff, sizeof node);
    node[0][0] = whole->receiver[0];
    node[of->parts][0] = whole->receiver[1];
    node[0][of->parts] = whole->receiver[2];
    cornered c = {.side = of->side,
                  .weld = p->spacing[of->side] * (WELD / (float)(VIT_RECEIVER_PARTS * VIT_RECEIVER_PARTS)), /* at any level */
                  .lift = lift_of(p, of->side, of->finer * of->parts),
                  .seen = true,
                  .own = own};
    bool fine = true;
    for (uint32_t k = 0; k < of->parts * of->parts && fine; k++) {
        uint32_t i[3], j[3];
        vit_receiver_cell *out = p->out->cells + of->first + k;
        c.at = p->pieces[of->first + k].at;
        cells_nodes(of->parts, k, i, j);
        for (int n = 0; n < 3; n++)
            own[n] = node[i[n]][j[n]];
        fine = take(p, &c, s, of->first + k - p->end, out);
        for (int n = 0; n < 3; n++)
            if (node[i[n]][j[n]] == VIT_NONE)
                node[i[n]][j[n]] = out->receiver[n];
    }
    fine = fine && receivers_hang(p, piece, node);
    *whole = (vit_receiver_cell){.receiver = {of->first, 0, 0}, .split = VIT_RECEIVER_DIVIDED | of->parts};
    return fine;
}

static bool take_cells(placing *p) {
    receivers *o = p->out;
    separations s = {0};
    bool fine = find_parted(p, p->cells.count, parted_cell, &s);
    if (fine)
        o->cells = calloc((size_t)p->cells.count + 1u, sizeof *o->cells);
    fine = fine && o->cells;
    for (uint32_t i = 0; i < p->cells.count && fine; i++)
        fine = !(p->spacing[p->cells.side_of[i]] > 0.0f) || take_cell(p, &s, i);
    separations_free(&s);
    return fine;
}

/* Of pieces that may be divided now those within which light changes much. */
static bool divide_pieces(placing *p, const float *irradiance, const float *noise) {
    receivers *o = p->out;
    separations s = {0};
    bool fine = receivers_find_parts(p, irradiance, noise) && receivers_find_edges(p) &&
                find_parted(p, p->piece_count - p->end, parted_part, &s);
    vit_receiver_cell *more = fine ? realloc(o->cells, (p->piece_count + 1u) * sizeof *more) : NULL;
    if (more)
        o->cells = more;
    fine = fine && more;
    for (uint32_t i = p->begin; i < p->end && fine; i++)
        fine = p->pieces[i].parts == 1 || take_parts(p, &s, i);
    separations_free(&s);
    p->begin = p->end;
    p->end = p->piece_count;
    return fine;
}

/* Light of all, and where it is not known. */
static vit_status look_last(placing *p, vit_text *why) {
    const receivers_input *in = p->in;
    receivers *o = p->out;
    o->irradiance = malloc(((size_t)o->count * in->columns + 1u) * sizeof *o->irradiance);
    vit_status status = o->irradiance ? in->look(in->user, o, o->irradiance, NULL, why)
                                      : bake_fail(why, VIT_FAILED, "receivers: out of memory");
    if (status == VIT_OK)
        receivers_find_unknown(p, o->irradiance);
    return status;
}

/* Corners of pieces that may be divided now, and those that they follow. */
static void ask(placing *p) {
    receivers *o = p->out;
    for (uint32_t i = 0; i < o->count; i++)
        o->receivers[i].asked = p->begin == 0 || p->in->light;
    for (uint32_t i = p->begin; i < p->end; i++)
        for (int k = 0; k < 3 && p->spacing[p->pieces[i].side] > 0.0f; k++)
            o->receivers[o->cells[i].receiver[k]].asked = true;
    for (uint32_t i = o->follower_count; i-- > 0;)
        for (uint32_t k = 0; k < RECEIVER_FROM && o->receivers[o->followers[i].receiver].asked; k++)
            o->receivers[o->followers[i].from[k]].asked = true;
}

/* Light at a first look says which, at another which of their parts. */
static vit_status divide(placing *p, vit_text *why) {
    const receivers_input *in = p->in;
    vit_status status = VIT_OK;
    if (!receivers_start_pieces(p) || (in->look && !receivers_find_records(p)))
        status = bake_fail(why, VIT_FAILED, "receivers: out of memory");
    for (int level = 0; level < VIT_RECEIVER_LEVELS && in->look && status == VIT_OK && p->begin < p->end; level++) {
        float *irradiance = malloc(((size_t)p->out->count * in->columns + 1u) * sizeof *irradiance),
              *noise = malloc((p->out->count + 1u) * sizeof *noise);
        ask(p);
        p->out->cell_count = p->end;
        status = irradiance && noise ? in->look(in->user, p->out, irradiance, noise, why)
                                     : bake_fail(why, VIT_FAILED, "receivers: out of memory");
        if (status == VIT_OK && !divide_pieces(p, irradiance, noise))
            status = bake_fail(why, VIT_FAILED, "receivers: out of memory");
        free(irradiance);
        free(noise);
    }
    return status == VIT_OK && in->light ? look_last(p, why) : status;
}

/* Dark sides have no cells of their own: any will do. */
static void drop_dark(placing *p) {
    receivers *o = p->out;
    o->sides = p->cells.sides;
    o->cell_count = 0;
    for (uint32_t i = 0; i < 2 * p->in->rays->s->triangle_count; i++) {
        const uint32_t parts = o->sides[i] >> VIT_SIDE_PARTS_SHIFT, first = o->sides[i] & VIT_SIDE_CELL;
        const bool dark = !(p->spacing[i] > 0.0f);
        o->sides[i] = dark ? 1u << VIT_SIDE_PARTS_SHIFT : parts << VIT_SIDE_PARTS_SHIFT | o->cell_count;
        for (uint32_t k = 0; !dark && k < parts * parts; k++)
            o->cells[o->cell_count++] = o->cells[first + k];
    }
    const uint32_t dropped = p->cells.count - o->cell_count, parts = p->piece_count - p->cells.count;
    memmove(o->cells + o->cell_count, o->cells + p->cells.count, parts * sizeof *o->cells);
    o->cell_count += parts;
    for (uint32_t i = 0; i < o->cell_count; i++)
        if (VIT_RECEIVER_IS_DIVIDED(o->cells[i].split) && o->cells[i].split != VIT_RECEIVER_BY_RAYS)
            o->cells[i].receiver[0] -= dropped;
}

/* What depends on the spacing. */
static void drop_cells(placing *p) {
    free(p->keys);
    free(p->found);
    free(p->looked_at);
    free(p->pieces);
    free(p->edges);
    free(p->edge_parts);
    p->keys = p->edges = NULL;
    p->found = NULL;
    p->pieces = NULL;
    p->looked_at = NULL;
    p->edge_parts = NULL;
    p->slots = p->room = p->split_room = p->follower_room = 0;
    cells_free(&p->cells);
}

/* For another round with another spacing. */
static void start_anew(placing *p) {
    const uint32_t lit = p->out->lit_sides, seen = p->out->seen_sides;
    drop_cells(p);
    receivers_free(p->out);
    p->out->lit_sides = lit;
    p->out->seen_sides = seen;
}

/* 4. As many as are wanted: the spacing shrinks once, or grows until they are, or has grown often enough. */
static vit_status place_all(placing *p, vit_text *why) {
    const receivers_input *in = p->in;
    for (int round = 0;; round++) {
        const vit_status status = cells_divide(in->geometry, in->rays->s->triangle_count, cell_edge, p, &p->cells, why);
        if (status != VIT_OK)
            return status;
        if (!receivers_find_looked_at(p) || !take_cells(p))
            return bake_fail(why, VIT_FAILED, "receivers: out of memory");
        uint32_t unseen = 0;
        for (uint32_t i = 0; i < p->out->count; i++)
            unseen += !p->seen[p->out->receivers[i].side];
        const uint32_t seen = p->out->count - unseen;
        const bool fewer_seen = seen > in->most, fewer_unseen = unseen > in->most / UNSEEN_PART;
        const bool more_seen = round == 0 && seen < in->least;
        if (!(fewer_seen || fewer_unseen || more_seen) || round == ROUNDS)
            return VIT_OK;
        const float more = fewer_seen  ? float_max(sqrtf((float)seen / (float)in->most) * 1.05f, GROWTH)
                           : more_seen ? float_max(sqrtf((float)seen / (float)in->least), SHRINKS)
                                       : 1.0f;
        p->finest *= more;
        p->unseen *= fewer_unseen ? 4.0f : 1.0f;
        for (uint32_t i = 0; i < 2 * in->rays->s->triangle_count; i++)
            if (p->spacing[i] > 0.0f)
                p->spacing[i] = p->seen[i] ? p->spacing[i] * more : p->unseen;
        start_anew(p);
    }
}

vit_status receivers_place(const receivers_input *in, receivers *out, vit_text *why) {
    *out = (receivers){0};
    placing p = {.in = in, .out = out, .finest = 4.0f * in->spacing};
    vit_status status = VIT_FAILED;
    if (receivers_find_spacing(&p))
        status = place_all(&p, why);
    else
        bake_fail(why, VIT_FAILED, "receivers: out of memory");
    if (status == VIT_OK)
        status = divide(&p, why);
    for (uint32_t i = 0; i < out->count; i++)
        out->receivers[i].asked = true;
    if (status == VIT_OK) {
        drop_dark(&p);
        out->side_count = 2 * in->rays->s->triangle_count;
        p.cells.sides = NULL;
    }
    free(p.spacing);
    free(p.seen);
    free(p.met);
    free(p.at);
    free(p.sights);
    drop_cells(&p);
    if (status != VIT_OK)
        receivers_free(out);
    return status;
}
