/* The loader against forged packs with baked irradiance, as test_pack_forged.c has it: every check of what is there for the
 * effects BASIS and RELIGHT, and what is just inside their limits. */
#include "forged_pack.h"

#include <float.h>
#include <math.h>

/* The fixture has 27 cells, 2 splits, 512 receivers, 2 lights, 4096 words, 96 coefficients; knots 0..1 of the first light, 0..2
 * of the second; records of BGRP and BFRM are those of light 0, light 1, light 0, light 1. */
#define META_FAULTS(X)                                                                                                         \
    X(META, huge_receiver_cells, "receiver_cells", im->scene->receiver_cells = 0x1000000)                                      \
    X(META, huge_receiver_splits, "receiver_splits", im->scene->receiver_splits = 0x1000000)                                   \
    X(META, huge_receivers, "receivers must be in 0..16777216", im->scene->receivers = 0x1000100)                              \
    X(META, half_a_group, "receivers must be a multiple of 256", ADD(receivers, 128))                                          \
    X(META, more_lights_than_there_are, "basis_lights must be in 0..2", im->scene->basis_lights = 3)                           \
    X(META, huge_basis_words, "basis_words", im->scene->basis_words = 0x10000001)                                              \
    X(META, huge_basis_coefficients, "basis_coefficients", im->scene->basis_coefficients = 0xffffffff)                         \
    X(META, photons_beside_the_basis, "PHOTONS and BASIS exclude", EFFECTS(BIT(PHOTONS) | BIT(LIST), 0))                       \
    X(META, basis_without_indirect_light, "BASIS without INDIRECT", EFFECTS(0, BIT(INDIRECT)))                                 \
    X(META, sparse_samples_of_a_basis, "SPARSE without PHOTONS", EFFECTS(BIT(SPARSE), 0))                                      \
    X(META, relight_without_basis, "RELIGHT without BASIS", EFFECTS(0, BIT(BASIS)))                                            \
    X(META, relight_without_lights, "RELIGHT without LIGHTS", EFFECTS(0, BIT(LIGHTS) | BIT(SPOT) | BIT(RANGE)))                \
    X(META, indirect_light_without_a_maker, "INDIRECT without what makes", EFFECTS(0, BIT(BASIS) | BIT(RELIGHT)))              \
    X(META, photons_without_a_basis, "512 receivers, 27 cells and 2 splits contradict",                                        \
      EFFECTS(BIT(PHOTONS) | BIT(LIST), BIT(BASIS) | BIT(RELIGHT)))                                                            \
    X(META, no_receivers, "0 receivers, 27 cells and 2 splits contradict", im->scene->receivers = 0)                           \
    X(META, no_receiver_cells, "512 receivers, 0 cells", im->scene->receiver_cells = 0)                                        \
    X(META, splits_without_the_effect, "0 receivers, 0 cells and 2 splits contradict",                                         \
      EFFECTS(0, BIT(INDIRECT) | BIT(BASIS) | BIT(RELIGHT)), im->scene->receivers = im->scene->receiver_cells = 0)             \
    X(META, no_lights_with_relight, "0 lights, 4096 words and 96 coefficients contradict", im->scene->basis_lights = 0)        \
    X(META, lights_without_relight, "2 lights, 4096 words and 96 coefficients contradict", EFFECTS(0, BIT(RELIGHT)))           \
    X(META, words_without_relight, "0 lights, 4096 words and 0 coefficients contradict", EFFECTS(0, BIT(RELIGHT)),             \
      im->scene->basis_lights = im->scene->basis_coefficients = 0)                                                             \
    X(META, coefficients_without_relight, "0 lights, 0 words and 96 coefficients contradict", EFFECTS(0, BIT(RELIGHT)),        \
      im->scene->basis_lights = im->scene->basis_words = 0)                                                                    \
    X(META, cells_of_zones, "27 cells contradict", im->scene->cells = 27)                                                      \
    X(META, baked_photons, "4 baked photons without", im->scene->baked = 4, vit_pack_derive(im->scene, NULL))                  \
    X(RCEL, one_cell_more, "META counts 28 records", ADD(receiver_cells, 1))                                                   \
    X(RSPL, one_split_less, "META counts 1 records", im->scene->receiver_splits--)                                             \
    X(RECV, a_group_more, "META counts 768 records", ADD(receivers, 256))                                                      \
    X(BGRP, a_light_less, "META counts 2 records", im->scene->basis_lights = 1)                                                \
    X(BWRD, one_word_more, "META counts 4097 records", ADD(basis_words, 1))                                                    \
    X(BCOE, most_coefficients, "META counts 268435456 records", im->scene->basis_coefficients = 1 << 28)

#define RECORD_FAULTS(X)                                                                                                       \
    X(SIDE, cell_beyond_the_last, "side 5: 1 parts from cell 27 on, of 27", im->sides[5] = 1u << VIT_SIDE_PARTS_SHIFT | 27)    \
    X(SIDE, parts_beyond_the_last, "side 0: 5 parts from cell 3 on, of 27", im->sides[0] = 5u << VIT_SIDE_PARTS_SHIFT | 3)     \
    X(RCEL, receiver_beyond_the_last, "record 26: receiver 512 of 512", im->receiver_cells[26].receiver[2] = 512)              \
    X(RCEL, huge_receiver, "record 0: receiver 4294967295 of 512", im->receiver_cells[0].receiver[0] = 0xffffffff)             \
    X(RCEL, split_beyond_the_last, "record 3: split 2 of 2", im->receiver_cells[3].split = 2)                                  \
    X(RCEL, huge_split, "record 3: split 2147483647 of 2", im->receiver_cells[3].split = VIT_RECEIVER_DIVIDED - 1)             \
    X(RCEL, no_parts, "record 3: 0 parts", divide(im, 3, 4, 0))                                                                \
    X(RCEL, many_parts, "record 3: 17 parts", divide(im, 3, 4, 17))                                                            \
    X(RCEL, most_parts, "record 3: 2147483646 parts", divide(im, 3, 4, VIT_RECEIVER_DIVIDED - 2))                              \
    X(RCEL, part_beyond_the_last, "record 3: its cells must be among those from record 12 on and before 27",                   \
      divide(im, 3, 12, 4))                                                                                                    \
    X(RCEL, parts_that_wrap, "record 3: its cells must be", divide(im, 3, 0xfffffff0, 4))                                      \
    X(RCEL, a_part_of_itself, "cells begin at record 3, expected behind 3", divide(im, 3, 3, 2))                               \
    X(RCEL, the_first_of_itself, "cells begin at record 0, expected behind 0", divide(im, 0, 0, 2))                            \
    X(RCEL, a_part_before_it, "record 1: its cells must be among those from record 2 on and before 2", divide(im, 3, 2, 2),    \
      divide(im, 1, 9, 2))                                                                                                     \
    X(RCEL, parts_of_two_levels, "record 3: its cells must be among", divide(im, 3, 5, 3), divide(im, 6, 9, 2))                \
    X(RCEL, divided_four_times, "record 13: divided more than", divide(im, 3, 4, 2), divide(im, 5, 9, 2),                      \
      divide(im, 9, 13, 2), divide(im, 13, 17, 2))                                                                             \
    X(RCEL, padding_of_a_divided_cell, "record 3: padding", divide(im, 3, 4, 2), im->receiver_cells[3].receiver[2] = 1)        \
    X(RSPL, receiver_beyond_the_last, "record 1: receiver 512 of 512", im->splits[1].receiver[1] = 512)                        \
    X(RSPL, normal_too_short, "record 0: its normal", im->splits[0].normal[1] = 0.5f)                                          \
    X(RSPL, normal_of_nan, "record 1: its normal", im->splits[1].normal[0] = NAN)                                              \
    X(RSPL, infinite_offset, "record 1: its normal", im->splits[1].offset = INFINITY)                                          \
    X(RSPL, padding_in_use, "record 0: padding", im->splits[0].pad = 1)                                                        \
    X(RECV, negative_irradiance, "receiver 511: irradiance", im->receivers[511].irradiance[2] = -1)                            \
    X(RECV, irradiance_of_nan, "receiver 0: irradiance", im->receivers[0].irradiance[0] = NAN)                                 \
    X(RECV, irradiance_near_the_largest_float, "receiver 7: irradiance", im->receivers[7].irradiance[1] = 1e38f)               \
    X(RECV, padding_in_use, "receiver 9: irradiance must be in 0..1e+30, and padding 0", im->receivers[9].pad = 1)             \
    X(BFRM, light_beyond_the_last, "record 3: light 2, expected one of 1..1", im->basis_frames[3].light = 2)                   \
    X(BFRM, a_light_twice, "record 1: light 0, expected one of 1..1", im->basis_frames[1].light = 0)                           \
    X(BFRM, lights_out_of_order, "record 3: light 0, expected", im->basis_frames[2].light = 1, im->basis_frames[3].light = 0)  \
    X(BFRM, huge_knot, "record 0: knot 4294967295", im->basis_frames[0].knot = 0xffffffff)                                     \
    X(BFRM, knot_beyond_the_limit, "record 0: knot 16777217", im->basis_frames[0].knot = (1 << 24) + 1)                        \
    X(BFRM, weight_above_1, "record 1: knot 1 or weight 1.5", im->basis_frames[1].weight = 1.5f)                               \
    X(BFRM, negative_weight, "record 2", im->basis_frames[2].weight = -0.25f)                                                  \
    X(BFRM, weight_of_nan, "record 2", im->basis_frames[2].weight = NAN)                                                       \
    X(BFRM, padding_in_use, "record 0", im->basis_frames[0].pad = 1)                                                           \
    X(BGRP, rank_33, "record 3: rank must be in 0..32", im->groups[3].rank = 33)                                               \
    X(BGRP, huge_rank, "record 0: rank", im->groups[0].rank = 0xffffffff)                                                      \
    X(BGRP, padding_in_use, "record 2: rank must be in 0..32, and padding 0", im->groups[2].pad = 1)                           \
    X(BGRP, vectors_beyond_the_last_word, "record 3: vectors run beyond the 4096 words", im->groups[3].first_word = 1)         \
    X(BGRP, vectors_that_wrap, "record 1: vectors run beyond", im->groups[1].first_word = 0xffffff80)                          \
    X(BGRP, first_word_beyond_the_last, "record 0: vectors run beyond", im->groups[0].first_word = 4097)                       \
    X(BGRP, coefficients_beyond_the_last, "record 3: coefficients run beyond the 96", im->groups[3].first_coefficient = 1)     \
    X(BGRP, coefficients_that_wrap, "record 2: coefficients run beyond", im->groups[2].first_coefficient = 0xfffffffd)         \
    X(BGRP, first_coefficient_beyond_the_last, "record 0: coefficients", im->groups[0].first_coefficient = 97)                 \
    X(BGRP, the_knot_after_the_last, "record 3: coefficients", im->basis_frames[3].knot = 3)                                   \
    X(BGRP, a_part_of_the_knot_after_the_last, "record 3: coefficients", im->basis_frames[3].weight = FLT_MIN)                 \
    X(BCOE, coefficient_of_nan, "record 95", im->coefficients[95].rgb[2] = NAN)                                                \
    X(BCOE, infinite_coefficient, "record 0", im->coefficients[0].rgb[0] = -INFINITY)                                          \
    X(BCOE, coefficient_near_the_largest_float, "record 1: must be in -1e+30..1e+30", im->coefficients[1].rgb[1] = 1e38f)      \
    X(BCOE, padding_in_use, "record 2", im->coefficients[2].pad = 1)                                                           \
    X(CAMS, irradiance_that_is_infinite_once_exposed, "frame 1: light could be",                                               \
      im->receivers[511].irradiance[2] = VIT_MAX_PHOTON, im->cameras[1].exposure = VIT_MAX_EXPOSURE)                           \
    X(CAMS, a_light_too_strong_for_its_coefficients, "frame 0: light could be", im->coefficients[95].rgb[1] = -1e18f,          \
      im->lights[1].intensity[2] = VIT_MAX_INTENSITY)

/* What is just inside the limits must pass: X(name, change made to `im`). */
#define LIMITS(X)                                                                                                              \
    X(no_split_used, im->receiver_cells[0].split = im->receiver_cells[26].split = VIT_NONE)                                    \
    X(a_cell_divided_up_to_the_last, divide(im, 3, 11, 4))                                                                     \
    X(parts_that_are_divided, divide(im, 3, 4, 2), divide(im, 5, 9, 2), divide(im, 4, 11, 4))                                  \
    X(two_divided_cells, divide(im, 3, 5, 2), divide(im, 4, 5, 4))                                                             \
    X(parts_up_to_the_last_cell, im->sides[0] = 5u << VIT_SIDE_PARTS_SHIFT | 2)                                                \
    X(three_times_the_last_receiver,                                                                                           \
      im->receiver_cells[0].receiver[0] = im->receiver_cells[0].receiver[1] = im->receiver_cells[0].receiver[2] = 511)         \
    X(a_plane_far_off, im->splits[0].offset = -FLT_MAX)                                                                        \
    X(dark_receivers, memset(im->receivers, 0, FIXTURE_RECEIVERS * sizeof *im->receivers))                                     \
    X(most_irradiance, im->receivers[0].irradiance[0] = VIT_MAX_PHOTON)                                                        \
    X(every_rank_0, no_ranks(im))                                                                                              \
    X(rank_0_and_the_last_knot_that_there_may_be, no_ranks(im), im->basis_frames[0].knot = 1 << 24)                            \
    X(every_rank_32, full_ranks(im))                                                                                           \
    X(weight_1_at_the_last_knot_but_one, im->basis_frames[0].weight = 1)                                                       \
    X(weight_0_at_the_last_knot, im->basis_frames[0].knot = 1, im->basis_frames[0].weight = 0)                                 \
    X(negative_coefficients, im->coefficients[0].rgb[0] = -1)                                                                  \
    X(most_coefficients_of_dark_lights, dim(im), im->coefficients[0].rgb[0] = -VIT_MAX_PHOTON)                                 \
    X(the_least_numbers, memset(im->words, 0x80, FIXTURE_WORDS * sizeof *im->words))

#define FAULTS(X) META_FAULTS(X) RECORD_FAULTS(X)

static void divide(image *im, uint32_t cell, uint32_t first, uint32_t parts) {
    im->receiver_cells[cell] = (vit_receiver_cell){.receiver = {first, 0, 0}, .split = VIT_RECEIVER_DIVIDED | parts};
}

static void no_ranks(image *im) {
    for (int i = 0; i < FIXTURE_GROUPS * FIXTURE_LIGHTS; i++)
        im->groups[i].rank = 0;
}

static void full_ranks(image *im) {
    for (int i = 0; i < FIXTURE_GROUPS * FIXTURE_LIGHTS; i++)
        im->groups[i] = (vit_basis_group){.rank = VIT_BASIS_RANK};
}

static void dim(image *im) {
    for (int i = 0; i < FIXTURE_FRAMES * FIXTURE_LIGHTS; i++)
        memset(im->lights[i].intensity, 0, sizeof im->lights[i].intensity);
}

/* A light on a track that lights no receiver: the baker has knots for it, and nothing else. */
static void a_light_that_lights_nothing_has_no_words_and_no_coefficients(void **state) {
    (void)state;
    pack_fixture f;
    fixture_make_basis(&f);
    for (int i = 0; i < FIXTURE_GROUPS * FIXTURE_LIGHTS; i++)
        f.groups[i] = (vit_basis_group){0};
    f.scene.basis_words = f.scene.basis_coefficients = 0;
    image im = image_of(&f);
    vit_text why;
    const vit_status status = read_image(&im, &why);
    assert_string_equal(why.text, "");
    assert_int_equal(status, VIT_OK);
    free(im.bytes);
}

#define FORGED_KIND FIXTURE_BASIS
#define FORGED_NAME "forged packs with a basis"
#define FORGED_TESTS cmocka_unit_test(a_light_that_lights_nothing_has_no_words_and_no_coefficients),
#include "forged_main.h"
