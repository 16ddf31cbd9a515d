#include "radiosity/basis_points.h"
#include "cache/fit.h"
#include "cache/walls.h"
#include "common/fail.h"
#include "common/parallel.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ENOUGH 16u          /* places that read a point, */
#define LEAST_ENOUGH 2u     /* or fewer where they are too many */
#define LEAST_OFFSETS 8.0f  /* ray_offsets that a box is wide, at least */
#define WORTH (0.01 * 0.01) /* variance that a wall takes away, at least, of light over itself and its mean */
#define MORTON_BITS 20      /* an axis */

typedef struct finding {
    const basis_points_input *in;
    vit_scene meta; /* levels, step, detail */
    cache_sights sights;
    cache_met whole, parts; /* without walls; with, if there are any */
    const cache_met *met;   /* the one that counts */
    cache_walls walls;
    float *light; /* a row x columns */
    float *noise; /* a row: deviation, all columns added up */
    float *point; /* columns, of each all points of `met`'s cells; not finite: nothing is known */
    double *off;  /* a column */
    bool failed;  /* set alike by any thread */
} finding;

static size_t all_points(const cache_met *m) {
    return (size_t)m->cell_count * VIT_CACHE_POINTS;
}

/* 1. Places. */

static vit_status find_rows(finding *f, vit_text *why) {
    vit_status status = VIT_OK;
    for (uint32_t enough = ENOUGH;; enough /= 2) {
        status = cache_met_find(&f->meta, &f->sights, enough, NULL, &f->whole, why);
        if (status != VIT_OK || f->whole.taken_count <= f->in->most || enough <= LEAST_ENOUGH)
            break;
        cache_met_free(&f->whole);
    }
    f->met = &f->whole;
    return status;
}

/* Light of the rows' places. */
static vit_status find_light(finding *f, bool rough, vit_text *why) {
    const uint32_t count = f->met->taken_count;
    receiver *places = calloc(count + 1u, sizeof *places);
    free(f->light);
    free(f->noise);
    f->light = malloc(((size_t)count * f->in->columns + 1u) * sizeof *f->light);
    f->noise = malloc((count + 1u) * sizeof *f->noise);
    vit_status status = places && f->light && f->noise ? VIT_OK : bake_fail(why, VIT_FAILED, "indirect light: out of memory");
    for (uint32_t i = 0; places && i < count; i++) {
        const cache_sight *s = f->sights.sight + f->met->taken[i];
        places[i] = (receiver){.side = s->side, .b1 = s->b1, .b2 = s->b2, .asked = true};
    }
    if (status == VIT_OK)
        status = f->in->light(f->in->user, places, count, rough, &(transport_light){f->light, f->noise}, why);
    free(places);
    return status;
}

/* 2. Walls: light of the rows' places, all columns together, as a number from 0 to 1. */
static vit_status find_walls(finding *f, vit_text *why) {
    const uint32_t rows = f->met->taken_count, columns = f->in->columns;
    float *value = calloc(rows + 1u, sizeof *value);
    double mean = 0.0;
    for (uint32_t i = 0; i < rows && value; i++) {
        for (uint32_t c = 0; c < columns; c++)
            value[i] += f->light[(size_t)i * columns + c];
        mean += (double)value[i] / rows;
    }
    for (uint32_t i = 0; i < rows && value; i++)
        value[i] = mean > 0.0 ? (float)((double)value[i] / ((double)value[i] + mean)) : 0.0f;
    const cache_walls_input in = {.rays = f->in->seen.rays,
                                  .sights = &f->sights,
                                  .met = f->met,
                                  .value = value,
                                  .step = f->meta.cache_step,
                                  .worth = WORTH,
                                  .threads = f->in->seen.threads};
    const bool holds = value && cache_walls_find(&in, &f->walls);
    free(value);
    return holds ? VIT_OK : bake_fail(why, VIT_FAILED, "indirect light: out of memory");
}

static vit_status find_parts(finding *f, vit_text *why) {
    vit_status status = find_walls(f, why);
    if (status != VIT_OK || f->walls.count == 0)
        return status;
    for (uint32_t enough = ENOUGH;; enough /= 2) {
        status = cache_met_find(&f->meta, &f->sights, enough, &f->walls, &f->parts, why);
        if (status != VIT_OK || f->parts.taken_count <= f->in->most || enough <= LEAST_ENOUGH)
            break;
        cache_met_free(&f->parts);
    }
    f->met = &f->parts;
    return status;
}

/* 3. Points. */

static void fit_column(void *user, uint32_t c) {
    finding *f = user;
    const uint32_t rows = f->met->taken_count, columns = f->in->columns;
    const size_t points = all_points(f->met);
    float *value = malloc((rows + 1u) * sizeof *value), *noise = malloc((rows + 1u) * sizeof *noise), *point = NULL;
    for (uint32_t i = 0; i < rows && value && noise; i++) {
        const float *all = f->light + (size_t)i * columns;
        float sum = 0.0f;
        for (uint32_t k = 0; k < columns; k++)
            sum += all[k];
        value[i] = all[c];
        noise[i] = sum > 0.0f ? f->noise[i] * (all[c] / sum) : 0.0f; /* what chance leaves of one it leaves of all */
    }
    if (value && noise)
        point = cache_fit(f->met, value, noise, f->off + c);
    if (point)
        memcpy(f->point + c * points, point, points * sizeof *point);
    else
        f->failed = true;
    free(point);
    free(value);
    free(noise);
}

static vit_status fit(finding *f, vit_text *why) {
    const uint32_t columns = f->in->columns;
    f->point = malloc((all_points(f->met) * columns + 1u) * sizeof *f->point);
    f->off = calloc(columns, sizeof *f->off);
    if (f->point && f->off)
        parallel_for(f->in->seen.threads, columns, fit_column, f);
    return f->point && f->off && !f->failed ? VIT_OK : bake_fail(why, VIT_FAILED, "indirect light: out of memory");
}

/* Root of the mean square of what is left at places held out, of the mean light. */
static double how_far_off(const finding *f) {
    const uint32_t rows = f->met->taken_count, columns = f->in->columns;
    double square = 0.0, all = 0.0;
    for (uint32_t c = 0; c < columns; c++) {
        double mean = 0.0;
        for (uint32_t i = 0; i < rows; i++)
            mean += (double)f->light[(size_t)i * columns + c] / rows;
        square += f->off[c] * f->off[c];
        all += mean * mean;
    }
    return all > 0.0 ? sqrt(square / all) : 0.0;
}

/* 4. The table, points of neighbouring cells side by side. */

typedef struct ordered {
    uint64_t place;
    uint32_t cell;
} ordered;

static uint64_t spread_bits(uint64_t x) {
    uint64_t r = 0;
    for (int i = 0; i < MORTON_BITS; i++)
        r |= (x >> i & 1u) << 3 * i;
    return r;
}

/* Along a curve through space [Morton 1966]. */
static uint64_t place_of(const cache_cell *c) {
    const int64_t half = (int64_t)1 << (MORTON_BITS - 1);
    uint64_t r = 0;
    for (int k = 0; k < 3; k++) {
        int64_t at = c->at[k] * ((int64_t)1 << c->level);
        at = at < -half ? -half : at >= half ? half - 1 : at;
        r |= spread_bits((uint64_t)(at + half)) << k;
    }
    return r;
}

static int compare(const void *a, const void *b) {
    const ordered *x = a, *y = b;
    if (x->place != y->place)
        return x->place < y->place ? -1 : 1;
    return x->cell < y->cell ? -1 : 1;
}

/* Numbers the cell's points, and says in its record which they are. */
static void number_points(const finding *f, uint32_t cell, vit_cache_cell *record, basis_points *out, float *irradiance) {
    const size_t points = all_points(f->met);
    uint32_t count = 0;
    record->word[0] = out->count;
    for (uint32_t q = 0; q < VIT_CACHE_POINTS; q++) {
        const float *of = f->point + (size_t)cell * VIT_CACHE_POINTS + q;
        const bool known = isfinite(of[0]);
        record->word[1] |= (known ? count : VIT_POINT_NONE) << VIT_POINT_BITS * q;
        for (uint32_t c = 0; c < f->in->columns && known; c++)
            irradiance[(size_t)(out->count + count) * f->in->columns + c] = float_max(of[c * points], 0.0f);
        count += known;
    }
    record->word[0] = count > 0 ? out->count : 0;
    out->count += count;
}

static vit_status put(const finding *f, basis_points *out, float *irradiance, vit_text *why) {
    const cache_met *m = f->met;
    ordered *order = malloc((m->cell_count + 1u) * sizeof *order);
    vit_cache_cell *records = malloc((m->cell_count + f->walls.count + 1u) * sizeof *records);
    vit_status status = order && records ? VIT_OK : bake_fail(why, VIT_FAILED, "indirect light: out of memory");
    if (order && records) {
        for (uint32_t i = 0; i < m->cell_count; i++)
            order[i] = (ordered){place_of(m->cells + i), i};
        qsort(order, m->cell_count, sizeof *order, compare);
        for (uint32_t i = 0; i < m->cell_count; i++) {
            records[i] = cache_cell_record(m->cells + order[i].cell);
            number_points(f, order[i].cell, records + i, out, irradiance);
        }
        out->parted = cache_walls_put(&f->walls, records + m->cell_count);
        out->cells = m->cell_count + out->parted;
        status = cache_table_fit(records, out->cells, &out->table, why);
    }
    free(order);
    free(records);
    return status;
}

static vit_status find(finding *f, basis_points *out, float **irradiance, vit_text *why) {
    vit_status status = cache_sights_find(&f->in->seen, &f->sights, why);
    if (status != VIT_OK)
        return status;
    cache_levels_choose(&f->sights, f->in->spacing, f->in->seen.rays->s->ray_offset * LEAST_OFFSETS, &f->meta);
    if ((status = find_rows(f, why)) != VIT_OK || (status = find_light(f, true, why)) != VIT_OK ||
        (status = find_parts(f, why)) != VIT_OK || (status = find_light(f, false, why)) != VIT_OK ||
        (status = fit(f, why)) != VIT_OK)
        return status;
    out->levels = f->meta.cache_levels;
    out->step = f->meta.cache_step;
    out->detail = f->meta.cache_detail;
    out->places = f->met->taken_count;
    out->off = how_far_off(f);
    *irradiance = calloc((all_points(f->met) + 1u) * f->in->columns, sizeof **irradiance);
    status = *irradiance ? put(f, out, *irradiance, why) : bake_fail(why, VIT_FAILED, "indirect light: out of memory");
    out->count += out->count == 0; /* a dark one, where nothing is seen */
    return status;
}

vit_status basis_points_find(const basis_points_input *in, basis_points *out, float **irradiance, vit_text *why) {
    finding f = {.in = in, .meta = {.cache_levels = 1}};
    *out = (basis_points){0};
    *irradiance = NULL;
    const vit_status status = find(&f, out, irradiance, why);
    cache_walls_free(&f.walls);
    cache_met_free(&f.whole);
    cache_met_free(&f.parts);
    cache_sights_free(&f.sights);
    free(f.light);
    free(f.noise);
    free(f.point);
    free(f.off);
    if (status != VIT_OK) {
        free(*irradiance);
        *irradiance = NULL;
        basis_points_free(out);
    }
    return status;
}

void basis_points_free(basis_points *p) {
    cache_table_free(&p->table);
    *p = (basis_points){0};
}
