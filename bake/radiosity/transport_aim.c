/* Small bright surfaces, as a patch of sun or the crack of a door: few of a receiver's rays meet them, and these few make it
 * too bright or too dark. What comes from cells much brighter than others is found by rays aimed at them instead, where that
 * way more rays go to a cell than by chance; others stay with the rays that met them. Receivers aim at blocks of cells in
 * proportion to what their neighbours got from these, so that no ray is lost on what none of them can see (importance caching:
 * Georgiev et al. 2012). What a receiver's own rays met must not say where it aims: light that they miss by chance would be
 * lost. */
#include "common/parallel.h"
#include "radiosity/transport_parts.h"
#include <stdlib.h>
#include <string.h>

#define BRIGHT 3.0 /* times what a receiver sees on average */
#define LEAST_COSINE 0.1f
#define AIMED_RAYS 2u /* a receiver has a ray aimed for so many that are not */
#define GROUP 128u    /* neighbours: half of them learn from the rays of the other half */
#define BLOCK 16u     /* cells, for what is learnt */
#define BATCH 32u     /* groups */

typedef struct aiming {
    const transport *t;
    const float *bright; /* a number: its radiosity in all states, each over the power of all cells in it */
    uint32_t *of_block;  /* numbers, block after block */
    uint32_t *block;     /* first of a block's, and an end */
    uint32_t blocks;
    uint32_t first, rays;
    uint32_t *to; /* of a batch: `room` entries a row */
    float *factor;
    uint32_t *entries; /* a row; VIT_NONE: out of memory */
    uint32_t room;
} aiming;

/* What half a group aims at. */
typedef struct targets {
    const aiming *a;
    double *got;   /* a block: what the other half got from it */
    float *share;  /* a number: how much of the rays it gets, before they are divided by all; 0: none */
    uint32_t *aim; /* numbers that get some */
    double *sum;   /* shares up to the end of each */
    double all;    /* of them */
    uint32_t count;
} targets;

static float area_of(const transport *t, uint32_t number) {
    return cells_area(&t->cells, t->in->geometry, transport_cell(t, number));
}

/* Do more rays go to the cell aimed than by chance? Seen from its middle, and the same answer whoever asks. */
static bool is_aimed(const targets *g, vec3 from, vec3 normal, uint32_t number) {
    const transport *t = g->a->t;
    if (!(g->share[number] > 0.0f))
        return false;
    const uint32_t cell = transport_cell(t, number);
    const vec3 face = side_face(t->in->geometry, t->cells.side_of[cell]),
               way = vec3_sub(cells_center(&t->cells, t->in->geometry, cell), from), d = vec3_unit(way);
    const float area = area_of(t, number), d2 = vec3_dot(way, way), here = float_max(vec3_dot(normal, d), LEAST_COSINE),
                there = float_max(-vec3_dot(face, d), LEAST_COSINE);
    if (!transport_is_far(t, cell, from))
        return false;
    const double by_chance =
        (double)t->in->receiver_rays * (double)here * (double)there * (double)area / (3.14159265358979 * (double)d2);
    return g->a->rays * (double)g->share[number] > by_chance * g->all;
}

static uint32_t chosen(const targets *g, double at) {
    uint32_t low = 0, high = g->count - 1;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (g->sum[middle] > at)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* The place of a bright cell that chance finds. False: it is on the other side of what stands on the cell. */
static bool place_on(const transport *t, uint32_t number, float x, float y, vec3 *out) {
    const uint32_t cell = transport_cell(t, number);
    const cell_corners c = cells_corners(&t->cells, cell);
    const float u = sqrtf(x), w[3] = {1.0f - u, u * (1.0f - y), u * y};
    const float b1 = w[0] * c.b1[0] + w[1] * c.b1[1] + w[2] * c.b1[2], b2 = w[0] * c.b2[0] + w[1] * c.b2[1] + w[2] * c.b2[2];
    *out = side_place(t->in->geometry, t->cells.side_of[cell], b1, b2);
    return separations_part(&t->apart, cell, *out) == t->cell[number] % SEPARATION_PARTS;
}

/* Form factor of one ray from a receiver to the place, over the density of such rays; 0: they do not see each other. */
static float aimed(const targets *g, const receiver *r, vec3 from, vec3 normal, uint32_t number, vec3 to) {
    const transport *t = g->a->t;
    const float offset = t->in->rays->s->ray_offset;
    const vec3 face = side_face(t->in->geometry, t->cells.side_of[transport_cell(t, number)]), way = vec3_sub(to, from),
               d = vec3_unit(way);
    const float here = vec3_dot(normal, d), there = -vec3_dot(face, d), d2 = vec3_dot(way, way);
    const vec3 own = side_face(t->in->geometry, r->side);
    if (!(here > 0.0f) || !(there > 0.0f) || !(vec3_dot(own, d) > 0.0f) || !(d2 > 0.0f) ||
        !separation_sees(t->in->rays, vec3_along(from, own, offset), vec3_along(to, face, offset)))
        return 0.0f;
    const double part = (double)here * (double)there * (double)area_of(t, number) / (3.14159265358979 * (double)d2);
    return (float)(part * g->all / ((double)g->share[number] * g->a->rays));
}

static uint32_t aim_row(const targets *g, uint32_t row, uint32_t *to, float *factor) {
    const aiming *a = g->a;
    const transport *t = a->t;
    const uint32_t seed = pcg(row ^ 0x7feb352du);
    const receiver *r = t->in->receivers + row;
    const vec3 from = side_place(t->in->geometry, r->side, r->b1, r->b2),
               normal = side_shading(t->in->geometry, r->side, r->b1, r->b2);
    uint32_t n = 0;
    for (size_t k = t->gathers.first[row]; k < t->gathers.first[row + 1]; k++) {
        if (is_aimed(g, from, normal, t->gathers.to[k]))
            continue;
        to[n] = t->gathers.to[k];
        factor[n++] = t->gathers.factor[k];
    }
    for (uint32_t i = 0; i < a->rays && g->count > 0; i++) {
        vec3 at;
        const double u = ((double)i + (double)unit_float(pcg(seed + 3u * i))) / a->rays * g->all;
        const uint32_t number = g->aim[chosen(g, u)];
        if (!is_aimed(g, from, normal, number) ||
            !place_on(t, number, unit_float(pcg(seed + 3u * i + 1u)), unit_float(pcg(seed + 3u * i + 2u)), &at))
            continue;
        const float f = aimed(g, r, from, normal, number, at);
        if (f > 0.0f) {
            to[n] = number;
            factor[n++] = f;
        }
    }
    return n;
}

/* Targets of rows first + half, + 2, ...: cells much brighter than what the others of the group see on average, in blocks that
 * they have met. */
static void choose(targets *g, uint32_t first, uint32_t end, uint32_t half) {
    const aiming *a = g->a;
    const transport_rows *rows = &a->t->gathers;
    double all = 0.0;
    memset(g->got, 0, a->blocks * sizeof *g->got);
    memset(g->share, 0, a->t->count * sizeof *g->share);
    for (uint32_t row = first + !half; row < end; row += 2)
        for (size_t k = rows->first[row]; k < rows->first[row + 1]; k++) {
            const double got = (double)rows->factor[k] * (double)a->bright[rows->to[k]];
            g->got[transport_cell(a->t, rows->to[k]) / BLOCK] += got;
            all += got;
        }
    const float least = (float)(BRIGHT * all / ((end - first + half) / 2));
    g->count = 0;
    all = 0.0;
    for (uint32_t b = 0; b < a->blocks; b++) {
        double power = 0.0;
        const uint32_t before = g->count;
        for (uint32_t i = a->block[b]; g->got[b] > 0.0 && i < a->block[b + 1]; i++) {
            const uint32_t n = a->of_block[i];
            if (a->bright[n] > least) {
                g->aim[g->count++] = n;
                g->share[n] = a->bright[n] * area_of(a->t, n);
                power += (double)g->share[n];
            }
        }
        for (uint32_t i = before; i < g->count; i++) {
            g->share[g->aim[i]] *= (float)(g->got[b] / power);
            all += (double)g->share[g->aim[i]];
            g->sum[i] = all;
        }
    }
    g->all = all;
}

static void aim_group(void *user, uint32_t item) {
    aiming *a = user;
    const transport *t = a->t;
    const uint32_t first = (a->first + item) * GROUP,
                   end = t->in->receiver_count - first < GROUP ? t->in->receiver_count : first + GROUP;
    targets g = {.a = a,
                 .got = malloc(a->blocks * sizeof *g.got),
                 .share = malloc((t->count + 1u) * sizeof *g.share),
                 .aim = malloc((t->count + 1u) * sizeof *g.aim),
                 .sum = malloc((t->count + 1u) * sizeof *g.sum)};
    if (g.got && g.share && g.aim && g.sum) {
        for (uint32_t half = 0; half < 2; half++) {
            choose(&g, first, end, half);
            for (uint32_t row = first + half; row < end; row += 2) {
                const size_t at = item * GROUP + row - first;
                a->entries[at] = aim_row(&g, row, a->to + at * a->room, a->factor + at * a->room);
            }
        }
    } else {
        a->entries[(size_t)item * GROUP] = VIT_NONE;
    }
    free(g.got);
    free(g.share);
    free(g.aim);
    free(g.sum);
}

/* False: out of memory. */
static bool find_blocks(aiming *a) {
    const transport *t = a->t;
    a->blocks = t->cells.count / BLOCK + 1u;
    a->block = calloc(a->blocks + 2u, sizeof *a->block);
    a->of_block = malloc((t->count + 1u) * sizeof *a->of_block);
    if (!a->block || !a->of_block)
        return false;
    for (uint32_t n = 0; n < t->count; n++)
        a->block[transport_cell(t, n) / BLOCK + 2]++;
    for (uint32_t b = 2; b < a->blocks + 2u; b++)
        a->block[b] += a->block[b - 1];
    for (uint32_t n = 0; n < t->count; n++)
        a->of_block[a->block[transport_cell(t, n) / BLOCK + 1]++] = n;
    return true;
}

/* False: out of memory. */
static bool find_bright(const transport *t, const float *radiosity, float *bright) {
    double *power = calloc(t->in->state_count, sizeof *power);
    if (!power)
        return false;
    for (uint32_t n = 0; n < t->count; n++)
        for (uint32_t c = 0; c < t->columns; c++)
            power[c / 3] += (double)area_of(t, n) * (double)radiosity[(size_t)n * t->columns + c];
    for (uint32_t n = 0; n < t->count; n++) {
        double sum = 0.0;
        for (uint32_t c = 0; c < t->columns; c++)
            sum += power[c / 3] > 0.0 ? (double)radiosity[(size_t)n * t->columns + c] / power[c / 3] : 0.0;
        bright[n] = (float)sum;
    }
    free(power);
    return true;
}

static bool append(transport_rows *rows, const aiming *a, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        size_t at = rows->first[rows->count];
        if (a->entries[i] == VIT_NONE || !transport_make_room(rows, rows->count + 1u, at + a->entries[i]))
            return false;
        memcpy(rows->to + at, a->to + (size_t)i * a->room, a->entries[i] * sizeof *rows->to);
        memcpy(rows->factor + at, a->factor + (size_t)i * a->room, a->entries[i] * sizeof *rows->factor);
        rows->first[++rows->count] = at + a->entries[i];
    }
    return true;
}

static bool aim_all(aiming *a, transport *t) {
    transport_rows rows = {0};
    const uint32_t groups = (t->in->receiver_count + GROUP - 1) / GROUP;
    bool fine = transport_make_room(&rows, 0, 1);
    for (a->first = 0; a->first < groups && fine; a->first += BATCH) {
        const uint32_t count = groups - a->first < BATCH ? groups - a->first : BATCH, left = t->in->receiver_count - rows.count,
                       of_batch = left < count * GROUP ? left : count * GROUP;
        parallel_for(t->in->threads, count, aim_group, a);
        t->report->rays += (uint64_t)of_batch * a->rays;
        fine = append(&rows, a, of_batch);
        transport_step(t, TRANSPORT_LIT, 1.0, (double)rows.count / t->in->receiver_count);
    }
    if (fine) {
        transport_drop_rows(&t->gathers);
        t->gathers = rows;
    } else {
        transport_drop_rows(&rows);
    }
    return fine;
}

bool transport_aim(transport *t, const float *radiosity) {
    const uint64_t ways = VIT_BIT(MIRROR) | VIT_BIT(GLASS); /* rays that met a cell by way of these cannot be aimed */
    const uint32_t rays = t->in->receiver_rays / AIMED_RAYS;
    if ((t->in->rays->s->effects & ways) || rays == 0 || t->in->receiver_count == 0)
        return true;
    float *bright = malloc((t->count + 1u) * sizeof *bright);
    aiming a = {.t = t, .bright = bright, .rays = rays, .room = rays + t->in->receiver_rays};
    a.to = malloc((size_t)BATCH * GROUP * a.room * sizeof *a.to);
    a.factor = malloc((size_t)BATCH * GROUP * a.room * sizeof *a.factor);
    a.entries = malloc(BATCH * GROUP * sizeof *a.entries);
    const bool fine =
        bright && a.to && a.factor && a.entries && find_bright(t, radiosity, bright) && find_blocks(&a) && aim_all(&a, t);
    free(bright);
    free(a.of_block);
    free(a.block);
    free(a.to);
    free(a.factor);
    free(a.entries);
    return fine;
}
