/* kernels/receivers.cl against doubles: what samples get between receivers. test_relight_kernel.c has the pass relight.
 *
 * Why this is hard: numbers that are interpolated look right when neighbours are mixed up. Strategy: receivers at the corners
 * of cells get the values of a linear function of the place, which interpolation must give back everywhere, and each side,
 * each cell and each half of a parted cell has a function of its own. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "host_lab.h"
#include "kernel_lab.h"

#include <float.h>
#include <math.h>

enum {
    MOST_PARTS = 9,
    MOST_CELLS = MOST_PARTS * MOST_PARTS,
    DIVIDED = 3, /* parts of a side whose cells are divided, at most */
    MOST_RECORDS = 2 * MOST_CELLS + DIVIDED * DIVIDED * (int)(VIT_RECEIVER_PARTS * VIT_RECEIVER_PARTS),
    SAMPLES = 4096
};

/* One triangle whose front and back have `parts` x `parts` cells, with three receivers a cell and three more behind its split.
 */
typedef struct cell_lab {
    vit_triangle triangle;
    vit_u32 sides[2];
    vit_receiver_cell cells[MOST_RECORDS];
    vit_receiver_split splits[2 * MOST_CELLS];
    float light[2 * MOST_RECORDS * 3 * 4];
    float places[5 * SAMPLES], irradiance[3 * SAMPLES]; /* planes: position, b1, b2 */
    uint32_t hit[SAMPLES];
    int32_t back[SAMPLES];
} cell_lab;

static cell_lab lab_of_cells;

/* The function that a channel of a side has, of barycentric weights; behind: of the half behind the split. */
static double field(int side, int behind, int channel, double b1, double b2) {
    return 3.0 + side * 4.0 + behind * 8.0 + channel + (1.0 + channel) * b1 + (side ? -1.5 : 0.5 * channel) * b2;
}

/* The corners of cell (i, j), lower or upper: row i from b1 = i / n on. */
static void corners_of(int n, int i, int j, int upper, double corner[3][2]) {
    const int lower_at[3][2] = {{i, j}, {i + 1, j}, {i, j + 1}}, upper_at[3][2] = {{i + 1, j + 1}, {i + 1, j}, {i, j + 1}};
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 2; k++)
            corner[c][k] = (double)(upper ? upper_at : lower_at)[c][k] / n;
}

static void put_receivers(cell_lab *l, vit_u32 first, int side, int behind, double corner[3][2], vit_u32 receiver[3]) {
    for (vit_u32 c = 0; c < 3; c++) {
        receiver[c] = first + c;
        for (int k = 0; k < 3; k++)
            l->light[4 * receiver[c] + (vit_u32)k] = (float)field(side, behind, k, corner[c][0], corner[c][1]);
    }
}

/* Cells in the order of records.clh and cells.clh: row after row, lower and upper ones in turn. normal: of the splits' planes;
 * NULL: no cell is parted. */
static cell_lab *make_cells(int n, const float v0[3], const float v1[3], const float v2[3], const float *normal, float offset) {
    cell_lab *l = &lab_of_cells;
    memset(l, 0, sizeof *l);
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        l->triangle.v0[k] = v0[k];
        l->triangle.v1[k] = v1[k];
        l->triangle.v2[k] = v2[k];
        u[k] = (double)v1[k] - (double)v0[k];
        v[k] = (double)v2[k] - (double)v0[k];
    }
    l->triangle.nx = (float)(u[1] * v[2] - u[2] * v[1]);
    l->triangle.ny = (float)(u[2] * v[0] - u[0] * v[2]);
    l->triangle.nz = (float)(u[0] * v[1] - u[1] * v[0]);
    vit_u32 cell = 0;
    for (int side = 0; side < 2; side++) {
        l->sides[side] = (vit_u32)n << VIT_SIDE_PARTS_SHIFT | cell;
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n - i; j++)
                for (int upper = 0; upper < (i + j < n - 1 ? 2 : 1); upper++, cell++) {
                    double corner[3][2];
                    corners_of(n, i, j, upper, corner);
                    put_receivers(l, 6 * cell, side, 0, corner, l->cells[cell].receiver);
                    put_receivers(l, 6 * cell + 3, side, 1, corner, l->splits[cell].receiver);
                    l->cells[cell].split = normal ? cell : VIT_NONE;
                    for (int k = 0; k < 3 && normal; k++)
                        l->splits[cell].normal[k] = normal[k];
                    l->splits[cell].offset = offset;
                }
    }
    assert_int_equal(cell, 2 * n * n);
    return l;
}

/* Divides a cell into parts[0] along each edge, these into parts[1] and so on up to a 0; the last get the light behind a
 * split. The next free record and receiver. */
static void divide(cell_lab *l, vit_u32 cell, double of[3][2], const int *parts, vit_u32 *record, vit_u32 *receiver) {
    vit_u32 part = *record;
    l->cells[cell] = (vit_receiver_cell){.receiver = {part, 0, 0}, .split = VIT_RECEIVER_DIVIDED | (vit_u32)parts[0]};
    *record += (vit_u32)(parts[0] * parts[0]);
    assert_true(*record <= MOST_RECORDS);
    for (int x = 0; x < parts[0]; x++)
        for (int y = 0; y < parts[0] - x; y++)
            for (int up = 0; up < (x + y < parts[0] - 1 ? 2 : 1); up++, part++) {
                double within[3][2], corner[3][2];
                corners_of(parts[0], x, y, up, within);
                for (int c = 0; c < 3; c++)
                    for (int k = 0; k < 2; k++)
                        corner[c][k] = of[0][k] + within[c][0] * (of[1][k] - of[0][k]) + within[c][1] * (of[2][k] - of[0][k]);
                if (parts[1]) {
                    divide(l, part, corner, parts + 1, record, receiver);
                    continue;
                }
                put_receivers(l, *receiver, 1, 1, corner, l->cells[part].receiver);
                l->cells[part].split = VIT_NONE;
                *receiver += 3;
            }
}

/* Divides each cell of the back. */
static void divide_back(cell_lab *l, int n, const int *parts) {
    vit_u32 record = 2u * (vit_u32)(n * n), cell = (vit_u32)(n * n), receiver = 6 * record;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n - i; j++)
            for (int upper = 0; upper < (i + j < n - 1 ? 2 : 1); upper++, cell++) {
                double of[3][2];
                corners_of(n, i, j, upper, of);
                divide(l, cell, of, parts, &record, &receiver);
            }
}

/* Place i at these weights, on a side. */
static void put_place(cell_lab *l, uint32_t i, double b1, double b2, int side) {
    const vit_triangle *t = &l->triangle;
    l->hit[i] = 0;
    l->back[i] = -side;
    l->places[3 * SAMPLES + i] = (float)b1;
    l->places[4 * SAMPLES + i] = (float)b2;
    for (uint32_t k = 0; k < 3; k++) {
        const double a = (double)t->v0[k];
        l->places[k * SAMPLES + i] = (float)(a + b1 * ((double)t->v1[k] - a) + b2 * ((double)t->v2[k] - a));
    }
}

/* What a channel of place i should get. */
static double field_of(const cell_lab *l, uint32_t i, int behind, int channel) {
    return field(-l->back[i], behind, channel, (double)l->places[3 * SAMPLES + i], (double)l->places[4 * SAMPLES + i]);
}

/* Corners of the lattice and of one four times as fine, which are edges and middles of cells, then anywhere inside. */
static void put_places(cell_lab *l, int n) {
    uint64_t random = 3;
    uint32_t i = 0;
    for (int side = 0; side < 2; side++)
        for (int a = 0; a <= 4 * n; a++)
            for (int b = 0; a + b <= 4 * n; b++)
                put_place(l, i++, a / (4.0 * n), b / (4.0 * n), side);
    assert_in_range(i, 1, SAMPLES - 100);
    for (; i < SAMPLES; i++) {
        double a = (double)lab_uniform(&random), b = (double)lab_uniform(&random);
        put_place(l, i, a + b > 1.0 ? 1.0 - a : a, a + b > 1.0 ? 1.0 - b : b, (int)(i % 2));
    }
}

static void receive(cell_lab *l) {
    const host_lab_received r = {.sides = l->sides, .cells = l->cells, .splits = l->splits};
    host_lab_find()->receive(&r, l->light, l->places, l->hit, l->back, SAMPLES, l->irradiance);
}

static const float corner0[3] = {0.5f, -1.0f, 2.0f}, corner1[3] = {3.0f, -0.5f, 1.0f}, corner2[3] = {1.0f, 2.0f, 2.5f};

static void a_linear_function_comes_back_in_every_cell_on_both_sides(void **state) {
    (void)state;
    for (int n = 1; n <= MOST_PARTS; n++) {
        cell_lab *l = make_cells(n, corner0, corner1, corner2, NULL, 0);
        double worst = 0.0;
        put_places(l, n);
        receive(l);
        for (uint32_t i = 0; i < SAMPLES; i++)
            for (uint32_t k = 0; k < 3; k++) {
                const double e = field_of(l, i, 0, (int)k);
                worst = fmax(worst, fabs((double)l->irradiance[k * SAMPLES + i] - e));
            }
        print_message("%d parts: worst %.3g\n", n, worst);
        assert_true(worst < 2e-5);
    }
}

static void a_divided_cell_has_the_light_of_its_parts(void **state) {
    (void)state;
    static const int parts[][VIT_RECEIVER_LEVELS + 1] = {{1},    {2},    {5},    {VIT_RECEIVER_PARTS},
                                                         {1, 1}, {3, 4}, {2, 7}, {2, 2, 3}};
    for (int n = 1; n <= DIVIDED; n++)
        for (size_t p = 0; p < sizeof parts / sizeof *parts; p++) {
            cell_lab *l = make_cells(n, corner0, corner1, corner2, NULL, 0);
            divide_back(l, n, parts[p]);
            put_places(l, n);
            receive(l);
            for (uint32_t i = 0; i < SAMPLES; i++)
                for (uint32_t k = 0; k < 3; k++) {
                    const double e = field_of(l, i, -l->back[i], (int)k);
                    assert_true(fabs((double)l->irradiance[k * SAMPLES + i] - e) < 1e-4);
                }
        }
}

static void samples_without_a_hit_get_nothing(void **state) {
    (void)state;
    cell_lab *l = make_cells(2, corner0, corner1, corner2, NULL, 0);
    put_places(l, 2);
    for (uint32_t i = 0; i < SAMPLES; i++)
        l->hit[i] = i % 3 == 0 || i < 64 ? VIT_NONE : 0;
    receive(l);
    for (uint32_t i = 0; i < SAMPLES; i++)
        for (uint32_t k = 0; k < 3; k++)
            assert_int_equal(l->irradiance[k * SAMPLES + i] == 0.0f, l->hit[i] == VIT_NONE);
}

/* Behind the plane, and on it, samples get the other receivers' light; the nearest to it may fall on either side. */
static void a_parted_cell_has_other_light_behind_its_plane(void **state) {
    (void)state;
    static const float normal[3] = {0.6f, 0.0f, -0.8f};
    for (int n = 1; n <= 4; n++) {
        cell_lab *l = make_cells(n, corner0, corner1, corner2, normal, -0.25f);
        uint32_t front = 0, back = 0;
        put_places(l, n);
        receive(l);
        for (uint32_t i = 0; i < SAMPLES; i++) {
            double height = 0.25;
            for (uint32_t k = 0; k < 3; k++)
                height += (double)normal[k] * (double)l->places[k * SAMPLES + i];
            const int behind = height <= 0.0;
            *(behind ? &back : &front) += 1;
            for (uint32_t k = 0; k < 3 && fabs(height) > 1e-6; k++) {
                const double e = field_of(l, i, behind, (int)k);
                assert_true(fabs((double)l->irradiance[k * SAMPLES + i] - e) < 4e-5);
            }
        }
        assert_true(front > 100 && back > 100);
    }
}

/* Exactly on the plane is behind it: the plane goes through dyadic places of a triangle of such corners. */
static void what_lies_on_the_plane_is_behind_it(void **state) {
    (void)state;
    static const float v0[3] = {0, 0, 0}, v1[3] = {1, 0, 0}, v2[3] = {0, 1, 0}, normal[3] = {1, 0, 0};
    cell_lab *l = make_cells(1, v0, v1, v2, normal, 0.25f);
    for (uint32_t i = 0; i < SAMPLES; i++)
        put_place(l, i, i % 2 ? 0.25 : nextafterf(0.25f, 1.0f), 0.5, 0);
    receive(l);
    for (uint32_t i = 0; i < SAMPLES; i++)
        assert_true(fabs((double)l->irradiance[i] - field(0, i % 2, 0, 0.25, 0.5)) < 1e-5);
}

/* Beyond the edges by what rounding makes of a hit, light is that of the edge. */
static void just_outside_is_the_edge(void **state) {
    (void)state;
    cell_lab *l = make_cells(3, corner0, corner1, corner2, NULL, 0);
    uint64_t random = 5;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        const double along = (double)lab_uniform(&random), off = 1e-6 * (double)lab_uniform(&random);
        put_place(l, i,
                  i % 3 == 0   ? -off
                  : i % 3 == 1 ? along
                               : along + off,
                  i % 3 == 0   ? along
                  : i % 3 == 1 ? -off
                               : 1.0 - along + off,
                  (int)(i % 2));
    }
    receive(l);
    for (uint32_t i = 0; i < SAMPLES; i++)
        assert_true(fabs((double)l->irradiance[i] - field_of(l, i, 0, 0)) < 1e-4);
}

/* Rays that are said to hit it, from all round. */
static void find_weights(cell_lab *l) {
    static float rays[7 * SAMPLES], distance[SAMPLES];
    const vit_scene scene = {.triangles = 1};
    const vit_attributes attributes = {.normal = {0}};
    const vit_material material = {.texture = VIT_NONE, .exponent = 1, .ior = 1};
    const host_lab_mesh m = {.scene = &scene, .triangles = &l->triangle, .attributes = &attributes, .materials = &material};
    uint64_t random = 11;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double d[3], length = 0.0;
        for (int k = 0; k < 3; k++) {
            d[k] = (double)lab_uniform(&random) - 0.5;
            length += d[k] * d[k];
        }
        distance[i] = i % 5 ? 1.0f : 0.0f;
        for (uint32_t k = 0; k < 3; k++) {
            const double unit = d[k] / sqrt(length);
            rays[k * SAMPLES + i] = (float)((double)l->places[k * SAMPLES + i] - unit * (double)distance[i]);
            rays[(3 + k) * SAMPLES + i] = (float)unit;
        }
    }
    host_lab_find()->weights(&m, rays, distance, l->hit, SAMPLES, l->places + 3 * SAMPLES, l->back);
}

/* Triangles of any size and shape that floats can state: light is a number, none below the least receiver's by more than
 * rounding, and at most twice the greatest's, where places have no meaning any more. */
static void degenerate_triangles_give_numbers(void **state) {
    (void)state;
    static const float sizes[] = {1e-30f, 1e-22f, 1e-20f, 3e-19f, 1e-12f, 1e-6f, 1.0f, 1e6f, 1e12f, 1e18f};
    static const float shapes[][3] = {{0, 1, 0}, {1, 1e-3f, 0}, {1, 1e-7f, 0}, {0.5f, 0, 1e-12f}, {-1, 1e-5f, 1e-5f}};
    uint32_t judged = 0;
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
        for (size_t h = 0; h < sizeof shapes / sizeof shapes[0]; h++)
            for (int n = 1; n <= 4; n += 3) {
                const float v0[3] = {0, 0, 0}, v1[3] = {sizes[s], 0, 0},
                            v2[3] = {sizes[s] * shapes[h][0], sizes[s] * shapes[h][1], sizes[s] * shapes[h][2]};
                cell_lab *l = make_cells(n, v0, v1, v2, NULL, 0);
                if (l->triangle.nx == 0.0f && l->triangle.ny == 0.0f && l->triangle.nz == 0.0f)
                    l->triangle.nz = FLT_TRUE_MIN; /* the loader takes no normal of 0 */
                put_places(l, n);
                for (uint32_t i = 0; i < SAMPLES; i += 7) /* and places that are not on it */
                    l->places[i % 3 * SAMPLES + i] += i % 2 ? 1.0f : -1e15f;
                find_weights(l);
                receive(l);
                judged++;
                for (uint32_t i = 0; i < SAMPLES; i++)
                    if (!(l->irradiance[i] >= 2.9f / 2 && l->irradiance[i] <= 2.0f * 13.0f))
                        fail_msg("size %g, shape %zu, %d parts: %g at %g %g", (double)sizes[s], h, n, (double)l->irradiance[i],
                                 (double)l->places[3 * SAMPLES + i], (double)l->places[4 * SAMPLES + i]);
            }
    assert_int_equal(judged, 100);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_linear_function_comes_back_in_every_cell_on_both_sides),
        cmocka_unit_test(a_divided_cell_has_the_light_of_its_parts),
        cmocka_unit_test(samples_without_a_hit_get_nothing),
        cmocka_unit_test(a_parted_cell_has_other_light_behind_its_plane),
        cmocka_unit_test(what_lies_on_the_plane_is_behind_it),
        cmocka_unit_test(just_outside_is_the_edge),
        cmocka_unit_test(degenerate_triangles_give_numbers),
    };
    return cmocka_run_group_tests_name("receivers", tests, NULL, NULL);
}
