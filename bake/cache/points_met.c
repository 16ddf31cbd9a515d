#include "cache/points_met.h"
#include "cache/points.h"
#include "common/fail.h"
#include <stdlib.h>
#include <string.h>

#define LEAST_SLOTS (1u << 12)
#define LEAST_WEIGHT 1e-6f /* of all: points that count less are not read */

typedef struct reader {
    const vit_scene *meta;
    const cache_walls *walls;
} reader;

/* A reading before its cell has a number. */
typedef struct reading {
    cache_cell cell;
    uint32_t q;
    float weight;
} reading;

static bool is_cell(const cache_cell *a, const cache_cell *b) {
    return memcmp(a, b, sizeof *a) == 0;
}

static uint32_t slot_of(const cache_met *m, const cache_cell *c) {
    return (cache_seed(c->at, c->level) + c->side * 0x9e3779b9u) & (m->slot_count - 1);
}

/* Twice as many slots. */
static bool grow_slots(cache_met *m) {
    const uint32_t count = m->slot_count ? m->slot_count * 2 : LEAST_SLOTS;
    uint32_t *slots = malloc(count * sizeof *slots);
    if (!slots)
        return false;
    free(m->slots);
    m->slots = slots;
    m->slot_count = count;
    memset(slots, 0xff, count * sizeof *slots);
    for (uint32_t i = 0; i < m->cell_count; i++) {
        uint32_t at = slot_of(m, m->cells + i);
        while (slots[at] != VIT_NONE)
            at = (at + 1) & (count - 1);
        slots[at] = i;
    }
    return true;
}

static bool grow_cells(cache_met *m) {
    const uint32_t room = m->cell_room ? m->cell_room * 2 : LEAST_SLOTS / 2;
    cache_cell *cells = realloc(m->cells, room * sizeof *cells);
    if (cells)
        m->cells = cells;
    uint8_t *places_of = cells ? realloc(m->places_of, (size_t)room * VIT_CACHE_POINTS) : NULL;
    if (!places_of)
        return false;
    memset(places_of + (size_t)m->cell_room * VIT_CACHE_POINTS, 0, (size_t)(room - m->cell_room) * VIT_CACHE_POINTS);
    m->places_of = places_of;
    m->cell_room = room;
    return true;
}

/* The cell's number, a new one if it has none; VIT_NONE: out of memory. */
static uint32_t number_of(cache_met *m, const cache_cell *c) {
    if (m->cell_count * 2 >= m->slot_count && !grow_slots(m))
        return VIT_NONE;
    uint32_t at = slot_of(m, c);
    for (; m->slots[at] != VIT_NONE; at = (at + 1) & (m->slot_count - 1))
        if (is_cell(m->cells + m->slots[at], c))
            return m->slots[at];
    if (m->cell_count == m->cell_room && !grow_cells(m))
        return VIT_NONE;
    m->slots[at] = m->cell_count;
    m->cells[m->cell_count] = *c;
    return m->cell_count++;
}

/* Of a cell that a wall parts the part that the place is in. */
static void choose_part(const cache_walls *w, const cache_place *place, cache_cell *cell) {
    const cache_met *m = w->met;
    uint32_t at = slot_of(m, cell);
    while (m->slots[at] != VIT_NONE && !is_cell(m->cells + m->slots[at], cell))
        at = (at + 1) & (m->slot_count - 1);
    if (m->slots[at] == VIT_NONE || w->plane[m->slots[at]].normal == 0)
        return;
    float from[3];
    cache_from_corner(place, cell->at, from);
    cell->side += (cache_before(w->plane + m->slots[at], from) ? 2 : 1) * VIT_CACHE_SIDES;
}

/* Readings of a place at a level, behind `count` others; returns how many there are then. */
static uint32_t read_level(const reader *r, const cache_sight *at, uint32_t level, float part, reading *out, uint32_t count) {
    const vit_scene *s = r->meta;
    const float p[3] = {at->position.x, at->position.y, at->position.z}, n[3] = {at->normal.x, at->normal.y, at->normal.z};
    const cache_place place = cache_place_of(p, 1.0f / s->cache_step * (1.0f / (float)(1u << level)));
    for (int box = 0; box < 27; box++) {
        const int by[3] = {box % 3 - 1, box / 3 % 3 - 1, box / 9 - 1};
        cache_cell cell = {.level = level};
        uint32_t q = 0;
        for (int k = 0; k < 3; k++) {
            const int32_t in = place.box[k] + by[k];
            cell.at[k] = cache_half(in);
            q |= ((uint32_t)in & 1u) << k;
        }
        const float weight = part * cache_weight(cache_distance2(&place, by, pcg(cache_seed(cell.at, level) + q)));
        for (uint32_t axis = 0; axis < 3 && weight > 0.0f; axis++) {
            const float share = weight * cache_share(n[axis]);
            cell.side = 2 * axis + (n[axis] < 0.0f);
            if (share > 0.0f && r->walls)
                choose_part(r->walls, &place, &cell);
            if (share > 0.0f)
                out[count++] = (reading){cell, q, share};
        }
    }
    return count;
}

/* All readings of a place, weights adding up to 1. */
static uint32_t read_place(const reader *r, const cache_sight *at, reading *out) {
    float next;
    double sum = 0.0;
    const uint32_t level = cache_level(r->meta, at->distance, &next);
    uint32_t count = read_level(r, at, level, 1.0f - next, out, 0), kept = 0;
    if (next > 0.0f)
        count = read_level(r, at, level + 1, next, out, count);
    for (uint32_t i = 0; i < count; i++)
        sum += (double)out[i].weight;
    for (uint32_t i = 0; i < count; i++) {
        out[kept] = out[i];
        out[kept].weight = (float)((double)out[i].weight / sum);
        kept += out[kept].weight > LEAST_WEIGHT;
    }
    return kept;
}

/* Makes it a row, if some point wants one. False: out of memory. */
static bool take(cache_met *m, uint32_t sight, const reading *read, uint32_t count, uint32_t enough) {
    bool wanted = false;
    if (m->read_count + count > m->read_room) {
        const size_t room = m->read_room ? m->read_room * 2 : 1u << 16;
        cache_read *reads = realloc(m->reads, room * sizeof *reads);
        if (!reads)
            return false;
        m->reads = reads;
        m->read_room = room;
    }
    cache_read *row = m->reads + m->read_count;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t cell = number_of(m, &read[i].cell);
        if (cell == VIT_NONE)
            return false;
        row[i] = (cache_read){cell * VIT_CACHE_POINTS + read[i].q, read[i].weight};
        wanted |= m->places_of[row[i].point] < enough;
    }
    if (!wanted)
        return true;
    for (uint32_t i = 0; i < count; i++)
        if (m->places_of[row[i].point] < enough)
            m->places_of[row[i].point]++;
    m->first[m->taken_count] = m->read_count;
    m->taken[m->taken_count++] = sight;
    m->read_count += count;
    return true;
}

void cache_levels_choose(const cache_sights *s, double spacing, float least, vit_scene *meta) {
    const float edge = s->pixel * (float)spacing, /* wanted, a metre of distance */
        step = float_max(s->nearest * edge, least);
    meta->cache_levels = 1;
    while (meta->cache_levels < VIT_CACHE_LEVELS && s->farthest * edge > step * (float)(1u << (meta->cache_levels - 1u)))
        meta->cache_levels++;
    meta->cache_step = step;
    meta->cache_detail = edge / step;
}

vit_status cache_met_find(const vit_scene *meta, const cache_sights *sights, uint32_t enough, const cache_walls *walls,
                          cache_met *out, vit_text *why) {
    const reader r = {meta, walls};
    reading read[CACHE_MOST_READ];
    memset(out, 0, sizeof *out);
    out->taken = malloc((sights->count + 1u) * sizeof *out->taken);
    out->first = malloc((sights->count + 1u) * sizeof *out->first);
    bool holds = out->taken && out->first && grow_slots(out);
    for (uint32_t i = 0; i < sights->count && holds; i++)
        holds = take(out, i, read, read_place(&r, sights->sight + i, read), enough);
    if (!holds) {
        cache_met_free(out);
        return bake_fail(why, VIT_FAILED, "out of memory");
    }
    out->first[out->taken_count] = out->read_count;
    return VIT_OK;
}

void cache_met_free(cache_met *m) {
    free(m->cells);
    free(m->places_of);
    free(m->slots);
    free(m->taken);
    free(m->first);
    free(m->reads);
    memset(m, 0, sizeof *m);
}
