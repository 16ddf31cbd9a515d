/* kernels/receivers.cl against doubles: the pass relight.
 *
 * Why this is hard: sums look right when a neighbour's numbers are in them. Strategy: relight is summed again from the sections
 * as records.clh describes them, where every limit is met, and numbers behind what a frame may read are no numbers. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "host_lab.h"
#include "kernel_lab.h"

#include <float.h>
#include <math.h>

enum {
    GROUPS = 3,
    RECEIVERS = GROUPS * VIT_BASIS_GROUP,
    LIGHTS = 3,
    MOVING = 2,
    FRAMES = 4,
    KNOTS = 3,
    HALF = VIT_BASIS_GROUP / 2
};
enum { WORDS = GROUPS * MOVING * VIT_BASIS_RANK * HALF, COEFFICIENTS = GROUPS * MOVING * VIT_BASIS_RANK * KNOTS };

typedef struct basis_lab {
    vit_scene scene;
    vit_light lights[FRAMES * LIGHTS];
    vit_basis_group groups[GROUPS * MOVING];
    vit_u32 words[WORDS];
    vit_basis_coefficient coefficients[COEFFICIENTS];
    vit_basis_frame frames[FRAMES * MOVING];
    vit_receiver receivers[RECEIVERS];
    float relit[RECEIVERS * 4];
} basis_lab;

static basis_lab lab_of_basis;

static host_lab_received received(const basis_lab *b) {
    return (host_lab_received){.scene = &b->scene,
                               .lights = b->lights,
                               .groups = b->groups,
                               .words = b->words,
                               .coefficients = b->coefficients,
                               .frames = b->frames,
                               .receivers = b->receivers};
}

/* A basis with these ranks, of group 0's first light on; the rest is random, and dark light is as likely as bright. */
static basis_lab *make_basis(const vit_u32 rank[GROUPS * MOVING]) {
    basis_lab *b = &lab_of_basis;
    uint64_t random = 7;
    memset(b, 0, sizeof *b);
    b->scene = (vit_scene){.lights = LIGHTS, .receivers = RECEIVERS, .basis_lights = MOVING, .frames = FRAMES};
    for (int i = 0; i < FRAMES * LIGHTS; i++)
        for (int k = 0; k < 3; k++)
            b->lights[i].intensity[k] = 4.0f * lab_uniform(&random);
    vit_u32 word = 0, coefficient = 0;
    for (int i = 0; i < GROUPS * MOVING; i++) {
        b->groups[i] = (vit_basis_group){.first_word = word, .rank = rank[i], .first_coefficient = coefficient};
        word += rank[i] * HALF;
        coefficient += rank[i] * KNOTS;
    }
    for (vit_u32 i = 0; i < WORDS; i++)
        b->words[i] = i % 97 == 0 ? 0x80008000u : i % 89 == 0 ? 0x80007fffu : (vit_u32)lab_random(&random);
    for (vit_u32 i = 0; i < COEFFICIENTS; i++)
        for (int k = 0; k < 3; k++)
            b->coefficients[i].rgb[k] = i < coefficient ? (lab_uniform(&random) - 0.5f) * 0x1p-15f : NAN;
    static const struct {
        vit_u32 knot;
        float weight;
    } places[FRAMES] = {{0, 0.375f}, {1, 1.0f}, {2, 0.0f}, {1, 0.7f}};
    for (int i = 0; i < FRAMES * MOVING; i++)
        b->frames[i] = (vit_basis_frame){.light = i % MOVING ? 2 : 0,
                                         .knot = places[(i / MOVING + i % MOVING) % FRAMES].knot,
                                         .weight = places[(i / MOVING + i % MOVING) % FRAMES].weight};
    for (int i = 0; i < RECEIVERS; i++)
        for (int k = 0; k < 3; k++)
            b->receivers[i].irradiance[k] = 2.0f * lab_uniform(&random);
    for (int i = 0; i < RECEIVERS * 4; i++)
        b->relit[i] = -7.0f;
    return b;
}

/* The number of vector `k` for receiver `r` of a group. */
static int number_of(const basis_lab *b, const vit_basis_group *g, vit_u32 k, vit_u32 r) {
    const vit_u32 word = b->words[g->first_word + k * HALF + r % HALF], half = r < HALF ? word & 0xffffu : word >> 16;
    return half < 0x8000u ? (int)half : (int)half - 0x10000;
}

/* Irradiance of a receiver in doubles, not clamped, and the sum of the absolute terms. */
static double expected(const basis_lab *b, vit_u32 frame, vit_u32 receiver, int channel, double *terms) {
    double sum = (double)b->receivers[receiver].irradiance[channel];
    *terms = sum;
    for (vit_u32 l = 0; l < MOVING; l++) {
        const vit_basis_group *g = &b->groups[receiver / VIT_BASIS_GROUP * MOVING + l];
        const vit_basis_frame *at = &b->frames[frame * MOVING + l];
        const double intensity = (double)b->lights[frame * LIGHTS + at->light].intensity[channel], w = (double)at->weight;
        for (vit_u32 k = 0; k < g->rank; k++) {
            const vit_basis_coefficient *c = &b->coefficients[g->first_coefficient + at->knot * g->rank + k];
            const double here = (double)c->rgb[channel], there = w > 0.0 ? (double)c[g->rank].rgb[channel] : 0.0,
                         number = number_of(b, g, k, receiver % VIT_BASIS_GROUP);
            sum += intensity * number * ((1.0 - w) * here + w * there);
            *terms += intensity * fabs(number) * ((1.0 + w) * fabs(here) + w * fabs(there));
        }
    }
    return sum;
}

/* The worst error over the sum of absolute terms, of all frames; *dark: receivers' channels that are clamped. */
static double worst_of_relight(basis_lab *b, uint32_t *dark) {
    const host_lab_received r = received(b);
    double worst = 0.0;
    *dark = 0;
    for (vit_u32 f = 0; f < FRAMES; f++) {
        host_lab_find()->relight(&r, f, b->relit);
        for (vit_u32 i = 0; i < RECEIVERS; i++)
            for (int k = 0; k < 3; k++) {
                double terms;
                const double e = expected(b, f, i, k, &terms), got = (double)b->relit[4 * i + (vit_u32)k];
                assert_true(got >= 0.0 && got <= DBL_MAX);
                *dark += e < 0.0;
                worst = fmax(worst, fabs(got - fmax(e, 0.0)) / fmax(terms, 1e-30));
            }
    }
    return worst;
}

static void relight_adds_up_what_the_sections_say(void **state) {
    (void)state;
    static const vit_u32 ranks[][GROUPS * MOVING] = {{0, 0, 0, 0, 0, 0},    {1, 0, 0, 1, 2, 3},     {32, 32, 32, 32, 32, 32},
                                                     {0, 32, 7, 1, 31, 12}, {32, 32, 32, 32, 0, 1}, {5, 4, 3, 2, 1, 32}};
    for (size_t i = 0; i < sizeof ranks / sizeof ranks[0]; i++) {
        uint32_t dark;
        const double worst = worst_of_relight(make_basis(ranks[i]), &dark);
        print_message("ranks %u %u ..: worst %.3g of the terms, %u clamped\n", ranks[i][0], ranks[i][1], worst, dark);
        assert_true(worst < 5e-7);
        assert_int_equal(dark > 0, i > 0);
    }
}

static void without_moving_light_relight_gives_what_is_still(void **state) {
    (void)state;
    static const vit_u32 none[GROUPS * MOVING];
    basis_lab *b = make_basis(none);
    const host_lab_received r = received(b);
    host_lab_find()->relight(&r, 1, b->relit);
    for (int i = 0; i < RECEIVERS; i++) {
        assert_memory_equal(b->relit + 4 * i, b->receivers[i].irradiance, sizeof b->receivers[i].irradiance);
        assert_true(b->relit[4 * i + 3] == -7.0f);
    }
}

/* Numbers of a few bits, so that floats are exact: each word has its own pair, the least of 16 bits among them. */
static void both_halves_of_a_word_keep_their_signs(void **state) {
    (void)state;
    static const int numbers[] = {-32768, 32767, -1, 0, 1, -32767, 16384};
    enum { COUNT = sizeof numbers / sizeof numbers[0] };
    static const vit_u32 ranks[GROUPS * MOVING] = {1, 0, 0, 1, 0, 0};
    basis_lab *b = make_basis(ranks);
    const host_lab_received r = received(b);
    for (vit_u32 i = 0; i < 2 * HALF; i++)
        b->words[i] = ((vit_u32)numbers[i % COUNT] & 0xffffu) | (vit_u32)numbers[i / COUNT % COUNT] << 16;
    for (vit_u32 i = 0; i < 2 * KNOTS; i++)
        b->coefficients[i] = (vit_basis_coefficient){.rgb = {0x1p-15f, -0x1p-15f, (float)(i % KNOTS) * 0x1p-15f}};
    for (vit_u32 i = 0; i < FRAMES * LIGHTS; i++)
        b->lights[i] = (vit_light){.intensity = {1, 2, 4}};
    for (vit_u32 i = 0; i < RECEIVERS; i++)
        b->receivers[i] = (vit_receiver){.irradiance = {1, 0.5f, 4}};
    host_lab_find()->relight(&r, 0, b->relit); /* knots: 0 and 0.375 on, 1 and 1 on */
    for (vit_u32 i = 0; i < RECEIVERS; i++) {
        const vit_u32 group = i / VIT_BASIS_GROUP, at = i % VIT_BASIS_GROUP, word = (group == 1 ? HALF : 0) + at % HALF;
        const double n = group > 1 ? 0.0 : numbers[at < HALF ? word % COUNT : word / COUNT % COUNT] / 32768.0;
        const double between = group == 1 ? 2.0 : 0.375;
        assert_true((double)b->relit[4 * i] == fmax(1.0 + n, 0.0));
        assert_true((double)b->relit[4 * i + 1] == fmax(0.5 - 2.0 * n, 0.0));
        assert_true((double)b->relit[4 * i + 2] == fmax(4.0 + 4.0 * n * between, 0.0));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(relight_adds_up_what_the_sections_say),
        cmocka_unit_test(without_moving_light_relight_gives_what_is_still),
        cmocka_unit_test(both_halves_of_a_word_keep_their_signs),
    };
    return cmocka_run_group_tests_name("relight", tests, NULL, NULL);
}
