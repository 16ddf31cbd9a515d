/* Cells of triangles' sides: the C of bake/geometry/cells.c against geometry, and kernels/cells.clh against that C.
 *
 * What could go wrong silently: a formula for a cell's number that is right inside and wrong along edges, where no picture
 * shows it. So the cells' areas must add up to the side's, a point must lie in the cell that it is said to lie in, and the
 * kernel must give the very same numbers as the C for many points, among them corners, edges and points that rounding has put a
 * little outside. */
#include "geometry/cells.h"
#include "kernel_lab.h"

#include <math.h>

enum { TRIANGLES = 40, SIDES = 2 * TRIANGLES, POINTS = 100000 };

typedef struct fixture {
    vit_triangle triangles[TRIANGLES];
    vit_attributes attributes[TRIANGLES];
    geometry g;
    cells c;
} fixture;

static vec3 cross(vec3 a, vec3 b) {
    return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static void put_triangle(vit_triangle *t, const float v[9]) {
    const vec3 n = cross(vec3_sub(vec3_load(v + 3), vec3_load(v)), vec3_sub(vec3_load(v + 6), vec3_load(v)));
    *t = (vit_triangle){{v[0], v[1], v[2]}, n.x, {v[3], v[4], v[5]}, n.y, {v[6], v[7], v[8]}, n.z};
}

/* Side i is divided as if it had (i mod 17) / 2 + 1 parts or so. */
static float some_edge(void *user, uint32_t side) {
    const fixture *f = user;
    return sqrtf(2.0f * side_area(&f->g, side)) / (0.9f + 0.5f * (float)(side % 17));
}

static float fixed_edge(void *user, uint32_t side) {
    (void)side;
    return *(const float *)user;
}

static fixture *make(void) {
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    uint64_t random = 7;
    vit_text why = {""};
    for (int i = 0; i < TRIANGLES; i++) {
        float v[9];
        for (int k = 0; k < 9; k++)
            v[k] = 4.0f * lab_uniform(&random) - 2.0f;
        put_triangle(f->triangles + i, v);
    }
    f->g = (geometry){f->triangles, f->attributes, 0.0f, 0.0f};
    assert_int_equal(cells_divide(&f->g, TRIANGLES, some_edge, f, &f->c, &why), VIT_OK);
    return f;
}

static void drop(fixture *f) {
    cells_free(&f->c);
    free(f);
}

static uint32_t parts_of(const cells *c, uint32_t side) {
    return c->sides[side] >> VIT_SIDE_PARTS_SHIFT;
}

/* Twice the area in the plane of the weights; a whole side has 1. */
static double weights_area(cell_corners k) {
    const double ux = (double)k.b1[1] - (double)k.b1[0], uy = (double)k.b2[1] - (double)k.b2[0];
    const double vx = (double)k.b1[2] - (double)k.b1[0], vy = (double)k.b2[2] - (double)k.b2[0];
    return fabs(ux * vy - uy * vx);
}

static void cells_follow_one_another_side_by_side(void **state) {
    (void)state;
    fixture *f = make();
    uint32_t next = 0, most = 0;
    for (uint32_t i = 0; i < SIDES; i++) {
        const uint32_t parts = parts_of(&f->c, i);
        assert_int_equal(f->c.sides[i] & VIT_SIDE_CELL, next);
        for (uint32_t k = 0; k < parts * parts; k++)
            assert_int_equal(f->c.side_of[next + k], i);
        next += parts * parts;
        most = parts > most ? parts : most;
    }
    assert_int_equal(next, f->c.count);
    assert_in_range(most, 8, 16); /* or the tests below saw little */
    drop(f);
}

static void a_sides_cells_are_equally_large_and_add_up_to_it(void **state) {
    (void)state;
    fixture *f = make();
    for (uint32_t i = 0; i < SIDES; i++) {
        const uint32_t first = f->c.sides[i] & VIT_SIDE_CELL, count = parts_of(&f->c, i) * parts_of(&f->c, i);
        double sum = 0.0, metres = 0.0;
        for (uint32_t k = first; k < first + count; k++) {
            const cell_corners at = cells_corners(&f->c, k);
            assert_true(fabs(weights_area(at) * count - 1.0) < 1e-3);
            const vec3 a = side_place(&f->g, i, at.b1[0], at.b2[0]), b = side_place(&f->g, i, at.b1[1], at.b2[1]),
                       c = side_place(&f->g, i, at.b1[2], at.b2[2]), n = cross(vec3_sub(b, a), vec3_sub(c, a));
            assert_true(fabsf(0.5f * sqrtf(vec3_dot(n, n)) / cells_area(&f->c, &f->g, k) - 1.0f) < 2e-3f);
            sum += weights_area(at);
            metres += (double)cells_area(&f->c, &f->g, k);
        }
        assert_true(fabs(sum - 1.0) < 1e-5);
        assert_true(fabs(metres / (double)side_area(&f->g, i) - 1.0) < 1e-4);
    }
    drop(f);
}

/* How far a place lies outside a cell, by its least weight there. */
static double outside(cell_corners k, double b1, double b2) {
    const double ux = (double)k.b1[1] - (double)k.b1[0], uy = (double)k.b2[1] - (double)k.b2[0];
    const double vx = (double)k.b1[2] - (double)k.b1[0], vy = (double)k.b2[2] - (double)k.b2[0];
    const double px = b1 - (double)k.b1[0], py = b2 - (double)k.b2[0], d = ux * vy - uy * vx;
    const double w1 = (px * vy - py * vx) / d, w2 = (ux * py - uy * px) / d, w0 = 1.0 - w1 - w2;
    return -fmin(w0, fmin(w1, w2));
}

/* Point i: a side, its weights. Every fourth is special: on a line between cells, on an edge, at a corner, a little outside. */
typedef struct point {
    uint32_t side;
    float b1, b2;
} point;

static point point_at(const fixture *f, uint32_t i, uint64_t *random) {
    point p = {(uint32_t)(lab_random(random) % SIDES), lab_uniform(random), lab_uniform(random)};
    const float n = (float)parts_of(&f->c, p.side);
    if (p.b1 + p.b2 > 1.0f) {
        p.b1 = 1.0f - p.b1;
        p.b2 = 1.0f - p.b2;
    }
    switch (i % 16) {
    case 0:
        p.b1 = floorf(p.b1 * n) / n;
        break;
    case 4:
        p.b2 = 1.0f - p.b1;
        break;
    case 8:
        p.b1 = i & 16 ? 0.0f : 1.0f, p.b2 = i & 16 ? (float)(i >> 5 & 1) : 0.0f;
        break;
    case 12:
        p.b1 = i & 16 ? -1e-6f : p.b1, p.b2 = i & 16 ? p.b2 : 1.000001f - p.b1;
        break;
    default:
        break;
    }
    return p;
}

static void a_point_lies_in_the_cell_that_is_looked_up_for_it(void **state) {
    (void)state;
    fixture *f = make();
    uint64_t random = 1;
    uint8_t *hit = calloc(f->c.count, 1);
    assert_non_null(hit);
    uint32_t missed = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        const point p = point_at(f, i, &random);
        const uint32_t cell = cells_at(&f->c, p.side, p.b1, p.b2);
        assert_in_range(cell, 0, f->c.count - 1);
        assert_int_equal(f->c.side_of[cell], p.side);
        hit[cell] = 1;
        if (outside(cells_corners(&f->c, cell), (double)p.b1, (double)p.b2) > 1e-4)
            fail_msg("point %u: %.9g, %.9g of side %u is not in cell %u", i, (double)p.b1, (double)p.b2, p.side, cell);
    }
    for (uint32_t i = 0; i < f->c.count; i++)
        missed += !hit[i];
    assert_int_equal(missed, 0);
    for (uint32_t i = 0; i < f->c.count; i++) { /* and a cell's centre leads back to it */
        const cell_corners k = cells_corners(&f->c, i);
        const float b1 = (k.b1[0] + k.b1[1] + k.b1[2]) / 3.0f, b2 = (k.b2[0] + k.b2[1] + k.b2[2]) / 3.0f;
        assert_int_equal(cells_at(&f->c, f->c.side_of[i], b1, b2), i);
    }
    free(hit);
    drop(f);
}

static const char look_up[] =
    "kernel void look_up(global const uint *sides, global const int *side, global const int *hit, global const float *b,\n"
    "                    global int *index, global float *weight)\n"
    "{\n"
    "    uint first = (uint)get_global_id(0) * VIT_LANES, n = (uint)get_global_size(0) * VIT_LANES;\n"
    "    li s = L_LOAD(side + first);\n"
    "    cell_place at = cell_at(sides, L_LOAD(hit + first), s >> 1, -(s & 1), L_LOAD(b + first), L_LOAD(b + n + first));\n"
    "    L_STORE(at.index, index + first);\n"
    "    L_STORE(at.w0, weight + first);\n"
    "    L_STORE(at.w1, weight + n + first);\n"
    "    L_STORE(at.w2, weight + 2 * n + first);\n"
    "}\n";

typedef struct looked_up {
    int side[POINTS], hit[POINTS], index[POINTS];
    float b[2 * POINTS], weight[3 * POINTS];
} looked_up;

static void run_kernel(const fixture *f, unsigned lanes, looked_up *p) {
    lab l = lab_open(lanes, VIT_BIT(LIGHTS) | VIT_BIT(INDIRECT) | VIT_BIT(PHOTONS) | VIT_BIT(LIST) | VIT_BIT(AREA), look_up);
    const cl_mem arguments[] = {lab_buffer(&l, f->c.sides, SIDES * sizeof *f->c.sides),
                                lab_buffer(&l, p->side, sizeof p->side),
                                lab_buffer(&l, p->hit, sizeof p->hit),
                                lab_buffer(&l, p->b, sizeof p->b),
                                lab_buffer(&l, NULL, sizeof p->index),
                                lab_buffer(&l, NULL, sizeof p->weight)};
    lab_run(&l, "look_up", POINTS / lanes, arguments, 6);
    lab_read(&l, arguments[4], p->index, sizeof p->index);
    lab_read(&l, arguments[5], p->weight, sizeof p->weight);
    for (int i = 0; i < 6; i++)
        clReleaseMemObject(arguments[i]);
    lab_close(&l);
}

/* The kernel's weights are those of the cell's corners, in their order: they give the point back. */
static void check_weights(const fixture *f, const looked_up *p, uint32_t i) {
    const float *w = p->weight + i, b1 = p->b[i], b2 = p->b[POINTS + i];
    const cell_corners k = cells_corners(&f->c, (uint32_t)p->index[i]);
    const double w0 = (double)w[0], w1 = (double)w[POINTS], w2 = (double)w[2 * POINTS];
    if (fabs(w0 + w1 + w2 - 1.0) > 1e-4 || w0 < 0.0 || w1 < 0.0 || w2 < 0.0 ||
        fabs(w0 * (double)k.b1[0] + w1 * (double)k.b1[1] + w2 * (double)k.b1[2] - (double)b1) > 1e-5 ||
        fabs(w0 * (double)k.b2[0] + w1 * (double)k.b2[1] + w2 * (double)k.b2[2] - (double)b2) > 1e-5)
        fail_msg("point %u: %g, %g has weights %g %g %g", i, (double)b1, (double)b2, w0, w1, w2);
}

static void kernels_look_up_the_same_cells_at_every_width(void **state) {
    (void)state;
    fixture *f = make();
    looked_up *p = calloc(LAB_WIDTHS, sizeof *p);
    assert_non_null(p);
    assert_int_equal(POINTS % 16, 0);
    for (unsigned k = 0; k < LAB_WIDTHS; k++) {
        uint64_t random = 2;
        for (uint32_t i = 0; i < POINTS; i++) {
            const point at = point_at(f, i, &random);
            p[k].side[i] = (int)at.side;
            p[k].hit[i] = -1;
            p[k].b[i] = at.b1;
            p[k].b[POINTS + i] = at.b2;
        }
        run_kernel(f, lab_lanes[k], p + k);
        for (uint32_t i = 0; i < POINTS; i++) {
            assert_int_equal(p[k].index[i], cells_at(&f->c, (uint32_t)p[k].side[i], p[k].b[i], p[k].b[POINTS + i]));
            check_weights(f, p + k, i);
        }
        assert_memory_equal(p[k].weight, p[0].weight, sizeof p->weight);
    }
    free(p);
    drop(f);
}

/* Lanes that hit nothing hold whatever is there. */
static void a_lane_that_hit_nothing_reads_a_cell_that_exists(void **state) {
    (void)state;
    static const float any[] = {NAN, INFINITY, -INFINITY, 3e38f, -3e38f, 0.0f, 1.0f, -NAN};
    fixture *f = make();
    looked_up *p = calloc(1, sizeof *p);
    assert_non_null(p);
    for (unsigned k = 0; k < LAB_WIDTHS; k++) {
        for (uint32_t i = 0; i < POINTS; i++) {
            p->side[i] = (int)(0x7ffffffe - i);
            p->b[i] = any[i % 8];
            p->b[POINTS + i] = any[i / 8 % 8];
        }
        run_kernel(f, lab_lanes[k], p);
        for (uint32_t i = 0; i < POINTS; i++)
            assert_in_range(p->index[i], 0, f->c.count - 1);
    }
    free(p);
    drop(f);
}

/* Divides copies of a triangle by one edge. */
static cells divided(const float v[9], uint32_t triangles, float edge) {
    vit_triangle *t = calloc(triangles, sizeof *t);
    assert_non_null(t);
    for (uint32_t i = 0; i < triangles; i++)
        put_triangle(t + i, v);
    const geometry g = {t, NULL, 0.0f, 0.0f};
    cells c;
    vit_text why = {""};
    assert_int_equal(cells_divide(&g, triangles, fixed_edge, &edge, &c, &why), VIT_OK);
    free(t);
    return c;
}

static const float right_angle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, sliver[9] = {0, 0, 0, 100, 0, 0, 0, 0.001f, 0};

static void cells_edges_are_no_longer_than_asked_for(void **state) {
    (void)state;
    cells c = divided(right_angle, 1, 0.125f);
    const uint32_t parts = parts_of(&c, 0);
    assert_in_range(parts, 8, 12);
    assert_int_equal(c.count, 2 * parts * parts);
    cells_free(&c);
    c = divided(right_angle, 1, 5.0f);
    assert_int_equal(parts_of(&c, 0), 1);
    cells_free(&c);
}

static void a_side_has_at_most_255_parts_and_a_sliver_fewer_than_its_length_asks_for(void **state) {
    (void)state;
    cells c = divided(right_angle, 1, 1e-4f);
    assert_int_equal(parts_of(&c, 0), 255);
    assert_int_equal(cells_at(&c, 1, 0.0f, 1.0f), 255 * 255 + 2 * 254);
    assert_int_equal(cells_at(&c, 1, 1.0f, 0.0f), 2 * 255 * 255 - 1);
    cells_free(&c);
    c = divided(sliver, 1, 1.0f);
    assert_in_range(parts_of(&c, 0), 10, 60); /* a hundred parts would be ten thousand cells */
    cells_free(&c);
}

static void many_sides_share_the_cells_that_there_are(void **state) {
    (void)state;
    cells c = divided(right_angle, 100, 1e-4f); /* 200 sides of 255^2 cells would be 13 million */
    const uint32_t parts = parts_of(&c, 0);
    assert_in_range(c.count, 1u << 22, 1u << 23);
    assert_in_range(parts, 100, 204);
    for (uint32_t i = 0; i < 200; i++)
        assert_int_equal(parts_of(&c, i), parts);
    cells_free(&c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_follow_one_another_side_by_side),
        cmocka_unit_test(a_sides_cells_are_equally_large_and_add_up_to_it),
        cmocka_unit_test(a_point_lies_in_the_cell_that_is_looked_up_for_it),
        cmocka_unit_test(kernels_look_up_the_same_cells_at_every_width),
        cmocka_unit_test(a_lane_that_hit_nothing_reads_a_cell_that_exists),
        cmocka_unit_test(cells_edges_are_no_longer_than_asked_for),
        cmocka_unit_test(a_side_has_at_most_255_parts_and_a_sliver_fewer_than_its_length_asks_for),
        cmocka_unit_test(many_sides_share_the_cells_that_there_are),
    };
    return cmocka_run_group_tests_name("cells", tests, NULL, NULL);
}
