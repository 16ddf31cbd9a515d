/* The pack: writer and loader together, on valid packs of each kind, which have every section between them, and on plain damage
 * (cut files, flipped bits), which must always be refused. Damage behind right hashes is test_pack_forged.c's,
 * test_pack_forged_basis.c's, test_pack_forged_live.c's, test_pack_forged_lightmap.c's and test_pack_forged_cache.c's. */
#include "pack_image.h"

#include <float.h>
#include <stdbool.h>

/* XXH3-64 of the fixtures' packs in format version 12. If this test fails, files of users fail too: raise VIT_PACK_VERSION,
 * and put the new hashes here. */
static const uint64_t golden_hashes[FIXTURE_KINDS] = {0xb8540195daf11a98u, 0x7e1eafb5a242ff43u, 0x86a8c4caefa75cc1u,
                                                      0xf31dd9a3c63561deu, 0xc4b859830f50083bu};

#define EACH_KIND(kind) for (fixture_kind kind = 0; kind < FIXTURE_KINDS; kind++)

static void a_valid_pack_is_accepted_and_its_sections_are_found_in_place(void **state) {
    (void)state;
    EACH_KIND(kind) {
        image im = valid_image_of(kind);
        vit_pack pack;
        vit_text why = {""};
        vit_status status = vit_pack_read(im.bytes, im.size, &pack, &why);
        assert_string_equal(why.text, "");
        assert_int_equal(status, VIT_OK);
        assert_ptr_equal(pack.scene, im.scene);
        for (int i = 0; i < VIT_SECTION_COUNT; i++) {
            assert_ptr_equal(pack.section[i], im.table[i].size > 0 ? section(&im, i) : NULL);
            assert_int_equal(pack.bytes[i], im.table[i].size);
        }
        free(im.bytes);
    }
}

static void the_fixtures_have_every_section_between_them(void **state) {
    (void)state;
    bool there[VIT_SECTION_COUNT] = {false};
    EACH_KIND(kind) {
        image im = valid_image_of(kind);
        for (int i = 0; i < VIT_SECTION_COUNT; i++)
            there[i] = there[i] || im.table[i].size > 0;
        free(im.bytes);
    }
    for (int i = 0; i < VIT_SECTION_COUNT; i++)
        assert_true(there[i]);
}

static void the_bytes_that_were_written_are_the_bytes_that_are_read(void **state) {
    (void)state;
    EACH_KIND(kind) {
        pack_fixture f;
        fixture_make_kind(&f, kind);
        image im = image_of(&f);
        vit_pack pack;
        vit_text why = {""};
        assert_int_equal(vit_pack_read(im.bytes, im.size, &pack, &why), VIT_OK);
        const pack_sections written = fixture_sections(&f);
        for (int i = 0; i < VIT_SECTION_COUNT; i++)
            if (pack.bytes[i] > 0)
                assert_memory_equal(pack.section[i], written.data[i], pack.bytes[i]);
        const bool has_basis = kind == FIXTURE_BASIS || kind == FIXTURE_POINT_CELLS;
        assert_int_equal(pack.bytes[VIT_SECTION_BVHN], 5 * sizeof(vit_bvh_node));
        assert_int_equal(pack.bytes[VIT_SECTION_BGRP], has_basis ? 4 * sizeof(vit_basis_group) : 0);
        assert_int_equal(pack.bytes[VIT_SECTION_BFRM], has_basis ? 4 * sizeof(vit_basis_frame) : 0);
        free(im.bytes);
    }
}

static void assembling_twice_gives_the_same_bytes(void **state) {
    (void)state;
    EACH_KIND(kind) {
        image a = valid_image_of(kind), b = valid_image_of(kind);
        assert_int_equal(a.size, b.size);
        assert_memory_equal(a.bytes, b.bytes, a.size);
        free(a.bytes);
        free(b.bytes);
    }
}

static void the_format_has_not_changed_without_a_new_version(void **state) {
    (void)state;
    assert_int_equal(VIT_PACK_VERSION, 12);
    EACH_KIND(kind) {
        image im = valid_image_of(kind);
        uint64_t hash = vit_hash(im.bytes, im.size);
        if (hash != golden_hashes[kind])
            fail_msg("the pack of fixture %d hashes to 0x%016llx", (int)kind, (unsigned long long)hash);
        free(im.bytes);
    }
}

static void the_hash_is_xxh3_64(void **state) {
    (void)state;
    assert_true(vit_hash("", 0) == 0x2d06800538d394c2u); /* the test vector of the XXH3 specification */
}

static void empty_sections_are_accepted_and_have_no_address(void **state) {
    (void)state;
    pack_fixture f;
    fixture_make(&f);
    f.scene.lights = f.scene.paths = f.scene.baked = f.scene.textures = f.scene.mips = f.scene.texels = f.scene.cells =
        f.scene.area_samples = f.scene.sky_samples = f.scene.sky_size = f.scene.chain = 0;
    f.scene.copies = 1;
    f.scene.effects = 0;
    f.materials[1].texture = VIT_NONE;
    assert_int_equal(vit_pack_derive(&f.scene, NULL), VIT_OK);
    image im = image_of(&f);
    vit_pack pack;
    vit_text why = {""};
    vit_status status = vit_pack_read(im.bytes, im.size, &pack, &why);
    assert_string_equal(why.text, "");
    assert_int_equal(status, VIT_OK);
    assert_null(pack.section[VIT_SECTION_LITE]);
    assert_null(pack.section[VIT_SECTION_SIDE]);
    assert_null(pack.section[VIT_SECTION_CELL]);
    assert_null(pack.section[VIT_SECTION_PHOT]);
    assert_int_equal(pack.bytes[VIT_SECTION_ATLS], 0);
    free(im.bytes);
}

static vit_status read_fixture(const pack_fixture *f, vit_text *why) {
    image im = image_of(f);
    vit_status status = read_image(&im, why);
    free(im.bytes);
    return status;
}

static void a_tree_may_be_63_nodes_deep_but_not_64(void **state) {
    (void)state;
    pack_fixture f;
    vit_text why;
    fixture_make_chain(&f, VIT_BVH_STACK - 1);
    assert_int_equal(read_fixture(&f, &why), VIT_OK);
    fixture_make_chain(&f, VIT_BVH_STACK);
    assert_refused(read_fixture(&f, &why), &why, "BVHN", "deeper");
    fixture_make_chain(&f, FIXTURE_TRIANGLES - 1);
    assert_refused(read_fixture(&f, &why), &why, "BVHN", "deeper");
}

static void make_single_leaf(pack_fixture *f) {
    fixture_make_chain(f, 1);
    f->scene.triangles = 1;
    for (int k = 0; k < 3; k++) {
        f->nodes[0].lo1[k] = FLT_MAX;
        f->nodes[0].hi1[k] = -FLT_MAX;
    }
    f->nodes[0].child1 = VIT_LEAF_BIT;
}

static void a_tree_of_one_leaf_may_lack_its_second_child_but_not_its_first(void **state) {
    (void)state;
    pack_fixture f;
    vit_text why;
    make_single_leaf(&f);
    assert_int_equal(read_fixture(&f, &why), VIT_OK);
    f.nodes[0].child1 = VIT_LEAF_BIT | 1; /* not even a missing child may point beyond the triangles */
    assert_refused(read_fixture(&f, &why), &why, "BVHN", "leaf of triangles 1..1 of 1");
    make_single_leaf(&f);
    for (int k = 0; k < 3; k++) {
        f.nodes[0].lo0[k] = FLT_MAX;
        f.nodes[0].hi0[k] = -FLT_MAX;
    }
    assert_refused(read_fixture(&f, &why), &why, "BVHN", "child 0 is not finite or inside out");
}

static image cut(const image *im, size_t size) {
    image c = *im;
    c.bytes = malloc(size ? size : 1);
    assert_non_null(c.bytes);
    memcpy(c.bytes, im->bytes, size);
    c.size = size;
    c.header = c.bytes;
    c.table = (vit_pack_entry *)(c.header + 1);
    return c;
}

static void refuses_cuts_of_every_section(fixture_kind kind) {
    image im = valid_image_of(kind);
    vit_text why;
    for (int i = 0; i < VIT_SECTION_COUNT; i++) {
        const vit_pack_entry e = im.table[i];
        if (e.size == 0)
            continue;
        const char code[5] = {e.code[0], e.code[1], e.code[2], e.code[3], 0};
        const size_t sizes[] = {(size_t)e.offset, (size_t)(e.offset + e.size / 2), (size_t)(e.offset + e.size - 1)};
        for (int k = 0; k < 3; k++) {
            image c = cut(&im, sizes[k]);
            assert_refused(read_image(&c, &why), &why, "header", "the file");
            c.header->size = c.size; /* forged: now the section that is cut names itself */
            forge(&c);
            assert_refused(read_image(&c, &why), &why, code, "runs beyond the end");
            free(c.bytes);
        }
    }
    free(im.bytes);
}

static void a_file_cut_at_or_inside_any_section_is_refused(void **state) {
    (void)state;
    EACH_KIND(kind) refuses_cuts_of_every_section(kind);
}

static void a_file_cut_inside_header_or_table_is_refused(void **state) {
    (void)state;
    image im = valid_image();
    vit_text why;
    const size_t table_end = sizeof *im.header + VIT_SECTION_COUNT * sizeof *im.table;
    for (size_t size = 0; size < table_end; size++) {
        image c = cut(&im, size);
        if (size >= sizeof *c.header)
            c.header->size = size;
        assert_refused(read_image(&c, &why), &why, "header", "the file");
        free(c.bytes);
    }
    free(im.bytes);
}

static void a_file_with_bytes_behind_its_end_is_refused(void **state) {
    (void)state;
    image im = valid_image();
    image longer = {.size = im.size + 8, .bytes = calloc(1, im.size + 8)};
    assert_non_null(longer.bytes);
    memcpy(longer.bytes, im.bytes, im.size);
    vit_text why;
    assert_refused(read_image(&longer, &why), &why, "header", "the file");
    ((vit_pack_header *)longer.bytes)->size = longer.size;
    assert_refused(read_image(&longer, &why), &why, "header", "8 bytes follow the last section");
    free(im.bytes);
    free(longer.bytes);
}

static void notices_each_flip(fixture_kind kind) {
    image im = valid_image_of(kind);
    unsigned char *bytes = im.bytes;
    vit_text why;
    const size_t table_end = sizeof *im.header + VIT_SECTION_COUNT * sizeof *im.table;
    for (size_t i = 0; i < im.size; i += i < table_end ? 1 : 11)
        for (int bit = 0; bit < 8; bit += i < table_end ? 1 : 7) {
            bytes[i] ^= (unsigned char)(1 << bit);
            if (read_image(&im, &why) != VIT_BAD_INPUT)
                fail_msg("bit %d of byte %zu", bit, i);
            assert_one_line(&why);
            bytes[i] ^= (unsigned char)(1 << bit);
        }
    for (int i = 0; i < VIT_SECTION_COUNT; i++) { /* and the section is named */
        char code[5] = {0};
        if (im.table[i].size == 0)
            continue;
        memcpy(code, im.table[i].code, 4);
        bytes[im.table[i].offset + im.table[i].size - 1] ^= 1;
        assert_refused(read_image(&im, &why), &why, code, "hash");
        bytes[im.table[i].offset + im.table[i].size - 1] ^= 1;
    }
    assert_int_equal(read_image(&im, &why), VIT_OK);
    free(im.bytes);
}

static void no_bit_can_flip_unnoticed(void **state) {
    (void)state;
    EACH_KIND(kind) notices_each_flip(kind);
}

static void a_pack_that_is_not_aligned_in_memory_is_refused(void **state) {
    (void)state;
    image im = valid_image();
    char *copy = malloc(im.size + 4);
    assert_non_null(copy);
    memcpy(copy + 4, im.bytes, im.size);
    image shifted = {.bytes = copy + 4, .size = im.size}, none = {.bytes = NULL, .size = im.size};
    vit_text why;
    assert_refused(read_image(&shifted, &why), &why, "header", "aligned");
    assert_refused(read_image(&none, &why), &why, "header", "in memory");
    free(copy);
    free(im.bytes);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_valid_pack_is_accepted_and_its_sections_are_found_in_place),
        cmocka_unit_test(the_fixtures_have_every_section_between_them),
        cmocka_unit_test(the_bytes_that_were_written_are_the_bytes_that_are_read),
        cmocka_unit_test(assembling_twice_gives_the_same_bytes),
        cmocka_unit_test(the_format_has_not_changed_without_a_new_version),
        cmocka_unit_test(the_hash_is_xxh3_64),
        cmocka_unit_test(empty_sections_are_accepted_and_have_no_address),
        cmocka_unit_test(a_tree_may_be_63_nodes_deep_but_not_64),
        cmocka_unit_test(a_tree_of_one_leaf_may_lack_its_second_child_but_not_its_first),
        cmocka_unit_test(a_file_cut_at_or_inside_any_section_is_refused),
        cmocka_unit_test(a_file_cut_inside_header_or_table_is_refused),
        cmocka_unit_test(a_file_with_bytes_behind_its_end_is_refused),
        cmocka_unit_test(no_bit_can_flip_unnoticed),
        cmocka_unit_test(a_pack_that_is_not_aligned_in_memory_is_refused),
    };
    return cmocka_run_group_tests_name("pack", tests, NULL, NULL);
}
