/* Live radiosity finds light of receivers that the frame looks up alone. Why this is hard: what is left out must be what nobody
 * asks for, and a frame that asked would still look right in most of its pixels. Strategy: the pack's hashes were made with all
 * receivers; frames in any order have them; a pack whose sets have all receivers has the same; take one receiver away, and a
 * frame is another. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <stdbool.h>

#include "counted_work.h"
#include "pack_sections.h"

static const char *const names[] = {"live", "live-once", "live-33x47", "live-shine"};
enum { NAMES = sizeof names / sizeof names[0] };

typedef void look_edit(vit_u32 *looked_up, const vit_scene *s);

/* The pack with other sets, on the device `host`; the relit buffer and all else as frames leave them. */
static void open_with(open_pack *p, const char *name, look_edit *edit) {
    vit_text why = {""};
    size_t size;
    void *old = read_file(test_pack(name), &size), *bytes = NULL;
    pack_sections sections = pack_sections_of(old);
    const vit_scene *s = sections.data[VIT_SECTION_META];
    const size_t words = (size_t)VIT_LOOKED_SETS(s) * (s->receivers / 32);
    vit_u32 *looked_up = malloc(words * sizeof *looked_up);
    assert_non_null(looked_up);
    memcpy(looked_up, sections.data[VIT_SECTION_LOOK], words * sizeof *looked_up);
    edit(looked_up, s);
    sections.data[VIT_SECTION_LOOK] = looked_up;
    if (pack_assemble(&sections, &bytes, &size, &why) != VIT_OK)
        fail_msg("%s", why.text);
    free(looked_up);
    free(old);
    pack_open_bytes(p, bytes, size, (vit_open_info){.device = VIT_DEVICE_HOST});
}

static void look_at_all(vit_u32 *looked_up, const vit_scene *s) {
    memset(looked_up, 0xff, (size_t)VIT_LOOKED_SETS(s) * (s->receivers / 32) * sizeof *looked_up);
}

static void frames_have_their_bits_in_any_order(void **state) {
    (void)state;
    for (size_t i = 0; i < NAMES; i++) {
        open_pack p;
        pack_open(&p, names[i], (vit_open_info){.device = VIT_DEVICE_HOST});
        for (uint32_t k = 2 * p.need.frames; k-- > 0;)
            assert_int_equal(pack_frame_hash(&p, k % p.need.frames), vit_golden(p.v, k % p.need.frames));
        pack_close(&p);
    }
}

static void looking_at_all_gives_the_same_bits(void **state) {
    (void)state;
    for (size_t i = 0; i < NAMES; i++) {
        open_pack p;
        open_with(&p, names[i], look_at_all);
        for (uint32_t k = 0; k < p.need.frames; k++)
            assert_int_equal(pack_frame_hash(&p, k), vit_golden(p.v, k));
        pack_close(&p);
    }
}

/* Those alone have light. */
static void receivers_that_no_sample_looks_up_are_left_out(void **state) {
    (void)state;
    for (size_t i = 0; i < NAMES; i++) {
        counted *c = count_frame(names[i], (vit_open_info){.device = VIT_DEVICE_HOST});
        const vit_scene *s = c->scene;
        const uint32_t set = 1 / s->looked_frames, words = s->receivers / 32;
        const vit_u32 *looked_up = (const vit_u32 *)c->p.v->pack.section[VIT_SECTION_LOOK] + (size_t)set * words;
        float *relit = read_buffer(&c->p, B_relit);
        uint32_t in = 0;
        for (uint32_t r = 0; r < s->receivers; r++) {
            const bool is_in = looked_up[r / 32] >> r % 32 & 1;
            in += is_in;
            for (uint32_t k = 0; k < 4; k++)
                assert_true(is_in || relit[4 * r + k] == 0.0f);
        }
        assert_in_range(in, 1, s->receivers);
        free(relit);
        drop(c);
    }
}

static vit_u32 taken; /* word of the receivers that are taken away */

static void look_at_fewer(vit_u32 *looked_up, const vit_scene *s) {
    for (uint32_t i = 0; i < VIT_LOOKED_SETS(s); i++)
        looked_up[i * (s->receivers / 32) + taken] = 0;
}

static void every_word_of_a_set_counts(void **state) {
    (void)state;
    open_pack all;
    pack_open(&all, "live", (vit_open_info){.device = VIT_DEVICE_HOST});
    const vit_scene *s = all.v->pack.scene;
    const vit_u32 *looked_up = all.v->pack.section[VIT_SECTION_LOOK];
    uint32_t tried = 0, changed = 0;
    for (taken = 0; taken < s->receivers / 32 && tried < 12; taken++) {
        open_pack p;
        if (!looked_up[taken])
            continue;
        open_with(&p, "live", look_at_fewer);
        uint32_t others = 0;
        for (uint32_t f = 0; f < p.need.frames; f++)
            others += pack_frame_hash(&p, f) != vit_golden(p.v, f);
        changed += others > 0;
        tried++;
        pack_close(&p);
    }
    pack_close(&all);
    assert_in_range(tried, 3, 12);
    assert_int_equal(changed, tried);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_have_their_bits_in_any_order),
        cmocka_unit_test(looking_at_all_gives_the_same_bits),
        cmocka_unit_test(receivers_that_no_sample_looks_up_are_left_out),
        cmocka_unit_test(every_word_of_a_set_counts),
    };
    return cmocka_run_group_tests_name("receivers that frames look up", tests, NULL, NULL);
}
