/* The loader against forged packs with a lightmap, as test_pack_forged.c has it: every check of what is there for the effects
 * LIGHTMAP and LIGHTMAP_RAYS, and what is just inside their limits. */
#include "forged_pack.h"

#include <float.h>
#include <math.h>

#define NO_LIGHTS_WITH_AN_EXTENT BIT(SKY_LIGHT) | BIT(AREA_LIGHTS)

/* The fixture has 30 cells, of which sides have 26, 2 splits, 40 receivers. */
#define FAULTS(X)                                                                                                              \
    X(META, huge_map_cells, "map_cells", im->scene->map_cells = 0x1000000)                                                     \
    X(META, huge_map_splits, "map_splits", im->scene->map_splits = 0x1000000)                                                  \
    X(META, huge_map_receivers, "map_receivers must be in 0..16777216", im->scene->map_receivers = 0x1000001)                  \
    X(META, nothing_with_an_extent, "LIGHTMAP without SKY_LIGHT and AREA_LIGHTS", EFFECTS(0, NO_LIGHTS_WITH_AN_EXTENT))        \
    X(META, rays_without_a_lightmap, "LIGHTMAP_RAYS without LIGHTMAP", EFFECTS(0, BIT(LIGHTMAP)))                              \
    X(META, no_map_receivers, "lightmap of 0 receivers, 30 cells and 2 splits contradicts", im->scene->map_receivers = 0)      \
    X(META, no_map_cells, "lightmap of 40 receivers, 0 cells", im->scene->map_cells = 0)                                       \
    X(META, splits_without_the_effect, "lightmap of 0 receivers, 0 cells and 2 splits contradicts",                            \
      EFFECTS(0, BIT(LIGHTMAP) | BIT(LIGHTMAP_RAYS)), im->scene->map_receivers = im->scene->map_cells = 0)                     \
    X(META, detail_of_points, "point_detail must be in 0..0", im->scene->point_detail = 1)                                     \
    X(MCEL, one_cell_more, "META counts 31 records", ADD(map_cells, 1))                                                        \
    X(MSPL, one_split_less, "META counts 1 records", im->scene->map_splits--)                                                  \
    X(MREC, a_receiver_more, "META counts 41 records", ADD(map_receivers, 1))                                                  \
    X(MSID, cell_beyond_the_last, "side 5: 1 parts from cell 30 on, of 30",                                                    \
      im->map_sides[5] = 1u << VIT_SIDE_PARTS_SHIFT | 30)                                                                      \
    X(MSID, no_parts, "side 0: 0 parts", im->map_sides[0] = 1)                                                                 \
    X(MCEL, receiver_beyond_the_last, "record 3: receiver 40 of 40", im->map_cells[3].receiver[2] = 40)                        \
    X(MCEL, split_beyond_the_last, "record 3: split 2 of 2", im->map_cells[3].split = 2)                                       \
    X(MCEL, many_parts, "record 3: 17 parts", im->map_cells[3] = divided(26, 17))                                              \
    X(MCEL, a_part_of_itself, "cells begin at record 1, expected behind 1", im->map_cells[1] = divided(1, 2))                  \
    X(MCEL, parts_beyond_the_last, "record 2: its cells must be", im->map_cells[2] = divided(27, 2))                           \
    X(MCEL, by_rays_with_a_receiver, "record 5: padding", im->map_cells[5].receiver[1] = 1)                                    \
    X(MCEL, by_rays_without_the_effect, "record 5: 0 parts", EFFECTS(0, BIT(LIGHTMAP_RAYS)))                                   \
    X(MSPL, receiver_beyond_the_last, "record 1: receiver 40 of 40", im->map_splits[1].receiver[0] = 40)                       \
    X(MSPL, normal_of_nan, "record 1: its normal", im->map_splits[1].normal[0] = NAN)                                          \
    X(MSPL, padding_in_use, "record 0: padding", im->map_splits[0].pad = 1)                                                    \
    X(MREC, negative_irradiance, "receiver 39: irradiance", im->map_receivers[39].irradiance[2] = -1)                          \
    X(MREC, irradiance_of_nan, "receiver 0: irradiance", im->map_receivers[0].irradiance[0] = NAN)                             \
    X(MREC, padding_in_use, "receiver 9: irradiance must be in 0..1e+30, and padding 0", im->map_receivers[9].pad = 1)         \
    X(CAMS, irradiance_that_is_infinite_once_exposed, "frame 1: light could be",                                               \
      im->map_receivers[7].irradiance[2] = VIT_MAX_PHOTON, im->cameras[1].exposure = VIT_MAX_EXPOSURE)

#define LIMITS(X)                                                                                                              \
    X(every_cell_by_rays, all_by_rays(im))                                                                                     \
    X(no_cell_by_rays, im->map_cells[5] = im->map_cells[28] = im->map_cells[3])                                                \
    X(the_last_receiver_everywhere, im->map_cells[7] = (vit_receiver_cell){.receiver = {39, 39, 39}, .split = VIT_NONE})       \
    X(dark_receivers, memset(im->map_receivers, 0, FIXTURE_MAP_RECEIVERS * sizeof *im->map_receivers))                         \
    X(most_irradiance, im->map_receivers[0].irradiance[0] = VIT_MAX_PHOTON)

static vit_receiver_cell divided(uint32_t first, uint32_t parts) {
    return (vit_receiver_cell){.receiver = {first, 0, 0}, .split = VIT_RECEIVER_DIVIDED | parts};
}

static void all_by_rays(image *im) {
    for (int i = 0; i < FIXTURE_MAP_CELLS; i++)
        im->map_cells[i] = (vit_receiver_cell){.split = VIT_RECEIVER_BY_RAYS};
}

#define FORGED_KIND FIXTURE_LIGHTMAP
#define FORGED_NAME "forged packs with a lightmap"
#define FORGED_TESTS
#include "forged_main.h"
