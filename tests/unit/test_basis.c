/* Irradiance of receivers by few vectors (bake/radiosity/basis.c), against the numbers that it was made of.
 *
 * Why this is hard: a product of too few vectors looks like light, too. Strategy: light is put together from so many vectors
 * that its rank is known, and what the sections hold is multiplied out again in doubles, as records.clh describes them: it must
 * be the light up to the 16 bits that a number has, from as many vectors as there are; and with an error allowed, that much is
 * missing and no more. */
#include "radiosity/basis.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

enum { LIGHTS = 2, RECEIVERS = 2 * VIT_BASIS_GROUP + 100, KNOTS = 10, COLUMNS = 3 * (1 + KNOTS) };

static const uint32_t knots[LIGHTS] = {1, KNOTS}, first[LIGHTS] = {0, 3};

typedef struct light {
    float irradiance[RECEIVERS * COLUMNS];
} light;

static double random_unit(uint64_t *seed) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 40) * 0x1p-24;
}

/* Sums of `rank` products of random positive vectors. Each receiver's mean is 1, so that all of them weigh alike, or something
 * up to `brightest`. */
static void make_light(light *l, uint32_t rank, double brightest) {
    static double right[COLUMNS][COLUMNS];
    uint64_t seed = 5 + rank;
    for (uint32_t k = 0; k < rank; k++)
        for (uint32_t c = 0; c < COLUMNS; c++)
            right[k][c] = random_unit(&seed);
    for (uint32_t r = 0; r < RECEIVERS; r++) {
        const double brightness = 1.0 + (brightest - 1.0) * random_unit(&seed);
        double row[COLUMNS] = {0}, mean[LIGHTS] = {0};
        for (uint32_t k = 0; k < rank; k++) {
            const double left = random_unit(&seed);
            for (uint32_t c = 0; c < COLUMNS; c++)
                row[c] += left * right[k][c];
        }
        for (uint32_t c = 0; c < COLUMNS; c++)
            mean[c >= first[1]] += row[c] / (3 * knots[c >= first[1]]);
        for (uint32_t c = 0; c < COLUMNS; c++)
            l->irradiance[r * COLUMNS + c] = (float)(brightness * row[c] / mean[c >= first[1]]);
    }
}

static basis made(const light *l, double error) {
    const basis_input in = {.irradiance = l->irradiance,
                            .receivers = RECEIVERS,
                            .columns = COLUMNS,
                            .first = first,
                            .knots = knots,
                            .lights = LIGHTS,
                            .error = error,
                            .threads = 1};
    basis b;
    vit_text why = {""};
    if (basis_make(&in, &b, &why) != VIT_OK)
        fail_msg("%s", why.text);
    return b;
}

/* What the sections say of receiver r and column c. */
static double multiplied(const basis *b, uint32_t r, uint32_t c) {
    const uint32_t l = c >= first[1], knot = (c - first[l]) / 3, half = VIT_BASIS_GROUP / 2, at = r % VIT_BASIS_GROUP;
    const vit_basis_group *g = b->groups + r / VIT_BASIS_GROUP * LIGHTS + l;
    double sum = 0.0;
    for (uint32_t k = 0; k < g->rank; k++) {
        const uint32_t word = b->words[g->first_word + k * half + at % half], number = at < half ? word & 0xffffu : word >> 16;
        sum += (double)(number < 0x8000u ? (int)number : (int)number - 0x10000) *
               (double)b->coefficients[g->first_coefficient + knot * g->rank + k].rgb[c % 3];
    }
    return sum;
}

/* The largest error, and the sum of its squares over that of the light. */
static double compare(const basis *b, const light *l, double *share) {
    double worst = 0.0, off = 0.0, all = 0.0;
    for (uint32_t r = 0; r < RECEIVERS; r++)
        for (uint32_t c = 0; c < COLUMNS; c++) {
            const double right = (double)l->irradiance[r * COLUMNS + c], d = multiplied(b, r, c) - right;
            worst = fmax(worst, fabs(d));
            off += d * d;
            all += right * right;
        }
    *share = off / all;
    return worst;
}

/* Of rank 1, of a few, and of as many as there are columns: 30 of the second light, 3 of the first, which has one knot. */
static void light_of_a_rank_takes_so_many_vectors_and_comes_back(void **state) {
    (void)state;
    static const uint32_t ranks[] = {1, 2, 7, 3 * KNOTS};
    static light l;
    for (size_t i = 0; i < sizeof ranks / sizeof *ranks; i++) {
        make_light(&l, ranks[i], 4.0);
        basis b = made(&l, 1e-12);
        double share;
        const double worst = compare(&b, &l, &share);
        for (uint32_t g = 0; g < b.group_count; g++) {
            assert_int_equal(b.groups[g * LIGHTS].rank, ranks[i] < 3 ? ranks[i] : 3);
            assert_int_equal(b.groups[g * LIGHTS + 1].rank, ranks[i]);
        }
        print_message("rank %u: %.2g of the light missing, worst %.2g of a mean\n", ranks[i], share, worst);
        /* A vector's numbers are up to 32767 steps, half of one off; a row's mean is 1 to 4. */
        assert_true(worst < 5e-4);
        basis_free(&b);
    }
}

static void about_as_much_is_missing_as_was_allowed(void **state) {
    (void)state;
    static const double errors[] = {3e-3, 1e-3, 3e-4, 1e-4};
    static light l;
    double before = INFINITY;
    make_light(&l, 3 * KNOTS, 1.0);
    for (size_t i = 0; i < sizeof errors / sizeof *errors; i++) {
        basis b = made(&l, errors[i]);
        double share;
        compare(&b, &l, &share);
        print_message("%g allowed: %.3g missing, %.3g said, mean rank %.1f\n", errors[i], share, b.left, b.mean_rank);
        assert_true(b.left <= errors[i] && b.left > errors[i] / 2);
        assert_true(fabs(share - b.left) < 0.02 * b.left + 1e-8);
        assert_true(b.left < before);
        before = b.left;
        basis_free(&b);
    }
}

static void no_light_takes_no_vector(void **state) {
    (void)state;
    static const light dark;
    basis b = made(&dark, 1e-3);
    assert_int_equal(b.group_count, 3);
    for (uint32_t i = 0; i < b.group_count * LIGHTS; i++)
        assert_int_equal(b.groups[i].rank, 0);
    assert_int_equal(b.word_count, 0);
    assert_true(b.left == 0.0);
    basis_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(light_of_a_rank_takes_so_many_vectors_and_comes_back),
                                       cmocka_unit_test(about_as_much_is_missing_as_was_allowed),
                                       cmocka_unit_test(no_light_takes_no_vector)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
