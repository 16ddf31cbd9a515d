/* Work counters of live radiosity: exact, and equal at any width, as test_work_counts.c has it of photons. What receivers see
 * is counted again from the pack, shadow rays from its points and lights. */
#include "counted_work.h"

static const vit_open_info on_host = {.device = VIT_DEVICE_HOST};

static void counts_of_live_radiosity_are_the_same_for_any_lanes(void **state) {
    (void)state;
    static const char *const names[] = {"live", "live-33x47", "live-shine"};
    assert_same_counts_for_any_lanes(names, sizeof names / sizeof names[0]);
}

/* Of frame 1: receivers that it looks up, columns that these see, and words that say so. */
typedef struct looked {
    uint64_t receivers, columns, words;
} looked;

static looked look(const counted *c) {
    const vit_pack *p = &c->p.v->pack;
    const vit_scene *s = c->scene;
    const vit_gather_row *rows = p->section[VIT_SECTION_GROW];
    const vit_u32 *bits = (const vit_u32 *)p->section[VIT_SECTION_LOOK] + (size_t)(1 / s->looked_frames) * (s->receivers / 32);
    looked l = {0};
    for (uint32_t r = 0; r < s->receivers; r++) {
        if (!(bits[r / 32] >> r % 32 & 1))
            continue;
        l.receivers++;
        l.columns += rows[r].ones + rows[r].weighted;
        l.words += rows[r].ones / 2 + rows[r].ones % 2 + rows[r].weighted;
    }
    return l;
}

static void evaluations_are_what_receivers_see(void **state) {
    (void)state;
    static const char *const names[] = {"live", "live-once", "live-33x47", "live-shine"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        counted *c = count_frame(names[i], on_host);
        const looked l = look(c);
        assert_true(l.columns > 0);
        assert_int_equal(WORK(&c->s, gather_patches, evaluations), l.columns);
        /* The rest are the cache's, of ambient light with a radius. */
        assert_int_equal(total(&c->s, VIT_WORK_evaluations) - WORK(&c->s, ambient_light, evaluations), l.columns);
        drop(c);
    }
}

/* A ray from each point that faces the light, of a lamp in the middle of a room: the room's are all but those that furniture
 * turns away. */
static void points_send_one_shadow_ray_at_most_to_each_light_that_is_live(void **state) {
    (void)state;
    static const char *const names[] = {"live", "live-33x47", "live-shine"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        counted *c = count_frame(names[i], on_host);
        const uint64_t rays = WORK(&c->s, patch_light, shadow_rays), lights = (uint64_t)__builtin_popcount(c->scene->live[0]);
        assert_true(lights > 0 && lights <= c->scene->lights);
        assert_in_range(rays, c->scene->patch_points / 8, c->scene->patch_points * lights);
        drop(c);
    }
}

static void bytes_of_live_radiosity_are_sizes_times_counts(void **state) {
    (void)state;
    counted *c = count_frame("live", on_host);
    const vit_scene *s = c->scene;
    const uint64_t points = s->patch_points, stride = VIT_PATCH_STRIDE(s), words = (uint64_t)s->transfer_words * 4,
                   right = (uint64_t)s->transfer_rank / 2 * stride * 4 + stride * 4,
                   mix = (uint64_t)s->transfer_rank * s->transfer_rank * 12;
    assert_int_equal(WORK(&c->s, patch_light, bytes), points * (64 + 16) + s->lights * sizeof(vit_light));
    assert_int_equal(WORK(&c->s, patch_mean, bytes), s->patches * 16 + points * 20 + stride * 16);
    assert_int_equal(WORK(&c->s, transfer_project, bytes) - right - stride * 16, pack_buffer_bytes(&c->p, "projected"));
    assert_int_equal(WORK(&c->s, transfer_mix, bytes) - mix,
                     pack_buffer_bytes(&c->p, "projected") + pack_buffer_bytes(&c->p, "mixed"));
    assert_int_equal(WORK(&c->s, transfer_partial, bytes),
                     words - right - mix + stride * 16 + pack_buffer_bytes(&c->p, "mixed") + pack_buffer_bytes(&c->p, "sums"));
    assert_int_equal(WORK(&c->s, transfer_sum, bytes),
                     pack_buffer_bytes(&c->p, "sums") + pack_buffer_bytes(&c->p, "reflected"));
    assert_int_equal(WORK(&c->s, patch_reflect, bytes),
                     pack_buffer_bytes(&c->p, "reflected") + 2 * pack_buffer_bytes(&c->p, "radiosity") + points * 16);
    const looked l = look(c);
    assert_int_equal(WORK(&c->s, gather_patches, bytes), s->receivers / 8 +
                                                             l.receivers * (sizeof(vit_gather_row) + sizeof(vit_receiver)) +
                                                             pack_buffer_bytes(&c->p, "relit") + l.words * 4 + l.columns * 16);
    drop(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_of_live_radiosity_are_the_same_for_any_lanes),
        cmocka_unit_test(evaluations_are_what_receivers_see),
        cmocka_unit_test(points_send_one_shadow_ray_at_most_to_each_light_that_is_live),
        cmocka_unit_test(bytes_of_live_radiosity_are_sizes_times_counts),
    };
    return cmocka_run_group_tests_name("work counts of live radiosity", tests, NULL, NULL);
}
