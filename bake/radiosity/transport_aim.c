/* Small bright surfaces, as a patch of sun or the ceiling over a lamp: few of a receiver's rays meet them, and these few make
 * it too bright or too dark. What comes from cells much brighter than others is found by rays aimed at them instead, in
 * proportion to their power, where that way more rays go to a cell than by chance; others stay with the rays that met them. */
#include "common/parallel.h"
#include "radiosity/transport_parts.h"
#include <stdlib.h>
#include <string.h>

#define BRIGHT 3.0    /* times what a receiver sees on average */
#define FAR_AWAY 8.0f /* squared distance over a cell's area */
#define LEAST_COSINE 0.1f
#define AIMED_RAYS 4u /* a receiver has a ray aimed for so many that are not */
#define BATCH 4096u

typedef struct aiming {
    const transport *t;
    const float *bright; /* a number: its radiosity in all states, each over the power of all cells in it */
    uint32_t *aim;       /* numbers of bright cells */
    double *sum;         /* their power up to the end of each */
    uint32_t count;
    bool *is; /* a number: among them */
    uint32_t first, rays;
    uint32_t *to; /* of a batch: `room` entries a row */
    float *factor;
    uint32_t *entries;
    uint32_t room;
} aiming;

static float area_of(const transport *t, uint32_t number) {
    return cells_area(&t->cells, t->in->geometry, t->cell[number] / 2);
}

/* Do more rays go to the cell aimed than by chance? Seen from its middle, and the same answer whoever asks. */
static bool is_aimed(const aiming *a, vec3 from, vec3 normal, uint32_t number) {
    const transport *t = a->t;
    const vec3 face = side_face(t->in->geometry, t->cells.side_of[t->cell[number] / 2]),
               way = vec3_sub(cells_center(&t->cells, t->in->geometry, t->cell[number] / 2), from), d = vec3_unit(way);
    const float area = area_of(t, number), d2 = vec3_dot(way, way), here = float_max(vec3_dot(normal, d), LEAST_COSINE),
                there = float_max(-vec3_dot(face, d), LEAST_COSINE);
    if (!(d2 > FAR_AWAY * area))
        return false;
    const double by_chance =
        (double)t->in->receiver_rays * (double)here * (double)there * (double)area / (3.14159265358979 * (double)d2);
    return a->rays * (double)area * (double)a->bright[number] > by_chance * a->sum[a->count - 1];
}

static uint32_t chosen(const aiming *a, double at) {
    uint32_t low = 0, high = a->count - 1;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (a->sum[middle] > at)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* The place of a bright cell that chance finds. False: it is on the other side of what stands on the cell. */
static bool place_on(const transport *t, uint32_t number, float x, float y, vec3 *out) {
    const uint32_t cell = t->cell[number] / 2, split = t->split[cell];
    const cell_corners c = cells_corners(&t->cells, cell);
    const float u = sqrtf(x), w[3] = {1.0f - u, u * (1.0f - y), u * y};
    const float b1 = w[0] * c.b1[0] + w[1] * c.b1[1] + w[2] * c.b1[2], b2 = w[0] * c.b2[0] + w[1] * c.b2[1] + w[2] * c.b2[2];
    *out = side_place(t->in->geometry, t->cells.side_of[cell], b1, b2);
    return split == VIT_NONE ||
           separation_front(t->splits[split].normal, t->splits[split].offset, *out) == ((t->cell[number] & 1) == 0);
}

/* Form factor of one ray from a receiver to the place, over the density of such rays; 0: they do not see each other. */
static float aimed(const aiming *a, const receiver *r, vec3 from, vec3 normal, uint32_t number, vec3 to) {
    const transport *t = a->t;
    const float offset = t->in->rays->s->ray_offset;
    const vec3 face = side_face(t->in->geometry, t->cells.side_of[t->cell[number] / 2]), way = vec3_sub(to, from),
               d = vec3_unit(way);
    const float here = vec3_dot(normal, d), there = -vec3_dot(face, d), d2 = vec3_dot(way, way);
    const vec3 own = side_face(t->in->geometry, r->side);
    if (!(here > 0.0f) || !(there > 0.0f) || !(vec3_dot(own, d) > 0.0f) || !(d2 > 0.0f) ||
        !separation_sees(t->in->rays, vec3_along(from, own, offset), vec3_along(to, face, offset)))
        return 0.0f;
    const double g = (double)here * (double)there / (3.14159265358979 * (double)d2);
    return (float)(g * a->sum[a->count - 1] / ((double)a->bright[number] * a->rays));
}

static void aim_row(void *user, uint32_t item) {
    const aiming *a = user;
    const transport *t = a->t;
    const uint32_t row = a->first + item, seed = pcg(row ^ 0x7feb352du);
    const receiver *r = t->in->receivers + row;
    const vec3 from = side_place(t->in->geometry, r->side, r->b1, r->b2),
               normal = side_shading(t->in->geometry, r->side, r->b1, r->b2);
    uint32_t *to = a->to + (size_t)item * a->room, n = 0;
    float *factor = a->factor + (size_t)item * a->room;
    for (size_t k = t->gathers.first[row]; k < t->gathers.first[row + 1]; k++) {
        if (a->is[t->gathers.to[k]] && is_aimed(a, from, normal, t->gathers.to[k]))
            continue;
        to[n] = t->gathers.to[k];
        factor[n++] = t->gathers.factor[k];
    }
    for (uint32_t i = 0; i < a->rays; i++) {
        vec3 at;
        const double u = ((double)i + (double)unit_float(pcg(seed + 3u * i))) / a->rays * a->sum[a->count - 1];
        const uint32_t number = a->aim[chosen(a, u)];
        if (!is_aimed(a, from, normal, number) ||
            !place_on(t, number, unit_float(pcg(seed + 3u * i + 1u)), unit_float(pcg(seed + 3u * i + 2u)), &at))
            continue;
        const float f = aimed(a, r, from, normal, number, at);
        if (f > 0.0f) {
            to[n] = number;
            factor[n++] = f;
        }
    }
    a->entries[item] = n;
}

/* What cells there are to aim at. False: out of memory. */
static bool choose(aiming *a, const float *radiosity, float *bright) {
    const transport *t = a->t;
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
    double seen = 0.0;
    for (size_t k = 0; k < t->gathers.first[t->gathers.count]; k++)
        seen += (double)t->gathers.factor[k] * (double)bright[t->gathers.to[k]];
    const double least = BRIGHT * seen / (t->gathers.count ? t->gathers.count : 1);
    double all = 0.0;
    for (uint32_t n = 0; n < t->count && least > 0.0; n++)
        if ((double)bright[n] > least) {
            all += (double)area_of(t, n) * (double)bright[n];
            a->is[n] = true;
            a->aim[a->count] = n;
            a->sum[a->count++] = all;
        }
    return true;
}

static bool append(transport_rows *rows, const aiming *a, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        size_t at = rows->first[rows->count];
        if (!transport_make_room(rows, rows->count + 1u, at + a->entries[i]))
            return false;
        memcpy(rows->to + at, a->to + (size_t)i * a->room, a->entries[i] * sizeof *rows->to);
        memcpy(rows->factor + at, a->factor + (size_t)i * a->room, a->entries[i] * sizeof *rows->factor);
        rows->first[++rows->count] = at + a->entries[i];
    }
    return true;
}

static bool aim_all(aiming *a, transport *t) {
    transport_rows rows = {0};
    bool fine = transport_make_room(&rows, 0, 1);
    for (a->first = 0; a->first < t->in->receiver_count && fine; a->first += BATCH) {
        const uint32_t count = t->in->receiver_count - a->first < BATCH ? t->in->receiver_count - a->first : BATCH;
        parallel_for(t->in->threads, count, aim_row, a);
        t->report->rays += (uint64_t)count * a->rays;
        fine = append(&rows, a, count);
        transport_step(t, TRANSPORT_LIT, 1.0, (double)(a->first + count) / t->in->receiver_count);
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
    if ((t->in->rays->s->effects & ways) || rays == 0)
        return true;
    float *bright = malloc((t->count + 1u) * sizeof *bright);
    aiming a = {.t = t, .bright = bright, .rays = rays, .room = rays + t->in->receiver_rays};
    a.aim = malloc((t->count + 1u) * sizeof *a.aim);
    a.sum = malloc((t->count + 1u) * sizeof *a.sum);
    a.is = calloc(t->count + 1u, sizeof *a.is);
    a.to = malloc((size_t)BATCH * a.room * sizeof *a.to);
    a.factor = malloc((size_t)BATCH * a.room * sizeof *a.factor);
    a.entries = malloc(BATCH * sizeof *a.entries);
    bool fine = bright && a.aim && a.sum && a.is && a.to && a.factor && a.entries && choose(&a, radiosity, bright);
    if (fine && a.count > 0)
        fine = aim_all(&a, t);
    free(bright);
    free(a.aim);
    free(a.sum);
    free(a.is);
    free(a.to);
    free(a.factor);
    free(a.entries);
    return fine;
}
