/* What Embree proposes leaves out nothing: hits are those of a loop over all triangles, to the bit, from near and far, and rays
 * at the corners and edges of closed bodies do not get through. */
#include "geometry/triangle_rays.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { ROWS = 12, TRIANGLES = 4 * ROWS * ROWS, RAYS = 4000 };

static vit_triangle ball[TRIANGLES];

static vec3 place(int i, int k) { /* of a ball of radius 1, in steps of its turn */
    float s, c, height, width;
    sincos_turn((float)(i % (2 * ROWS)) / (2.0f * ROWS), &s, &c);
    sincos_turn(0.25f + 0.5f * (float)k / ROWS, &height, &width);
    return k == 0 || k == ROWS ? (vec3){0.0f, 0.0f, k ? -1.0f : 1.0f} : (vec3){width * c, width * s, height};
}

static void make(vit_triangle *t, vec3 a, vec3 b, vec3 c) {
    const vec3 e = vec3_sub(b, a), f = vec3_sub(c, a);
    *t = (vit_triangle){{a.x, a.y, a.z},       e.y * f.z - e.z * f.y, {b.x, b.y, b.z},
                        e.z * f.x - e.x * f.z, {c.x, c.y, c.z},       e.x * f.y - e.y * f.x};
}

static uint32_t make_ball(void) {
    uint32_t n = 0;
    for (int i = 0; i < 2 * ROWS; i++)
        for (int k = 0; k < ROWS; k++) {
            if (k > 0)
                make(ball + n++, place(i, k), place(i, k + 1), place(i + 1, k));
            if (k + 1 < ROWS)
                make(ball + n++, place(i + 1, k), place(i, k + 1), place(i + 1, k + 1));
        }
    return n;
}

/* At corners, at middles of edges, and anywhere. */
static vec3 aim(uint32_t i) {
    const uint32_t h = pcg(i);
    const vec3 a = place((int)(h % 24u), (int)(h / 24u % (ROWS + 1u))),
               b = place((int)(h % 24u) + 1, (int)(h / 24u % (ROWS + 1u)));
    const float share = i % 3 == 0 ? 0.0f : i % 3 == 1 ? 0.5f : unit_float(pcg(h));
    return vec3_along(a, vec3_sub(b, a), share);
}

static void hits_are_those_of_a_loop_over_all(void **state) {
    (void)state;
    static const float from[] = {0.3f, 3.0f, 12.0f};
    triangle_rays r, all;
    const uint32_t count = make_ball();
    uint32_t lost = 0, last = VIT_NONE;
    assert_true(triangle_rays_open(ball, count, 0x1p-20f, 1, &r));
    all = r;
    all.nearest = -1.0f; /* as from very far */
    for (uint32_t i = 0; i < RAYS; i++) {
        const float away = from[i / 3 % 3];
        const vec3 o = {away * (unit_float(pcg(3 * i)) - 0.5f), away * (unit_float(pcg(3 * i + 1)) - 0.5f),
                        away * (unit_float(pcg(3 * i + 2)) - 0.5f)};
        const vec3 d = vec3_unit(vec3_sub(aim(i), o));
        triangle_hit a, b;
        const bool hit = triangle_rays_nearest(&r, o, d, INFINITY, NULL, NULL, &a);
        assert_true(triangle_rays_nearest(&all, o, d, INFINITY, NULL, NULL, &b) == hit);
        assert_true(triangle_rays_any(&r, o, d, INFINITY, NULL, NULL) == hit);
        uint32_t likely = i % 2 ? last : i % count; /* whatever is guessed */
        assert_true(triangle_rays_any_likely(&r, o, d, INFINITY, NULL, NULL, &likely) == hit);
        if (hit) {
            last = likely;
            assert_true(triangle_rays_any_likely(&all, o, d, INFINITY, NULL, NULL, &likely));
        }
        if (hit) {
            assert_int_equal(a.triangle, b.triangle);
            assert_memory_equal(&a.distance, &b.distance, sizeof a.distance);
            assert_memory_equal(a.weight, b.weight, sizeof a.weight);
            assert_false(triangle_rays_any(&r, o, d, a.distance * 0.999f, NULL, NULL));
        }
        lost += !hit && away < 0.5f; /* from inside */
    }
    assert_int_equal(lost, 0);
    triangle_rays_close(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(hits_are_those_of_a_loop_over_all)};
    return cmocka_run_group_tests_name("triangle rays", tests, NULL, NULL);
}
