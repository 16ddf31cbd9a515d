/* What turns a pack round on a big-endian machine, on this little-endian one. That packs play there is tests/matrix.sh's row
 * s390x.
 *
 * Strategy: a wrong or a missing swap shows against bytes reversed one by one, and twice is the identity. That one word size
 * covers every record is read from the text of the kernels' headers, since C cannot list a struct's fields. */
#include "byte_order.h"
#include "pack_image.h"

#include <string.h>

static void reverse(unsigned char *bytes, size_t at, size_t size) {
    for (size_t i = 0; i < size / 2; i++) {
        const unsigned char kept = bytes[at + i];
        bytes[at + i] = bytes[at + size - 1 - i];
        bytes[at + size - 1 - i] = kept;
    }
}

static void number(unsigned char *bytes, size_t size) {
    for (size_t i = 0; i < size; i++)
        bytes[i] = (unsigned char)(i * 37 + (i >> 8));
}

static void a_swap_reverses_the_bytes_of_each_word(void **state) {
    (void)state;
    unsigned char from[241], to[241], want[240];
    for (size_t word = 2; word <= 8; word *= 2)
        for (size_t shift = 0; shift < 2; shift++) { /* words need not be aligned */
            number(from, sizeof from);
            memcpy(want, from + shift, sizeof want);
            for (size_t at = 0; at < sizeof want; at += word)
                reverse(want, at, word);
            assert_ptr_equal(vit_swap_words(to + shift, from + shift, sizeof want, word), to + shift);
            assert_memory_equal(to + shift, want, sizeof want);
            vit_swap_words(from + shift, from + shift, sizeof want, word); /* in place */
            assert_memory_equal(from + shift, want, sizeof want);
        }
}

static void header_and_entry_keep_their_characters_and_swap_their_numbers(void **state) {
    (void)state;
    unsigned char header[64], entry[32], out[64]; /* as vitrine_pack.h draws them */
    vit_pack_header h, swapped_header;
    vit_pack_entry e, swapped_entry;
    number(header, sizeof header);
    number(entry, sizeof entry);
    memcpy(&h, header, sizeof h);
    memcpy(&e, entry, sizeof e);
    memcpy(out, vit_swap_header(&swapped_header, &h), sizeof h);
    reverse(header, 8, 4);
    reverse(header, 12, 4);
    reverse(header, 16, 8);
    reverse(header, 24, 8);
    assert_memory_equal(out, header, sizeof header);
    memcpy(out, vit_swap_entry(&swapped_entry, &e), sizeof e);
    reverse(entry, 4, 4);
    reverse(entry, 8, 8);
    reverse(entry, 16, 8);
    reverse(entry, 24, 8);
    assert_memory_equal(out, entry, sizeof entry);
}

static void a_pack_swapped_twice_is_the_pack(void **state) {
    (void)state;
    for (fixture_kind kind = 0; kind < FIXTURE_KINDS; kind++) {
        image im = valid_image_of(kind), kept = valid_image_of(kind);
        for (int times = 1; times <= 2; times++) {
            for (int i = 0; i < VIT_SECTION_COUNT; i++) {
                const vit_pack_entry e = kept.table[i];
                vit_swap_words((char *)im.bytes + e.offset, (char *)im.bytes + e.offset, (size_t)e.size, VIT_WORD);
                vit_swap_entry(&im.table[i], &im.table[i]);
            }
            vit_swap_header(im.header, im.header);
            assert_int_equal(memcmp(im.bytes, kept.bytes, im.size) == 0, times == 2);
        }
        free(im.bytes);
        free(kept.bytes);
    }
}

static void the_one_field_of_two_words_comes_out_whole(void **state) {
    (void)state;
    vit_scene s = {.width = 0x01020304, .effects = 0x1112131415161718u}, t;
    vit_swap_words(&t, &s, sizeof s, VIT_WORD);
    vit_swap_scene(&t);
    assert_int_equal(t.width, 0x04030201);
    assert_true(t.effects == 0x1817161514131211u);
}

/* Declarations between "typedef struct" and "}" must begin with a type of 32 bits; one may take several lines. */
static void expect_words(const char *path, int *records, int *fields) {
    static const char *const types[] = {"vit_u32", "vit_i32", "float"};
    char line[512], type[64];
    int inside = 0, comment = 0, goes_on = 0;
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    while (fgets(line, sizeof line, f)) {
        const int skip = comment || sscanf(line, " %60[/*]", type) == 1; /* a comment of its own lines */
        comment = (comment || strstr(line, "/*")) && !strstr(line, "*/");
        if (line[0] == '}')
            inside = 0;
        if (inside && !skip && sscanf(line, " %63[A-Za-z0-9_]", type) == 1) {
            const int begins = !goes_on;
            goes_on = strchr(line, ';') == NULL;
            if (!begins || strstr(line, "vit_u64 effects;")) /* of two words: vit_swap_scene() puts it right */
                continue;
            if (strcmp(type, types[0]) != 0 && strcmp(type, types[1]) != 0 && strcmp(type, types[2]) != 0)
                fail_msg("a record has a field of type %s", type);
            ++*fields;
        }
        if (strncmp(line, "typedef struct", 14) == 0) {
            inside = 1;
            ++*records;
        }
    }
    (void)fclose(f);
}

static void every_field_of_every_record_is_a_word(void **state) {
    (void)state;
    int records = 0, fields = 0, codes = 0, cells = 0;
    assert_true(sizeof(vit_u32) == VIT_WORD && sizeof(vit_i32) == VIT_WORD && sizeof(float) == VIT_WORD);
    expect_words("kernels/records.clh", &records, &fields);
    expect_words("kernels/transfer_code.clh", &codes, &fields);
    assert_int_equal(codes, 1);
    expect_words("kernels/cache_cell.clh", &cells, &fields);
    assert_int_equal(cells, 1);
    assert_true(records >= 12 && fields > 60);
#define X(code, type, records) assert_int_equal(sizeof(type) % VIT_WORD, 0);
    VIT_SECTIONS(X)
#undef X
}

static void a_hash_of_swapped_words_is_the_hash_of_what_was_swapped(void **state) {
    (void)state;
    static const size_t sizes[] = {0, 8, 240, 248, 1016, 1024, 1032, 4096, 5000};
    static unsigned char from[5000], swapped[5000];
    number(from, sizeof from);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        for (size_t word = 2; word <= 8; word *= 2) {
            vit_swap_words(swapped, from, sizes[i], word);
            assert_true(vit_hash_swapped(from, sizes[i], word) == vit_hash(swapped, sizes[i]));
        }
}

static void a_little_endian_machine_looks_at_what_lies_there(void **state) {
    (void)state;
    static const vit_cell cells[3];
    const vit_cell *second = VIT_RECORD(vit_cell, cells, 1);
    assert_ptr_equal(second, &cells[1]);
#define X(name, word, bytes, word_bytes, meaning)                                                                              \
    assert_true(vit_hash_frame("0123456789abcdef", VIT_FORMAT_##name, 16) == vit_hash("0123456789abcdef", 16));
    VIT_FORMATS(X)
#undef X
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_swap_reverses_the_bytes_of_each_word),
        cmocka_unit_test(header_and_entry_keep_their_characters_and_swap_their_numbers),
        cmocka_unit_test(a_pack_swapped_twice_is_the_pack),
        cmocka_unit_test(the_one_field_of_two_words_comes_out_whole),
        cmocka_unit_test(every_field_of_every_record_is_a_word),
        cmocka_unit_test(a_hash_of_swapped_words_is_the_hash_of_what_was_swapped),
        cmocka_unit_test(a_little_endian_machine_looks_at_what_lies_there),
    };
    return cmocka_run_group_tests_name("byte order", tests, NULL, NULL);
}
