/* Cells within which light changes much are divided once more, and so are their parts: by how much it differs between corners,
 * at a first look, against what there is. Where a neighbour is divided less often, what lies on the common edge takes the
 * neighbour's light, as hanging nodes of finite elements do. */
#include "common/parallel.h"
#include "radiosity/receivers_parts.h"
#include <stdlib.h>
#include <string.h>

#define STEP 0.4f         /* of the light at the corners of a part, over its mean; half of that where parts are divided */
#define RANGE 1.7         /* of three numbers: deviations between the least and the largest, on average */
#define DIM 0.02f         /* of the mean of all: less counts as so much */
#define PARTS_BY_LIGHT 4u /* of a piece, along each edge, at most, where light of places tells */
#define MOST_COLUMNS 3u   /* of that */
#define MORE_STEP 1.3f    /* where there would be too many */
#define MORE 1u           /* receivers of parts, at most so many times the records of cells, */
#define MORE_LEAST 32768u /* or so many; parts of parts, always */

/* How much the light of a piece's corners differs, over its mean, beyond what noise alone makes of three; all columns
 * together. */
static float contrast_of(const placing *p, uint32_t piece, const float *irradiance, const float *noise, double mean) {
    const uint32_t columns = p->in->columns;
    const vit_u32 *r = p->out->cells[piece].receiver;
    double differ = -RANGE * ((double)noise[r[0]] + (double)noise[r[1]] + (double)noise[r[2]]) / 3.0, sum = 0.0;
    for (uint32_t c = 0; c < columns; c++) {
        const float a = irradiance[(size_t)r[0] * columns + c], b = irradiance[(size_t)r[1] * columns + c],
                    d = irradiance[(size_t)r[2] * columns + c];
        differ += (double)(float_max(a, float_max(b, d)) - float_min(a, float_min(b, d)));
        sum += ((double)a + (double)b + (double)d) / 3.0;
    }
    return differ > 0.0 && sum + DIM * mean > 0.0 ? (float)(differ / (sum + DIM * mean)) : 0.0f;
}

/* Parts of cells that the cameras look at are looked at, too. */
static bool is_seen(const placing *p, uint32_t piece) {
    return p->met[p->pieces[piece].side] && (piece >= p->cells.count || p->looked_at[piece]);
}

/* Light in the middles of pieces, against what interpolation says of it. */
typedef struct judging {
    const placing *p;
    const float *irradiance;
    double mean;
    uint32_t first; /* piece */
} judging;

/* How far off interpolation is at weights w of the piece's corners, over the light there; all columns together. */
static float off_at(const judging *j, uint32_t index, const float w[3]) {
    const placing *p = j->p;
    const receiver_piece *piece = p->pieces + index;
    const vit_receiver_cell *cell = p->out->cells + index;
    const cell_corners *k = &piece->at;
    const float b1 = w[0] * k->b1[0] + w[1] * k->b1[1] + w[2] * k->b1[2],
                b2 = w[0] * k->b2[0] + w[1] * k->b2[1] + w[2] * k->b2[2];
    const vit_receiver_split *s = cell->split == VIT_NONE ? NULL : p->out->splits + cell->split;
    const bool front = !s || vec3_dot(vec3_load(s->normal), side_place(p->in->geometry, piece->side, b1, b2)) > s->offset;
    const vit_u32 *r = front ? cell->receiver : s->receiver;
    float light[MOST_COLUMNS];
    double off = 0.0, sum = 0.0;
    p->in->light(p->in->user, piece->side, b1, b2, light);
    for (uint32_t c = 0; c < p->in->columns; c++) {
        double known = 0.0;
        for (int i = 0; i < 3; i++)
            known += (double)w[i] * (double)j->irradiance[(size_t)r[i] * p->in->columns + c];
        off += fabs((double)light[c] - known);
        sum += (double)light[c];
    }
    return sum + DIM * j->mean > 0.0 ? (float)(off / (sum + DIM * j->mean)) : 0.0f;
}

/* Of cells, which are large, the middles of four parts are looked at, else one. */
static void judge(void *user, uint32_t item) {
    static const float at[4][3] = {{1.0f / 3.0f, 1.0f / 3.0f, 1.0f / 3.0f},
                                   {2.0f / 3.0f, 1.0f / 6.0f, 1.0f / 6.0f},
                                   {1.0f / 6.0f, 2.0f / 3.0f, 1.0f / 6.0f},
                                   {1.0f / 6.0f, 1.0f / 6.0f, 2.0f / 3.0f}};
    const judging *j = user;
    const placing *p = j->p;
    const uint32_t index = j->first + item;
    const bool whole = index < p->cells.count;
    receiver_piece *piece = p->pieces + index;
    if (!is_seen(p, index))
        return;
    for (int i = 0; i < (whole ? 4 : 1); i++)
        piece->off = float_max(piece->off, off_at(j, index, at[i]));
}

static double mean_of(const placing *p, const float *irradiance) {
    double mean = 0.0;
    for (size_t i = 0; i < (size_t)p->out->count * p->in->columns; i++)
        mean += (double)irradiance[i] / p->out->count;
    return mean;
}

/* Of pieces that have come since the last time. */
static void judge_pieces(placing *p, const float *irradiance, double mean) {
    const judging j = {.p = p, .irradiance = irradiance, .mean = mean, .first = p->begin};
    parallel_for(p->in->threads, p->end - p->begin, judge, (void *)(uintptr_t)&j);
}

/* A piece may be divided into so many parts along each edge. */
static uint32_t finest_parts(const placing *p, const receiver_piece *piece) {
    const float parts = p->finest / (float)piece->finer;
    return parts > (float)PARTS_BY_LIGHT ? PARTS_BY_LIGHT : parts > 1.0f ? (uint32_t)parts : 1u;
}

void receivers_find_unknown(placing *p, const float *irradiance) {
    double all = 0.0, unknown = 0.0;
    judge_pieces(p, irradiance, p->mean);
    for (uint32_t i = 0; i < p->piece_count; i++) {
        const receiver_piece *piece = p->pieces + i;
        const float edge = p->spacing[piece->side] / (float)piece->finer;
        if (piece->parts > 1 || !is_seen(p, i))
            continue;
        all += (double)(edge * edge);
        if (piece->off > p->in->off_limits && finest_parts(p, piece) > 1) {
            p->out->cells[i] = (vit_receiver_cell){.split = VIT_RECEIVER_BY_RAYS};
            p->out->unknown++;
            unknown += (double)(edge * edge);
        }
    }
    p->out->unknown_share = all > 0.0 ? (float)(unknown / all) : 0.0f;
}

/* Cells are divided as often as they may be, or the next level's middles would be too far apart to tell; parts, where they are
 * off by e, so that it becomes less than `step`: about e / 2 if places are half as far apart, at the edges of shadows too. */
static uint32_t parts_by_light(const placing *p, const receiver_piece *piece, float step) {
    const uint32_t most = finest_parts(p, piece);
    uint32_t parts = 1;
    while (2 * parts <= most && piece->off > (piece->finer == 1 ? step : step * (float)parts))
        parts *= 2;
    return parts;
}

/* finest: parts of parts along an edge of a cell, at most. */
static uint32_t parts_for(const receiver_piece *piece, float contrast, float step, float finest) {
    uint32_t parts = 1;
    while (parts < VIT_RECEIVER_PARTS && contrast > step * (float)parts && (float)(2 * parts * piece->finer) <= finest)
        parts *= 2;
    return parts;
}

bool receivers_start_pieces(placing *p) {
    p->pieces = malloc((p->cells.count + 1u) * sizeof *p->pieces);
    for (uint32_t i = 0; p->pieces && i < p->cells.count; i++)
        p->pieces[i] = (receiver_piece){.at = cells_corners(&p->cells, i), .side = p->cells.side_of[i], .finer = 1, .parts = 1};
    p->piece_count = p->end = p->cells.count;
    return p->pieces != NULL;
}

static bool add_parts(placing *p) {
    uint64_t count = p->piece_count;
    for (uint32_t i = p->begin; i < p->end; i++) {
        const uint32_t parts = p->pieces[i].parts;
        count += parts > 1 ? parts * parts : 0u;
    }
    receiver_piece *more = realloc(p->pieces, (count + 1u) * sizeof *more);
    if (!more)
        return false;
    p->pieces = more;
    for (uint32_t i = p->begin; i < p->end; i++) {
        receiver_piece *whole = p->pieces + i;
        whole->first = p->piece_count;
        for (uint32_t k = 0; k < whole->parts * whole->parts && whole->parts > 1; k++)
            p->pieces[p->piece_count++] = (receiver_piece){.at = cells_within(&whole->at, whole->parts, k),
                                                           .side = whole->side,
                                                           .finer = whole->finer * whole->parts,
                                                           .parts = 1};
    }
    return true;
}

/* Slot of an edge, or the free one where it belongs. */
static uint32_t edge_slot(const placing *p, uint32_t a, uint32_t b) {
    const uint64_t key = a < b ? (uint64_t)b << 32 | a : (uint64_t)a << 32 | b;
    uint32_t at = pcg((uint32_t)key ^ pcg((uint32_t)(key >> 32))) & (p->edge_slots - 1);
    while (p->edge_parts[at] && p->edges[at] != key)
        at = (at + 1) & (p->edge_slots - 1);
    p->edges[at] = key;
    return at;
}

/* A table for the edges of all pieces. False: out of memory. */
static bool clear_edges(placing *p) {
    free(p->edges);
    free(p->edge_parts);
    p->edge_slots = 1024;
    while (p->edge_slots < 6u * p->end && p->edge_slots < 1u << 30)
        p->edge_slots *= 2;
    p->edges = malloc(p->edge_slots * sizeof *p->edges);
    p->edge_parts = calloc(p->edge_slots, sizeof *p->edge_parts);
    return p->edges && p->edge_parts;
}

/* Beside a piece that is divided others are divided as often: what happens on the common edge is not to be seen at their
 * corners. False: out of memory. */
static bool grade(placing *p) {
    if (!clear_edges(p))
        return false;
    for (uint32_t i = p->begin; i < p->end; i++)
        for (int k = 0; k < 3; k++) {
            const vit_u32 *r = p->out->cells[i].receiver;
            const uint32_t at = edge_slot(p, r[k], r[(k + 1) % 3]), parts = p->pieces[i].parts;
            p->edge_parts[at] = (uint8_t)(parts > p->edge_parts[at] ? parts : p->edge_parts[at]);
        }
    for (uint32_t i = p->begin; i < p->end; i++)
        for (int k = 0; k < 3 && is_seen(p, i); k++) {
            const vit_u32 *r = p->out->cells[i].receiver;
            const uint32_t most = p->edge_parts[edge_slot(p, r[k], r[(k + 1) % 3])];
            p->pieces[i].parts = most > p->pieces[i].parts ? most : p->pieces[i].parts;
        }
    return true;
}

static uint64_t nodes_of_parts(const placing *p) {
    uint64_t nodes = 0;
    for (uint32_t i = p->begin; i < p->end; i++) {
        const uint32_t n = p->pieces[i].parts;
        nodes += n > 1 ? n * n / 2u : 0u; /* about; neighbours share some */
    }
    return nodes;
}

/* With the least step by which they are not too many. False: out of memory. */
static bool choose_parts(placing *p, const float *contrast) {
    const bool light = p->in->light;
    const uint32_t records = p->out->count - p->out->follower_count;
    uint32_t most = records * MORE > MORE_LEAST && p->begin == 0 ? records * MORE : MORE_LEAST;
    if (light)
        most = p->in->most / 2u;
    for (float step = light ? p->in->error : p->begin ? STEP * 0.5f : STEP;; step *= MORE_STEP) {
        for (uint32_t i = p->begin; i < p->end; i++)
            p->pieces[i].parts = light ? parts_by_light(p, p->pieces + i, step)
                                       : parts_for(p->pieces + i, contrast[i - p->begin], step, p->finest);
        if (!grade(p))
            return false;
        if (nodes_of_parts(p) <= most)
            return true;
    }
}

bool receivers_find_parts(placing *p, const float *irradiance, const float *noise) {
    float *contrast = calloc(p->end - p->begin + 1u, sizeof *contrast);
    if (!contrast)
        return false;
    if (p->begin == 0)
        p->mean = mean_of(p, irradiance);
    if (p->begin == 0)
        receivers_part_records(p, irradiance, p->mean);
    if (p->in->light)
        judge_pieces(p, irradiance, p->mean);
    for (uint32_t i = p->begin; i < p->end && !p->in->light; i++)
        if (is_seen(p, i))
            contrast[i - p->begin] = contrast_of(p, i, irradiance, noise, p->mean);
    const bool fine = choose_parts(p, contrast);
    free(contrast);
    return fine && add_parts(p);
}

/* An end that hangs may lie on a longer edge, and on an edge between two that carry something may hang: both stay straight. */
static bool is_settled(const receiver *a, const receiver *b) {
    return a->hangs || b->hangs || (a->carries && b->carries);
}

bool receivers_find_edges(placing *p) {
    if (!clear_edges(p))
        return false;
    for (uint32_t i = 0; i < p->end; i++) {
        const receiver_piece *piece = p->pieces + i;
        const vit_u32 *r = p->out->cells[i].receiver;
        const bool gone = (i < p->begin && piece->parts > 1) || !(p->spacing[piece->side] > 0.0f);
        for (int k = 0; k < 3 && !gone; k++) {
            const uint32_t a = r[k], b = r[(k + 1) % 3], at = edge_slot(p, a, b);
            const uint32_t parts = is_settled(p->out->receivers + a, p->out->receivers + b) ? 1 : piece->parts;
            if (p->edge_parts[at] == 0 || p->edge_parts[at] > parts)
                p->edge_parts[at] = (uint8_t)parts;
        }
    }
    return true;
}

static bool hang(placing *p, uint32_t on, uint32_t a, uint32_t b, float weight) {
    receivers *o = p->out;
    if (on == VIT_NONE || a == VIT_NONE || b == VIT_NONE || o->receivers[on].follows || o->receivers[on].carries)
        return true;
    if (o->follower_count == p->follower_room) {
        const uint32_t room = p->follower_room ? 2 * p->follower_room : 1024;
        receiver_follower *more = realloc(o->followers, room * sizeof *more);
        if (!more)
            return false;
        o->followers = more;
        p->follower_room = room;
    }
    o->receivers[on].follows = o->receivers[on].hangs = true;
    o->receivers[a].carries = o->receivers[b].carries = true;
    o->followers[o->follower_count++] = (receiver_follower){on, {a, b, a, a, a, a}, {1.0f - weight, weight}};
    return true;
}

bool receivers_hang(placing *p, uint32_t piece, uint32_t (*node)[RECEIVER_NODES]) {
    static const uint32_t corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    const uint32_t parts = p->pieces[piece].parts;
    const vit_u32 *r = p->out->cells[piece].receiver;
    bool fine = true;
    for (int e = 0; e < 3; e++) {
        const uint32_t *from = corner[e], *to = corner[(e + 1) % 3];
        const uint32_t fewest = p->edge_parts[edge_slot(p, r[e], r[(e + 1) % 3])], step = fewest ? parts / fewest : 1;
        uint32_t on[RECEIVER_NODES];
        for (uint32_t k = 0; k <= parts; k++)
            on[k] = node[from[0] * (parts - k) + to[0] * k][from[1] * (parts - k) + to[1] * k];
        for (uint32_t k = 1; k < parts && fine; k++) {
            const uint32_t low = k / step * step;
            fine = k == low || hang(p, on[k], on[low], on[low + step], (float)(k - low) / (float)step);
        }
    }
    return fine;
}
