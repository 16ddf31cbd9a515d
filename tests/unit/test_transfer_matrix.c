/* k reflections as one matrix, and its order.
 *
 * Why this is hard: a series that is cut off, one that converges slowly and one that does not at all look alike entry by entry.
 * Strategy: form factors whose powers have closed forms, and the plain iteration of bounces.c as a rival. */
#include "radiosity/bounces.h"
#include "radiosity/matrix_order.h"
#include "transfer_lab.h"

/* F F = F, so that all entries are (c + ... + c^k) / n. */
static void a_furnace_is_a_geometric_series(void **state) {
    static const float albedo[] = {0.0f, 0.5f, 0.9f, 0.99f};
    static const uint32_t sizes[] = {1, 3, 5, 64, 130};
    static const uint32_t bounces[] = {1, 2, 3, 64, TRANSFER_CONVERGED};
    (void)state;
    for (size_t s = 0; s < 5; s++)
        for (size_t a = 0; a < 4; a++)
            for (size_t b = 0; b < 5; b++) {
                const uint32_t n = sizes[s], k = bounces[b] == TRANSFER_CONVERGED ? 4000 : bounces[b];
                transfer_lab l = transfer_lab_open(n, factor_even);
                double right = 0.0, term = 1.0;
                transfer_lab_paint(&l, albedo[a]);
                for (uint32_t h = 0; h < k; h++)
                    right += term *= (double)albedo[a];
                transfer_matrix m = transfer_lab_matrix(&l, bounces[b], 1);
                assert_true(fabs(m.spectral[1] - (double)albedo[a]) < 1e-5);
                for (uint32_t i = 0; i < n * n; i++)
                    if (fabs((double)m.s[2][i] * n - right) > 1e-3 * right)
                        fail_msg("%u patches, albedo %g, %u bounces: %g instead of %g", n, (double)albedo[a], bounces[b],
                                 (double)m.s[2][i] * n, right);
                transfer_matrix_free(&m);
                transfer_lab_close(&l);
            }
}

static void an_albedo_of_one_converges_nowhere_but_64_reflections_of_it_count(void **state) {
    transfer_lab l = transfer_lab_open(40, factor_even);
    transfer_matrix m;
    vit_text why = {""};
    (void)state;
    transfer_lab_paint(&l, 1.0f);
    const transfer_matrix_input in = {.factors = &l.factors, .patches = &l.patches, .bounces = TRANSFER_CONVERGED};
    assert_int_equal(transfer_matrix_make(&in, &m, &why), VIT_BAD_INPUT);
    assert_non_null(strstr(why.text, "does not die out"));
    assert_null(m.s[0]);
    m = transfer_lab_matrix(&l, 64, 1);
    for (uint32_t i = 0; i < 40 * 40; i++)
        assert_true(fabsf(m.s[0][i] - 1.6f) < 1e-4f);
    transfer_matrix_free(&m);
    transfer_lab_close(&l);
}

static void the_product_is_what_reflecting_one_after_the_other_gives(void **state) {
    static const uint32_t bounces[] = {1, 3, 64, TRANSFER_CONVERGED};
    enum { N = 137 };
    transfer_lab l = transfer_lab_open(N, factor_room);
    float direct[3 * N], all[3 * N];
    (void)state;
    for (uint32_t i = 0; i < 3 * N; i++)
        direct[i] = unit_float(pcg(i)) > 0.7f ? 5.0f * unit_float(pcg(i + 999)) : 0.0f;
    for (size_t b = 0; b < 4; b++) {
        double spectral;
        vit_text why = {""};
        const bounces_input in = {
            .factors = &l.factors, .patches = &l.patches, .bounces = bounces[b], .columns = 3, .direct = direct, .threads = 1};
        assert_int_equal(bounces_solve(&in, all, &spectral, &why), VIT_OK);
        transfer_matrix m = transfer_lab_matrix(&l, bounces[b], 1);
        for (uint32_t i = 0; i < N; i++)
            for (uint32_t c = 0; c < 3; c++) {
                double sum = (double)direct[3 * i + c];
                for (uint32_t j = 0; j < N; j++)
                    sum += (double)m.s[c][i * N + j] * (double)direct[3 * j + c];
                assert_true(fabs(sum - (double)all[3 * i + c]) < 1e-4 * (double)all[3 * i + c] + 1e-6);
            }
        transfer_matrix_free(&m);
    }
    transfer_lab_close(&l);
}

/* Channels of the same albedos are made once: all patches have to be looked at. */
static void one_patch_of_another_colour_gives_its_channel_a_matrix_of_its_own(void **state) {
    enum { N = 70 };
    transfer_lab l = transfer_lab_open(N, factor_even);
    (void)state;
    transfer_lab_paint(&l, 0.5f);
    l.patches.patch[N - 1].albedo[1] = 0.9f;
    transfer_matrix m = transfer_lab_matrix(&l, 2, 1);
    assert_memory_equal(m.s[2], m.s[0], N * N * sizeof(float));
    assert_true(m.spectral[2] == m.spectral[0] && m.spectral[1] > m.spectral[0]);
    for (uint32_t i = 0; i < N * N; i++)
        assert_true(m.s[1][i] > m.s[0][i]);
    transfer_matrix_free(&m);
    transfer_lab_close(&l);
}

static void the_bound_of_the_spectral_radius_is_one_and_close(void **state) {
    transfer_lab l = transfer_lab_open(200, factor_room);
    transfer_matrix m = transfer_lab_matrix(&l, 1, 0);
    double x[200], next[200], radius = 0.0;
    (void)state;
    for (int i = 0; i < 200; i++)
        x[i] = 1.0;
    for (int step = 0; step < 3000; step++) { /* S is F^C */
        radius = 0.0;
        for (int i = 0; i < 200; i++) {
            next[i] = 0.0;
            for (int j = 0; j < 200; j++)
                next[i] += (double)m.s[0][i * 200 + j] * x[j];
            radius = next[i] > radius ? next[i] : radius;
        }
        for (int i = 0; i < 200; i++)
            x[i] = next[i] / radius;
    }
    assert_true(m.spectral[0] >= radius * (1.0 - 1e-9) && m.spectral[0] < 1.05 * radius);
    transfer_matrix_free(&m);
    transfer_lab_close(&l);
}

static void threads_change_no_byte(void **state) {
    transfer_lab l = transfer_lab_open(200, factor_room);
    transfer_matrix a = transfer_lab_matrix(&l, 3, 1), b = transfer_lab_matrix(&l, 3, 2);
    uint32_t one[200], two[200];
    vit_text why;
    (void)state;
    for (uint32_t c = 0; c < 3; c++)
        assert_memory_equal(a.s[c], b.s[c], 200 * 200 * sizeof(float));
    assert_int_equal(matrix_order_find(&a, 2, 1, one, &why), VIT_OK);
    assert_int_equal(matrix_order_find(&a, 2, 2, two, &why), VIT_OK);
    assert_memory_equal(one, two, sizeof one);
    transfer_matrix_free(&a);
    transfer_matrix_free(&b);
    transfer_lab_close(&l);
}

/* Sum of the differences of neighbouring rows. */
static double roughness(const transfer_matrix *m) {
    const size_t n = m->count;
    double sum = 0.0;
    for (uint32_t c = 0; c < 3; c++)
        for (size_t i = 0; i + 1 < n; i++)
            for (size_t j = 0; j < n; j++)
                sum += fabs((double)m->s[c][i * n + j] - (double)m->s[c][(i + 1) * n + j]);
    return sum;
}

static void an_order_is_a_permutation_that_makes_neighbours_alike(void **state) {
    enum { N = 150 };
    transfer_lab l = transfer_lab_open(N, factor_room);
    transfer_matrix m = transfer_lab_matrix(&l, 3, 0), mixed, ordered;
    uint32_t shuffled[N], found[N];
    vit_text why;
    (void)state;
    for (uint32_t i = 0; i < N; i++)
        shuffled[i] = i * 77 % N;
    assert_int_equal(matrix_order_apply(&m, shuffled, &mixed, &why), VIT_OK);
    for (uint32_t passes = 0; passes <= 2; passes++) {
        bool seen[N] = {false};
        assert_int_equal(matrix_order_find(&mixed, passes, 0, found, &why), VIT_OK);
        assert_int_equal(matrix_order_apply(&mixed, found, &ordered, &why), VIT_OK);
        for (uint32_t i = 0; i < N; i++) {
            assert_true(found[i] < N && !seen[found[i]]);
            assert_true(passes > 0 || found[i] == i);
            seen[found[i]] = true;
            assert_true(ordered.s[1][i * N + 3] == mixed.s[1][found[i] * N + found[3]]);
        }
        if (passes == 1) /* each row is followed by the nearest of those left */
            assert_true(roughness(&ordered) < 0.9 * roughness(&mixed));
        transfer_matrix_free(&ordered);
    }
    transfer_matrix_free(&mixed);
    transfer_matrix_free(&m);
    transfer_lab_close(&l);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_furnace_is_a_geometric_series),
        cmocka_unit_test(an_albedo_of_one_converges_nowhere_but_64_reflections_of_it_count),
        cmocka_unit_test(the_product_is_what_reflecting_one_after_the_other_gives),
        cmocka_unit_test(one_patch_of_another_colour_gives_its_channel_a_matrix_of_its_own),
        cmocka_unit_test(the_bound_of_the_spectral_radius_is_one_and_close),
        cmocka_unit_test(threads_change_no_byte),
        cmocka_unit_test(an_order_is_a_permutation_that_makes_neighbours_alike),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
