#include "radiosity/receivers.h"
#include "common/fail.h"
#include "common/parallel.h"
#include "radiosity/gather.h"
#include "radiosity/separation.h"
#include <stdlib.h>
#include <string.h>

#define FRAMES_LOOKED_AT 48u /* of the path, at most */
#define RAYS 6e6             /* from the cameras, over all of these; at most one a pixel */
#define UNSEEN_APART 0.02f   /* of the scene's size: receivers of sides that no ray met, should they be seen after all */
#define WELD 0.35f           /* of the spacing: corners closer than that, with like normals, share a receiver */
#define WELD_LEAST 0.08f     /* likewise, at least */
#define NORMAL_STEPS 12      /* of the octahedral square each way, for like normals */
#define PULLED_IN 0.04f      /* of the way to the cell's middle: corners lie on edges, where others' surfaces begin */
#define LIFT 0.04f           /* of the spacing: how far above the surface places look at each other */
#define GROWTH 1.1f
#define ROUNDS 4       /* of growth, at most */
#define UNSEEN_PART 8u /* of the receivers wanted at most, for sides that no ray met */

typedef struct placing {
    const receivers_input *in;
    receivers *out;
    float *spacing; /* a side, m; 0: it is dark, or no light stays on it */
    bool *seen;     /* a side: by the cameras' rays, or beside one that they met */
    bool *met;      /* a side: by the cameras' rays */
    float *lift;    /* a side: how far above it places look at each other, m */
    float (*at)[2]; /* a seen side: where the nearest of them met it, barycentric weights */
    float unseen;   /* spacing of the others, m */
    uint32_t step;  /* pixels between the cameras' rays, each way */
    cells cells;
    uint32_t room, split_room;
    uint64_t *keys; /* a hash table of welded corners */
    uint32_t *found;
    uint32_t slots; /* of the table, a power of two */
    bool failed;
} placing;

/* 1. How far apart a side's receivers are. */

static float pixel_angle(const vit_camera *c) {
    const vec3 right = vec3_load(c->right);
    return sqrtf(vec3_dot(right, right));
}

typedef struct looking {
    const placing *p;
    uint32_t frame;
    uint32_t across;
    gather_hit *hit;
} looking;

static void look_row(void *user, uint32_t row) {
    const looking *l = user;
    const receivers_input *in = l->p->in;
    const vit_camera *c = in->tracks->cameras + l->frame;
    for (uint32_t i = 0; i < l->across; i++) {
        const uint32_t chance = pcg(row * l->across + i + pcg(l->frame));
        const bool all = l->p->step == 1; /* then as the frame's own */
        const float x = ((float)i + (all ? 0.5f : unit_float(chance))) * (float)l->p->step,
                    y = ((float)row + (all ? 0.5f : unit_float(pcg(chance)))) * (float)l->p->step;
        const vec3 d = vec3_unit(vec3_along(vec3_along(vec3_load(c->corner), vec3_load(c->right), x), vec3_load(c->down), y));
        l->hit[(size_t)row * l->across + i] = gather(in->rays, in->geometry, vec3_load(c->eye), d, pcg(chance ^ 1u));
    }
}

static bool takes_light(const receivers_input *in, uint32_t side) {
    return !side_is_dark(in->geometry, side) && gather_is_matt(in->rays->s, side / 2);
}

static uint32_t vertex_slot(const float v[3], uint32_t slots) {
    uint32_t word[3];
    memcpy(word, v, sizeof word);
    return pcg(word[0] ^ pcg(word[1] ^ pcg(word[2]))) & (slots - 1);
}

static bool faces_camera(const placing *p, uint32_t side, uint32_t frames) {
    const vec3 middle = side_place(p->in->geometry, side, 1.0f / 3.0f, 1.0f / 3.0f), face = side_face(p->in->geometry, side);
    for (uint32_t f = 0; f < frames; f++) {
        const vit_camera *c = p->in->tracks->cameras + (uint64_t)f * p->in->frames / frames;
        if (vec3_dot(face, vec3_sub(vec3_load(c->eye), middle)) > 0.0f)
            return true;
    }
    return false;
}

/* Small triangles may lie between the cameras' rays: sides that face a camera beside seen ones count as seen. A table of the
 * seen ones' vertices has what spacing they have; vertices that fall together there by chance do no harm. False: out of
 * memory. */
static bool spread_seen(placing *p, uint32_t frames) {
    const receivers_input *in = p->in;
    const uint32_t triangles = in->rays->s->triangle_count;
    uint32_t slots = 4096;
    while (slots < triangles * 4u && slots < 1u << 28)
        slots *= 2;
    float *least = malloc(slots * sizeof *least);
    if (!least)
        return false;
    for (uint32_t i = 0; i < slots; i++)
        least[i] = INFINITY;
    for (uint32_t i = 0; i < 2 * triangles; i++) {
        const vit_triangle *t = in->geometry->triangles + i / 2;
        const float *v[3] = {t->v0, t->v1, t->v2};
        for (int k = 0; k < 3 && p->seen[i]; k++) {
            float *at = least + vertex_slot(v[k], slots);
            *at = float_min(*at, p->spacing[i]);
        }
    }
    for (uint32_t i = 0; i < 2 * triangles; i++) {
        const vit_triangle *t = in->geometry->triangles + i / 2;
        if (p->seen[i] || !takes_light(in, i))
            continue;
        const float spacing = float_min(least[vertex_slot(t->v0, slots)],
                                        float_min(least[vertex_slot(t->v1, slots)], least[vertex_slot(t->v2, slots)]));
        if (!(spacing < INFINITY) || !faces_camera(p, i, frames))
            continue;
        p->seen[i] = true;
        p->spacing[i] = spacing;
        p->at[i][0] = p->at[i][1] = 1.0f / 3.0f;
    }
    free(least);
    return true;
}

/* False: out of memory. */
static bool find_spacing(placing *p) {
    const receivers_input *in = p->in;
    const uint32_t sides = 2 * in->rays->s->triangle_count,
                   frames = in->frames < FRAMES_LOOKED_AT ? in->frames : FRAMES_LOOKED_AT;
    p->step = (uint32_t)ceil(sqrt((double)in->width * in->height * frames / RAYS));
    looking l = {.p = p, .across = (in->width + p->step - 1) / p->step};
    const uint32_t down = (in->height + p->step - 1) / p->step;
    p->spacing = malloc(((size_t)sides + 1u) * sizeof *p->spacing);
    p->seen = calloc((size_t)sides + 1u, sizeof *p->seen);
    p->met = calloc((size_t)sides + 1u, sizeof *p->met);
    p->lift = malloc(((size_t)sides + 1u) * sizeof *p->lift);
    p->at = malloc(((size_t)sides + 1u) * sizeof *p->at);
    l.hit = malloc(((size_t)l.across * down + 1u) * sizeof *l.hit);
    if (!p->spacing || !p->seen || !p->at || !p->met || !p->lift || !l.hit) {
        free(l.hit);
        return false;
    }
    p->unseen = in->size * UNSEEN_APART;
    for (uint32_t i = 0; i < sides; i++)
        p->spacing[i] = INFINITY;
    for (uint32_t f = 0; f < frames; f++) {
        l.frame = (uint32_t)((uint64_t)f * in->frames / frames);
        const vit_camera *c = in->tracks->cameras + l.frame;
        parallel_for(in->threads, down, look_row, &l);
        for (size_t i = 0; i < (size_t)l.across * down; i++) {
            const gather_hit h = l.hit[i];
            if (h.side == VIT_NONE || !takes_light(in, h.side))
                continue;
            const vec3 way = vec3_sub(side_place(in->geometry, h.side, h.b1, h.b2), vec3_load(c->eye));
            const float wide = sqrtf(vec3_dot(way, way)) * pixel_angle(c) * in->spacing;
            if (wide < p->spacing[h.side]) {
                p->spacing[h.side] = float_max(wide, in->rays->s->ray_offset * 8.0f);
                p->at[h.side][0] = h.b1;
                p->at[h.side][1] = h.b2;
            }
            p->seen[h.side] = p->met[h.side] = true;
        }
    }
    free(l.hit);
    if ((p->step > 1 || frames < in->frames || in->within) && !spread_seen(p, frames))
        return false;
    for (uint32_t i = 0; i < sides; i++) {
        const bool takes = takes_light(in, i);
        p->out->lit_sides += takes;
        p->out->seen_sides += p->seen[i];
        p->spacing[i] = p->seen[i] ? p->spacing[i] : takes ? p->unseen : 0.0f;
        p->lift[i] = float_max(p->spacing[i] * LIFT, 2.0f * in->rays->s->ray_offset);
    }
    return true;
}

static float cell_edge(void *user, uint32_t side) {
    const placing *p = user;
    return p->seen[side] ? p->spacing[side] : INFINITY;
}

/* 2. Corners of cells share receivers. */

static uint32_t new_receiver(placing *p, uint32_t side, float b1, float b2) {
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
    o->receivers[o->count] = (receiver){side, b1, b2};
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

/* Which corners are one: the cube that holds the place, and the square that holds the normal. */
static uint64_t corner_key(const placing *p, uint32_t side, float b1, float b2) {
    const geometry *g = p->in->geometry;
    const vec3 at = side_place(g, side, b1, b2), n = side_shading(g, side, b1, b2);
    int level;
    float x, y;
    frexp((double)(p->seen[side] ? weld_of(p, side) : p->spacing[side]), &level);
    const double edge = ldexp(1.0, level - 1);
    octahedral_place(n, &x, &y);
    uint64_t h = mixed(0, (uint32_t)level);
    h = mixed(h, (uint32_t)(int64_t)floor((double)at.x / edge));
    h = mixed(h, (uint32_t)(int64_t)floor((double)at.y / edge));
    h = mixed(h, (uint32_t)(int64_t)floor((double)at.z / edge));
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
static uint32_t corner_receiver(placing *p, uint32_t side, float b1, float b2, float in1, float in2, vec3 from, float lift) {
    if (p->failed || (p->out->count * 2u >= p->slots && !grow_table(p))) {
        p->failed = true;
        return 0;
    }
    const uint64_t key = corner_key(p, side, b1, b2);
    uint32_t at = (uint32_t)(key >> 32) & (p->slots - 1);
    while (p->found[at] != VIT_NONE && p->keys[at] != key)
        at = (at + 1) & (p->slots - 1);
    if (p->found[at] == VIT_NONE) {
        p->keys[at] = key;
        return p->found[at] = new_receiver(p, side, in1, in2);
    }
    const receiver *r = p->out->receivers + p->found[at];
    if (!p->met[side] || separation_sees(p->in->rays, from, lifted(p, r->side, r->b1, r->b2, lift)))
        return p->found[at];
    return new_receiver(p, side, in1, in2);
}

/* 3. What stands on a cell. */

typedef struct parting {
    const placing *p;
    separation *found; /* a cell */
    bool *is;
    uint32_t first;
} parting;

static float lift_of(const placing *p, uint32_t side) {
    return p->lift[side];
}

static void find_parting(void *user, uint32_t item) {
    const parting *s = user;
    const placing *p = s->p;
    const uint32_t side = p->cells.side_of[item];
    const cell_corners k = cells_corners(&p->cells, item);
    s->found[item] = (separation){.places = (1u << SEPARATION_PLACES) - 1u};
    s->is[item] = p->met[side] && separation_find(p->in->rays, p->in->geometry, side, &k, lift_of(p, side), s->found + item);
}

/* The place of those in `places` that is nearest to a corner; or the cell's middle. */
static void place_for(const placing *p, uint32_t side, const cell_corners *k, int corner, uint32_t places, float *b1,
                      float *b2) {
    const vec3 want = side_place(p->in->geometry, side, k->b1[corner], k->b2[corner]);
    float least = INFINITY;
    *b1 = (k->b1[0] + k->b1[1] + k->b1[2]) / 3.0f;
    *b2 = (k->b2[0] + k->b2[1] + k->b2[2]) / 3.0f;
    for (uint32_t i = 0; i < SEPARATION_PLACES; i++) {
        float u, v;
        if (!(places >> i & 1))
            continue;
        separation_place(k, i, &u, &v);
        const vec3 way = vec3_sub(side_place(p->in->geometry, side, u, v), want);
        const float d2 = vec3_dot(way, way);
        if (d2 < least) {
            least = d2;
            *b1 = u;
            *b2 = v;
        }
    }
}

/* The receivers of a cell, or of the part of it that holds `places`: a corner's own if the places see it, else one at the
 * place that is nearest to the corner. */
static void take_corners(placing *p, uint32_t cell, uint32_t places, vit_u32 out[3]) {
    const uint32_t side = p->cells.side_of[cell];
    const cell_corners k = cells_corners(&p->cells, cell);
    const float m1 = (k.b1[0] + k.b1[1] + k.b1[2]) / 3.0f, m2 = (k.b2[0] + k.b2[1] + k.b2[2]) / 3.0f, lift = lift_of(p, side);
    for (int i = 0; i < 3; i++) {
        const float in1 = k.b1[i] + (m1 - k.b1[i]) * PULLED_IN, in2 = k.b2[i] + (m2 - k.b2[i]) * PULLED_IN;
        float b1 = p->at[side][0], b2 = p->at[side][1]; /* of a side of one cell the place that a camera sees */
        if (!p->seen[side] || p->cells.sides[side] >> VIT_SIDE_PARTS_SHIFT > 1)
            place_for(p, side, &k, i, places, &b1, &b2);
        const vec3 from = lifted(p, side, b1, b2, lift);
        if (!p->seen[side] ||
            (separation_sees(p->in->rays, from, lifted(p, side, in1, in2, lift)) && is_open(p, side, in1, in2, lift)))
            out[i] = corner_receiver(p, side, k.b1[i], k.b2[i], in1, in2, from, lift);
        else
            out[i] = new_receiver(p, side, b1, b2);
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

static bool take_cells(placing *p) {
    receivers *o = p->out;
    parting s = {.p = p};
    const uint32_t all = (1u << SEPARATION_PLACES) - 1u;
    s.found = malloc((p->cells.count + 1u) * sizeof *s.found);
    s.is = malloc((p->cells.count + 1u) * sizeof *s.is);
    o->cells = malloc((p->cells.count + 1u) * sizeof *o->cells);
    bool fine = s.found && s.is && o->cells;
    if (fine)
        parallel_for(p->in->threads, p->cells.count, find_parting, &s);
    for (uint32_t i = 0; i < p->cells.count && fine; i++) {
        vit_receiver_cell *c = o->cells + i;
        *c = (vit_receiver_cell){.receiver = {0, 0, 0}, .split = VIT_NONE};
        if (!(p->spacing[p->cells.side_of[i]] > 0.0f))
            continue;
        const separation *apart = s.found + i;
        take_corners(p, i, apart->places & ~apart->alone ? apart->places & ~apart->alone : apart->places, c->receiver);
        if (s.is[i] && make_room_for_split(p)) {
            vit_receiver_split *t = o->splits + o->split_count;
            *t = (vit_receiver_split){.offset = apart->offset};
            memcpy(t->normal, apart->normal, sizeof t->normal);
            const uint32_t behind = all & ~apart->places;
            take_corners(p, i, behind & ~apart->alone ? behind & ~apart->alone : behind, t->receiver);
            c->split = o->split_count++;
        }
        fine = !p->failed;
    }
    free(s.found);
    free(s.is);
    return fine;
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
}

/* For another round with another spacing. */
static void start_anew(placing *p) {
    const uint32_t lit = p->out->lit_sides, seen = p->out->seen_sides;
    free(p->keys);
    free(p->found);
    p->keys = NULL;
    p->found = NULL;
    p->slots = p->room = p->split_room = 0;
    cells_free(&p->cells);
    receivers_free(p->out);
    p->out->lit_sides = lit;
    p->out->seen_sides = seen;
}

/* 4. As many as are wanted: the spacing grows until they are, or has grown often enough. */
static vit_status place_all(placing *p, vit_text *why) {
    const receivers_input *in = p->in;
    for (int round = 0;; round++) {
        const vit_status status = cells_divide(in->geometry, in->rays->s->triangle_count, cell_edge, p, &p->cells, why);
        if (status != VIT_OK)
            return status;
        if (!take_cells(p))
            return bake_fail(why, VIT_FAILED, "receivers: out of memory");
        uint32_t unseen = 0;
        for (uint32_t i = 0; i < p->out->count; i++)
            unseen += !p->seen[p->out->receivers[i].side];
        const uint32_t seen = p->out->count - unseen;
        const bool fewer_seen = seen > in->most, fewer_unseen = unseen > in->most / UNSEEN_PART;
        if (!(fewer_seen || fewer_unseen) || round == ROUNDS)
            return VIT_OK;
        const float more = fewer_seen ? float_max(sqrtf((float)seen / (float)in->most) * 1.05f, GROWTH) : 1.0f;
        p->unseen *= fewer_unseen ? 4.0f : 1.0f;
        for (uint32_t i = 0; i < 2 * in->rays->s->triangle_count; i++)
            if (p->spacing[i] > 0.0f)
                p->spacing[i] = p->seen[i] ? p->spacing[i] * more : p->unseen;
        start_anew(p);
    }
}

vit_status receivers_place(const receivers_input *in, receivers *out, vit_text *why) {
    *out = (receivers){0};
    placing p = {.in = in, .out = out};
    vit_status status = VIT_FAILED;
    if (find_spacing(&p))
        status = place_all(&p, why);
    else
        bake_fail(why, VIT_FAILED, "receivers: out of memory");
    if (status == VIT_OK) {
        drop_dark(&p);
        out->side_count = 2 * in->rays->s->triangle_count;
        p.cells.sides = NULL;
    }
    free(p.spacing);
    free(p.seen);
    free(p.met);
    free(p.lift);
    free(p.at);
    free(p.keys);
    free(p.found);
    cells_free(&p.cells);
    if (status != VIT_OK)
        receivers_free(out);
    return status;
}

void receivers_free(receivers *r) {
    free(r->sides);
    free(r->cells);
    free(r->splits);
    free(r->receivers);
    *r = (receivers){0};
}
