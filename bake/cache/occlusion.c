#include "cache/occlusion.h"
#include "cache/fit.h"
#include "cache/points.h"
#include "cache/walls.h"
#include "common/fail.h"
#include "common/parallel.h"
#include "common/progress.h"
#include <stdlib.h>
#include <string.h>

#define ENOUGH 32u     /* places that read a point */
#define LEAST_RAYS 16u /* a place */
#define MOST_RAYS 1024u
#define RAYS_FOR_WALLS 64u     /* a place, where frames fill the cells: values that tell where walls are alone */
#define EVEN 0.25              /* variance of even rays over that of chance, at most, where edges are few */
#define CHUNK 256u             /* places */
#define LEAST_OFFSETS 8.0f     /* ray_offsets that a box is wide, at least */
#define LEAST_OF_RADIUS 256.0f /* and this part of the radius */

typedef struct asking {
    const occlusion_input *in;
    const cache_sights *sights;
    const cache_met *met;
    uint32_t rays;
    float *open; /* a row */
    float *of;   /* a sight; NAN: not asked yet */
} asking;

/* Part of the rays by the cosine about the normal that get to the radius; those below the surface do not. */
static float open_at(const asking *a, const cache_sight *s, uint32_t number) {
    const uint32_t shift = pcg(number), other = pcg(shift);
    const float radius = (float)a->in->radius;
    uint32_t open = 0;
    for (uint32_t i = 0; i < a->rays; i++) {
        const vec3 d = vec3_cosine(s->normal, lattice_u(i, shift), lattice_v(i, other));
        open += vec3_dot(s->face, d) > 0.0f && !photon_rays_occluded(a->in->seen.rays, s->position, d, radius);
    }
    return (float)open / (float)a->rays;
}

static void ask(void *user, uint32_t chunk, uint64_t *sum) {
    const asking *a = user;
    for (uint32_t row = chunk * CHUNK; row < (chunk + 1) * CHUNK && row < a->met->taken_count; row++) {
        float *of = a->of + a->met->taken[row];
        if (isnan(*of))
            *of = open_at(a, a->sights->sight + a->met->taken[row], row);
        a->open[row] = *of;
    }
    *sum += 1;
}

static void tell(void *user, double fraction) {
    const cache_sights_input *in = &((const asking *)user)->in->seen;
    if (in->progress)
        in->progress(in->user, fraction);
}

/* Boxes of the nearest place are as wide on the picture as wanted. */
static void choose_levels(const occlusion_input *in, const cache_sights *s, vit_scene *meta) {
    const float least = in->seen.rays->s->ray_offset * LEAST_OFFSETS;
    cache_levels_choose(s, in->spacing, float_max(least, (float)in->radius / LEAST_OF_RADIUS), meta);
}

static uint32_t code_of(float value) {
    const float code = floorf(value * VIT_CACHE_STEPS + 0.5f) + (float)VIT_CACHE_ZERO;
    return (uint32_t)float_min(float_max(code, 1.0f), (float)VIT_CACHE_MOST);
}

/* The cells with what is known at their points, as a table. */
static vit_status put(const cache_met *m, const cache_walls *w, const float *value, occlusion *out, vit_text *why) {
    vit_cache_cell *cells = malloc((m->cell_count + w->count + 1u) * sizeof *cells);
    if (!cells)
        return bake_fail(why, VIT_FAILED, "out of memory");
    for (uint32_t i = 0; i < m->cell_count; i++) {
        cells[i] = cache_cell_record(m->cells + i);
        for (uint32_t q = 0; q < VIT_CACHE_POINTS; q++) {
            const float v = value[i * VIT_CACHE_POINTS + q];
            if (isfinite(v)) {
                cells[i].word[VIT_CACHE_WORD(q)] |= code_of(v) << VIT_CACHE_SHIFT(q);
                out->points++;
            }
        }
    }
    out->parted = cache_walls_put(w, cells + m->cell_count);
    out->cells = m->cell_count + out->parted;
    const vit_status status = cache_table_fit(cells, out->cells, &out->table, why);
    free(cells);
    return status;
}

/* Rays of a place: those of all places share the error that a point may have. */
static uint32_t rays_of(const occlusion_input *in, const cache_met *m) {
    size_t points = 0;
    for (size_t i = 0; i < (size_t)m->cell_count * VIT_CACHE_POINTS; i++)
        points += m->places_of[i] > 0;
    const double all = 0.25 * EVEN / (in->error * in->error) * (double)points, each = all / ((double)m->taken_count + 1.0);
    uint32_t rays = LEAST_RAYS;
    while ((double)rays < each && rays < MOST_RAYS)
        rays += LEAST_RAYS;
    return rays;
}

static float *nothing_known(const cache_met *m) {
    const size_t points = (size_t)m->cell_count * VIT_CACHE_POINTS;
    float *value = calloc(points + 1, sizeof *value);
    for (size_t i = 0; i < points && value; i++)
        value[i] = NAN;
    return value;
}

/* All rows' values. False: out of memory. */
static bool ask_rows(asking *a) {
    uint64_t asked = 0;
    const parallel_work work = {.run = ask,
                                .done = tell,
                                .user = a,
                                .step = 1,
                                .count = (a->met->taken_count + CHUNK - 1) / CHUNK,
                                .threads = a->in->seen.threads};
    free(a->open);
    a->open = malloc((a->met->taken_count + 1u) * sizeof *a->open);
    return a->open && parallel_run(&work, &asked);
}

/* Asks the places that read whole cells, finds the walls among them, and where there are any asks those that read parts. */
static bool ask_places(asking *a, const vit_scene *meta, cache_met met[2], cache_walls *walls, vit_text *why) {
    a->met = met;
    a->rays = a->in->live ? RAYS_FOR_WALLS : rays_of(a->in, met);
    a->of = malloc((a->sights->count + 1u) * sizeof *a->of);
    for (uint32_t i = 0; a->of && i < a->sights->count; i++)
        a->of[i] = NAN;
    if (!a->of || !ask_rows(a))
        return false;
    const cache_walls_input in = {.rays = a->in->seen.rays,
                                  .sights = a->sights,
                                  .met = met,
                                  .value = a->open,
                                  .step = meta->cache_step,
                                  .worth = a->in->error * a->in->error,
                                  .threads = a->in->seen.threads};
    if (!cache_walls_find(&in, walls))
        return false;
    if (walls->count == 0)
        return true;
    a->met = met + 1;
    return cache_met_find(meta, a->sights, ENOUGH, walls, met + 1, why) == VIT_OK && (a->in->live || ask_rows(a));
}

/* met: empty ones, to be freed. */
static vit_status find(const occlusion_input *in, const cache_sights *sights, cache_met met[2], occlusion *out, vit_text *why) {
    vit_scene meta = {.cache_levels = 1};
    choose_levels(in, sights, &meta);
    vit_status status = cache_met_find(&meta, sights, ENOUGH, NULL, met, why);
    if (status != VIT_OK)
        return status;
    asking a = {.in = in, .sights = sights};
    cache_walls walls = {0};
    float *value = NULL;
    if (ask_places(&a, &meta, met, &walls, why))
        value = in->live ? nothing_known(a.met) : cache_fit(a.met, a.open, NULL, &out->off);
    status = value ? put(a.met, &walls, value, out, why) : bake_fail(why, VIT_FAILED, "out of memory");
    cache_walls_free(&walls);
    free(a.open);
    free(a.of);
    free(value);
    out->levels = meta.cache_levels;
    out->step = meta.cache_step;
    out->detail = meta.cache_detail;
    out->places = a.met->taken_count;
    out->rays = a.rays;
    return status;
}

vit_status occlusion_find(const occlusion_input *in, occlusion *out, vit_text *why) {
    const double began = progress_now();
    cache_sights sights = {0};
    cache_met met[2] = {{0}};
    memset(out, 0, sizeof *out);
    vit_status status = cache_sights_find(&in->seen, &sights, why);
    if (status == VIT_OK)
        status = find(in, &sights, met, out, why);
    cache_met_free(met);
    cache_met_free(met + 1);
    cache_sights_free(&sights);
    out->seconds = progress_now() - began;
    return status;
}

void occlusion_free(occlusion *o) {
    cache_table_free(&o->table);
    memset(o, 0, sizeof *o);
}
