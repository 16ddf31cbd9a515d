/* The loader against forged packs with live radiosity, as test_pack_forged.c has it: every check of what is there for the
 * effects RADIOSITY, TRANSFER and LOW_RANK, and what is just inside their limits. */
#include "forged_pack.h"

#include <float.h>
#include <math.h>

/* The fixture has 20 patches (32 columns), 48 points, two a patch; 512 receivers, every second of which sees 4 columns in 3
 * words: 768; two sets of receivers that are looked up, a frame each; a coded matrix of rank 16 with 2 sums. */
#define NO_RADIOSITY EFFECTS(0, BIT(INDIRECT) | BIT(RADIOSITY) | BIT(TRANSFER) | BIT(LOW_RANK)), im->scene->most_reflected = 0
#define META_FAULTS(X)                                                                                                         \
    X(META, huge_patches, "patches must be in 0..65520", im->scene->patches = 65521)                                           \
    X(META, more_columns_than_16_bits, "patch_points must be in 0..65504", im->scene->patch_points = 65520)                    \
    X(META, half_of_sixteen_points, "patch_points and transfer_rank must be multiples of 16", ADD(patch_points, 8))            \
    X(META, half_of_sixteen_ranks, "patch_points and transfer_rank must be multiples of 16", ADD(transfer_rank, 8))            \
    X(META, huge_gather_words, "gather_words", im->scene->gather_words = 0x10000001)                                           \
    X(META, huge_transfer_words, "transfer_words", im->scene->transfer_words = 0x40000001)                                     \
    X(META, huge_rank, "transfer_rank must be in 0..512", im->scene->transfer_rank = 528)                                      \
    X(META, huge_sums, "transfer_sums", im->scene->transfer_sums = 514)                                                        \
    X(META, photons_beside_radiosity, "PHOTONS and RADIOSITY exclude", EFFECTS(BIT(PHOTONS) | BIT(LIST), 0))                   \
    X(META, a_basis_beside_radiosity, "BASIS and RADIOSITY exclude", EFFECTS(BIT(BASIS), 0))                                   \
    X(META, radiosity_without_indirect_light, "RADIOSITY without INDIRECT", EFFECTS(0, BIT(INDIRECT)))                         \
    X(META, radiosity_without_lights, "RADIOSITY without LIGHTS", EFFECTS(0, BIT(LIGHTS) | BIT(SPOT) | BIT(RANGE)))            \
    X(META, transfer_without_radiosity, "TRANSFER without RADIOSITY", EFFECTS(BIT(BASIS), BIT(RADIOSITY)))                     \
    X(META, a_rank_without_transfer, "LOW_RANK without TRANSFER", EFFECTS(0, BIT(TRANSFER)), im->scene->most_reflected = 0)    \
    X(META, patches_without_the_effect, "512 receivers, 27 cells and 2 splits contradict", NO_RADIOSITY)                       \
    X(META, no_patches, "0 patches, 48 points and 768 words contradict", im->scene->patches = 0)                               \
    X(META, no_points, "20 patches, 0 points and 768 words contradict", im->scene->patch_points = 0)                           \
    X(META, frames_that_share_no_set, "looked_frames 0 contradicts", im->scene->looked_frames = 0)                             \
    X(META, more_frames_share_a_set_than_there_are, "looked_frames must be in 0..2", im->scene->looked_frames = 3)             \
    X(META, sets_without_live_radiosity, "looked_frames 1 contradicts", NO_RADIOSITY,                                          \
      im->scene->effects |= BIT(INDIRECT) | BIT(BASIS), im->scene->patches = im->scene->patch_points = 0,                      \
      im->scene->live[0] = im->scene->gather_words = 0)                                                                        \
    X(META, no_light_is_live, "20 patches, 48 points and 768 words contradict", im->scene->live[0] = 0)                        \
    X(META, a_light_that_is_not_there_is_live, "light 2 of 2 is live", im->scene->live[0] = 6)                                 \
    X(META, the_last_of_64_lights_is_live, "light 63 of 2 is live", im->scene->live[1] = 1u << 31)                             \
    X(META, no_words_with_transfer, "0 words, 2 sums and a rank of 16 contradict", im->scene->transfer_words = 0)              \
    X(META, no_sums_with_transfer, "1656 words, 0 sums and a rank of 16 contradict", im->scene->transfer_sums = 0)             \
    X(META, a_rank_without_the_effect, "1656 words, 2 sums and a rank of 16 contradict", EFFECTS(0, BIT(LOW_RANK)))            \
    X(META, no_bound_of_reflected_light, "most_reflected", im->scene->most_reflected = NAN)                                    \
    X(META, huge_bound_of_reflected_light, "most_reflected", im->scene->most_reflected = 2 * VIT_MAX_PHOTON)                   \
    X(PATC, a_patch_more, "META counts 21 records", ADD(patches, 1))                                                           \
    X(PPNT, sixteen_points_less, "META counts 32 records", im->scene->patch_points = 32)                                       \
    X(GATH, a_word_more, "META counts 769 records", ADD(gather_words, 1))                                                      \
    X(LOOK, one_set_for_both_frames, "META counts 16 records", im->scene->looked_frames = 2)                                   \
    X(XFER, a_word_more, "META counts 1657 records", ADD(transfer_words, 1))

#define RECORD_FAULTS(X)                                                                                                       \
    X(PATC, points_that_another_patch_has, "patch 1: points 1 to 4 of 48, expected from 2 on", im->patches[1].first = 1)       \
    X(PATC, a_point_that_no_patch_has, "patch 3: points 7", im->patches[3].first = 7)                                          \
    X(PATC, a_patch_without_points, "patch 19: points 38 to 38", im->patches[19].end = 38)                                     \
    X(PATC, points_beyond_the_last, "patch 19: points 38 to 49 of 48", im->patches[19].end = 49)                               \
    X(PATC, padding_in_use, "patch 0: padding", im->patches[0].pad[1] = 1)                                                     \
    X(PPNT, patch_beyond_the_last, "point 47: there is no such patch", im->patch_points[47].patch = 20)                        \
    X(PPNT, position_of_nan, "point 0: position", im->patch_points[0].position[2] = NAN)                                       \
    X(PPNT, normal_too_long, "point 1: position is not finite, or normal", im->patch_points[1].normal[1] = 2)                  \
    X(PPNT, negative_weight, "point 2: weight", im->patch_points[2].weight = -0.25f)                                           \
    X(PPNT, weight_of_nan, "point 2: weight", im->patch_points[2].weight = NAN)                                                \
    X(PPNT, weights_beyond_1, "patch 1: weights of its points sum to 1.75", im->patch_points[2].weight = 1)                    \
    X(PPNT, albedo_beyond_1, "point 3: albedo", im->patch_points[3].albedo[2] = 1.5f)                                          \
    X(PPNT, albedo_of_nan, "point 3: albedo", im->patch_points[3].albedo[0] = NAN)                                             \
    X(PPNT, reflects_too_much, "point 4: reflect", im->patch_points[4].reflect[0] = 17)                                        \
    X(PPNT, reflects_less_than_nothing, "point 4: reflect", im->patch_points[4].reflect[1] = -1)                               \
    X(PPNT, padding_in_use, "point 5: padding", im->patch_points[5].pad0 = 1)                                                  \
    X(PPNT, padding_at_the_end_in_use, "point 5: padding", im->patch_points[5].pad1 = 1)                                       \
    X(GROW, a_row_within_another, "receiver 2: 3 columns and 1 words from 2 on, expected from 3 on",                           \
      im->gather_rows[2].first = 2)                                                                                            \
    X(GROW, words_beyond_the_last, "receiver 510: 3 columns and 2 words from 765 on", im->gather_rows[510].weighted = 2)       \
    X(GROW, columns_beyond_the_last, "receiver 510: 5 columns and 1 words from 765 on", im->gather_rows[510].ones = 5)         \
    X(GROW, a_count_that_wraps, "receiver 0: 3 columns and 4294967295 words", im->gather_rows[0].weighted = 0xffffffff)        \
    X(GROW, columns_that_wrap, "receiver 0: 4294967295 columns", im->gather_rows[0].ones = 0xffffffff)                         \
    X(GROW, negative_scale, "receiver 1: scale", im->gather_rows[1].scale = -0x1p-18f)                                         \
    X(GROW, scale_of_nan, "receiver 1: scale", im->gather_rows[1].scale = NAN)                                                 \
    X(GROW, more_than_there_is_to_see, "receiver 0: weights sum to 1.01", im->gather_rows[0].scale = 0x1p-8f)                  \
    X(GATH, column_beyond_the_last, "word 767: column 80 of 80", im->gather_words[767] = 80)                                   \
    X(GATH, last_of_16_bits, "word 5: column 65535 of 80", im->gather_words[5] |= 0xffff)                                      \
    X(GATH, second_column_beyond_the_last, "word 3: column 80 of 80", im->gather_words[3] = 80u << 16)                         \
    X(GATH, padding_in_use, "word 4: padding", im->gather_words[4] = 1u << 16)                                                 \
    X(XFER, another_codec, "codec 5", im->transfer[1] = 5)                                                                     \
    X(XFER, a_codec_that_has_no_rank, "codec 0, 20 patches, rank 16", im->transfer[1] = 0)                                     \
    X(XFER, patches_that_meta_does_not_have, "19 patches, rank 16 and 2 sums, META says 20", im->transfer[2] = 19)             \
    X(XFER, more_rows, "not where they belong", im->transfer[3] = 48)                                                          \
    X(XFER, a_part_elsewhere, "not where they belong", im->transfer[10]++)                                                     \
    X(XFER, more_sums, "an entry kept apart has no place", im->transfer[5] = 2)                                                \
    X(XFER, a_place_beyond_the_last, "an entry kept apart has no place", im->transfer[120 + 31] = 32)                          \
    X(XFER, a_slot_in_a_column_beyond_the_last, "an entry kept apart has no place", im->transfer[152] = 32)                    \
    X(XFER, slots_beyond_the_last, "an entry kept apart has no place", im->transfer[119] = 3)                                  \
    X(XFER, a_code_that_is_infinite, "not finite", im->transfer[20] = 0x7f000000)                                              \
    X(XFER, an_infinite_scale, "not finite", im->transfer[504] = 0x7f800000)                                                   \
    X(XFER, an_infinite_mix, "not finite", im->transfer[FIXTURE_TRANSFER - 1] = 0xff800000)                                    \
    X(CAMS, reflected_light_that_is_infinite_once_exposed, "frame 1: light could be",                                          \
      im->scene->most_reflected = VIT_MAX_PHOTON, im->cameras[1].exposure = VIT_MAX_EXPOSURE)

/* What is just inside the limits must pass: X(name, change made to `im`). */
#define LIMITS(X)                                                                                                              \
    X(no_receiver_sees_a_patch, memset(im->gather_words, 0, FIXTURE_GATHER * sizeof *im->gather_words))                        \
    X(the_last_column, im->gather_words[2] = 65535u << 16 | 79)                                                                \
    X(both_last_columns, im->gather_words[0] = 79u << 16 | 79)                                                                 \
    X(receivers_that_no_frame_looks_up, memset(im->looked_up, 0, FIXTURE_LOOKED * sizeof *im->looked_up))                      \
    X(every_light_is_live, im->scene->live[0] = 3)                                                                             \
    X(black_points, memset(im->patch_points[0].albedo, 0, sizeof im->patch_points[0].albedo))                                  \
    X(points_without_weight, im->patch_points[0].weight = im->patch_points[1].weight = 0)                                      \
    X(nothing_is_reflected, im->scene->most_reflected = 0)                                                                     \
    X(numbers_that_are_negative, im->transfer[FIXTURE_TRANSFER - 1] = 0xff7fffff)                                              \
    X(the_largest_codes, im->transfer[168] = 0xffffffff)

#define FAULTS(X) META_FAULTS(X) RECORD_FAULTS(X)

#define FORGED_KIND FIXTURE_LIVE
#define FORGED_NAME "forged packs with live radiosity"
#define FORGED_TESTS
#include "forged_main.h"
