/* Vertices in fewer bits: how far they may move, what must not tear, and what is dropped. The model is a soup of random
 * triangles, many of them with shared or repeated corners and some far smaller than a step of the grid. */
#include "kernel_lab.h"
#include "common/octahedral.h"
#include "geometry/quantise.h"
#include <math.h>

enum { VERTICES = 3000, TRIANGLES = 4000, TINY = 100, MATERIALS = 2 };

typedef struct soup {
    model m, q;
    float position[3 * VERTICES], normal[3 * VERTICES];
    uint32_t index[3 * TRIANGLES], material[TRIANGLES];
    model_material materials[MATERIALS];
} soup;

static void random_unit(uint64_t *random, float n[3]) {
    float length = 0;
    while (length < 0.1f || length > 1.0f) {
        length = 0;
        for (int k = 0; k < 3; k++) {
            n[k] = 2.0f * lab_uniform(random) - 1.0f;
            length += n[k] * n[k];
        }
    }
    for (int k = 0; k < 3; k++)
        n[k] /= sqrtf(length);
}

/* A box of 40 x 10 x 0 m from (-30, 2, 7) on: one axis has no extent. The last TINY triangles are of material 1 and a
 * micrometre wide. */
static soup *soup_make(void) {
    uint64_t random = 3;
    soup *s = calloc(1, sizeof *s);
    assert_non_null(s);
    for (uint32_t v = 0; v < VERTICES; v++) {
        float *p = s->position + 3 * (size_t)v;
        p[0] = v == 0 ? -30.0f : v == 1 ? 10.0f : -30.0f + 40.0f * lab_uniform(&random);
        p[1] = v == 0 ? 2.0f : v == 1 ? 12.0f : 2.0f + 10.0f * lab_uniform(&random);
        p[2] = 7.0f;
        if (v >= 1000 && v < 2000) /* the same places again */
            memcpy(p, p - 3000, 3 * sizeof *p);
        random_unit(&random, s->normal + 3 * (size_t)v);
    }
    const float middle[3][2] = {{5.0f, 5.0f}, {5.000001f, 5.0f}, {5.0f, 5.000001f}};
    for (uint32_t v = 0; v < 3; v++)
        memcpy(s->position + 3 * (size_t)(VERTICES - 3 + v), middle[v], sizeof middle[v]);
    for (uint32_t t = 0; t < TRIANGLES; t++)
        for (uint32_t k = 0; k < 3; k++)
            s->index[3 * t + k] = t < TRIANGLES - TINY ? (3 * t + k) * 7 % (VERTICES - 3) : VERTICES - 3 + k;
    for (uint32_t t = 0; t < TRIANGLES; t++)
        s->materials[s->material[t] = t >= TRIANGLES - TINY].triangles++;
    s->m = (model){.position = s->position,
                   .normal = s->normal,
                   .vertices = VERTICES,
                   .index = s->index,
                   .material = s->material,
                   .triangles = TRIANGLES,
                   .materials = s->materials,
                   .material_count = MATERIALS,
                   .lo = {-30, 2, 7},
                   .hi = {10, 12, 7},
                   .degenerate = 5};
    return s;
}

static soup *quantised(int vertex_bits, int normal_bits) {
    soup *s = soup_make();
    vit_text why = {""};
    if (model_quantise(&s->m, vertex_bits, normal_bits, &s->q, &why) != VIT_OK)
        fail_msg("%s", why.text);
    return s;
}

static void drop(soup *s) {
    model_quantise_free(&s->q);
    free(s);
}

static void vertices_lie_on_the_grid_at_most_half_a_step_away(void **state) {
    (void)state;
    soup *s = quantised(16, 16);
    uint32_t moved = 0;
    for (uint32_t i = 0; i < 3 * VERTICES; i++) {
        const double step = (s->m.hi[i % 3] - s->m.lo[i % 3]) / 65535, at = (double)s->q.position[i],
                     was = (double)s->position[i];
        moved += at != was;
        if (step == 0) {
            assert_true(at == was);
            continue;
        }
        const double steps = (at - s->m.lo[i % 3]) / step;
        assert_true(fabs(at - was) <= 0.5 * step + 2e-6);
        assert_true(fabs(steps - round(steps)) * step < 2e-6);
        assert_true(at >= s->m.lo[i % 3] && at <= s->m.hi[i % 3]);
    }
    assert_true(moved > VERTICES);
    drop(s);
}

static void vertices_at_one_place_stay_at_one_place(void **state) {
    (void)state;
    soup *s = quantised(16, 16);
    for (uint32_t v = 1000; v < 2000; v++)
        assert_memory_equal(s->q.position + 3 * (size_t)v, s->q.position + 3 * (size_t)(v - 1000), 3 * sizeof(float));
    drop(s);
}

static void triangles_smaller_than_the_grid_are_dropped_and_counted(void **state) {
    (void)state;
    soup *s = quantised(16, 16);
    assert_true(s->q.triangles <= TRIANGLES - TINY && s->q.triangles > TRIANGLES - TINY - 50);
    assert_int_equal(s->q.degenerate, 5 + TRIANGLES - s->q.triangles);
    assert_int_equal(s->q.materials[1].triangles, 0);
    assert_int_equal(s->q.materials[0].triangles, s->q.triangles);
    for (uint32_t t = 0; t < s->q.triangles; t++)
        assert_int_equal(s->q.material[t], 0);
    assert_int_equal(s->m.triangles, TRIANGLES); /* the model itself is as it was */
    assert_int_equal(s->m.materials[1].triangles, TINY);
    drop(s);
}

static void a_scene_that_vanishes_is_refused(void **state) {
    (void)state;
    soup *s = soup_make();
    vit_text why = {""};
    memmove(s->index, s->index + 3 * (TRIANGLES - TINY), 3 * TINY * sizeof *s->index);
    s->m.triangles = TINY;
    assert_int_equal(model_quantise(&s->m, 16, 16, &s->q, &why), VIT_BAD_INPUT);
    assert_non_null(strstr(why.text, "vertex_bits"));
    free(s);
}

static void normals_of_8_bits_are_unit_and_off_by_no_more_than_stated(void **state) {
    (void)state;
    soup *s = quantised(32, 8);
    double worst = 0;
    for (uint32_t v = 0; v < VERTICES; v++) {
        const float *a = s->normal + 3 * (size_t)v, *b = s->q.normal + 3 * (size_t)v;
        double d2 = 0, length2 = 0;
        for (int k = 0; k < 3; k++) {
            d2 += ((double)a[k] - (double)b[k]) * ((double)a[k] - (double)b[k]);
            length2 += (double)b[k] * (double)b[k];
        }
        assert_true(fabs(length2 - 1) < 1e-6);
        worst = fmax(worst, 2 * asin(sqrt(d2) / 2));
    }
    print_message("worst angle %g\n", worst);
    assert_true(worst < 1.3e-2 && worst > 0.5e-2);
    assert_memory_equal(s->q.position, s->position, sizeof s->position);
    drop(s);
}

static void full_bits_change_nothing(void **state) {
    (void)state;
    soup *s = quantised(32, 16);
    assert_memory_equal(s->q.position, s->position, sizeof s->position);
    assert_memory_equal(s->q.normal, s->normal, sizeof s->normal);
    assert_memory_equal(s->q.index, s->index, sizeof s->index);
    assert_int_equal(s->q.degenerate, 5);
    drop(s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vertices_lie_on_the_grid_at_most_half_a_step_away),
        cmocka_unit_test(vertices_at_one_place_stay_at_one_place),
        cmocka_unit_test(triangles_smaller_than_the_grid_are_dropped_and_counted),
        cmocka_unit_test(a_scene_that_vanishes_is_refused),
        cmocka_unit_test(normals_of_8_bits_are_unit_and_off_by_no_more_than_stated),
        cmocka_unit_test(full_bits_change_nothing),
    };
    return cmocka_run_group_tests_name("quantise", tests, NULL, NULL);
}
