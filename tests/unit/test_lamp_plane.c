/* Lamps in the plane of other faces. Stated: a panel in its ceiling comes out of it to the cameras' side, whichever way it is
 * wound and wherever it stands among the triangles; the lid of a closed body, a panel beside the ceiling, one a centimetre
 * below and one across it stay. */
#include "geometry/area_light_plane.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define OFFSET 1e-4f /* m */
enum { MOST = 64, WALL = 0, LAMP = 1 };

typedef struct scene_of_quads {
    float position[3 * MOST];
    uint32_t index[3 * MOST], material[MOST];
    model_material materials[2];
    model m;
} scene_of_quads;

static void begin(scene_of_quads *s) {
    memset(s, 0, sizeof *s);
    s->materials[LAMP].emission[0] = 1.0f;
    s->m = (model){
        .position = s->position, .index = s->index, .material = s->material, .materials = s->materials, .material_count = 2};
}

/* Two triangles of corners p, p + u, p + u + v, p + v. */
static uint32_t quad(scene_of_quads *s, uint32_t material, const float p[3], const float u[3], const float v[3]) {
    const uint32_t first = s->m.vertices;
    for (int i = 0; i < 4; i++)
        for (int x = 0; x < 3; x++)
            s->position[3 * (first + (uint32_t)i) + (uint32_t)x] =
                p[x] + (i == 1 || i == 2 ? u[x] : 0.0f) + (i >= 2 ? v[x] : 0.0f);
    const uint32_t corners[6] = {0, 1, 2, 0, 2, 3};
    for (uint32_t i = 0; i < 6; i++)
        s->index[3 * s->m.triangles + i] = first + corners[i];
    s->material[s->m.triangles] = s->material[s->m.triangles + 1] = material;
    s->m.vertices += 4;
    s->m.triangles += 2;
    return first;
}

static const float X[3] = {1, 0, 0}, Z[3] = {0, 0, 1};
static const float corner[3] = {-2, 2, -2}, x4[3] = {4, 0, 0}, z4[3] = {0, 0, 4};

/* The ceiling y = 2 and a panel of 1 m2; which comes first, and how the panel is wound. Returns by how much it moved up. */
static float moved(int panel_first, int turned, const float at[3], uint32_t *count) {
    static scene_of_quads s;
    const vit_camera below[2] = {{.eye = {0, 1, 0}}, {.eye = {0.5f, 0, 1}}};
    begin(&s);
    uint32_t panel = 0;
    for (int i = 0; i < 2; i++)
        if (i == !panel_first)
            panel = quad(&s, LAMP, at, turned ? Z : X, turned ? X : Z);
        else
            (void)quad(&s, WALL, corner, x4, z4);
    assert_true(area_light_plane(&s.m, below, 2, OFFSET, count));
    for (uint32_t i = 1; i < 4; i++)
        assert_true(s.position[3 * (panel + i) + 1] == s.position[3 * panel + 1]);
    for (uint32_t i = 0; i < 4; i++) /* the ceiling stays */
        assert_true(s.position[3 * ((panel ? 0u : 4u) + i) + 1] == 2.0f);
    return s.position[3 * panel + 1] - at[1];
}

static void a_panel_in_its_ceiling_comes_out_of_it(void **state) {
    static const float at[3] = {0.25f, 2, 0.25f};
    (void)state;
    for (int way = 0; way < 4; way++) {
        uint32_t count;
        const float up = moved(way & 1, way >> 1, at, &count);
        assert_int_equal(count, 2);
        assert_true(fabsf(up + (float)AREA_LIGHT_PLANE * OFFSET) < 1e-6f);
    }
}

static void what_is_in_no_other_plane_stays(void **state) {
    static const float places[3][3] = {{0.25f, 1.99f, 0.25f}, {2, 2, 0}, {7, 2, 0}}; /* below, edge to edge, far beside */
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        uint32_t count;
        assert_true(moved(0, 0, places[i], &count) == 0.0f);
        assert_int_equal(count, 0);
    }
}

static void the_lid_of_a_closed_body_stays(void **state) {
    static scene_of_quads s, was;
    static const float p[3] = {0, 1, 0}, top[3] = {0, 2, 0}, up[3] = {0, 1, 0}, right[3] = {1, 1, 0}, back[3] = {0, 1, 1};
    const vit_camera below = {.eye = {0, 0, 0}};
    uint32_t count;
    (void)state;
    begin(&s);
    (void)quad(&s, WALL, corner, x4, z4);
    (void)quad(&s, LAMP, p, X, Z);
    (void)quad(&s, LAMP, top, Z, X);
    (void)quad(&s, LAMP, p, up, X);
    (void)quad(&s, LAMP, p, Z, up);
    (void)quad(&s, LAMP, right, up, Z);
    (void)quad(&s, LAMP, back, X, up);
    was = s;
    assert_true(area_light_plane(&s.m, &below, 1, OFFSET, &count));
    assert_int_equal(count, 0);
    assert_memory_equal(s.position, was.position, sizeof s.position);
    s.material[s.m.triangles - 1] = WALL; /* with a hole in it, it is a sheet */
    assert_true(area_light_plane(&s.m, &below, 1, OFFSET, &count));
    assert_int_equal(count, 2);
}

static void a_lamp_across_the_plane_stays(void **state) {
    static scene_of_quads s;
    static const float p[3] = {0, 1.5f, 0}, up[3] = {0, 1, 0};
    const vit_camera below = {.eye = {0, 0, 0}};
    uint32_t count;
    (void)state;
    begin(&s);
    (void)quad(&s, WALL, corner, x4, z4);
    (void)quad(&s, LAMP, p, X, up);
    assert_true(area_light_plane(&s.m, &below, 1, OFFSET, &count));
    assert_int_equal(count, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_panel_in_its_ceiling_comes_out_of_it),
        cmocka_unit_test(what_is_in_no_other_plane_stays),
        cmocka_unit_test(the_lid_of_a_closed_body_stays),
        cmocka_unit_test(a_lamp_across_the_plane_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
