/* Lights that lie in a surface. Stated: found are those nearer than ray_offset to a triangle, slanted or not, in the frames
 * where they are; not those 4 ray_offsets off, beside a triangle, dark, or directional. */
#include "light/lights_in_surfaces.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define OFFSET 1e-4f /* m */
enum { FRAMES = 5, LIGHTS = 5 };

/* A ceiling of y = 2, a slanted wall x = y, a wall of z = -5. */
static const vit_triangle triangles[3] = {{.v0 = {-2, 2, -2}, .v1 = {4, 2, -2}, .v2 = {-2, 2, 4}, .ny = -36},
                                          {.v0 = {0, 0, -3}, .v1 = {1, 1, 0}, .v2 = {0, 0, 3}, .nx = 6, .ny = -6},
                                          {.v0 = {-2, -2, -5}, .v1 = {4, -2, -5}, .v2 = {-2, 4, -5}, .nz = 36}};

typedef struct path {
    vit_light light[FRAMES][LIGHTS];
    bool still[LIGHTS];
    light_in_surface found[LIGHTS];
} path;

static void put(path *p, int light, int frame, float x, float y, float z) {
    p->light[frame][light] = (vit_light){.kind = VIT_LIGHT_POINT, .position = {x, y, z}, .intensity = {1, 1, 1}};
}

static void look(path *p) {
    triangle_rays rays;
    const tracks t = {.lights = p->light[0], .light_count = LIGHTS, .still = p->still};
    assert_true(triangle_rays_open(triangles, 3, 1e-6f, 1, &rays));
    lights_in_surfaces(&t, FRAMES, &rays, OFFSET, p->found);
    triangle_rays_close(&rays);
}

static void still_lights_are_found_in_all_frames(void **state) {
    (void)state;
    static path p;
    for (int f = 0; f < FRAMES; f++) {
        put(&p, 0, f, 0.5f, 2.0f, 0.5f);              /* in the ceiling */
        put(&p, 1, f, 0.5f, 2.0f - 4 * OFFSET, 0.5f); /* below it */
        put(&p, 2, f, 3.5f, 2.0f, 3.5f);              /* in its plane, beside it */
        put(&p, 3, f, 0.5f + 1.3f * OFFSET, 0.5f, 0); /* 0.92 offsets off the slanted wall */
        put(&p, 4, f, 0, 0, -5);                      /* in the last wall */
    }
    memset(p.still, 1, sizeof p.still);
    look(&p);
    assert_int_equal(p.found[0].frames, FRAMES);
    assert_int_equal(p.found[0].first, 0);
    assert_int_equal(p.found[1].frames, 0);
    assert_int_equal(p.found[2].frames, 0);
    assert_int_equal(p.found[3].frames, FRAMES);
    assert_int_equal(p.found[4].frames, FRAMES);
}

static void moving_lights_are_found_where_they_pass(void **state) {
    (void)state;
    static path p;
    for (int f = 0; f < FRAMES; f++) {
        put(&p, 0, f, 0.5f, 1.4f + 0.2f * (float)f, 0.5f); /* through the ceiling in frame 3 */
        put(&p, 1, f, 0.5f, 2.0f + (f < 2 ? 1.0f : 0.5f * OFFSET), 0.5f);
        put(&p, 2, f, 0.5f, 2.0f, 0.5f);
        put(&p, 3, f, 0.5f, 2.0f, 0.5f);
        put(&p, 4, f, 0, 0, -5);
        p.light[f][2].kind = VIT_LIGHT_DIRECTIONAL;
        memset(p.light[f][3].intensity, 0, sizeof p.light[f][3].intensity);
    }
    memset(p.still, 0, sizeof p.still);
    look(&p);
    assert_int_equal(p.found[0].frames, 1);
    assert_int_equal(p.found[0].first, 3);
    assert_int_equal(p.found[1].frames, FRAMES - 2);
    assert_int_equal(p.found[1].first, 2);
    assert_int_equal(p.found[2].frames, 0);
    assert_int_equal(p.found[3].frames, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(still_lights_are_found_in_all_frames),
        cmocka_unit_test(moving_lights_are_found_where_they_pass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
