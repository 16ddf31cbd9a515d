/* Forged packs: what tests of them share (unit/test_pack_forged*.c). A fault is one damage to a fixture's pack, which gets
 * right hashes again; its list is X(place, name, part of the line, damage done to `im`). */
#ifndef VIT_TESTS_FORGED_PACK_H
#define VIT_TESTS_FORGED_PACK_H

#include "pack_image.h"

#define ADD(count, by) im->scene->count += by
#define EFFECTS(on, off) im->scene->effects = (im->scene->effects | (on)) & ~(vit_u64)(off)
#define BIT(name) VIT_BIT(name)
#define ENTRY(code) im->table[VIT_SECTION_##code]

/* A damage that must be refused, or that must not. */
typedef struct fault {
    fixture_kind kind;
    const char *place, *cause;
    void (*spoil)(image *im);
} fault;

static inline void a_pack_just_inside_a_limit_is_accepted(void **state) {
    const fault *f = *state;
    image im = valid_image_of(f->kind);
    f->spoil(&im);
    forge(&im);
    vit_text why;
    vit_status status = read_image(&im, &why);
    assert_string_equal(why.text, "");
    assert_int_equal(status, VIT_OK);
    free(im.bytes);
}

static inline void a_forged_pack_is_refused_for_its_own_reason(void **state) {
    const fault *f = *state;
    image im = valid_image_of(f->kind);
    f->spoil(&im);
    forge(&im);
    vit_text why;
    assert_refused(read_image(&im, &why), &why, f->place, f->cause);
    free(im.bytes);
}

/* Every word in turn; more than `least` packs are refused. */
static inline void any_word_has_any_value(fixture_kind kind, size_t least) {
    static const uint32_t values[] = {0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0x7f800000 /* inf */, 0x7fc00000 /* NaN */};
    image im = valid_image_of(kind);
    vit_text why;
    size_t refused = 0;
    for (int i = 0; i < VIT_SECTION_COUNT; i++) {
        uint32_t *words = section(&im, i);
        const size_t step = i == VIT_SECTION_BWRD ? 61 : 1; /* many, and all alike */
        for (size_t w = 0; w < im.table[i].size / 4; w += step)
            for (size_t v = 0; v < sizeof values / sizeof values[0]; v++) {
                const uint32_t before = words[w];
                words[w] = values[v];
                forge(&im);
                if (read_image(&im, &why) != VIT_OK) {
                    assert_one_line(&why);
                    refused++;
                }
                words[w] = before;
            }
    }
    assert_true(refused > least);
    forge(&im);
    assert_int_equal(read_image(&im, &why), VIT_OK);
    free(im.bytes);
}

#endif
