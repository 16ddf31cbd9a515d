/* Dark sides and the ways that light takes: through rooms in a row, glass and windows, by mirrors, from lamps that shine and
 * the sky; how far it goes, and the photons' radius that comes of it. As test_dark_sides.c: scenes in which the answer is
 * beyond doubt. */
#include "dark_sides_lab.h"

/* A wall across the long room of the next function, with a square hole of `width` m about (x, 2.5, z). */
static void add_wall(fixture *f, float x, float z, float width) {
    const float near = z - 0.5f * width, far = z + 0.5f * width, beside = 2.5f - 0.5f * width;
    add_plate(f, (const float[]){x, 0, -5}, (const float[]){0, 5, 0}, (const float[]){0, 0, near + 5}, 8);
    add_plate(f, (const float[]){x, 0, far}, (const float[]){0, 5, 0}, (const float[]){0, 0, 5 - far}, 8);
    add_plate(f, (const float[]){x, 0, near}, (const float[]){0, beside, 0}, (const float[]){0, 0, width}, 2);
    add_plate(f, (const float[]){x, 5 - beside, near}, (const float[]){0, beside, 0}, (const float[]){0, 0, width}, 2);
}

/* Looks along x, 90 degrees wide, 100 pixels. */
static vit_camera camera_at(float x, float y, float z, float forward) {
    return (vit_camera){.eye = {x, y, z},
                        .exposure = 1.0f,
                        .corner = {forward, 1.0f, -forward},
                        .right = {0, 0, 0.02f * forward},
                        .down = {0, -0.02f, 0},
                        .forward = {forward, 0, 0}};
}

/* Three rooms of 400 m2 in a row, the lamp in the first, each open to the next by a hole out of the lamp's sight: what comes
 * in, 0.8 E width^2, is what 0.2 of the walls swallow, so each has 1e-2 width^2 of the irradiance before it; the threshold
 * is 1.8e-5 of the first. Returns the part of the last one's outer walls that is lit. All outsides must be dark, as must a
 * closed box in the last room. */
static double lit_behind_two_holes(float width, vit_camera *cameras) {
    fixture *f = make();
    const uint32_t box = add_box(f, (const float[]){-15, 0, -5}, (const float[]){15, 5, 5}, 24), end = f->m.triangles;
    add_wall(f, 5, -3, width);
    add_wall(f, -5, 3, width);
    const uint32_t inner = add_box(f, (const float[]){-11, 0.1f, -2}, (const float[]){-10.6f, 0.5f, -1.6f}, 4);
    f->cameras = cameras;
    add_light(f, 10, 4, 4);
    search(f, 2);
    uint32_t walls = 0, lit = 0;
    for (uint32_t i = box; i < end; i++) {
        const float *p = f->m.position + 9 * (size_t)i;
        assert_true(f->flags[i] & VIT_SIDE_DARK_FRONT);
        if (p[0] + p[3] + p[6] < 3 * -5.0f) {
            walls++;
            lit += !(f->flags[i] & VIT_SIDE_DARK_BACK);
        }
    }
    for (uint32_t i = inner; i < f->m.triangles; i++)
        assert_true(f->flags[i] & VIT_SIDE_DARK_BACK);
    drop(f);
    return (double)lit / walls;
}

static void a_dim_room_is_lit_and_a_dimmer_one_dark(void **state) {
    (void)state;
    const double dim = lit_behind_two_holes(0.9f, NULL), dimmer = lit_behind_two_holes(0.5f, NULL);
    print_message("lit: %.4f with 3.6 times the threshold, %.4f with 0.35 of it\n", dim, dimmer);
    assert_true(dim > 0.98);
    assert_true(dimmer < 0.05);
}

/* Seen from within, the dimmer room is all that there is; from the first room it is nothing. */
static void a_dim_room_that_fills_a_frame_is_lit(void **state) {
    (void)state;
    vit_camera there = camera_at(-6, 2.5f, -4, -1), here = camera_at(8, 2.5f, 0, -1);
    const double seen = lit_behind_two_holes(0.5f, &there), narrow = lit_behind_two_holes(0.1f, &there),
                 unseen = lit_behind_two_holes(0.5f, &here);
    print_message("lit: %.4f and %.4f seen from within, with 0.35 and 0.0006 of the threshold, %.4f from afar\n", seen, narrow,
                  unseen);
    assert_true(seen > 0.98 && narrow > 0.98);
    assert_true(unseen < 0.05);
}

/* Of chords of a convex body that begin evenly over its surface and along the cosine the mean is 4 volumes over the surface.
 * All faces of a cube are alike, so light that does not lie evenly has the same mean. */
static void light_goes_the_mean_chord_of_a_cube(void **state) {
    (void)state;
    for (int size = 1; size <= 4; size *= 4) {
        fixture *f = make();
        const float s = (float)size;
        add_box(f, (const float[]){0, 0, 0}, (const float[]){s, s, s}, 12);
        add_light(f, 0.5f * s, 0.5f * s, 0.5f * s);
        search(f, 1);
        const double one = f->r.free_path, chord = 4.0 * s * s * s / (6.0 * s * s);
        assert_true(fabs(one / chord - 1.0) < 0.02);
        search(f, 3);
        assert_memory_equal(&f->r.free_path, &one, sizeof one);
        drop(f);
    }
}

static void light_that_leaves_the_scene_goes_no_way(void **state) {
    (void)state;
    fixture *f = make();
    add_plate(f, (const float[]){-50, 0, -50}, (const float[]){0, 0, 100}, (const float[]){100, 0, 0}, 20);
    add_light(f, 0, 1, 0);
    search(f, 2);
    assert_true(f->r.free_path >= 0.0 && f->r.free_path <= 0.0); /* an even floor: light finds nothing */
    drop(f);
}

/* The radius "auto": a fifth of the way, but 4 to 150 photons a disc, and always a number that is one. */
static void the_automatic_radius_follows_the_way_of_light_within_bounds(void **state) {
    static const double ways[] = {0.0, 0.1, 1.0, 5.0, 1e30, (double)NAN};
    (void)state;
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        const plan p = {.lit_area = 100.0, .free_path = ways[i]};
        double last = INFINITY;
        for (double stored = 1.0; stored < 1e9; stored *= 3.0) {
            const double radius = plan_radius(&p, stored), held = 3.14159265358979 * radius * radius * stored / 100.0;
            assert_true(held > 4.0 * 0.999 && held < 150.0 * 1.001);
            assert_true(radius <= last);
            last = radius;
            if (held > 4.01 && held < 149.0)
                assert_true(fabs(radius / (0.2 * ways[i]) - 1.0) < 0.001);
        }
    }
    const plan room = {.lit_area = 100.0, .free_path = 3.0};
    assert_true(fabs(plan_radius(&room, 2000.0) - 0.6) < 0.001);
}

/* A box in a glass box, in a room with a lamp: glass lets light in, to both sides of what stands there, and is not dark itself.
 */
static void light_gets_into_glass(void **state) {
    (void)state;
    for (uint32_t kind = GLASS; kind <= THIN_GLASS; kind++) {
        fixture *f = make();
        add_box(f, ROOM, 1);
        const uint32_t glass = add_box(f, (const float[]){-1, 1, -1}, (const float[]){1, 3, 1}, 2),
                       inner = add_box(f, (const float[]){-0.5f, 1.5f, -0.5f}, (const float[]){0.5f, 2.5f, 0.5f}, 4);
        paint(f, glass, inner - glass, kind);
        add_light(f, 4, 4, 4);
        search(f, 2);
        expect(f, glass, inner - glass, 0);
        expect(f, inner, 6 * 32, VIT_SIDE_DARK_BACK);
        assert_true(fabs(f->r.area - 2.0 * (400.0 + 6.0)) < 1e-3); /* without the glass */
        drop(f);
    }
}

/* Two rooms with a window between them. */
static void light_passes_a_window(void **state) {
    (void)state;
    for (int window = 0; window < 2; window++) {
        fixture *f = make();
        add_box(f, ROOM, 4);
        const uint32_t wall = f->m.triangles;
        add_plate(f, (const float[]){0, 0, -5}, (const float[]){0, 0, 10}, (const float[]){0, 5, 0}, 4);
        paint(f, wall + 10, 2, window ? THIN_GLASS : OPAQUE);
        add_light(f, 3, 3, 1);
        search(f, 2);
        uint32_t beyond = 0, dark = 0;
        for (uint32_t i = 0; i < wall; i++) { /* the room's far wall */
            const float *p = f->m.position + 9 * (size_t)i;
            if (p[0] > -4.99f || p[3] > -4.99f || p[6] > -4.99f)
                continue;
            beyond++;
            dark += f->flags[i] == (VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK);
        }
        assert_int_equal(beyond, 32);
        assert_int_equal(dark, window ? 0 : 32);
        drop(f);
    }
}

/* Round a corner by a mirror alone: a narrow duct whose walls are mirrors but for a plate at its end. */
static void mirrors_hand_light_on(void **state) {
    (void)state;
    for (int mirror = 0; mirror < 2; mirror++) {
        fixture *f = make();
        add_box(f, (const float[]){0, 0, 0}, (const float[]){6, 1, 1}, 1);
        const uint32_t duct = f->m.triangles;
        paint(f, 0, duct, mirror ? MIRROR : OPAQUE);
        add_plate(f, (const float[]){5.9f, 0.2f, 0.2f}, (const float[]){0, 0, 0.6f}, (const float[]){0, 0.6f, 0}, 2);
        add_light(f, 0.5f, 0.5f, 0.5f);
        f->lights[0].kind = VIT_LIGHT_SPOT; /* away from the plate */
        f->lights[0].direction[1] = 1.0f;
        f->lights[0].cos_outer = 0.7f;
        search(f, 2);
        /* Both sides: the plate's back sees the end. */
        expect(f, duct, 8, 0);
        if (mirror)
            assert_true(fabs(f->r.area - 2 * 0.36) < 1e-4);
        drop(f);
    }
}

/* A lamp of its own light: what it shines on is lit, what hangs before its other side, in a box, too; a covered side sends
 * none. */
static void area_lights_light(void **state) {
    (void)state;
    fixture *f = make();
    const uint32_t room = add_box(f, ROOM, 1), box = add_box(f, (const float[]){-1, 1, -1}, (const float[]){1, 2, 1}, 4),
                   lamp = f->m.triangles;
    add_plate(f, (const float[]){3, 4.9999f, 3}, (const float[]){1, 0, 0}, (const float[]){0, 0, 1}, 2); /* on the ceiling */
    paint(f, lamp, 8, LAMP);
    search(f, 2);
    expect(f, room, 12, VIT_SIDE_DARK_FRONT);
    expect(f, box, 6 * 32, VIT_SIDE_DARK_BACK);
    for (uint32_t i = lamp; i < lamp + 8; i++) /* one of the two: the one against the ceiling */
        assert_true(f->flags[i] == VIT_SIDE_DARK_FRONT || f->flags[i] == VIT_SIDE_DARK_BACK);
    drop(f);
}

static void the_sky_lights_what_is_open_to_it(void **state) {
    (void)state;
    fixture *f = make();
    const uint32_t closed = add_box(f, (const float[]){-1, 0, -1}, (const float[]){1, 2, 1}, 2), open = f->m.triangles;
    add_plate(f, (const float[]){2, 0, 2}, (const float[]){0, 0, 2}, (const float[]){2, 0, 0}, 2);
    f->sky = true;
    f->m.lo[0] = f->m.lo[2] = -1;
    f->m.hi[0] = f->m.hi[2] = 4;
    f->m.hi[1] = 2;
    search(f, 2);
    expect(f, closed, open - closed, VIT_SIDE_DARK_BACK);
    expect(f, open, 8, 0);
    drop(f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_dim_room_is_lit_and_a_dimmer_one_dark),
        cmocka_unit_test(a_dim_room_that_fills_a_frame_is_lit),
        cmocka_unit_test(light_goes_the_mean_chord_of_a_cube),
        cmocka_unit_test(light_that_leaves_the_scene_goes_no_way),
        cmocka_unit_test(the_automatic_radius_follows_the_way_of_light_within_bounds),
        cmocka_unit_test(light_gets_into_glass),
        cmocka_unit_test(light_passes_a_window),
        cmocka_unit_test(mirrors_hand_light_on),
        cmocka_unit_test(area_lights_light),
        cmocka_unit_test(the_sky_lights_what_is_open_to_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
