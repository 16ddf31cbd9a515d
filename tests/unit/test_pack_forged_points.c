/* The loader against forged packs whose receivers are points, as test_pack_forged.c has it: every check of what is there for
 * the effect POINTS, and what is just inside their limits. */
#include "forged_pack.h"

#include <float.h>
#include <math.h>

/* The fixture has 8 records, of keys 8, 15, 17, 17 and, the last, 7, the third of which is parted, and 512 receivers. */
#define META_FAULTS(X)                                                                                                         \
    X(META, many_levels, "point_levels must be in 0..16, got 17", im->scene->point_levels = 17)                                \
    X(META, no_levels, "0 levels, 8 cells and 0 splits contradict the effect POINTS", im->scene->point_levels = 0)             \
    X(META, a_split, "2 levels, 8 cells and 1 splits contradict the effect POINTS", im->scene->receiver_splits = 1)            \
    X(META, cells_of_no_power, "2 levels, 7 cells and 0 splits contradict the effect POINTS", im->scene->receiver_cells = 7)   \
    X(META, no_cells, "512 receivers, 0 cells and 0 splits contradict", im->scene->receiver_cells = 0)                         \
    X(META, points_without_basis, "POINTS without BASIS", EFFECTS(0, BIT(BASIS) | BIT(RELIGHT)))                               \
    X(META, step_without_the_effect, "point_step must be in 0..0", EFFECTS(0, BIT(POINTS)))                                    \
    X(META, detail_without_the_effect, "point_detail must be in 0..0", EFFECTS(0, BIT(POINTS)), im->scene->point_step = 0)     \
    X(META, levels_without_the_effect, "2 levels, 8 cells", EFFECTS(0, BIT(POINTS)),                                           \
      im->scene->point_step = im->scene->point_detail = 0)                                                                     \
    X(META, no_step, "point_step must be in", im->scene->point_step = 0)                                                       \
    X(META, subnormal_step, "point_step must be in", im->scene->point_step = FLT_MIN / 2)                                      \
    X(META, infinite_step, "point_step must be in", im->scene->point_step = INFINITY)                                          \
    X(META, step_of_nan, "point_step must be in", im->scene->point_step = NAN)                                                 \
    X(META, negative_detail, "point_detail must be in", im->scene->point_detail = -1)                                          \
    X(META, detail_of_nan, "point_detail must be in", im->scene->point_detail = NAN)                                           \
    X(RCEL, twice_the_cells, "META counts 16 records", im->scene->receiver_cells = 16)

#define RECORD_FAULTS(X)                                                                                                       \
    X(RCEL, before_its_place, "record 3 is not found behind record 2", im->point_cells[2] = (vit_cache_cell){.key = 40})       \
    X(RCEL, behind_a_greater_key, "record 1 is not found behind record 0", im->point_cells[0].key = 24)                        \
    X(RCEL, behind_no_cell, "record 1 is not found behind record 0",                                                           \
      im->point_cells[0] = (vit_cache_cell){.key = VIT_CACHE_EMPTY})                                                           \
    X(RCEL, the_same_cell_twice, "record 3 is not found behind record 2", im->point_cells[3].word[2] = 2u << 20)               \
    X(RCEL, receiver_beyond_the_last, "record 0: receiver 512 of 512", im->point_cells[0].word[0] = 512)                       \
    X(RCEL, last_point_beyond_the_last, "record 7: receiver 512 of 512", im->point_cells[7].word[0] = 505)                     \
    X(RCEL, point_9_of_8, "record 3: receiver 308 of 512", im->point_cells[3].word[1] = 0xffffff8f)                            \
    X(RCEL, point_15_of_8, "record 3: receiver 314 of 512", im->point_cells[3].word[1] = 0xffffffef)                           \
    X(RCEL, huge_receiver, "record 1: receiver 4294967295 of 512", im->point_cells[1].word[0] = 0xffffffff)                    \
    X(RCEL, receiver_that_wraps, "record 1: receiver", im->point_cells[1].word[0] = 0xffffffff,                                \
      im->point_cells[1].word[1] = 0xfffffff1)                                                                                 \
    X(RCEL, bits_that_no_point_has, "record 0: bits that no point has", im->point_cells[0].word[2] |= 1)                       \
    X(RCEL, most_bits_of_a_parted_one, "record 2: bits that no point has", im->point_cells[2].word[2] &= ~1u)                  \
    X(RCEL, plane_of_no_distance, "record 2: its plane is none", im->point_cells[2].word[1] = 0x7fffffff)                      \
    X(RCEL, plane_too_far, "record 2: its plane is none", im->point_cells[2].word[1] = 0xc5800001)                             \
    X(RCEL, plane_of_nan, "record 2: its plane is none", im->point_cells[2].word[1] = 0xffc00000)                              \
    X(RCEL, points_of_no_cell, "record 4: bits that no point has", im->point_cells[4].word[1] = 1)                             \
    X(RCEL, tag_of_no_cell, "record 6: bits that no point has", im->point_cells[6].word[2] = VIT_CACHE_TAG)

#define LIMITS(X)                                                                                                              \
    X(a_cell_that_knows_nothing, im->point_cells[0].word[0] = im->point_cells[0].word[1] = 0xffffffff)                         \
    X(the_last_receiver, im->point_cells[0].word[0] = 511)                                                                     \
    X(every_point_one_receiver, im->point_cells[7].word[0] = 511, im->point_cells[7].word[1] = 0)                              \
    X(every_tag, im->point_cells[7].word[2] = VIT_CACHE_TAG)                                                                   \
    X(the_farthest_plane, im->point_cells[2].word[1] = 0xc5800000)                                                             \
    X(any_normal, im->point_cells[2].word[0] = 0xffffffff)                                                                     \
    X(the_most_levels, im->scene->point_levels = 16)                                                                           \
    X(any_step, im->scene->point_step = FLT_MIN, im->scene->point_detail = FLT_MAX)                                            \
    X(no_detail, im->scene->point_detail = 0)

#define FAULTS(X) META_FAULTS(X) RECORD_FAULTS(X)

#define FORGED_KIND FIXTURE_POINT_CELLS
#define FORGED_NAME "forged packs with receivers at points"
#define FORGED_TESTS
#include "forged_main.h"
