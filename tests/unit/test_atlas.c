/* The atlas. Images are made by hand with texels that tell where they come from; what is read back goes through vit_texture and
 * vit_mip as a kernel would, so that layout, gutter and colour are tested together. Means are checked against numbers worked
 * out here, not against the filter's own code. */
#include "geometry/atlas.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define MAX_IMAGES 64

/* A model of nothing but materials and images; each material has one triangle. */
typedef struct fixture {
    model m;
    model_image images[MAX_IMAGES];
    model_material materials[MAX_IMAGES];
    uint32_t material[MAX_IMAGES];
    atlas a;
} fixture;

static fixture *make(void) {
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->m.images = f->images;
    f->m.materials = f->materials;
    f->m.material = f->material;
    return f;
}

static uint8_t *add_image(fixture *f, int width, int height) {
    model_image *image = f->images + f->m.image_count++;
    image->width = width;
    image->height = height;
    image->rgba = malloc(4 * (size_t)width * (size_t)height);
    assert_non_null(image->rgba);
    memset(image->rgba, 255, 4 * (size_t)width * (size_t)height);
    return image->rgba;
}

static model_material *add_material(fixture *f, int image, uint32_t wrap_u, uint32_t wrap_v) {
    f->material[f->m.triangles++] = (uint32_t)f->m.material_count;
    model_material *material = f->materials + f->m.material_count++;
    material->image = image;
    material->wrap_u = wrap_u;
    material->wrap_v = wrap_v;
    material->alpha = 1.0f;
    return material;
}

static void pack(fixture *f) {
    vit_text why = {""};
    if (atlas_pack(&f->m, &f->a, &why) != VIT_OK)
        fail_msg("%s", why.text);
}

static void drop(fixture *f) {
    atlas_free(&f->a);
    for (int i = 0; i < f->m.image_count; i++)
        free(f->images[i].rgba);
    free(f);
}

static uint32_t word_at(const fixture *f, uint32_t texture, uint32_t level, int x, int y) {
    const vit_mip *mip = f->a.mips + f->a.textures[texture].first_mip + level;
    const uint32_t at = mip->offset + (uint32_t)y * mip->pitch + (uint32_t)x; /* as records.clh has it: two's complement */
    assert_true(at < f->a.texel_count);
    return f->a.texels[at];
}

static int channel(uint32_t word, int k) {
    return (int)(word >> (10 * k) & 1023u);
}

static double linear(int srgb) {
    const double c = srgb / 255.0;
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static int unorm10(double linear_value) {
    return (int)(sqrt(linear_value) * 1023.0 + 0.5);
}

/* An image in which red says the column and green the row. */
static void add_numbered_image(fixture *f, int width, int height) {
    uint8_t *texel = add_image(f, width, height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, texel += 4) {
            texel[0] = (uint8_t)(20 * x + 40);
            texel[1] = (uint8_t)(20 * y + 40);
            texel[2] = 7;
        }
}

static uint32_t numbered(int x, int y) {
    return (uint32_t)unorm10(linear(20 * x + 40)) | (uint32_t)unorm10(linear(20 * y + 40)) << 10 |
           (uint32_t)unorm10(linear(7)) << 20 | 0x80000000u;
}

static void a_model_without_textures_has_an_empty_atlas(void **state) {
    (void)state;
    fixture *f = make();
    add_material(f, -1, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT);
    add_material(f, -1, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT);
    pack(f);
    assert_int_equal(f->a.texel_count, 0);
    assert_int_equal(f->a.texture_count, 0);
    assert_int_equal(f->a.mip_count, 0);
    assert_int_equal(f->a.material_texture[0], VIT_NONE);
    assert_int_equal(f->a.material_texture[1], VIT_NONE);
    drop(f);
}

static void texels_are_square_roots_of_linear_light_in_ten_bits(void **state) {
    (void)state;
    fixture *f = make();
    uint8_t *rgba = add_image(f, 256, 1);
    for (int i = 0; i < 256; i++)
        rgba[4 * i] = rgba[4 * i + 1] = rgba[4 * i + 2] = (uint8_t)i;
    add_material(f, 0, VIT_WRAP_CLAMP, VIT_WRAP_CLAMP);
    pack(f);
    for (int i = 0; i < 256; i++) {
        const uint32_t word = word_at(f, 0, 0, i, 0);
        assert_int_equal(word >> 30, 2);
        for (int k = 0; k < 3; k++)
            assert_int_equal(channel(word, k), unorm10(linear(i)));
    }
    assert_int_equal(channel(word_at(f, 0, 0, 255, 0), 0), 1023);
    assert_int_equal(channel(word_at(f, 0, 0, 0, 0), 0), 0);
    drop(f);
}

/* Expected texel of a coordinate outside, per wrap mode, written out. */
static int continued(int at, int size, uint32_t wrap) {
    if (at >= 0 && at < size)
        return at;
    const bool before = at < 0;
    switch (wrap) {
    case VIT_WRAP_REPEAT:
        return before ? size - 1 : 0;
    default:
        return before ? 0 : size - 1;
    }
}

static void check_gutter(uint32_t wrap_u, uint32_t wrap_v, int width, int height) {
    fixture *f = make();
    add_numbered_image(f, width, height);
    add_material(f, 0, wrap_u, wrap_v);
    pack(f);
    assert_int_equal(f->a.textures[0].wrap_u, wrap_u);
    assert_int_equal(f->a.textures[0].wrap_v, wrap_v);
    for (int y = -1; y <= height; y++)
        for (int x = -1; x <= width; x++)
            assert_int_equal(word_at(f, 0, 0, x, y), numbered(continued(x, width, wrap_u), continued(y, height, wrap_v)));
    for (uint32_t level = 1; level < f->a.textures[0].mip_count; level++) {
        const vit_mip *mip = f->a.mips + level;
        const int w = (int)mip->width, h = (int)mip->height;
        for (int y = -1; y <= h; y++)
            for (int x = -1; x <= w; x++)
                assert_int_equal(word_at(f, 0, level, x, y),
                                 word_at(f, 0, level, continued(x, w, wrap_u), continued(y, h, wrap_v)));
    }
    drop(f);
}

static void a_mip_gutter_continues_a_repeating_image_with_the_opposite_edge(void **state) {
    (void)state;
    check_gutter(VIT_WRAP_REPEAT, VIT_WRAP_REPEAT, 5, 3);
    check_gutter(VIT_WRAP_REPEAT, VIT_WRAP_REPEAT, 8, 8);
    check_gutter(VIT_WRAP_REPEAT, VIT_WRAP_REPEAT, 1, 1);
}

static void a_mip_gutter_continues_a_clamped_or_mirrored_image_with_the_same_edge(void **state) {
    (void)state;
    check_gutter(VIT_WRAP_CLAMP, VIT_WRAP_CLAMP, 5, 3);
    check_gutter(VIT_WRAP_MIRROR, VIT_WRAP_MIRROR, 7, 4);
}

static void the_corners_of_a_gutter_follow_both_wrap_modes(void **state) {
    (void)state;
    check_gutter(VIT_WRAP_REPEAT, VIT_WRAP_CLAMP, 6, 5);
    check_gutter(VIT_WRAP_MIRROR, VIT_WRAP_REPEAT, 3, 9);
}

static void mips_halve_down_to_one_texel(void **state) {
    (void)state;
    fixture *f = make();
    add_image(f, 37, 10);
    add_material(f, 0, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT);
    pack(f);
    const uint32_t sizes[][2] = {{37, 10}, {18, 5}, {9, 2}, {4, 1}, {2, 1}, {1, 1}};
    assert_int_equal(f->a.textures[0].mip_count, 6);
    for (uint32_t i = 0; i < 6; i++) {
        assert_int_equal(f->a.mips[i].width, sizes[i][0]);
        assert_int_equal(f->a.mips[i].height, sizes[i][1]);
    }
    drop(f);
}

static void black_and_white_mix_in_linear_light(void **state) {
    (void)state;
    fixture *f = make();
    uint8_t *rgba = add_image(f, 2, 2);
    memset(rgba, 0, 3);
    memset(rgba + 12, 0, 3);
    add_material(f, 0, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT);
    pack(f);
    assert_int_equal(channel(word_at(f, 0, 1, 0, 0), 0), 723); /* sqrt(1/2) * 1023; mixing sRGB values would give 471 */
    drop(f);
}

static void a_plain_image_of_any_size_is_plain_on_every_level(void **state) {
    (void)state;
    const int sizes[][2] = {{37, 23}, {1, 19}, {64, 2}, {100, 100}, {255, 3}};
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        fixture *f = make();
        uint8_t *rgba = add_image(f, sizes[s][0], sizes[s][1]);
        for (int i = 0; i < sizes[s][0] * sizes[s][1]; i++)
            memcpy(rgba + 4 * i, (const uint8_t[]){90, 200, 13, 255}, 4);
        add_material(f, 0, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT);
        pack(f);
        const uint32_t first = word_at(f, 0, 0, 0, 0);
        for (uint32_t level = 0; level < f->a.textures[0].mip_count; level++)
            for (int y = -1; y <= (int)f->a.mips[level].height; y++)
                for (int x = -1; x <= (int)f->a.mips[level].width; x++)
                    assert_int_equal(word_at(f, 0, level, x, y), first);
        drop(f);
    }
}

static void odd_sizes_are_weighted_by_the_area_that_is_covered(void **state) {
    (void)state;
    fixture *f = make();
    const int grey[5] = {250, 10, 120, 60, 200};
    uint8_t *rgba = add_image(f, 5, 1);
    for (int i = 0; i < 5; i++)
        memset(rgba + 4 * i, grey[i], 3);
    add_material(f, 0, VIT_WRAP_CLAMP, VIT_WRAP_CLAMP);
    pack(f);
    const double l[5] = {linear(250), linear(10), linear(120), linear(60), linear(200)};
    assert_int_equal(channel(word_at(f, 0, 1, 0, 0), 1), unorm10((l[0] + l[1] + 0.5 * l[2]) / 2.5));
    assert_int_equal(channel(word_at(f, 0, 1, 1, 0), 1), unorm10((0.5 * l[2] + l[3] + l[4]) / 2.5));
    assert_int_equal(channel(word_at(f, 0, 2, 0, 0), 1), unorm10((l[0] + l[1] + l[2] + l[3] + l[4]) / 5.0));
    drop(f);
}

/* Red leaf on a green, transparent ground. */
static fixture *leaf(float cutoff) {
    fixture *f = make();
    uint8_t *rgba = add_image(f, 16, 16);
    for (int i = 0; i < 256; i++)
        memcpy(rgba + 4 * i, i % 16 + i / 16 < 12 ? (const uint8_t[]){255, 0, 0, 255} : (const uint8_t[]){0, 255, 0, 0}, 4);
    add_material(f, 0, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT)->cutoff = cutoff;
    pack(f);
    return f;
}

static void the_colour_of_transparent_texels_does_not_bleed_into_a_cut_out(void **state) {
    (void)state;
    fixture *f = leaf(0.5f);
    for (uint32_t level = 0; level < f->a.textures[0].mip_count; level++)
        for (int y = -1; y <= (int)f->a.mips[level].height; y++)
            for (int x = -1; x <= (int)f->a.mips[level].width; x++)
                assert_int_equal(word_at(f, 0, level, x, y) & 0x3fffffffu, 1023);
    drop(f);
}

static void an_opaque_material_keeps_the_colour_whatever_the_alpha(void **state) {
    (void)state;
    fixture *f = leaf(0.0f);
    const uint32_t word = word_at(f, 0, 0, 15, 15);
    assert_int_equal(word, 0x80000000u | 1023u << 10);
    drop(f);
}

static void the_verdict_is_that_of_alpha_times_factor_against_the_cutoff(void **state) {
    (void)state;
    fixture *f = make();
    uint8_t *rgba = add_image(f, 256, 1);
    for (int i = 0; i < 256; i++)
        rgba[4 * i + 3] = (uint8_t)i;
    const float cases[][2] = {{0.5f, 1.0f}, {0.5f, 0.75f}, {1.0f, 1.0f}, {0.25f, 0.0f}, {0.01f, 0.3f}};
    for (int c = 0; c < 5; c++) {
        model_material *material = add_material(f, 0, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT);
        material->cutoff = cases[c][0];
        material->alpha = cases[c][1];
    }
    pack(f);
    for (int c = 0; c < 5; c++)
        for (int i = 0; i < 256; i++) {
            const bool opaque = (double)i / 255.0 * (double)cases[c][1] >= (double)cases[c][0];
            assert_int_equal(word_at(f, f->a.material_texture[c], 0, i, 0) >> 31, opaque);
        }
    drop(f);
}

static void mips_of_a_cut_out_keep_about_its_coverage(void **state) {
    (void)state;
    fixture *f = leaf(0.5f);
    for (uint32_t level = 0; level < 4; level++) { /* 16, 8, 4, 2 texels wide */
        const int w = (int)f->a.mips[level].width;
        int opaque = 0;
        for (int i = 0; i < w * w; i++)
            opaque += (int)(word_at(f, 0, level, i % w, i / w) >> 31);
        const double share = (double)opaque / (w * w);
        assert_true(fabs(share - 78.0 / 256.0) < 0.1); /* 78 texels have x + y < 12 */
    }
    drop(f);
}

static void each_combination_of_image_wrap_and_cutoff_is_packed_once(void **state) {
    (void)state;
    fixture *f = make();
    add_image(f, 4, 4);
    add_image(f, 4, 4);
    add_material(f, 0, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT);
    add_material(f, 0, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT); /* the same */
    add_material(f, 0, VIT_WRAP_REPEAT, VIT_WRAP_CLAMP);
    add_material(f, 1, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT);
    add_material(f, 0, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT)->cutoff = 0.5f;
    model_material *same = add_material(f, 0, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT); /* the same ratio */
    same->cutoff = 0.25f;
    same->alpha = 0.5f;
    add_material(f, 1, VIT_WRAP_MIRROR, VIT_WRAP_MIRROR);
    f->m.triangles--; /* nothing uses the last one */
    pack(f);
    const uint32_t expected[] = {0, 0, 1, 2, 3, 3, VIT_NONE};
    assert_int_equal(f->a.texture_count, 4);
    assert_memory_equal(f->a.material_texture, expected, sizeof expected);
    drop(f);
}

static void levels_and_gutters_do_not_overlap(void **state) {
    (void)state;
    fixture *f = make();
    for (int i = 0; i < 40; i++) {
        add_image(f, 1 + (i * 97) % 300, 1 + (i * 61) % 260);
        add_material(f, i, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT);
    }
    pack(f);
    assert_int_equal(f->a.texel_count, f->a.width * f->a.height);
    uint8_t *taken = calloc(f->a.texel_count, 1);
    assert_non_null(taken);
    uint64_t texels = 0;
    for (uint32_t i = 0; i < f->a.mip_count; i++) {
        const vit_mip *mip = f->a.mips + i;
        const uint32_t column = mip->offset % mip->pitch;
        assert_int_equal(mip->pitch, f->a.width);
        assert_true(column >= 1 && column + mip->width < mip->pitch); /* a row with its gutter does not wrap */
        for (int64_t y = -1; y <= (int64_t)mip->height; y++)
            for (int64_t x = -1; x <= (int64_t)mip->width; x++, texels++) {
                const int64_t at = (int64_t)mip->offset + y * mip->pitch + x;
                assert_true(at >= 0 && at < (int64_t)f->a.texel_count);
                assert_false(taken[at]);
                taken[at] = 1;
            }
    }
    assert_true(fabs(f->a.occupancy - (double)texels / f->a.texel_count) < 1e-12);
    assert_true(f->a.occupancy > 0.85);
    free(taken);
    drop(f);
}

static void power_of_two_images_waste_little_in_spite_of_their_gutters(void **state) {
    (void)state;
    fixture *f = make();
    for (int i = 0; i < 6; i++) {
        add_image(f, 512, 512);
        add_material(f, i, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT);
    }
    pack(f);
    assert_true(f->a.occupancy > 0.85);
    drop(f);
}

static void textures_that_no_sheet_can_hold_are_bad_input(void **state) {
    (void)state;
    fixture *f = make();
    for (int i = 0; i < 7; i++) { /* 7 * 16386^2 * 4/3 > 2^31; their texels are never looked at */
        f->images[i].width = f->images[i].height = 16384;
        add_material(f, i, VIT_WRAP_REPEAT, VIT_WRAP_REPEAT);
    }
    f->m.image_count = 7;
    vit_text why = {""};
    assert_int_equal(atlas_pack(&f->m, &f->a, &why), VIT_BAD_INPUT);
    assert_non_null(strstr(why.text, "7 with"));
    assert_null(f->a.textures);
    drop(f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_model_without_textures_has_an_empty_atlas),
        cmocka_unit_test(texels_are_square_roots_of_linear_light_in_ten_bits),
        cmocka_unit_test(a_mip_gutter_continues_a_repeating_image_with_the_opposite_edge),
        cmocka_unit_test(a_mip_gutter_continues_a_clamped_or_mirrored_image_with_the_same_edge),
        cmocka_unit_test(the_corners_of_a_gutter_follow_both_wrap_modes),
        cmocka_unit_test(mips_halve_down_to_one_texel),
        cmocka_unit_test(black_and_white_mix_in_linear_light),
        cmocka_unit_test(a_plain_image_of_any_size_is_plain_on_every_level),
        cmocka_unit_test(odd_sizes_are_weighted_by_the_area_that_is_covered),
        cmocka_unit_test(the_colour_of_transparent_texels_does_not_bleed_into_a_cut_out),
        cmocka_unit_test(an_opaque_material_keeps_the_colour_whatever_the_alpha),
        cmocka_unit_test(the_verdict_is_that_of_alpha_times_factor_against_the_cutoff),
        cmocka_unit_test(mips_of_a_cut_out_keep_about_its_coverage),
        cmocka_unit_test(each_combination_of_image_wrap_and_cutoff_is_packed_once),
        cmocka_unit_test(levels_and_gutters_do_not_overlap),
        cmocka_unit_test(power_of_two_images_waste_little_in_spite_of_their_gutters),
        cmocka_unit_test(textures_that_no_sheet_can_hold_are_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
