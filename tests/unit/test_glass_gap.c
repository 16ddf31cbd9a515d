/* Glass drawn in: faces move by the gap, bodies stay closed, nothing else moves, and triangles too small for the gap keep their
 * way round. */
#include "geometry/glass_inset.h"
#include "common/triangle.h"
#include "vitrine_pack.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>
#include <cmocka.h>

#define GAP 0.015 /* of ray offsets of 0.01 m */

/* A box of glass, its faces with corners of their own, and a floor under it that shares their places. */
enum { FACES = 7, VERTICES = 4 * FACES, TRIANGLES = 2 * FACES };
static float position[3 * VERTICES], before[3 * VERTICES];
static uint32_t indices[3 * TRIANGLES], material[TRIANGLES];
static model_material materials[2];

static model box(double size) {
    static const int face[FACES][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3},
                                       {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 4, 5, 1}};
    for (uint32_t f = 0; f < FACES; f++) {
        static const uint32_t two[6] = {0, 1, 2, 0, 2, 3};
        for (uint32_t k = 0; k < 4; k++) {
            const int c = face[f][k];
            float *p = position + 3 * (4 * f + k);
            p[0] = (float)(c & 1 ? size : 0);
            p[1] = (float)(c & 2 ? size : 0);
            p[2] = (float)(c & 4 ? size : 0);
        }
        for (uint32_t k = 0; k < 6; k++)
            indices[6 * f + k] = 4 * f + two[k];
        material[2 * f] = material[2 * f + 1] = f == FACES - 1;
    }
    memset(materials, 0, sizeof materials);
    materials[0].kind = VIT_GLASS;
    memcpy(before, position, sizeof before);
    return (model){.position = position,
                   .vertices = VERTICES,
                   .index = indices,
                   .material = material,
                   .triangles = TRIANGLES,
                   .materials = materials,
                   .material_count = 2};
}

static void normal_of(const float *p, uint32_t triangle, double n[3]) {
    float f[3];
    triangle_normal(p + 3 * indices[3 * triangle], p + 3 * indices[3 * triangle + 1], p + 3 * indices[3 * triangle + 2], f);
    for (int k = 0; k < 3; k++)
        n[k] = (double)f[k];
}

/* All glass triangles still look the way that they did, and are not much smaller. */
static void draw_in_without_turning(model *m) {
    assert_true(glass_inset(m, 0.01f));
    for (uint32_t t = 0; t < TRIANGLES - 2; t++) {
        double a[3], b[3];
        normal_of(before, t, a);
        normal_of(position, t, b);
        assert_true(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] > 0.25 * (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]));
    }
}

static void each_face_of_a_box_moves_in_by_the_gap(void **unused) {
    (void)unused;
    model m = box(2.0);
    assert_true(glass_inset(&m, 0.01f));
    for (int i = 0; i < 3 * (VERTICES - 4); i++)
        assert_true(fabs((double)position[i] - (before[i] > 0.0f ? 2.0 - GAP : GAP)) < 1e-6);
    assert_memory_equal(position + 3 * (VERTICES - 4), before + 3 * (VERTICES - 4), 12 * sizeof *position); /* the floor */
}

static void a_closed_body_stays_closed(void **unused) {
    (void)unused;
    model m = box(2.0);
    before[0] = position[0] = -0.0f; /* the same place as 0 */
    assert_true(glass_inset(&m, 0.01f));
    for (int i = 0; i < VERTICES - 4; i++)
        for (int j = 0; j < i; j++) {
            bool together = true;
            for (int k = 0; k < 3; k++)
                together = together && before[3 * i + k] == before[3 * j + k];
            assert_int_equal(together, memcmp(position + 3 * i, position + 3 * j, 3 * sizeof *position) == 0);
        }
}

static void small_triangles_keep_their_way_round(void **unused) {
    (void)unused;
    model m = box(0.001); /* the gap is 15 times as large */
    draw_in_without_turning(&m);
    assert_true(position[0] > 0.0f);
}

/* A face of 2 m x 2 m by a needle of two triangles 1 mm high. */
static void needles_keep_their_way_round(void **unused) {
    (void)unused;
    model m = box(2.0);
    for (int i = 0; i < VERTICES; i++)
        position[3 * i + 1] *= 0.0005f;
    memcpy(before, position, sizeof before);
    draw_in_without_turning(&m);
}

static void what_is_no_glass_does_not_move(void **unused) {
    static const uint32_t kinds[] = {VIT_MATTE, VIT_MIRROR, VIT_THIN_GLASS};
    (void)unused;
    for (size_t i = 0; i < 3; i++) {
        model m = box(2.0);
        materials[0].kind = kinds[i];
        assert_true(glass_inset(&m, 0.01f));
        assert_memory_equal(position, before, sizeof before);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_face_of_a_box_moves_in_by_the_gap), cmocka_unit_test(a_closed_body_stays_closed),
        cmocka_unit_test(small_triangles_keep_their_way_round), cmocka_unit_test(needles_keep_their_way_round),
        cmocka_unit_test(what_is_no_glass_does_not_move)};
    return cmocka_run_group_tests_name("glass gap", tests, NULL, NULL);
}
