/* The derived fields of a scene and the limits of the counts they follow from. The expected numbers are worked out by hand from
 * records.clh's words, not by the code's formulas; every limit is tried on both of its sides. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "vitrine_pack.h"

#include <string.h>

static vit_scene full_hd(void) {
    return (vit_scene){.width = 1920,
                       .height = 1080,
                       .frames = 100,
                       .tile = 16,
                       .triangles = 1000,
                       .nodes = 300,
                       .materials = 1,
                       .paths = 10000,
                       .baked = 77,
                       .bounces = 4,
                       .slice_count = 500,
                       .copies = 1};
}

static void full_hd_in_500_slices_has_a_key_of_23_bits_on_5_levels(void **state) {
    (void)state;
    vit_scene s = full_hd();
    assert_int_equal(vit_pack_derive(&s, NULL), VIT_OK);
    assert_int_equal(s.tiles_x, 120);
    assert_int_equal(s.tiles_y, 68); /* 67.5 */
    assert_int_equal(s.samples, 2088960);
    assert_int_equal(s.photons, 30077);
    assert_int_equal(s.key_bits_x, 7);
    assert_int_equal(s.key_bits_y, 7);
    assert_int_equal(s.key_bits_z, 9);
    assert_int_equal(s.key_bits_n, 0);
    assert_int_equal(s.key_bits, 23);
    assert_int_equal(s.levels, 5);
    /* Words by level: keys >> 25, >> 20, >> 15, >> 10, >> 5. */
    const vit_u32 first[VIT_MAX_LEVELS] = {0, 1, 1 + 8, 1 + 8 + 256, 1 + 8 + 256 + 8192};
    assert_memory_equal(s.level_first, first, sizeof first);
    assert_int_equal(s.mask_words, 1 + 8 + 256 + 8192 + 262144);
}

static void the_hierarchy_holds_every_key_without_waste(void **state) {
    (void)state;
    for (vit_u32 width = 8; width <= 7680; width *= 2)
        for (vit_u32 slices = 1; slices <= 4096; slices = slices * 2 + 1) {
            vit_scene s = full_hd();
            s.width = width;
            s.tile = 8;
            s.slice_count = slices;
            if (vit_pack_derive(&s, NULL) != VIT_OK)
                continue;
            const uint64_t last_key = ((uint64_t)1 << s.key_bits) - 1;
            for (vit_u32 j = 0; j < s.levels; j++) {
                const vit_u32 end = j + 1 < s.levels ? s.level_first[j + 1] : s.mask_words;
                assert_int_equal(end - s.level_first[j], (last_key >> 5 * (s.levels - j)) + 1);
            }
            assert_int_equal(s.levels > 1 ? s.level_first[1] : s.mask_words, 1); /* one root */
        }
}

static void one_tile_and_one_slice_need_no_key_but_one_level(void **state) {
    (void)state;
    vit_scene s = full_hd();
    s.width = s.height = 64;
    s.tile = 64;
    s.slice_count = 1;
    s.bounces = 1; /* traced photons are stored from the second hit on */
    assert_int_equal(vit_pack_derive(&s, NULL), VIT_OK);
    assert_int_equal(s.key_bits, 0);
    assert_int_equal(s.levels, 1);
    assert_int_equal(s.mask_words, 1);
    assert_int_equal(s.samples, 4096);
    assert_int_equal(s.photons, 77);
}

static void normal_keys_cost_6_bits(void **state) {
    (void)state;
    vit_scene s = full_hd();
    s.effects = VIT_BIT(NORMAL_KEYS);
    assert_int_equal(vit_pack_derive(&s, NULL), VIT_OK);
    assert_int_equal(s.key_bits_n, 6);
    assert_int_equal(s.key_bits, 29);
    assert_int_equal(s.levels, 6);
}

static void keys_may_have_30_bits_but_not_31(void **state) {
    (void)state;
    vit_scene s = full_hd();
    vit_text why = {""};
    s.effects = VIT_BIT(NORMAL_KEYS);
    s.slice_count = 1024;
    assert_int_equal(vit_pack_derive(&s, &why), VIT_OK);
    assert_int_equal(s.key_bits, 30);
    assert_int_equal(s.levels, 6);
    assert_int_equal(s.mask_words, 1 + 32 + 1024 + 32768 + 1048576 + 33554432);
    s.slice_count = 1025;
    assert_int_equal(vit_pack_derive(&s, &why), VIT_BAD_INPUT);
    assert_string_equal(why.text, "key_bits must be in 0..30, got 31");
}

static void photon_slots_may_number_2_to_the_25th_but_not_one_more(void **state) {
    (void)state;
    vit_scene s = full_hd();
    vit_text why = {""};
    s.paths = 1000000;
    s.bounces = 32;
    s.baked = 33554432 - 31000000;
    assert_int_equal(vit_pack_derive(&s, &why), VIT_OK);
    assert_int_equal(s.photons, 33554432);
    s.baked++;
    assert_int_equal(vit_pack_derive(&s, &why), VIT_BAD_INPUT);
    assert_non_null(strstr(why.text, "photons"));
}

static void every_count_has_limits_and_names_itself_beyond_them(void **state) {
    (void)state;
#define LIMIT(field, least, most)                                                                                              \
    { #field, offsetof(vit_scene, field), least, most }
    static const struct {
        const char *name;
        size_t offset;
        vit_u32 least, most;
    } limits[] = {LIMIT(width, 1, 7680),
                  LIMIT(height, 1, 4320),
                  LIMIT(frames, 1, 100000),
                  LIMIT(triangles, 300, 1 << 27),
                  LIMIT(nodes, 1, 1000),
                  LIMIT(materials, 1, 1 << 24),
                  LIMIT(textures, 0, 65536),
                  LIMIT(mips, 0, 65536 * 15),
                  LIMIT(texels, 0, 0x7fffffff),
                  LIMIT(lights, 0, 64),
                  LIMIT(paths, 0, 1000000),
                  LIMIT(bounces, 1, 32),
                  LIMIT(slice_count, 1, 4096),
                  LIMIT(tile, 8, 64),
                  LIMIT(chain, 0, 32),
                  LIMIT(area_samples, 0, 1024),
                  LIMIT(sky_samples, 0, 1024),
                  LIMIT(sky_size, 0, 2048),
                  LIMIT(copies, 1, 16),
                  LIMIT(cells, 0, 0xffffff),
                  LIMIT(baked, 0, 1 << 25),
                  LIMIT(receiver_cells, 0, 0xffffff),
                  LIMIT(receiver_splits, 0, 0xffffff),
                  LIMIT(receivers, 0, 1 << 24),
                  LIMIT(map_cells, 0, 0xffffff),
                  LIMIT(map_splits, 0, 0xffffff),
                  LIMIT(map_receivers, 0, 1 << 24),
                  LIMIT(basis_lights, 0, 3),
                  LIMIT(basis_words, 0, 1 << 28),
                  LIMIT(basis_coefficients, 0, 1 << 28),
                  LIMIT(patches, 0, 65520),
                  LIMIT(gather_words, 0, 1 << 28),
                  LIMIT(looked_frames, 0, 100),
                  LIMIT(cache_cells, 0, 1 << 26),
                  LIMIT(cache_probes, 0, 64),
                  LIMIT(cache_levels, 0, 16),
                  LIMIT(point_levels, 0, 16),
                  LIMIT(transfer_words, 0, 1 << 30),
                  LIMIT(transfer_sums, 0, 513)};
#undef LIMIT
    for (size_t i = 0; i < sizeof limits / sizeof limits[0]; i++)
        for (int k = 0; k < 4; k++) {
            const vit_u32 values[4] = {limits[i].least, limits[i].most, limits[i].least - 1, limits[i].most + 1};
            if (k == 2 && limits[i].least == 0)
                continue;
            vit_scene s = full_hd();
            vit_text why = {""};
            s.paths = 0;
            s.lights = 3;
            memcpy((char *)&s + limits[i].offset, &values[k], sizeof values[k]);
            if (vit_pack_derive(&s, &why) != (k < 2 ? VIT_OK : VIT_BAD_INPUT) || (k >= 2 && why.text[0] == 0))
                fail_msg("%s = %u: '%s'", limits[i].name, values[k], why.text);
        }
}

/* So that the pass relight's work-items have whole groups, at any number of lanes. */
static void receivers_come_in_whole_groups(void **state) {
    (void)state;
    vit_scene s = full_hd();
    vit_text why = {""};
    s.receivers = 768;
    assert_int_equal(vit_pack_derive(&s, &why), VIT_OK);
    for (vit_u32 less = 1; less < 256; less += less + 1) {
        s.receivers = 768 - less;
        assert_int_equal(vit_pack_derive(&s, &why), VIT_BAD_INPUT);
        assert_non_null(strstr(why.text, "receivers must be a multiple of 256"));
    }
}

static void deriving_twice_changes_nothing(void **state) {
    (void)state;
    vit_scene a = full_hd(), b;
    assert_int_equal(vit_pack_derive(&a, NULL), VIT_OK);
    b = a;
    assert_int_equal(vit_pack_derive(&b, NULL), VIT_OK);
    assert_memory_equal(&a, &b, sizeof a);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(full_hd_in_500_slices_has_a_key_of_23_bits_on_5_levels),
        cmocka_unit_test(the_hierarchy_holds_every_key_without_waste),
        cmocka_unit_test(one_tile_and_one_slice_need_no_key_but_one_level),
        cmocka_unit_test(normal_keys_cost_6_bits),
        cmocka_unit_test(keys_may_have_30_bits_but_not_31),
        cmocka_unit_test(photon_slots_may_number_2_to_the_25th_but_not_one_more),
        cmocka_unit_test(every_count_has_limits_and_names_itself_beyond_them),
        cmocka_unit_test(receivers_come_in_whole_groups),
        cmocka_unit_test(deriving_twice_changes_nothing),
    };
    return cmocka_run_group_tests_name("derived fields", tests, NULL, NULL);
}
