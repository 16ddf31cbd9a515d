/* Dark sides. Random rays decide, so the tests use scenes in which the answer is beyond doubt: closed boxes, boxes with a hole,
 * faces that touch. The front of a box's face is outside. What must never happen is a lit side that is called dark; several
 * tests are about what could lead to it: small triangles, cut-outs, lights that are somewhere for one frame only. Ways that
 * light takes through rooms, glass and mirrors: test_dark_sides_ways.c. */
#include "dark_sides_lab.h"

static void the_inside_of_a_closed_box_is_dark_and_its_outside_lit(void **state) {
    (void)state;
    fixture *f = make();
    const uint32_t room = add_box(f, ROOM, 1), box = add_box(f, (const float[]){-1, 1, -1}, (const float[]){1, 2, 1}, 4);
    add_light(f, 0, 4, 0);
    search(f, 2);
    expect(f, room, 12, VIT_SIDE_DARK_FRONT); /* nothing is outside */
    expect(f, box, 6 * 32, VIT_SIDE_DARK_BACK);
    assert_true(fabs(f->r.area - 2.0 * (400.0 + 16.0)) < 1e-3);
    assert_true(fabs(f->r.dark_front - 400.0) < 1e-3);
    assert_true(fabs(f->r.dark_back - 16.0) < 1e-3);
    assert_int_equal(f->r.dark_sides, 12 + 6 * 32);
    drop(f);
}

static void light_finds_its_way_through_a_hole(void **state) {
    (void)state;
    fixture *f = make();
    add_box(f, ROOM, 1);
    const uint32_t box = add_box(f, (const float[]){-1, 1, -1}, (const float[]){1, 2, 1}, 4);
    add_light(f, 4, 4, 4);
    const float elsewhere[9] = {3, 1, 3, 3.5f, 1, 3, 3, 1, 3.5f}; /* where one triangle of the box's 192 goes */
    memcpy(f->m.position + 9 * (size_t)(box + 40), elsewhere, sizeof elsewhere);
    search(f, 2);
    expect(f, box, 6 * 32, 0);
    drop(f);
}

static void faces_that_touch_are_dark_on_both_sides(void **state) {
    (void)state;
    fixture *f = make();
    add_box(f, ROOM, 1);
    const uint32_t left = add_box(f, (const float[]){-1, 1, -1}, (const float[]){0, 2, 1}, 3);
    const uint32_t right = add_box(f, (const float[]){0, 1, -1}, (const float[]){1, 2, 1}, 4);
    add_light(f, 0, 4, 0);
    search(f, 2);
    expect(f, left, 18, VIT_SIDE_DARK_BACK);
    expect(f, left + 18, 18, VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK); /* +x face */
    expect(f, left + 36, 72, VIT_SIDE_DARK_BACK);
    expect(f, right, 32, VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK); /* -x face */
    expect(f, right + 32, 160, VIT_SIDE_DARK_BACK);
    drop(f);
}

static void no_small_triangle_is_darkened_by_bad_luck(void **state) {
    (void)state;
    fixture *f = make();
    const uint32_t room = add_box(f, ROOM, 50); /* 30 000 triangles */
    const uint32_t dust = f->m.triangles;       /* plates of 2 mm, far fewer light rays than triangles hit one */
    for (int i = 0; i < 500; i++)
        add_plate(f, (const float[]){-4.0f + 0.016f * (float)i, 0.5f, -3.0f + 0.01f * (float)(i % 37)},
                  (const float[]){0, 0, 0.002f}, (const float[]){0.002f, 0, 0}, 1);
    add_light(f, 0, 4, 0);
    search(f, 2);
    expect(f, room, 30000, VIT_SIDE_DARK_FRONT);
    expect(f, dust, 1000, 0);
    drop(f);
}

/* Specks of 2 mm in a row, facing down. */
static uint32_t add_specks(fixture *f, int count, float y) {
    const uint32_t first = f->m.triangles;
    for (int i = 0; i < count; i++)
        add_plate(f, (const float[]){-0.3f + 0.6f * (float)i / (float)count, y, 0}, (const float[]){0.002f, 0, 0},
                  (const float[]){0, 0, 0.002f}, 1);
    return first;
}

/* In the plane of the plate, so that nothing but the light lights them. */
static void specks_that_see_the_light_alone_are_lit(void **state) {
    (void)state;
    fixture *f = make();
    add_plate(f, (const float[]){3, 3, 0}, (const float[]){1, 0, 0}, (const float[]){0, 0, 1}, 2);
    const uint32_t specks = add_specks(f, 100, 3);
    add_light(f, 0, 0, 0);
    search(f, 2);
    expect(f, specks, 200, VIT_SIDE_DARK_BACK);
    drop(f);
}

/* A plate that fills a twentieth of what the specks see is lit by a spot light that shines away from them. */
static void specks_that_see_something_lit_in_a_corner_of_their_view_are_lit(void **state) {
    (void)state;
    fixture *f = make();
    add_plate(f, (const float[]){-0.4f, 0, -0.4f}, (const float[]){0, 0, 0.8f}, (const float[]){0.8f, 0, 0}, 2);
    const uint32_t specks = add_specks(f, 100, 2);
    add_light(f, 0, 1, 0);
    f->lights[0].kind = VIT_LIGHT_SPOT;
    f->lights[0].direction[1] = -1.0f;
    f->lights[0].cos_outer = 0.9f;
    search(f, 2);
    expect(f, specks, 200, VIT_SIDE_DARK_BACK);
    drop(f);
}

/* Rays start above the surface; near a sharp edge that would be outside. */
static void the_inside_of_a_sharp_wedge_is_dark(void **state) {
    (void)state;
    fixture *f = make();
    add_box(f, ROOM, 1);
    const uint32_t wedge = f->m.triangles; /* 17 degrees at x = -1 */
    const float a[2][3] = {{-1, 1, -1}, {-1, 1, 1}}, b[2][3] = {{1, 1, -1}, {1, 1, 1}}, c[2][3] = {{1, 1.6f, -1}, {1, 1.6f, 1}};
    const float along[3] = {0, 0, 2};
    add_plate(f, a[0], (const float[]){2, 0, 0}, along, 40);
    add_plate(f, b[0], (const float[]){0, 0.6f, 0}, along, 40);
    add_plate(f, a[0], along, (const float[]){2, 0.6f, 0}, 40);
    add_triangle(f, a[0], c[0], b[0]);
    add_triangle(f, a[1], b[1], c[1]);
    add_light(f, 0, 4, 0);
    search(f, 2);
    expect(f, wedge, f->m.triangles - wedge, VIT_SIDE_DARK_BACK);
    drop(f);
}

static void light_passes_the_holes_of_a_cut_out(void **state) {
    (void)state;
    fixture *f = make();
    add_box(f, ROOM, 1);
    const uint32_t outer = add_box(f, (const float[]){-1, 1, -1}, (const float[]){1, 2, 1}, 2);
    const uint32_t inner = add_box(f, (const float[]){-0.5f, 1.2f, -0.5f}, (const float[]){0.5f, 1.8f, 0.5f}, 2);
    for (uint32_t i = outer; i < inner; i++)
        f->m.material[i] = 1;
    add_light(f, 0, 4, 0);
    search(f, 2);
    expect(f, outer, inner - outer, 0);
    expect(f, inner, f->m.triangles - inner, VIT_SIDE_DARK_BACK);
    drop(f);
}

static void a_room_that_the_light_visits_for_one_frame_is_lit(void **state) {
    (void)state;
    fixture *f = make();
    const uint32_t room = add_box(f, ROOM, 2), other = add_box(f, (const float[]){20, 0, 0}, (const float[]){26, 3, 4}, 2);
    const uint32_t never = add_box(f, (const float[]){40, 0, 0}, (const float[]){46, 3, 4}, 2);
    for (int i = 0; i < MAX_FRAMES; i++)
        add_light(f, i == 61 ? 23.0f : 0.02f * (float)i, 2, i == 61 ? 2.0f : 0.0f);
    search(f, 2);
    expect(f, room, 48, VIT_SIDE_DARK_FRONT);
    expect(f, other, 48, VIT_SIDE_DARK_FRONT);
    expect(f, never, 48, VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK);
    drop(f);
}

static void a_spot_light_lights_only_its_cone(void **state) {
    (void)state;
    for (int spot = 0; spot < 2; spot++) {
        fixture *f = make(); /* two plates above the light; their back is below */
        add_plate(f, (const float[]){-0.5f, 3, -0.5f}, (const float[]){0, 0, 1}, (const float[]){1, 0, 0}, 2);
        add_plate(f, (const float[]){2.5f, 3, -0.5f}, (const float[]){0, 0, 1}, (const float[]){1, 0, 0}, 2);
        add_light(f, 0, 1, 0);
        if (spot) {
            f->lights[0].kind = VIT_LIGHT_SPOT;
            f->lights[0].direction[1] = 1.0f;
            f->lights[0].cos_outer = 0.95f;
        }
        search(f, 2);
        expect(f, 0, 8, VIT_SIDE_DARK_FRONT);
        expect(f, 8, 8, spot ? VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK : VIT_SIDE_DARK_FRONT);
        drop(f);
    }
}

/* Rays, not seconds: boxes in a closed box; 112 rays per side would tell the same. */
static void insides_of_bodies_cost_few_rays(void **state) {
    (void)state;
    fixture *f = make();
    add_box(f, ROOM, 1);
    const uint32_t housing = add_box(f, (const float[]){-2, 1, -2}, (const float[]){2, 3, 2}, 8), parts = f->m.triangles;
    for (int i = 0; i < 80; i++) {
        const float x = 0.35f * (float)(i % 10) - 1.8f, z = 0.45f * (float)(i / 10) - 1.8f;
        add_box(f, (const float[]){x, 1.5f, z}, (const float[]){x + 0.3f, 2, z + 0.3f}, 5);
    }
    add_light(f, 4, 4, 4);
    search(f, 2);
    expect(f, housing, parts - housing, VIT_SIDE_DARK_BACK);
    expect(f, parts, f->m.triangles - parts, VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK);
    const uint64_t sides = 2 * (uint64_t)f->m.triangles, of_lights = 1u << 18;
    assert_true(f->r.rays > of_lights && f->r.rays < of_lights + 40 * sides);
    drop(f);
}

static void without_light_nothing_is_flagged(void **state) {
    (void)state;
    fixture *f = make();
    add_box(f, ROOM, 1);
    add_light(f, 0, 4, 0);
    memset(f->lights[0].intensity, 0, sizeof f->lights[0].intensity);
    search(f, 2);
    expect(f, 0, 12, 0);
    assert_int_equal(f->r.dark_sides, 0);
    drop(f);
}

static void one_thread_and_two_flag_the_same_sides(void **state) {
    (void)state;
    fixture *f = make();
    add_box(f, ROOM, 12);
    for (int i = 0; i < 60; i++) { /* a heap of boxes that overlap, so that many sides are near the threshold */
        const float x = 0.13f * (float)(i * 17 % 31) - 2.0f, y = 0.11f * (float)(i * 7 % 13),
                    z = 0.12f * (float)(i * 11 % 29) - 2.0f;
        add_box(f, (const float[]){x, y, z}, (const float[]){x + 0.7f, y + 0.6f, z + 0.5f}, 3);
    }
    add_light(f, 0, 4, 0);
    search(f, 1);
    assert_true(f->r.dark_back > 0.0);
    uint32_t one[MAX_TRIANGLES];
    memcpy(one, f->flags, sizeof one);
    for (unsigned run = 0; run < 3; run++) {
        search(f, run == 2 ? 0 : 2);
        assert_memory_equal(f->flags, one, sizeof one);
    }
    drop(f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_inside_of_a_closed_box_is_dark_and_its_outside_lit),
        cmocka_unit_test(light_finds_its_way_through_a_hole),
        cmocka_unit_test(faces_that_touch_are_dark_on_both_sides),
        cmocka_unit_test(no_small_triangle_is_darkened_by_bad_luck),
        cmocka_unit_test(specks_that_see_the_light_alone_are_lit),
        cmocka_unit_test(specks_that_see_something_lit_in_a_corner_of_their_view_are_lit),
        cmocka_unit_test(the_inside_of_a_sharp_wedge_is_dark),
        cmocka_unit_test(light_passes_the_holes_of_a_cut_out),
        cmocka_unit_test(a_room_that_the_light_visits_for_one_frame_is_lit),
        cmocka_unit_test(a_spot_light_lights_only_its_cone),
        cmocka_unit_test(insides_of_bodies_cost_few_rays),
        cmocka_unit_test(without_light_nothing_is_flagged),
        cmocka_unit_test(one_thread_and_two_flag_the_same_sides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
