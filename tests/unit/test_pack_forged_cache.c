/* The loader against forged packs with a world-space cache, as test_pack_forged.c has it: every check of what is there for the
 * effect OCCLUSION, and what is just inside their limits. */
#include "forged_pack.h"

#include <float.h>
#include <math.h>

/* The fixture has 8 records, of keys 8, 15, 17, 17 and, the last, 7: a look-up takes up to 3. */
#define META_FAULTS(X)                                                                                                         \
    X(META, cells_of_no_power, "cache_cells must be a power of two, got 7", im->scene->cache_cells = 7)                        \
    X(META, huge_cache, "cache_cells must be in 0..67108864", im->scene->cache_cells = 1u << 27)                               \
    X(META, many_probes, "cache_probes must be in 0..64, got 65", im->scene->cache_probes = 65)                                \
    X(META, many_levels, "cache_levels must be in 0..16, got 17", im->scene->cache_levels = 17)                                \
    X(META, occlusion_without_light, "OCCLUSION without AMBIENT", EFFECTS(0, BIT(AMBIENT)))                                    \
    X(META, no_cells, "0 cells, 3 probes and 2 levels of a cache contradict", im->scene->cache_cells = 0)                      \
    X(META, no_probes, "8 cells, 0 probes and 2 levels of a cache contradict", im->scene->cache_probes = 0)                    \
    X(META, no_levels, "8 cells, 3 probes and 0 levels of a cache contradict", im->scene->cache_levels = 0)                    \
    X(META, cells_without_the_effect, "ambient_radius must be in 0..0", EFFECTS(0, BIT(OCCLUSION)))                            \
    X(META, levels_without_the_effect, "0 cells, 0 probes and 2 levels", EFFECTS(0, BIT(OCCLUSION)),                           \
      im->scene->ambient_radius = im->scene->cache_step = im->scene->cache_detail = 0,                                         \
      im->scene->cache_cells = im->scene->cache_probes = 0)                                                                    \
    X(META, no_radius, "ambient_radius must be in", im->scene->ambient_radius = 0)                                             \
    X(META, radius_of_nan, "ambient_radius must be in", im->scene->ambient_radius = NAN)                                       \
    X(META, infinite_radius, "ambient_radius must be in", im->scene->ambient_radius = INFINITY)                                \
    X(META, no_step, "cache_step must be in", im->scene->cache_step = 0)                                                       \
    X(META, subnormal_step, "cache_step must be in", im->scene->cache_step = FLT_MIN / 2)                                      \
    X(META, step_of_nan, "cache_step must be in", im->scene->cache_step = NAN)                                                 \
    X(META, negative_detail, "cache_detail must be in", im->scene->cache_detail = -1)                                          \
    X(META, detail_of_nan, "cache_detail must be in", im->scene->cache_detail = NAN)                                           \
    X(META, error_of_a_baked_cache, "cache_error must be in 0..0", im->scene->cache_error = 0.5f)                              \
    X(META, no_error_of_a_live_one, "cache_error must be in", EFFECTS(BIT(LIVE_CACHE), 0))                                     \
    X(META, live_cache_without_one, "LIVE_CACHE without OCCLUSION", EFFECTS(BIT(LIVE_CACHE), BIT(OCCLUSION)),                  \
      im->scene->ambient_radius = im->scene->cache_step = im->scene->cache_detail = 0, im->scene->cache_error = 0.5f)          \
    X(META, step_of_points, "point_step must be in 0..0", im->scene->point_step = 1)                                           \
    X(CACH, twice_the_cells, "META counts 16 records", im->scene->cache_cells = 16)

#define RECORD_FAULTS(X)                                                                                                       \
    X(CACH, too_far_from_its_place, "record 1 is 2 records from its key's place, expected less than 2",                        \
      im->scene->cache_probes = 2)                                                                                             \
    X(CACH, before_its_place, "record 7 is 7 records from its key's place", im->cache[7].key = 0)                              \
    X(CACH, behind_a_greater_key, "record 1 is not found behind record 0", im->cache[0].key = 23)                              \
    X(CACH, behind_no_cell, "record 2 is not found behind record 1", im->cache[1] = (vit_cache_cell){.key = VIT_CACHE_EMPTY})  \
    X(CACH, the_same_cell_twice, "record 3 is not found behind record 2", im->cache[3].word[2] = im->cache[2].word[2])         \
    X(CACH, bits_that_no_point_has, "record 0: bits that no point has", im->cache[0].word[0] |= 0x40000000)                    \
    X(CACH, bits_of_the_second_word, "record 7: bits that no point has", im->cache[7].word[1] |= 0x80000000)                   \
    X(CACH, plane_of_no_distance, "record 0: its plane is none", im->cache[0].word[2] |= VIT_CACHE_PARTED,                     \
      im->cache[0].word[1] = 0x7fffffff)                                                                                       \
    X(CACH, plane_too_far, "record 0: its plane is none", im->cache[0].word[2] |= VIT_CACHE_PARTED,                            \
      im->cache[0].word[1] = 0xc5800001)                                                                                       \
    X(CACH, plane_of_nan, "record 0: its plane is none", im->cache[0].word[2] |= VIT_CACHE_PARTED,                             \
      im->cache[0].word[1] = 0xffc00000)                                                                                       \
    X(CACH, points_of_no_cell, "record 4: bits that no point has", im->cache[4].word[0] = 1)                                   \
    X(CACH, tag_of_no_cell, "record 6: bits that no point has", im->cache[6].word[2] = VIT_CACHE_TAG)

#define LIMITS(X)                                                                                                              \
    X(a_cell_that_knows_nothing, memset(im->cache[0].word, 0, sizeof im->cache[0].word))                                       \
    X(every_bit_of_the_last_word, im->cache[7].word[2] = 0xffffffff, im->cache[7].word[1] = 0x80000000)                        \
    X(the_farthest_plane, im->cache[0].word[2] |= VIT_CACHE_PARTED, im->cache[0].word[1] = 0xc5800000)                         \
    X(any_normal, im->cache[0].word[2] |= VIT_CACHE_PARTED, im->cache[0].word[1] = 0xbf800000,                                 \
      im->cache[0].word[0] = 0xffffffff)                                                                                       \
    X(every_point_the_greatest, im->cache[7].word[0] = im->cache[7].word[1] = 0x3fffffff)                                      \
    X(the_most_levels, im->scene->cache_levels = 16)                                                                           \
    X(more_probes_than_needed, im->scene->cache_probes = 64)                                                                   \
    X(any_step, im->scene->cache_step = FLT_MIN, im->scene->cache_detail = FLT_MAX)                                            \
    X(a_live_cache, EFFECTS(BIT(LIVE_CACHE), 0), im->scene->cache_error = 1)                                                   \
    X(no_detail, im->scene->cache_detail = 0)

#define FAULTS(X) META_FAULTS(X) RECORD_FAULTS(X)

#define FORGED_KIND FIXTURE_BASIS
#define FORGED_NAME "forged packs with a cache"
#define FORGED_TESTS
#include "forged_main.h"
