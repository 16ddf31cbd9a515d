/* kernels/cache.clh against the baker's copy of it and against what interpolation must do.
 *
 * Why this is hard: a wrong hash, box or weight still gives numbers between 0 and 1 that look like occlusion. Strategy: cells
 * get random values, and the kernel must give at random places what the baker's rows (points_met.h) say in double; places lie
 * on both sides of the origin, on borders of boxes and on points themselves, boxes are from 1e-3 to 1e3 m wide. What all points
 * agree upon must come out everywhere, and where a distance passes from one level to the next nothing may jump. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "cache/points.h"
#include "cache/points_met.h"
#include "cache/table.h"
#include "cache/walls.h"
#include "host_lab.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PLACES = 4096 };

typedef struct lab {
    vit_scene scene;
    cache_sights sights;
    cache_met met, whole;
    cache_walls walls; /* of `whole`'s cells; none: `met` is of whole ones itself */
    cache_table table;
    float places[7 * PLACES], open[PLACES];
} lab;

static uint32_t random_state;

static float random_unit(void) {
    return unit_float(random_state = pcg(random_state));
}

/* Places about the origin: some on borders of boxes, in corners of cells, at the origin. */
static cache_sight place(uint32_t i, float step, float farthest) {
    float p[3], n[3];
    for (int k = 0; k < 3; k++) {
        p[k] = (random_unit() - 0.5f) * 40.0f * step;
        if (i % 4 == (uint32_t)k)
            p[k] = floorf(p[k] / step) * step;
        if (i % 64 == 5)
            p[k] = 0.0f;
        n[k] = random_unit() - 0.5f;
        if (i % 8 == 1)
            n[k] = k == (int)(i / 8 % 3) ? i % 16 > 8 ? -1.0f : 1.0f : 0.0f;
    }
    const vec3 normal = vec3_unit(vec3_load(n));
    return (cache_sight){vec3_load(p), normal, normal, farthest * random_unit(), 0, 0, 0};
}

/* Every third cell gets a plane through its middle part, in any direction or along an axis. */
static void part_cells(lab *l) {
    vit_text why;
    l->whole = l->met;
    l->walls = (cache_walls){.met = &l->whole, .plane = calloc(l->met.cell_count + 1, sizeof *l->walls.plane)};
    assert_non_null(l->walls.plane);
    for (uint32_t i = 0; i < l->whole.cell_count; i += 3) {
        const uint32_t random = pcg(i), axis = 10 * (i % 9 / 3);
        const uint32_t normal = i % 2 ? random & 0x3fffffffu : (0x20080200u & ~(1023u << axis)) | 1023u << axis;
        l->walls.plane[i] = (cache_plane){normal, i % 2 ? -(float)(random >> 22) : -511.0f * (float)(random >> 31)};
        l->walls.count++;
    }
    assert_int_equal(cache_met_find(&l->scene, &l->sights, 255, &l->walls, &l->met, &why), VIT_OK);
    assert_true(l->met.cell_count > l->whole.cell_count);
}

/* Records of the planes; returns their number. */
static uint32_t put_planes(const lab *l, vit_cache_cell *cells) {
    uint32_t count = 0;
    for (uint32_t i = 0; l->walls.count && i < l->whole.cell_count; i++)
        if (l->walls.plane[i].normal) {
            const cache_cell *c = &l->whole.cells[i];
            uint32_t from;
            memcpy(&from, &l->walls.plane[i].from, sizeof from);
            cells[count++] = (vit_cache_cell){cache_key(cache_seed(c->at, c->level), c->side),
                                              {l->walls.plane[i].normal, from, cache_tag(c->at) | VIT_CACHE_PARTED}};
        }
    return count;
}

static lab *open_lab(float step, uint32_t levels, float farthest) {
    lab *l = calloc(1, sizeof *l);
    vit_text why;
    assert_non_null(l);
    l->scene = (vit_scene){.cache_levels = levels, .cache_step = step, .cache_detail = 1.0f, .ambient_radius = 1.0f};
    l->sights.sight = malloc(PLACES * sizeof *l->sights.sight);
    assert_non_null(l->sights.sight);
    l->sights.count = PLACES;
    random_state = levels;
    for (uint32_t i = 0; i < PLACES; i++) {
        const cache_sight s = l->sights.sight[i] = place(i, step, farthest);
        const float plane[7] = {s.position.x, s.position.y, s.position.z, s.normal.x, s.normal.y, s.normal.z, s.distance};
        for (int k = 0; k < 7; k++)
            l->places[k * PLACES + (int)i] = plane[k];
    }
    assert_int_equal(cache_met_find(&l->scene, &l->sights, 255, NULL, &l->met, &why), VIT_OK);
    assert_int_equal(l->met.taken_count, PLACES);
    return l;
}

/* Cells with the values of points, of which every `hole`-th knows nothing. */
static void fill(lab *l, uint32_t (*code)(uint32_t point), uint32_t hole) {
    vit_text why;
    vit_cache_cell *cells = calloc(l->met.cell_count + l->walls.count + 1, sizeof *cells);
    assert_non_null(cells);
    for (uint32_t i = 0; i < l->met.cell_count; i++) {
        const cache_cell *c = &l->met.cells[i];
        cells[i] = (vit_cache_cell){cache_key(cache_seed(c->at, c->level), c->side), {0, 0, cache_tag(c->at)}};
        for (uint32_t q = 0; q < VIT_CACHE_POINTS; q++)
            if (hole == 0 || (i * VIT_CACHE_POINTS + q) % hole != 0)
                cells[i].word[q / 3] |= code(i * VIT_CACHE_POINTS + q) << q % 3 * 10;
    }
    const uint32_t count = l->met.cell_count + put_planes(l, cells + l->met.cell_count);
    assert_int_equal(cache_table_fit(cells, count, &l->table, &why), VIT_OK);
    assert_int_equal(l->table.dropped, 0);
    assert_int_equal(l->table.filled, count); /* no two cells have key and tag in common */
    free(cells);
    l->scene.cache_cells = l->table.count;
    l->scene.cache_probes = l->table.longest;
    host_lab_find()->open(&l->scene, l->table.records, NULL, l->places, PLACES, l->open);
}

static void close_lab(lab *l) {
    cache_table_free(&l->table);
    cache_met_free(&l->met);
    cache_met_free(&l->whole);
    free(l->walls.plane);
    cache_sights_free(&l->sights);
    free(l);
}

static uint32_t any_code(uint32_t point) {
    return 1 + pcg(point) % VIT_CACHE_MOST;
}

static uint32_t code_of_half(uint32_t point) {
    (void)point;
    return VIT_CACHE_ZERO + (uint32_t)VIT_CACHE_STEPS / 2;
}

/* What the rows say, in double, as codes; NAN: nothing. */
static double expected_code(const lab *l, uint32_t row, uint32_t hole) {
    double sum = 0.0, weight = 0.0;
    for (size_t i = l->met.first[row]; i < l->met.first[row + 1]; i++) {
        const uint32_t point = l->met.reads[i].point;
        if (hole && point % hole == 0)
            continue;
        const double w = (double)l->met.reads[i].weight;
        sum += w * (double)any_code(point);
        weight += w;
    }
    return weight > 0.0 ? sum / weight : NAN;
}

/* The same as the part that is open. */
static double expected(const lab *l, uint32_t row, uint32_t hole) {
    const double open = (expected_code(l, row, hole) - VIT_CACHE_ZERO) / (double)VIT_CACHE_STEPS;
    return isfinite(open) ? fmin(fmax(open, 0.0), 1.0) : NAN;
}

static void the_kernel_reads_what_the_baker_wrote(void **state) {
    (void)state;
    static const float steps[] = {1e-3f, 0.37f, 1e3f};
    for (size_t s = 0; s < sizeof steps / sizeof *steps; s++)
        for (uint32_t run = 0; run < 4; run++) {
            const uint32_t hole = run % 2 * 3;
            lab *l = open_lab(steps[s], 4, 12.0f);
            if (run >= 2)
                part_cells(l);
            fill(l, any_code, hole);
            uint32_t known = 0;
            for (uint32_t i = 0; i < PLACES; i++) {
                const double e = expected(l, i, hole);
                if (!isfinite(e))
                    continue;
                known++;
                if (!(fabs(e - (double)l->open[i]) < 2e-4)) /* weights of less than 1e-6 are left out by the baker */
                    fail_msg("step %g, place %u: %g, expected %g", (double)steps[s], i, (double)l->open[i], e);
            }
            assert_in_range(known, PLACES - PLACES / 100, PLACES);
            close_lab(l);
        }
}

static void what_all_points_agree_upon_is_so_everywhere(void **state) {
    (void)state;
    lab *l = open_lab(0.25f, 3, 7.0f);
    fill(l, code_of_half, 0);
    for (uint32_t i = 0; i < PLACES; i++)
        assert_true(fabsf(l->open[i] - 0.5f) < 1e-6f);
    close_lab(l);
}

static void where_nothing_is_known_it_is_open(void **state) {
    (void)state;
    lab *l = open_lab(0.25f, 1, 1.0f);
    fill(l, code_of_half, 1);
    for (uint32_t i = 0; i < PLACES; i++)
        assert_true(l->open[i] == 1.0f);
    close_lab(l);
}

/* Rays of a point, from none to as many as are kept, and how many of them were open. */
static uint32_t any_rays(uint32_t record_point) {
    const uint32_t random = pcg(record_point ^ 77u);
    return random % 5 == 0 ? 0 : random % 5 == 1 ? 0xffffu : random >> 8 & 31u;
}

static uint32_t any_open(uint32_t record_point) {
    return any_rays(record_point) * (pcg(record_point) & 15u) / 15u;
}

/* What a place's points have seen, each by its rays over 4 more; NAN: nothing. */
static double expected_live(const lab *l, uint32_t row) {
    double sum = 0.0, weight = 0.0;
    for (size_t i = l->met.first[row]; i < l->met.first[row + 1]; i++) {
        const uint32_t point = l->met.reads[i].point, q = point % VIT_CACHE_POINTS;
        const cache_cell *c = &l->met.cells[point / VIT_CACHE_POINTS];
        const uint32_t at = cache_table_find(&l->table, cache_key(cache_seed(c->at, c->level), c->side), cache_tag(c->at)),
                       rays = any_rays(at * VIT_CACHE_POINTS + q), open = any_open(at * VIT_CACHE_POINTS + q);
        assert_int_not_equal(at, VIT_NONE);
        sum += (double)l->met.reads[i].weight * open / (rays + 4.0);
        weight += (double)l->met.reads[i].weight * rays / (rays + 4.0);
    }
    return weight > 0.0 ? sum / weight : NAN;
}

static void a_point_counts_by_its_rays_where_they_are_found_while_playing(void **state) {
    (void)state;
    lab *l = open_lab(0.37f, 4, 12.0f);
    fill(l, code_of_half, 0);
    const uint32_t points = l->table.count * VIT_CACHE_POINTS;
    uint32_t *counts = malloc(points * sizeof *counts), known = 0;
    assert_non_null(counts);
    for (uint32_t i = 0; i < points; i++)
        counts[i] = any_rays(i) | any_open(i) << 16;
    host_lab_find()->open(&l->scene, l->table.records, counts, l->places, PLACES, l->open);
    for (uint32_t i = 0; i < PLACES; i++) {
        const double e = expected_live(l, i);
        known += isfinite(e);
        if (isfinite(e) && !(fabs(e - (double)l->open[i]) < 2e-4))
            fail_msg("place %u: %g, expected %g", i, (double)l->open[i], e);
    }
    assert_in_range(known, PLACES - PLACES / 100, PLACES);
    memset(counts, 0, points * sizeof *counts); /* no ray yet */
    host_lab_find()->open(&l->scene, l->table.records, counts, l->places, PLACES, l->open);
    for (uint32_t i = 0; i < PLACES; i++)
        assert_true(l->open[i] == 1.0f);
    free(counts);
    close_lab(l);
}

/* The cells with receivers for points, of which every third is none: the n-th has the number n * 3 + 1 as it is red, green
 * twice as much. Cells are numbered as they come, so that `first` is of no order in the table. */
static uint32_t put_receivers(lab *l, float *receivers) {
    vit_text why;
    uint32_t count = 0;
    vit_cache_cell *cells = calloc(l->met.cell_count + l->walls.count + 1, sizeof *cells);
    assert_non_null(cells);
    for (uint32_t i = 0; i < l->met.cell_count; i++) {
        cells[i] = cache_cell_record(&l->met.cells[i]);
        cells[i].word[0] = count;
        for (uint32_t q = 0, n = 0; q < VIT_CACHE_POINTS; q++) {
            const uint32_t point = i * VIT_CACHE_POINTS + q;
            const bool known = point % 3 != 0;
            cells[i].word[1] |= (known ? n++ : VIT_POINT_NONE) << VIT_POINT_BITS * q;
            if (known) {
                const float value = (float)any_code(point);
                memcpy(receivers + 4 * (size_t)count++, (float[4]){value, 2 * value, 1, -1}, 4 * sizeof *receivers);
            }
        }
    }
    const uint32_t all = l->met.cell_count + cache_walls_put(&l->walls, cells + l->met.cell_count);
    assert_int_equal(cache_table_fit(cells, all, &l->table, &why), VIT_OK);
    assert_int_equal(l->table.filled, all);
    free(cells);
    l->scene.receiver_cells = l->table.count;
    l->scene.point_levels = l->scene.cache_levels;
    l->scene.point_step = l->scene.cache_step;
    l->scene.point_detail = l->scene.cache_detail;
    l->scene.cache_levels = l->scene.cache_cells = 0;
    return count;
}

static void receivers_at_points_are_read_as_the_baker_says(void **state) {
    (void)state;
    static float out[3 * PLACES];
    for (uint32_t run = 0; run < 2; run++) {
        lab *l = open_lab(0.37f, 4, 12.0f);
        if (run == 1)
            part_cells(l);
        float *receivers = malloc(((size_t)l->met.cell_count * VIT_CACHE_POINTS + 1) * 4 * sizeof *receivers);
        assert_non_null(receivers);
        (void)put_receivers(l, receivers);
        host_lab_find()->point(&l->scene, l->table.records, receivers, l->places, PLACES, out);
        uint32_t known = 0;
        for (uint32_t i = 0; i < PLACES; i++) {
            const double code = expected_code(l, i, 3);
            known += isfinite(code);
            if (isfinite(code) && !(fabs(code - (double)out[i]) < 0.2 && fabs(2 * code - (double)out[PLACES + i]) < 0.4 &&
                                    fabsf(out[2 * PLACES + i] - 1) < 1e-5f))
                fail_msg("place %u: %g, expected %g", i, (double)out[i], code);
        }
        assert_in_range(known, PLACES - PLACES / 100, PLACES);
        free(receivers);
        close_lab(l);
    }
}

/* A place that goes away from the eye: cells of all levels about it know something. */
static void levels_change_without_a_jump(void **state) {
    (void)state;
    lab *l = calloc(1, sizeof *l);
    vit_text why;
    assert_non_null(l);
    l->scene = (vit_scene){.cache_levels = 5, .cache_step = 0.1f, .cache_detail = 1.0f};
    l->sights.sight = malloc(PLACES * sizeof *l->sights.sight);
    assert_non_null(l->sights.sight);
    l->sights.count = PLACES;
    const float p[3] = {-0.31f, 0.77f, -1.9f}, n[3] = {0.36f, -0.48f, 0.8f};
    for (uint32_t i = 0; i < PLACES; i++) {
        l->sights.sight[i] = (cache_sight){vec3_load(p), vec3_load(n), vec3_load(n), 20.0f * (float)i / PLACES, 0, 0, 0};
        for (uint32_t k = 0; k < 3; k++) {
            l->places[k * PLACES + i] = p[k];
            l->places[(3 + k) * PLACES + i] = n[k];
        }
        l->places[6 * PLACES + i] = l->sights.sight[i].distance;
    }
    assert_int_equal(cache_met_find(&l->scene, &l->sights, 255, NULL, &l->met, &why), VIT_OK);
    fill(l, any_code, 0);
    float least = 1.0f, most = 0.0f;
    for (uint32_t i = 1; i < PLACES; i++) {
        /* A step of distance is 0.005: of the fastest change, within half a unit of distance, a hundredth. */
        assert_true(fabsf(l->open[i] - l->open[i - 1]) < 0.012f);
        least = float_min(least, l->open[i]);
        most = float_max(most, l->open[i]);
    }
    assert_true(most - least > 0.01f); /* levels do differ */
    close_lab(l);
}

/* The nearest point has most of the weight, and a point that coincides with the place no more than all. */
static void a_place_on_a_point_is_finite(void **state) {
    (void)state;
    const cache_place at = {.box = {0, 0, 0}, .in = {0.25f + 0.5f * 0.5f / 1024.0f, 0.5f, 0.5f}};
    const int by[3] = {0, 0, 0};
    const uint32_t middle = 512u << 10 | 512u << 20;
    const float d2 = cache_distance2(&at, by, middle);
    assert_true(d2 >= 0.0f && d2 < 1e-6f);
    assert_true(cache_weight(d2) > 0.999f && cache_weight(0.0f) == 1.0f);
    assert_true(cache_weight(VIT_CACHE_REACH * VIT_CACHE_REACH) < 1e-12f && cache_weight(27.0f) == 0.0f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_kernel_reads_what_the_baker_wrote),
        cmocka_unit_test(what_all_points_agree_upon_is_so_everywhere),
        cmocka_unit_test(where_nothing_is_known_it_is_open),
        cmocka_unit_test(receivers_at_points_are_read_as_the_baker_says),
        cmocka_unit_test(levels_change_without_a_jump),
        cmocka_unit_test(a_place_on_a_point_is_finite),
        cmocka_unit_test(a_point_counts_by_its_rays_where_they_are_found_while_playing),
    };
    return cmocka_run_group_tests_name("cache kernel", tests, NULL, NULL);
}
