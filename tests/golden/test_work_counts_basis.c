/* Work counters of baked irradiance: exact, and equal at any width, as test_work_counts.c has it of photons. Evaluations are
 * worked out again from the pack's ranks. */
#include "counted_work.h"

static const vit_open_info on_host = {.device = VIT_DEVICE_HOST};

static void counts_of_baked_irradiance_are_the_same_for_any_lanes(void **state) {
    (void)state;
    static const char *const names[] = {"basis", "basis-33x47", "basis-shine"};
    assert_same_counts_for_any_lanes(names, sizeof names / sizeof names[0]);
}

/* Numbers of all vectors of a frame, a light and a receiver each. */
static uint64_t numbers_of_vectors(const counted *c) {
    const vit_basis_group *groups = c->p.v->pack.section[VIT_SECTION_BGRP];
    uint64_t sum = 0;
    for (uint32_t i = 0; i < c->scene->receivers / VIT_BASIS_GROUP * c->scene->basis_lights; i++)
        sum += (uint64_t)groups[i].rank * VIT_BASIS_GROUP;
    return sum;
}

static void evaluations_of_a_basis_are_the_numbers_of_its_vectors(void **state) {
    (void)state;
    static const char *const names[] = {"basis", "basis-33x47", "basis-shine", "basis-still"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        counted *c = count_frame(names[i], on_host);
        assert_int_equal(WORK(&c->s, relight, evaluations), numbers_of_vectors(c));
        assert_int_equal(numbers_of_vectors(c) > 0, i < 3);
        assert_int_equal(total(&c->s, VIT_WORK_evaluations) - WORK(&c->s, ambient_light, evaluations), numbers_of_vectors(c));
        drop(c);
    }
}

/* Each number of a vector has two bytes. A hit's sample looks up side, cell and three receivers, and its light is written. */
static void bytes_of_a_basis_are_sizes_times_counts(void **state) {
    (void)state;
    counted *c = count_frame("basis", on_host);
    assert_int_equal(WORK(&c->s, relight, bytes), pack_buffer_bytes(&c->p, "receivers") + pack_buffer_bytes(&c->p, "relit") +
                                                      pack_buffer_bytes(&c->p, "basis_groups") +
                                                      pack_buffer_bytes(&c->p, "basis_frames") / c->scene->frames +
                                                      numbers_of_vectors(c) * 2);
    assert_int_equal(WORK(&c->s, samples, bytes),
                     pack_buffer_bytes(&c->p, "hit_triangle") + pack_buffer_bytes(&c->p, "hit_distance") +
                         pack_buffer_bytes(&c->p, "position") + pack_buffer_bytes(&c->p, "normal") +
                         pack_buffer_bytes(&c->p, "albedo") + pack_buffer_bytes(&c->p, "direct") +
                         pack_buffer_bytes(&c->p, "indirect") +
                         WORK(&c->s, samples, surface_points) * (48 + 48 + 80 + 4 + 16 + 3 * 12) +
                         WORK(&c->s, samples, texture_fetches) * 16);
    drop(c);
}

/* A point that counts has its cell's two words and three floats read; light of hits is written by a pass of its own. */
static void bytes_of_a_basis_at_points_are_sizes_times_counts(void **state) {
    (void)state;
    static const char *const names[] = {"points", "points-shine"};
    assert_same_counts_for_any_lanes(names, sizeof names / sizeof names[0]);
    counted *c = count_frame("points", on_host);
    const uint64_t points = WORK(&c->s, point_light, evaluations), hits = WORK(&c->s, samples, surface_points);
    assert_in_range(points, hits, hits * 27 * 3 * 2); /* some of 27 points, of three sides and two levels */
    assert_int_equal(WORK(&c->s, point_light, bytes),
                     pack_buffer_bytes(&c->p, "hit_triangle") + pack_buffer_bytes(&c->p, "position") +
                         pack_buffer_bytes(&c->p, "normal") + pack_buffer_bytes(&c->p, "albedo") +
                         pack_buffer_bytes(&c->p, "indirect") + points * (4 + 4 + 12));
    assert_int_equal(WORK(&c->s, samples, bytes),
                     pack_buffer_bytes(&c->p, "hit_triangle") + pack_buffer_bytes(&c->p, "hit_distance") +
                         pack_buffer_bytes(&c->p, "position") + pack_buffer_bytes(&c->p, "normal") +
                         pack_buffer_bytes(&c->p, "albedo") + pack_buffer_bytes(&c->p, "direct") + hits * (48 + 48 + 80) +
                         WORK(&c->s, samples, texture_fetches) * 16);
    drop(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_of_baked_irradiance_are_the_same_for_any_lanes),
        cmocka_unit_test(evaluations_of_a_basis_are_the_numbers_of_its_vectors),
        cmocka_unit_test(bytes_of_a_basis_are_sizes_times_counts),
        cmocka_unit_test(bytes_of_a_basis_at_points_are_sizes_times_counts),
    };
    return cmocka_run_group_tests_name("work counts of baked irradiance", tests, NULL, NULL);
}
