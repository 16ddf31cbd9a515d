#include "cache/walls.h"
#include "common/parallel.h"
#include <stdlib.h>
#include <string.h>

#define TRIES 64u     /* pairs of places that are drawn for a cell */
#define OPPOSED -0.5f /* cosine between the two faces of a wall, at most */
#define MOST_NORMAL 511.0f

/* A row that reads a cell, and how much of it. */
typedef struct reader {
    uint32_t row;
    float weight;
} reader;

typedef struct finding {
    const cache_walls_input *in;
    size_t *first; /* a cell: in `readers`; one more at the end */
    reader *readers;
    cache_plane *plane;
} finding;

/* Goes through the reads row by row; `last`, a cell, is the row whose reader is the cell's last one. With `list` NULL counts.
 */
static void collect(const cache_met *m, size_t *next, uint32_t *last, reader *list) {
    memset(last, 0xff, m->cell_count * sizeof *last);
    for (uint32_t row = 0; row < m->taken_count; row++)
        for (size_t i = m->first[row]; i < m->first[row + 1]; i++) {
            const uint32_t cell = m->reads[i].point / VIT_CACHE_POINTS;
            if (last[cell] != row && list)
                list[next[cell]] = (reader){row, 0.0f};
            next[cell] += last[cell] != row;
            last[cell] = row;
            if (list)
                list[next[cell] - 1].weight += m->reads[i].weight;
        }
}

static bool sort_by_cell(const cache_met *m, finding *f) {
    const size_t cells = m->cell_count;
    size_t *next = calloc(cells + 1, sizeof *next);
    uint32_t *last = malloc((cells + 1) * sizeof *last);
    f->first = malloc((cells + 1) * sizeof *f->first);
    bool holds = next && last && f->first;
    if (holds) {
        collect(m, next, last, NULL);
        size_t count = 0;
        for (size_t c = 0; c < cells; c++) {
            f->first[c] = count;
            count += next[c];
            next[c] = f->first[c];
        }
        f->first[cells] = count;
        f->readers = malloc((count + 1) * sizeof *f->readers);
        holds = f->readers != NULL;
    }
    if (holds)
        collect(m, next, last, f->readers);
    free(next);
    free(last);
    return holds;
}

static void place_in_cell(const finding *f, const cache_cell *c, vec3 p, float at[3]) {
    const float from[3] = {p.x, p.y, p.z};
    const cache_place place = cache_place_of(from, 1.0f / f->in->step * (1.0f / (float)(1u << c->level)));
    cache_from_corner(&place, c->at, at);
}

/* Where the way from a to b is first blocked, on the face; false: nowhere before b. */
static bool meets(const photon_rays *rays, vec3 a, vec3 b, vec3 *at, vec3 *face) {
    const vec3 way = vec3_sub(b, a), d = vec3_unit(way);
    const float length = sqrtf(vec3_dot(way, way));
    float t;
    const uint32_t triangle = length > 0.0f ? photon_rays_nearest(rays, a, d, &t) : VIT_NONE;
    if (triangle == VIT_NONE || t >= length)
        return false;
    *at = vec3_along(a, d, t);
    *face = photon_surface_at(rays->s, a, d, t, triangle).face;
    return true;
}

/* The plane in the middle of the wall between two places, if there is one. */
static bool wall_between(const finding *f, const cache_cell *c, vec3 a, vec3 b, cache_plane *out) {
    vec3 near, far, front, back;
    if (!meets(f->in->rays, a, b, &near, &front) || !meets(f->in->rays, b, a, &far, &back) || vec3_dot(front, back) > OPPOSED)
        return false;
    const vec3 normal = vec3_unit(vec3_sub(front, back)), middle = vec3_along(near, vec3_sub(far, near), 0.5f);
    const float by[3] = {normal.x, normal.y, normal.z};
    float at[3], n[3], product = 0.0f;
    place_in_cell(f, c, middle, at);
    for (int k = 0; k < 3; k++) {
        n[k] = floorf(by[k] * MOST_NORMAL + 0.5f);
        product = fmaf(n[k], at[k], product);
    }
    const float sign = product < 0.0f ? -1.0f : 1.0f;
    out->normal = 0;
    for (int k = 0; k < 3; k++)
        out->normal |= (uint32_t)((int)(sign * n[k]) + VIT_CACHE_NORMAL) << 10 * k;
    out->from = -fabsf(product);
    return true;
}

/* Weight times variance of the values on the plane's two sides, added up; whole: as if there were none. */
static double left_over(const finding *f, uint32_t cell, const cache_plane *plane, double *whole) {
    const cache_met *m = f->in->met;
    double weight[2] = {0}, sum[2] = {0}, square = 0.0;
    for (size_t i = f->first[cell]; i < f->first[cell + 1]; i++) {
        const reader *r = f->readers + i;
        float at[3];
        place_in_cell(f, m->cells + cell, f->in->sights->sight[m->taken[r->row]].position, at);
        const int side = cache_before(plane, at);
        const double v = (double)f->in->value[r->row], w = (double)r->weight;
        weight[side] += w;
        sum[side] += w * v;
        square += w * v * v;
    }
    const double all = weight[0] + weight[1], both = sum[0] + sum[1];
    *whole = (square - both * both / all) / all;
    for (int side = 0; side < 2; side++)
        square -= weight[side] > 0.0 ? sum[side] * sum[side] / weight[side] : 0.0;
    return square / all;
}

static void part(void *user, uint32_t cell) {
    const finding *f = user;
    const cache_walls_input *in = f->in;
    const reader *r = f->readers + f->first[cell];
    const uint32_t count = (uint32_t)(f->first[cell + 1] - f->first[cell]);
    double whole, least = 1e9;
    uint32_t random = pcg(cell);
    for (uint32_t i = 0; i < TRIES && count > 1; i++) {
        const uint32_t a = (random = pcg(random)) % count, b = (random = pcg(random)) % count;
        const double apart = (double)in->value[r[a].row] - (double)in->value[r[b].row];
        cache_plane plane;
        if (apart * apart < in->worth ||
            !wall_between(f, in->met->cells + cell, in->sights->sight[in->met->taken[r[a].row]].position,
                          in->sights->sight[in->met->taken[r[b].row]].position, &plane))
            continue;
        const double left = left_over(f, cell, &plane, &whole);
        if (left < least && whole - left > in->worth) {
            least = left;
            f->plane[cell] = plane;
        }
    }
}

bool cache_walls_find(const cache_walls_input *in, cache_walls *out) {
    finding f = {.in = in, .plane = calloc(in->met->cell_count + 1u, sizeof *f.plane)};
    const bool holds = f.plane && sort_by_cell(in->met, &f);
    if (holds)
        parallel_for(in->threads, in->met->cell_count, part, &f);
    *out = (cache_walls){.met = in->met, .plane = f.plane};
    for (uint32_t i = 0; i < in->met->cell_count && holds; i++)
        out->count += f.plane[i].normal != 0;
    free(f.first);
    free(f.readers);
    if (!holds)
        cache_walls_free(out);
    return holds;
}

uint32_t cache_walls_put(const cache_walls *w, vit_cache_cell *cells) {
    uint32_t count = 0;
    for (uint32_t i = 0; w->count > 0 && i < w->met->cell_count; i++)
        if (w->plane[i].normal != 0) {
            vit_cache_cell *c = cells + count++;
            *c = cache_cell_record(w->met->cells + i);
            c->word[0] = w->plane[i].normal;
            memcpy(c->word + 1, &w->plane[i].from, sizeof *c->word);
            c->word[2] |= VIT_CACHE_PARTED;
        }
    return count;
}

void cache_walls_free(cache_walls *w) {
    free(w->plane);
    memset(w, 0, sizeof *w);
}
