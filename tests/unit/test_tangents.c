/* Tangents of vertices (bake/geometry/tangents.c). The words are decoded here anew, from what records.clh says of them.
 *
 * Why this is hard: a normal map means something only in the tangent space that it was made in, so what is right is
 * MikkTSpace's rules, and a wrong one shows as light from a wrong side. Strategy: meshes so small that each rule has one number
 * to show: which way tangents go, which triangles share them and by what weights, and what has none. */
#include "geometry/bvh.h"
#include "geometry/tangents.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { MOST = 16 };
#define CLOSE 1e-5 /* of the code: VIT_TANGENT_STEPS to a turn */

/* Vertices one by one, triangles of them; material 0 has a normal map, 1 has none. */
typedef struct mesh {
    model m;
    float position[3 * MOST], normal[3 * MOST], uv[2 * MOST];
    uint32_t index[3 * MOST], material[MOST];
    model_material materials[2];
    vit_attributes attributes[MOST];
} mesh;

static uint32_t vertex(mesh *s, double x, double y, double z, double u, double v) {
    const uint32_t i = s->m.vertices++;
    const float p[3] = {(float)x, (float)y, (float)z}, up[3] = {0, 0, 1}, t[2] = {(float)u, (float)v};
    memcpy(s->position + 3 * (size_t)i, p, sizeof p);
    memcpy(s->normal + 3 * (size_t)i, up, sizeof up);
    memcpy(s->uv + 2 * (size_t)i, t, sizeof t);
    return i;
}

static void triangle(mesh *s, uint32_t a, uint32_t b, uint32_t c) {
    const uint32_t corner[3] = {a, b, c};
    memcpy(s->index + 3 * (size_t)s->m.triangles++, corner, sizeof corner);
}

/* Records in the mesh's own order. */
static void pack(mesh *s) {
    uint32_t order[MOST];
    geometry g;
    vit_text why = {""};
    for (uint32_t i = 0; i < MOST; i++)
        order[i] = i;
    const bvh b = {.order = order};
    s->materials[0].normal_scale = 1.0f;
    s->m.position = s->position;
    s->m.normal = s->normal;
    s->m.uv = s->uv;
    s->m.index = s->index;
    s->m.material = s->material;
    s->m.materials = s->materials;
    s->m.material_count = 2;
    if (geometry_pack(&s->m, &b, &g, &why) != VIT_OK)
        fail_msg("%s", why.text);
    memcpy(s->attributes, g.attributes, s->m.triangles * sizeof *g.attributes);
    geometry_free(&g);
}

static bool has_none(const vit_attributes *a) {
    return a->tangent[0] == 0 && a->tangent[1] == 0;
}

/* Tangent of a corner whose normal is +z: the axes of ray_make() are x and y there. */
static void tangent_is(const vit_attributes *a, int corner, double x, double y) {
    const uint64_t both = (uint64_t)a->tangent[1] << 32 | a->tangent[0];
    const uint32_t code = both >> VIT_TANGENT_BITS * corner & ((1u << VIT_TANGENT_BITS) - 1);
    const double turn = (code - 1.0) * 4.0 / VIT_TANGENT_STEPS, dx = turn < 2 ? 1 - turn : turn - 3,
                 dy = turn < 2 ? 1 - fabs(dx) : fabs(dx) - 1, length = hypot(dx, dy), want = hypot(x, y);
    assert_true(code >= 1 && code <= VIT_TANGENT_STEPS);
    if (fabs(dx / length - x / want) > CLOSE || fabs(dy / length - y / want) > CLOSE)
        fail_msg("the tangent is (%g, %g), want (%g, %g)", dx / length, dy / length, x / want, y / want);
}

static bool is_mirrored(const vit_attributes *a) {
    return a->tangent[1] & VIT_TANGENT_MIRRORED;
}

/* A picture as it is seen: u to the right, v down. Turned about by degrees; mirrored: u to the left. */
static void a_tangent_goes_where_u_grows_and_v_stays(void **state) {
    (void)state;
    for (int degrees = 0; degrees < 360; degrees += 15)
        for (int mirrored = 0; mirrored < 2; mirrored++) {
            const double c = cos(degrees * 3.14159265358979 / 180), s = sin(degrees * 3.14159265358979 / 180),
                         side = mirrored ? -1 : 1;
            mesh q = {.m = {.vertices = 0}};
            triangle(&q, vertex(&q, 0, 0, 0, 0, 1), vertex(&q, c, s, 0, side, 1), vertex(&q, -s, c, 0, 0, 0));
            pack(&q);
            for (int k = 0; k < 3; k++)
                tangent_is(&q.attributes[0], k, side * c, side * s);
            assert_int_equal(is_mirrored(&q.attributes[0]), mirrored);
        }
}

/* Two triangles meet in an edge, with lines of equal v along x on one and along -y on the other: at the edge's ends each
 * counts by its angle there. */
static void triangles_that_meet_share_tangents_by_their_angles(void **state) {
    (void)state;
    mesh s = {.m = {.vertices = 0}};
    const uint32_t a = vertex(&s, 0, 0, 0, 0, 1), b = vertex(&s, 1, 1, 0, 1, 0);
    const uint32_t right = vertex(&s, 1, 0, 0, 1, 1);
    triangle(&s, a, right, b);
    /* Here u = x and v = 1 - y, there u = 2 x - y and v = 1 - x: at the edge the same. */
    const uint32_t left = vertex(&s, -1, 1, 0, -3, 2);
    triangle(&s, a, b, left);
    pack(&s);
    tangent_is(&s.attributes[0], 1, 1, 0);
    tangent_is(&s.attributes[1], 2, 0, -1);
    assert_false(is_mirrored(&s.attributes[0]) || is_mirrored(&s.attributes[1]));
    for (int t = 0; t < 2; t++) {
        tangent_is(&s.attributes[t], 0, 1, -2);              /* 45 degrees of x, 90 of -y */
        tangent_is(&s.attributes[t], t == 0 ? 2 : 1, 1, -1); /* 45 of both */
    }
}

static void corners_of_a_vertex_are_found_by_its_values(void **state) {
    (void)state;
    mesh s = {.m = {.vertices = 0}};
    triangle(&s, vertex(&s, 0, 0, 0, 0, 1), vertex(&s, 1, 0, 0, 1, 1), vertex(&s, 1, 1, 0, 1, 0));
    triangle(&s, vertex(&s, -0.0, 0, 0, 0, 1), vertex(&s, 1, 1, -0.0, 1, 0), vertex(&s, -1, 1, 0, -3, 2));
    pack(&s);
    tangent_is(&s.attributes[0], 0, 1, -2);
    tangent_is(&s.attributes[1], 0, 1, -2);
}

/* Where the picture is mirrored at an edge, as both halves of a face are. */
static void mirrored_neighbours_share_nothing(void **state) {
    (void)state;
    mesh s = {.m = {.vertices = 0}};
    const uint32_t a = vertex(&s, 0, 0, 0, 0, 1), b = vertex(&s, 0, 1, 0, 0, 0);
    triangle(&s, a, vertex(&s, 1, 0, 0, 1, 1), b);
    triangle(&s, a, b, vertex(&s, -1, 0, 0, 1, 1));
    pack(&s);
    for (int k = 0; k < 3; k++) {
        tangent_is(&s.attributes[0], k, 1, 0);
        tangent_is(&s.attributes[1], k, -1, 0);
    }
    assert_false(is_mirrored(&s.attributes[0]));
    assert_true(is_mirrored(&s.attributes[1]));
}

/* Texture coordinates without area: on one line, in one point, none at all (0, 0 everywhere). */
static void without_area_tangents_are_the_neighbours_or_none(void **state) {
    (void)state;
    mesh s = {.m = {.vertices = 0}};
    const uint32_t a = vertex(&s, 0, 0, 0, 0, 1), b = vertex(&s, 0, 1, 0, 0, 0), c = vertex(&s, -1, 1, 0, 0, -1);
    triangle(&s, a, b, c); /* on a line; comes first, and its neighbour says how */
    triangle(&s, a, vertex(&s, 1, 0, 0, 1, 1), b);
    triangle(&s, vertex(&s, 5, 0, 0, 0, 0), vertex(&s, 6, 0, 0, 0, 0), vertex(&s, 5, 1, 0, 0, 0));
    pack(&s);
    tangent_is(&s.attributes[0], 0, 1, 0);
    tangent_is(&s.attributes[0], 1, 1, 0);
    assert_false(is_mirrored(&s.attributes[0]));
    assert_true(has_none(&s.attributes[2]));
}

static void what_has_no_normal_map_has_none_and_changes_none(void **state) {
    (void)state;
    mesh s = {.m = {.vertices = 0}};
    const uint32_t a = vertex(&s, 0, 0, 0, 0, 1), b = vertex(&s, 1, 1, 0, 1, 0);
    triangle(&s, a, vertex(&s, 1, 0, 0, 1, 1), b);
    triangle(&s, a, b, vertex(&s, -1, 1, 0, -3, 2));
    s.material[1] = 1;
    pack(&s);
    tangent_is(&s.attributes[0], 0, 1, 0);
    assert_true(has_none(&s.attributes[1]));
    assert_true(s.attributes[0].material & VIT_TRIANGLE_SMOOTH);
    assert_false(s.attributes[1].material & VIT_TRIANGLE_SMOOTH);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tangent_goes_where_u_grows_and_v_stays),
        cmocka_unit_test(triangles_that_meet_share_tangents_by_their_angles),
        cmocka_unit_test(corners_of_a_vertex_are_found_by_its_values),
        cmocka_unit_test(mirrored_neighbours_share_nothing),
        cmocka_unit_test(without_area_tangents_are_the_neighbours_or_none),
        cmocka_unit_test(what_has_no_normal_map_has_none_and_changes_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
