/* Indirect light at one sample in 4 or 16: near what all samples would give, and nowhere worse than its rules say.
 *
 * Why this is hard: what interpolation may change is a matter of degree, and a picture that is right on average may have dark
 * rims. Strategy: the same scene is baked both ways and irradiance is compared sample by sample. Samples of the coarse grid and
 * samples without agreeing neighbours must be as the full estimate has them; the others are bounded by their mean error, and no
 * lit one may be dark. */
#include "open_pack.h"
#include "read_buffer.h"

#include <math.h>

/* Irradiance of frame 0, in planes of `samples`; keys and flags (sparse packs only). */
typedef struct light {
    open_pack pack;
    uint32_t samples;
    float *irradiance;
    uint32_t *keys, *flags;
} light;

static void *buffer(open_pack *p, uint32_t b) {
    const size_t bytes = (size_t)vit_buffer_bytes(b, p->v->pack.scene, &p->v->launch);
    if (bytes == 0)
        return NULL;
    return read_buffer(p, (vit_buffer)b);
}

static light light_of(const char *name) {
    light l = {.samples = 0};
    pack_open(&l.pack, name, (vit_open_info){.view = VIT_VIEW_final});
    pack_frame(&l.pack, 0);
    l.samples = l.pack.v->pack.scene->samples;
    l.irradiance = buffer(&l.pack, B_indirect);
    l.keys = buffer(&l.pack, B_keys);
    l.flags = buffer(&l.pack, B_flags);
    return l;
}

static void light_free(light *l) {
    free(l->irradiance);
    free(l->keys);
    free(l->flags);
    pack_close(&l->pack);
}

static int has_key(const light *l, uint32_t sample) {
    return (int32_t)l->keys[sample] >= 0;
}

static int is_flagged(const light *l, uint32_t sample) {
    return (int)(l->flags[sample / 16] >> (sample % 16) & 1u);
}

static float sum_of(const light *l, uint32_t sample) {
    return l->irradiance[sample] + l->irradiance[l->samples + sample] + l->irradiance[2 * l->samples + sample];
}

/* Squared error over squared mean. */
static double nmse(const light *full, const light *sparse) {
    double squares = 0, mean = 0;
    const size_t n = 3 * (size_t)full->samples;
    for (size_t i = 0; i < n; i++) {
        const double d = (double)sparse->irradiance[i] - (double)full->irradiance[i];
        squares += d * d;
        mean += (double)full->irradiance[i];
    }
    assert_true(mean > 0);
    return squares * (double)n / (mean * mean);
}

typedef struct pair {
    const char *full, *sparse;
    uint32_t step; /* pixels between coarse samples */
    double most;   /* NMSE; half of it measured */
} pair;
static const pair pairs[] = {
    {"list", "sparse", 2, 4e-3},
    {"normal-keys", "sparse-16", 4, 2e-2},
    {"room-buckets", "sparse-buckets", 2, 2e-3},
    {"room", "sparse-room", 4, 4e-2},
    {"zones-areas", "sparse-zones-areas", 2, 6e-3},
};
#define PAIRS (sizeof pairs / sizeof pairs[0])

static void interpolated_light_is_near_the_full_estimate(void **state) {
    (void)state;
    for (size_t i = 0; i < PAIRS; i++) {
        light full = light_of(pairs[i].full), sparse = light_of(pairs[i].sparse);
        const double e = nmse(&full, &sparse);
        if (!(e <= pairs[i].most) || !(e > 0))
            fail_msg("%s against %s: NMSE %g", pairs[i].sparse, pairs[i].full, e);
        light_free(&full);
        light_free(&sparse);
    }
}

static void the_coarse_grid_has_the_full_estimate(void **state) {
    (void)state;
    for (size_t i = 0; i < PAIRS; i++) {
        light full = light_of(pairs[i].full), sparse = light_of(pairs[i].sparse);
        uint32_t seen = 0;
        for (uint32_t s = 0; s < full.samples; s++) {
            if (s % 4 % pairs[i].step || s / 4 % 4 % pairs[i].step || !has_key(&full, s))
                continue;
            seen++;
            for (uint32_t k = 0; k < 3; k++) { /* it is multiplied and divided by its weight on the way */
                const float a = full.irradiance[k * full.samples + s], b = sparse.irradiance[k * full.samples + s];
                if (fabsf(a - b) > 1e-6f * a)
                    fail_msg("%s: sample %u has %g, not %g", pairs[i].sparse, s, (double)b, (double)a);
            }
        }
        assert_in_range(seen, full.samples / 64, full.samples);
        light_free(&full);
        light_free(&sparse);
    }
}

static void samples_that_agree_with_no_neighbour_have_the_full_estimate_bit_by_bit(void **state) {
    (void)state;
    for (size_t i = 0; i < PAIRS; i++) {
        light full = light_of(pairs[i].full), sparse = light_of(pairs[i].sparse);
        uint32_t seen = 0;
        for (uint32_t s = 0; s < full.samples; s++) {
            if (!is_flagged(&sparse, s))
                continue;
            seen++;
            for (uint32_t k = 0; k < 3; k++)
                assert_memory_equal(&full.irradiance[k * full.samples + s], &sparse.irradiance[k * full.samples + s], 4);
        }
        if (seen == 0 || seen > full.samples / 10)
            fail_msg("%s: %u of %u samples flagged", pairs[i].sparse, seen, full.samples);
        light_free(&full);
        light_free(&sparse);
    }
}

static void no_lit_sample_is_dark_and_no_sample_without_a_key_is_lit(void **state) {
    (void)state;
    for (size_t i = 0; i < PAIRS; i++) {
        light full = light_of(pairs[i].full), sparse = light_of(pairs[i].sparse);
        double mean = 0;
        for (uint32_t s = 0; s < full.samples; s++)
            mean += (double)sum_of(&full, s) / full.samples;
        for (uint32_t s = 0; s < full.samples; s++) {
            assert_int_equal(has_key(&full, s), has_key(&sparse, s));
            if (!has_key(&full, s))
                assert_true(sum_of(&sparse, s) == 0);
            else if ((double)sum_of(&full, s) > mean)
                assert_true((double)sum_of(&sparse, s) > 0.1 * mean);
        }
        light_free(&full);
        light_free(&sparse);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(interpolated_light_is_near_the_full_estimate),
        cmocka_unit_test(the_coarse_grid_has_the_full_estimate),
        cmocka_unit_test(samples_that_agree_with_no_neighbour_have_the_full_estimate_bit_by_bit),
        cmocka_unit_test(no_lit_sample_is_dark_and_no_sample_without_a_key_is_lit),
    };
    return cmocka_run_group_tests_name("sparse", tests, NULL, NULL);
}
