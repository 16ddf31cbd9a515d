#include "common/parallel.h"
#include "radiosity/gather.h"
#include "radiosity/transport_parts.h"
#include <stdlib.h>
#include <string.h>

#define PILOTS 262144u   /* paths that tell which sides' light matters */
#define PILOT_LEAST 4.0f /* hits of a side that are believed */
#define EDGE_RANGE 6.0f  /* cells' edges are at most so many times larger or smaller than if all were alike */
#define SPLIT_LEAST 0.2f /* cells much smaller than others are not looked at for what stands on them */
#define BATCH 1024u      /* rows between two times that their hits are noted */
#define CLOSE_BY 2.0f    /* squared distance over a cell's area */
#define LEAST_RAYS 8u    /* of a cell that light comes from */
#define MOST_RAYS 256u
#define GENERATIONS 3u /* of cells: those that receivers meet, that these meet, ... The last meet only what is known */

/* 1. Cells: small where much of the light comes from. */

typedef struct pilot {
    const transport *t;
    uint32_t *met; /* 2 per path: sides */
} pilot;

/* Sides that are thought dark may get some light all the same. */
static bool gives_light(const transport *t, uint32_t side) {
    return side_area(t->in->geometry, side) > 0.0f && gather_is_matt(t->in->rays->s, side / 2);
}

static vec3 leave(const transport *t, uint32_t side, float b1, float b2) {
    return vec3_along(side_place(t->in->geometry, side, b1, b2), side_face(t->in->geometry, side), t->in->rays->s->ray_offset);
}

static void pilot_path(void *user, uint32_t path) {
    const pilot *w = user;
    const transport_input *in = w->t->in;
    uint32_t chance = pcg(path);
    const receiver *r = in->receivers + chance % in->receiver_count;
    gather_hit at = {.side = r->side, .b1 = r->b1, .b2 = r->b2};
    w->met[2 * path] = w->met[2 * path + 1] = VIT_NONE;
    for (int k = 0; k < 2; k++) {
        const float u = unit_float(chance = pcg(chance)), v = unit_float(chance = pcg(chance));
        const vec3 o = leave(w->t, at.side, at.b1, at.b2);
        at = gather(in->rays, in->geometry, o, vec3_cosine(side_face(in->geometry, at.side), u, v), pcg(chance ^ 7u));
        if (at.side == VIT_NONE || !gives_light(w->t, at.side))
            return;
        w->met[2 * path + (uint32_t)k] = at.side;
    }
}

static float edge_of(void *user, uint32_t side) {
    const transport *t = user;
    return t->edge[side] > 0.0f ? t->edge[side] : INFINITY;
}

static bool find_edges(transport *t) {
    const uint32_t sides = 2 * t->in->rays->s->triangle_count;
    pilot w = {.t = t, .met = malloc(2u * PILOTS * sizeof *w.met)};
    t->edge = calloc(sides + 1u, sizeof *t->edge);
    if (!w.met || !t->edge) {
        free(w.met);
        return false;
    }
    if (t->in->receiver_count > 0)
        parallel_for(t->in->threads, PILOTS, pilot_path, &w);
    double hits = 0.0, area = 0.0;
    for (uint32_t i = 0; i < 2u * PILOTS && t->in->receiver_count > 0; i++)
        if (w.met[i] != VIT_NONE) {
            t->edge[w.met[i]] += 1.0f;
            hits += 1.0;
        }
    free(w.met);
    for (uint32_t i = 0; i < sides; i++)
        area += gives_light(t, i) && t->edge[i] > 0.0f ? (double)side_area(t->in->geometry, i) : 0.0;
    const double mean = area / t->in->cells; /* of a cell, m2 */
    const float alike = (float)sqrt(2.0 * mean);
    for (uint32_t i = 0; i < sides; i++) {
        const double met = (double)t->edge[i];
        float edge = alike;
        if (met >= (double)PILOT_LEAST)
            edge = (float)sqrt(2.0 * (double)side_area(t->in->geometry, i) * hits / (met * t->in->cells));
        edge = float_min(float_max(edge, alike / EDGE_RANGE), alike * EDGE_RANGE);
        t->edge[i] = gives_light(t, i) && alike > 0.0f ? edge : 0.0f;
    }
    return true;
}

static bool parted_cell(void *user, uint32_t cell, separation_cell *out) {
    const transport *t = user;
    const uint32_t side = t->cells.side_of[cell];
    const float edge = t->edge[side];
    *out = (separation_cell){side, cells_corners(&t->cells, cell), separation_lift(t->in->rays, edge)};
    return edge > 0.0f && cells_area(&t->cells, t->in->geometry, cell) > SPLIT_LEAST * SPLIT_LEAST * edge * edge;
}

static bool find_parted(transport *t) {
    const separations_input in = {.rays = t->in->rays,
                                  .geometry = t->in->geometry,
                                  .count = t->cells.count,
                                  .cell = parted_cell,
                                  .user = t,
                                  .threads = t->in->threads};
    return separations_find(&in, &t->apart);
}

bool transport_divide(transport *t, vit_text *why) {
    if (!find_edges(t) || cells_divide(t->in->geometry, t->in->rays->s->triangle_count, edge_of, t, &t->cells, why) != VIT_OK ||
        !find_parted(t))
        return false;
    t->number = malloc((SEPARATION_PARTS * (size_t)t->cells.count + 1u) * sizeof *t->number);
    if (!t->number)
        return false;
    memset(t->number, 0xff, SEPARATION_PARTS * (size_t)t->cells.count * sizeof *t->number);
    return true;
}

/* 2. Rows: where rays of a receiver, or of a cell's places, end. */

typedef struct found {
    uint32_t part; /* SEPARATION_PARTS * cell + part of it; VIT_NONE: nowhere */
    float weight;
    bool near; /* closer by than the cell is large */
    transport_place place;
} found;

typedef struct shooting {
    const transport *t;
    bool receivers;           /* or cells */
    uint32_t first, rays;     /* rays: of a row, at most */
    const uint32_t *row_rays; /* a cell: how many it has */
    found *hits;              /* `rays` per row */
} shooting;

static uint32_t part_of(const transport *t, const gather_hit *h) {
    const uint32_t cell = cells_at(&t->cells, h->side, h->b1, h->b2);
    return SEPARATION_PARTS * cell + separations_part(&t->apart, cell, side_place(t->in->geometry, h->side, h->b1, h->b2));
}

static bool is_near(const transport *t, const transport_place *from, const found *h) {
    const uint32_t cell = h->part / SEPARATION_PARTS;
    const vec3 at = transport_place_at(t, from), way = vec3_sub(transport_place_at(t, &h->place), at);
    return vec3_dot(way, way) < CLOSE_BY * cells_area(&t->cells, t->in->geometry, cell) && !transport_is_far(t, cell, at);
}

static int by_part(const void *a, const void *b) {
    const found *x = a, *y = b;
    if (x->part != y->part)
        return x->part < y->part ? -1 : 1;
    return x->place.rank < y->place.rank ? -1 : x->place.rank > y->place.rank;
}

static void shoot_row(void *user, uint32_t item) {
    const shooting *s = user;
    const transport *t = s->t;
    const transport_input *in = t->in;
    const uint32_t row = s->first + item, seed = pcg(row ^ (s->receivers ? 0x2545f491u : 0x9e3779b9u));
    const uint32_t rays = s->receivers ? s->rays : s->row_rays[row];
    found *hits = s->hits + (size_t)item * s->rays;
    for (uint32_t i = 0; i < rays; i++) {
        transport_place from;
        vec3 about;
        if (s->receivers) {
            const receiver *r = in->receivers + row;
            from = (transport_place){.side = r->side, .b1 = r->b1, .b2 = r->b2};
            about = side_shading(in->geometry, from.side, from.b1, from.b2);
        } else {
            from = t->places[(size_t)row * TRANSPORT_PLACES + i % t->place_count[row]];
            about = side_face(in->geometry, from.side);
        }
        const uint32_t n = s->receivers ? i : i / t->place_count[row],
                       shift = s->receivers ? seed : pcg(seed + i % t->place_count[row]);
        const float u = lattice_u(n, shift), v = lattice_v(n, pcg(shift));
        const vec3 d = vec3_cosine(about, u, v);
        hits[i] = (found){.part = VIT_NONE};
        if (!(vec3_dot(d, side_face(in->geometry, from.side)) > 0.0f))
            continue;
        const gather_hit h = gather(in->rays, in->geometry, leave(t, from.side, from.b1, from.b2), d, pcg(seed ^ pcg(i)));
        if (h.side == VIT_NONE || !(h.weight > 0.0f) || !(t->edge[h.side] > 0.0f))
            continue;
        hits[i] = (found){.part = part_of(t, &h), .weight = h.weight, .place = {h.side, h.b1, h.b2, pcg(seed + pcg(i))}};
        hits[i].near = s->receivers && is_near(t, &from, hits + i);
    }
    qsort(hits, rays, sizeof *hits, by_part);
}

bool transport_make_room(transport_rows *r, uint32_t rows, size_t entries) {
    if (rows + 1u > r->row_room) {
        const uint32_t room = r->row_room ? 2 * r->row_room : rows + BATCH;
        size_t *first = realloc(r->first, room * sizeof *first);
        if (!first)
            return false;
        if (r->row_room == 0)
            first[0] = 0;
        r->first = first;
        r->row_room = room;
    }
    if (entries > r->room) {
        const size_t room = r->room ? r->room + r->room / 2 + entries : 2 * entries;
        uint32_t *to = realloc(r->to, room * sizeof *to);
        if (!to)
            return false;
        r->to = to;
        float *factor = realloc(r->factor, room * sizeof *factor);
        if (!factor)
            return false;
        r->factor = factor;
        r->room = room;
    }
    return true;
}

/* A part's number, a new one if need be; VIT_NONE: out of memory. */
static uint32_t number_of(transport *t, uint32_t part) {
    if (t->number[part] != VIT_NONE)
        return t->number[part];
    if (t->count == t->room) {
        const uint32_t room = t->room ? 2 * t->room : 65536u;
        uint32_t *cell = realloc(t->cell, room * sizeof *cell);
        if (cell)
            t->cell = cell;
        uint32_t *count = realloc(t->place_count, room * sizeof *count);
        if (count)
            t->place_count = count;
        transport_place *places = realloc(t->places, (size_t)room * TRANSPORT_PLACES * sizeof *places);
        if (places)
            t->places = places;
        if (!cell || !count || !places)
            return VIT_NONE;
        t->room = room;
    }
    t->cell[t->count] = part;
    t->place_count[t->count] = 0;
    return t->number[part] = t->count++;
}

/* A place is kept if it is among those of least rank. */
static void offer(transport *t, uint32_t number, const transport_place *p) {
    transport_place *kept = t->places + (size_t)number * TRANSPORT_PLACES;
    uint32_t *count = t->place_count + number, worst = 0;
    if (*count < TRANSPORT_PLACES) {
        kept[(*count)++] = *p;
        return;
    }
    for (uint32_t i = 1; i < TRANSPORT_PLACES; i++)
        worst = kept[i].rank > kept[worst].rank ? i : worst;
    if (p->rank < kept[worst].rank)
        kept[worst] = *p;
}

/* Notes a row's hits, which are sorted. known: of cells that have numbers only, whose places stay; they stand for the others,
 * too, or light would be lost. */
static bool note_row(transport *t, transport_rows *rows, const found *hits, uint32_t rays, bool known) {
    if (!rows->first || !transport_make_room(rows, rows->count + 1u, rows->first[rows->count] + rays))
        return false;
    const size_t begin = rows->first[rows->count];
    size_t at = begin;
    double all = 0.0, noted = 0.0;
    for (uint32_t i = 0; i < rays && hits[i].part != VIT_NONE;) {
        const uint32_t part = hits[i].part, number = known ? t->number[part] : number_of(t, part);
        double sum = 0.0;
        if (number == VIT_NONE && !known)
            return false;
        for (; i < rays && hits[i].part == part; i++) {
            sum += (double)hits[i].weight;
            if (!known)
                offer(t, number, &hits[i].place);
            const transport_near near = {rows->count, number, hits[i].place, hits[i].weight / (float)rays};
            if (hits[i].near && !transport_note_near(t, &near))
                return false;
        }
        all += sum;
        if (number == VIT_NONE)
            continue;
        noted += sum;
        rows->to[at] = number;
        rows->factor[at++] = (float)(sum / rays);
    }
    for (size_t k = begin; k < at && noted < all; k++)
        rows->factor[k] *= (float)(all / noted);
    rows->first[++rows->count] = at;
    return true;
}

/* part: of the cells' time that is left. */
static bool shoot(transport *t, const uint32_t *row_rays, uint32_t first, uint32_t end, bool known, double part) {
    uint32_t rays = t->in->receiver_rays;
    for (uint32_t i = first; row_rays && i < end; i++)
        rays = i == first || row_rays[i] > rays ? row_rays[i] : rays;
    shooting s = {.t = t,
                  .receivers = !row_rays,
                  .row_rays = row_rays,
                  .rays = rays,
                  .hits = malloc((size_t)BATCH * rays * sizeof *s.hits)};
    bool fine = s.hits != NULL;
    for (s.first = first; s.first < end && fine; s.first += BATCH) {
        const uint32_t count = end - s.first < BATCH ? end - s.first : BATCH;
        parallel_for(t->in->threads, count, shoot_row, &s);
        for (uint32_t i = 0; i < count && fine; i++) {
            const uint32_t of_row = row_rays ? row_rays[s.first + i] : rays;
            t->report->rays += of_row;
            fine = note_row(t, row_rays ? &t->bounces : &t->gathers, s.hits + (size_t)i * rays, of_row, known);
        }
        /* Cells of later generations are not known yet: each takes half of what is left. */
        const double done = (double)(s.first + count - first) / (end - first),
                     begun = row_rays ? TRANSPORT_BOUNCED - (TRANSPORT_BOUNCED - TRANSPORT_GATHERED) * part : 0.0;
        transport_step(t, begun, row_rays ? (begun + TRANSPORT_BOUNCED) / 2 : TRANSPORT_GATHERED, done);
    }
    free(s.hits);
    return fine;
}

/* Rays of cells from number `first` on: in proportion to what receivers get from them; the rest have the fewest. */
static uint32_t *share_rays(const transport *t, uint32_t first) {
    uint32_t *rays = calloc(t->count + 1u, sizeof *rays);
    float *weight = calloc(t->count + 1u, sizeof *weight);
    if (rays && weight) {
        double all = 0.0;
        for (size_t k = 0; k < t->gathers.first[t->gathers.count]; k++) {
            weight[t->gathers.to[k]] += t->gathers.factor[k];
            all += (double)t->gathers.factor[k];
        }
        for (uint32_t i = first; i < t->count; i++) {
            const double part = all > 0.0 ? (double)weight[i] / all * t->in->bounce_rays : 0.0;
            rays[i] = part > MOST_RAYS ? MOST_RAYS : part > LEAST_RAYS ? (uint32_t)part : LEAST_RAYS;
        }
    } else {
        free(rays);
        rays = NULL;
    }
    free(weight);
    return rays;
}

void transport_drop_rows(transport_rows *r) {
    free(r->first);
    free(r->to);
    free(r->factor);
    *r = (transport_rows){0};
}

bool transport_gather(transport *t) {
    bool fine = transport_make_room(&t->gathers, 0, 1) && transport_make_room(&t->bounces, 0, 1) &&
                shoot(t, NULL, 0, t->in->receiver_count, false, 1.0);
    uint32_t begin = 0;
    double part = 1.0;
    for (uint32_t g = 0; g < GENERATIONS && fine && t->in->reflections != 1u; g++) {
        const uint32_t end = t->count;
        uint32_t *rays = share_rays(t, begin);
        fine = rays && shoot(t, rays, begin, end, g + 1 == GENERATIONS, part);
        part /= 2;
        free(rays);
        begin = end;
    }
    return fine;
}
