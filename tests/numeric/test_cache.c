/* The world-space cache's cells, implicit points and table where they are hard.
 *
 * What can go wrong: coordinates are cut rather than rounded down, which makes the boxes at the origin twice as wide; on
 * borders of boxes and cells a place reads other points than a step beside it, and something jumps; a place on a point, or
 * points in one place, give 0 / 0; far from the origin, or with boxes a millimetre or a kilometre wide, a place's box is
 * another one. The bound: what the kernel says is the modified Shepard interpolation of all points nearer than 5/4 of a box,
 * worked out in double with exact boxes. A box's borders are where the sum is continuous, so that a box more or less by
 * rounding must not show. What is far from the origin has the precision of its coordinates: a sweep shows where that ends.
 *
 * A table that is full drops cells: places then must get what the other cells say, whatever the order in which cells came. */
#include "catalogue.h"

#include "cache/points.h"
#include "cache/points_met.h"
#include "cache/table.h"
#include "host_lab.h"

#include <math.h>

enum { PLACES = 2048, RECORDS = 4096, ORDERS = 5 };

typedef enum kind { ANYWHERE, NEGATIVE, BORDERS, CELL_BORDERS, ORIGIN, ON_POINTS, KINDS } kind;
static const char *const kinds[KINDS] = {"anywhere",         "negative coordinates",       "borders of boxes",
                                         "borders of cells", "within a box of the origin", "on implicit points"};

typedef struct lab {
    vit_scene scene;
    cache_sight sight[PLACES];
    cache_met met;
    cache_table table;
    float places[7 * PLACES], open[PLACES];
} lab;

static lab it;
static uint32_t random_state = 1;

static double random_unit(void) {
    return (double)unit_float(random_state = pcg(random_state));
}

/* Coordinate k of a place, in boxes. */
static double coordinate(kind of, int k, uint32_t i, double from) {
    const double x = from + (random_unit() - 0.5) * 40;
    switch (of) {
    case NEGATIVE:
        return -fabs(x) - 1e-3;
    case BORDERS:
        return (int)(i % 3) == k ? floor(x) : x;
    case CELL_BORDERS:
        return 2 * floor(x / 2);
    case ORIGIN:
        return i == 0 ? 0 : i == 1 ? -0.0 : random_unit() - 0.5;
    case ON_POINTS: {
        const uint32_t place = pcg(i * 3 + (uint32_t)k) & 1023u;
        return floor(x) + 0.25 + (place + 0.5) * 0.5 / 1024;
    }
    default:
        return x;
    }
}

/* Moves a place that lies in a box to the box's point. */
static void to_point(double p[3], uint32_t level) {
    int32_t cell[3];
    uint32_t q = 0;
    for (int k = 0; k < 3; k++) {
        const int32_t box = (int32_t)floor(p[k]);
        cell[k] = cache_half(box);
        q |= ((uint32_t)box & 1u) << k;
    }
    const uint32_t random = pcg(cache_seed(cell, level) + q);
    for (int k = 0; k < 3; k++)
        p[k] = floor(p[k]) + 0.25 + ((random >> 10 * k & 1023u) + 0.5) * 0.5 / 1024;
}

static void put_places(kind of, double from) {
    for (uint32_t i = 0; i < PLACES; i++) {
        double p[3];
        float at[3], n[3];
        for (int k = 0; k < 3; k++)
            p[k] = coordinate(of, k, i, from);
        if (of == ON_POINTS)
            to_point(p, 0);
        for (int k = 0; k < 3; k++) {
            at[k] = (float)(p[k] * (double)it.scene.cache_step);
            n[k] = (float)(random_unit() - 0.5);
        }
        const vec3 normal = i % 4 ? vec3_unit(vec3_load(n)) : (vec3){0, i % 8 ? 1.0f : -1.0f, 0};
        const float far = of == ON_POINTS ? 0.0f : (float)((2 << it.scene.cache_levels) * random_unit() * random_unit());
        it.sight[i] = (cache_sight){vec3_load(at), normal, normal, far, 0, 0, 0};
        const float plane[7] = {at[0], at[1], at[2], normal.x, normal.y, normal.z, far};
        for (uint32_t k = 0; k < 7; k++)
            it.places[k * PLACES + i] = plane[k];
    }
}

/* What a point knows follows from its cell's key, so that who works it out needs no table. */
static uint32_t code_of(uint32_t key, uint32_t q) {
    return 1 + pcg(key + q) % VIT_CACHE_MOST;
}

static vit_cache_cell cell_of(const cache_cell *c) {
    vit_cache_cell r = {cache_key(cache_seed(c->at, c->level), c->side), {0, 0, cache_tag(c->at)}};
    for (uint32_t q = 0; q < VIT_CACHE_POINTS; q++)
        r.word[VIT_CACHE_WORD(q)] |= code_of(r.key, q) << VIT_CACHE_SHIFT(q);
    return r;
}

/* All cells that the places read, in a table that holds them. */
static void open_lab(float step, uint32_t levels, kind of, double from) {
    vit_text why;
    memset(&it, 0, sizeof it);
    it.scene = (vit_scene){.cache_levels = levels, .cache_step = step, .cache_detail = 1.0f};
    put_places(of, from);
    const cache_sights sights = {.sight = it.sight, .count = PLACES};
    assert_int_equal(cache_met_find(&it.scene, &sights, 255, NULL, &it.met, &why), VIT_OK);
}

static vit_cache_cell *cells_of(void) {
    vit_cache_cell *cells = malloc((it.met.cell_count + 1) * sizeof *cells);
    assert_non_null(cells);
    for (uint32_t i = 0; i < it.met.cell_count; i++)
        cells[i] = cell_of(it.met.cells + i);
    return cells;
}

static void ask_the_kernel(void) {
    it.scene.cache_cells = it.table.count;
    it.scene.cache_probes = it.table.longest;
    host_lab_find()->open(&it.scene, it.table.records, NULL, it.places, PLACES, it.open);
}

static void close_lab(void) {
    cache_table_free(&it.table);
    cache_met_free(&it.met);
}

/* Adds a level's points; `whole`: all cells count, else those of the table alone. */
static void add_level(const cache_sight *s, uint32_t level, double part, bool whole, double *sum, double *weight) {
    const double edge = (double)it.scene.cache_step * (double)(1u << level);
    const double p[3] = {(double)s->position.x / edge, (double)s->position.y / edge, (double)s->position.z / edge};
    const double n[3] = {(double)s->normal.x, (double)s->normal.y, (double)s->normal.z};
    for (int box = 0; box < 125; box++) {
        const int by[3] = {box % 5 - 2, box / 5 % 5 - 2, box / 25 - 2};
        int32_t cell[3];
        uint32_t q = 0;
        double d2 = 0;
        for (int k = 0; k < 3; k++) {
            const int32_t at = (int32_t)floor(p[k]) + by[k];
            cell[k] = (int32_t)floor(at / 2.0);
            q |= ((uint32_t)at & 1u) << k;
        }
        const uint32_t seed = cache_seed(cell, level), random = pcg(seed + q);
        for (int k = 0; k < 3; k++)
            d2 += pow(floor(p[k]) + by[k] + 0.25 + ((random >> 10 * k & 1023u) + 0.5) * 0.5 / 1024 - p[k], 2);
        const double near = fmax(1 - d2 / (1.25 * 1.25), 0);
        for (uint32_t axis = 0; axis < 3 && near > 0; axis++) {
            const uint32_t key = cache_key(seed, 2 * axis + (n[axis] < 0));
            const double w = part * near * near * fmax(n[axis] * n[axis] - 1.0 / 64, 0);
            if (!whole && cache_table_find(&it.table, key, cache_tag(cell)) == VIT_NONE)
                continue;
            *sum += w * ((double)code_of(key, q) - VIT_CACHE_ZERO) / (double)VIT_CACHE_STEPS;
            *weight += w;
        }
    }
}

/* What a place should get; NAN: none of its two levels' points is known. */
static double expected(const cache_sight *s, bool whole) {
    const double wanted =
        fmin(fmax((double)s->distance * (double)it.scene.cache_detail, 1), (double)(1u << (it.scene.cache_levels - 1)));
    const uint32_t level = (uint32_t)floor(log2(wanted));
    const double next = fmax(2 * wanted / (double)(1u << level) - 3, 0);
    double sum = 0, weight = 0;
    add_level(s, level, 1 - next, whole, &sum, &weight);
    if (next > 0)
        add_level(s, level + 1, next, whole, &sum, &weight);
    return weight > 1e-5 ? fmin(fmax(sum / weight, 0), 1) : NAN;
}

static double worst_of(bool whole, uint32_t *known) {
    double worst = 0;
    *known = 0;
    for (uint32_t i = 0; i < PLACES; i++) {
        const double e = expected(it.sight + i, whole);
        if (isfinite(e)) {
            worst = fmax(worst, fabs(e - (double)it.open[i]));
            ++*known;
        }
    }
    return worst;
}

static double worst_with_all_cells(float step, uint32_t levels, kind of, double from) {
    vit_text why;
    uint32_t known;
    open_lab(step, levels, of, from);
    vit_cache_cell *cells = cells_of();
    assert_int_equal(cache_table_fit(cells, it.met.cell_count, &it.table, &why), VIT_OK);
    free(cells);
    ask_the_kernel();
    const double worst = worst_of(true, &known);
    assert_in_range(known, PLACES * 99 / 100, PLACES);
    close_lab();
    return worst;
}

static void places_get_what_points_about_them_know(void **state) {
    (void)state;
    static const float steps[] = {1e-3f, 0.37f, 1e3f};
    for (int of = 0; of < KINDS; of++)
        for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
            char what[96];
            (void)snprintf(what, sizeof what, "%s, boxes of %g m: against all points in double", kinds[of], (double)steps[i]);
            catalogue_row("implicit points", what, worst_with_all_cells(steps[i], 4, (kind)of, 0), of == ORIGIN ? 2e-6 : 5e-6,
                          "of all light");
        }
    catalogue_row("implicit points", "16 levels of detail", worst_with_all_cells(0.01f, 16, ANYWHERE, 0), 3e-6, "of all light");
}

/* Boxes from the origin: where a float has no more bits for the place in its box. */
static void far_from_the_origin_they_get_coarse(void **state) {
    (void)state;
    catalogue_point points[18];
    const size_t count = sizeof points / sizeof *points;
    for (size_t i = 0; i < count; i++) {
        const double from = exp2((double)i + 4);
        points[i] = (catalogue_point){from, worst_with_all_cells(0.37f, 1, ANYWHERE, from)};
        if (i == 6)
            catalogue_row("implicit points", "1024 boxes from the origin", points[i].y, 1e-3, "of all light");
    }
    assert_true(points[count - 1].y > points[0].y);
    catalogue_sweep("far", "boxes from the origin", "error", points, count);
}

/* Of three points at these squared distances the first with what is left to it of 1, the second, the third. */
static uint32_t wrong_choices(const double d2[3], uint32_t *count) {
    enum { STEPS = 1024 };
    static float in[4 * STEPS], out[STEPS];
    const float d[3] = {(float)d2[0], (float)d2[1], (float)d2[2]};
    const float first = d[1] * d[2], second = d[0] * d[2], all = first + second + d[0] * d[1]; /* of floats: 0 where they are */
    uint32_t wrong = 0;
    for (int i = 0; i < STEPS; i++) {
        for (int k = 0; k < 3; k++)
            in[k * STEPS + i] = d[k];
        in[3 * STEPS + i] = (float)i / STEPS;
    }
    host_lab_find()->call(HOST_LAB_choose, NULL, in, STEPS, out);
    for (int i = 0; i < STEPS; i++) {
        const double u = (double)i / STEPS * (double)all, edge = 1e-6 * (double)all;
        const bool by_chance = all > 0 && (fabs(u - (double)first) < edge || fabs(u - (double)first - (double)second) < edge);
        const int should = !(all > 0) || u < (double)first ? 0 : u < (double)first + (double)second ? 1 : 2;
        wrong += !by_chance && (int)out[i] != should;
    }
    *count += STEPS;
    return wrong;
}

static void points_in_one_place_are_chosen_by_their_order(void **state) {
    (void)state;
    static const double near[][3] = {
        {0, 0, 0},         {0, 0, 1},          {0, 0.3, 1},   {0, 1e-30, 1e-20}, {1e-30, 1e-30, 1e-30},
        {1e-30, 1e-30, 1}, {0.25, 0.25, 0.25}, {0.1, 0.5, 2}, {1e-6, 0.5, 0.5}};
    uint32_t wrong = 0, count = 0;
    for (size_t i = 0; i < sizeof near / sizeof *near; i++)
        wrong += wrong_choices(near[i], &count);
    catalogue_none("coincident points", "one of three by chance: d2 d3, d1 d3, d1 d2; else the first", wrong, count, "choices");
}

static void shuffle(vit_cache_cell *cells, uint32_t count) {
    for (uint32_t i = count; i > 1; i--) {
        const uint32_t other = (random_state = pcg(random_state)) % i;
        const vit_cache_cell c = cells[i - 1];
        cells[i - 1] = cells[other];
        cells[other] = c;
    }
}

/* So full of cells, in many orders: `unlike` counts tables that differ from the first. Returns the worst place. */
static double worst_of_full(uint32_t cells_in, uint32_t *unlike, uint32_t *dropped) {
    vit_text why;
    uint32_t known;
    open_lab(0.37f, 2, ANYWHERE, 0);
    vit_cache_cell *cells = cells_of();
    assert_true(it.met.cell_count >= cells_in);
    assert_int_equal(cache_table_make(cells, cells_in, RECORDS, VIT_CACHE_PROBES, &it.table, &why), VIT_OK);
    for (int i = 0; i < ORDERS; i++) {
        cache_table other;
        shuffle(cells, cells_in);
        assert_int_equal(cache_table_make(cells, cells_in, RECORDS, VIT_CACHE_PROBES, &other, &why), VIT_OK);
        *unlike += memcmp(other.records, it.table.records, RECORDS * sizeof *other.records) != 0 ||
                   other.dropped != it.table.dropped || it.table.filled + it.table.dropped != cells_in;
        cache_table_free(&other);
    }
    free(cells);
    *dropped = it.table.dropped;
    ask_the_kernel();
    const double worst = worst_of(false, &known);
    assert_true(known > PLACES / 50);
    close_lab();
    return worst;
}

static void a_full_table_drops_the_same_cells_whatever_the_order(void **state) {
    (void)state;
    static const uint32_t percent[] = {50, 90, 100};
    static const double bound[] = {1e-5, 1e-4, 1e-5};
    for (size_t i = 0; i < sizeof percent / sizeof *percent; i++) {
        uint32_t unlike = 0, dropped = 0;
        char what[96];
        const double worst = worst_of_full(RECORDS * percent[i] / 100, &unlike, &dropped);
        (void)snprintf(what, sizeof what, "%u %% of cells for its records, %u dropped: the others' light", percent[i], dropped);
        catalogue_row("full table", what, worst, bound[i], "of all light");
        (void)snprintf(what, sizeof what, "%u %% of cells for its records: tables that differ by order", percent[i]);
        catalogue_none("full table", what, unlike, ORDERS, "orders");
        assert_true(percent[i] < 100 || dropped > 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_get_what_points_about_them_know),
        cmocka_unit_test(far_from_the_origin_they_get_coarse),
        cmocka_unit_test(points_in_one_place_are_chosen_by_their_order),
        cmocka_unit_test(a_full_table_drops_the_same_cells_whatever_the_order),
    };
    return cmocka_run_group_tests_name("cache", tests, NULL, NULL);
}
