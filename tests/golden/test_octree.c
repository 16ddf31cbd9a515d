/* The baseline octree (tests/baselines/) is right, and leaks where ours does not.
 *
 * A rival that is wrong proves nothing when it is slower. So its tree is held to the loop over all triangles with the same
 * triangle test, to the bit: least distance in (0, limit], among equal ones the smallest index; small leaves and deep trees
 * make the walk long, and boxes on whole numbers, some of them twice, put rays into the octants' planes and make ties. The test
 * on closed meshes is about what Moeller and Trumbore's triangle test lets through at shared edges: that the baseline leaks is
 * the point, since it shows that these rays would find a leak in ours. */
#include "baselines/octree_lab.h"
#include "closed_meshes.h"
#include "ray_trees.h"

#define RAYS 4096u
#define AIMED (1u << 13)

static lab device;

static int open_device(void **state) {
    (void)state;
    device = octree_lab_open("", ray_lab_kernels);
    return 0;
}

static int close_device(void **state) {
    (void)state;
    lab_close(&device);
    return 0;
}

/* Anywhere in a cube of half an edge of 10, of all sizes; every eighth is a copy of the one before. */
static void make_random(ray_mesh *r, uint32_t triangles) {
    uint64_t state = 3;
    mesh_reserve(r, 3 * triangles, triangles);
    for (uint32_t i = 0; i < triangles; i++) {
        const uint32_t first = r->m.vertices;
        const float size = i % 3 == 0 ? 8.0f : 1.0f;
        float at[3];
        for (int k = 0; k < 3; k++)
            at[k] = 20 * lab_uniform(&state) - 10;
        if (i % 8 == 7) {
            mesh_triangle(r, first - 3, first - 2, first - 1);
            continue;
        }
        for (int v = 0; v < 3; v++)
            mesh_vertex(r, at[0] + size * (lab_uniform(&state) - 0.5f), at[1] + size * (lab_uniform(&state) - 0.5f),
                        at[2] + size * (lab_uniform(&state) - 0.5f));
        mesh_triangle(r, first, first + 1, first + 2);
    }
}

/* From inside and outside the root's box; some along axes and in planes, with zeros of both signs, some from whole numbers,
 * some that end early. */
static ray_set mixed_rays(void) {
    ray_set s = rays_new(RAYS);
    uint64_t state = 5;
    for (uint32_t i = 0; i < s.n; i++) {
        const uint64_t bits = lab_random(&state);
        float o[3], d[3];
        random_direction(&state, d);
        for (int k = 0; k < 3; k++) {
            o[k] = (i % 2 ? 60.0f : 20.0f) * (lab_uniform(&state) - 0.5f);
            if (i % 2)
                d[k] = 8 * (lab_uniform(&state) - 0.5f) - o[k];
            if (i % 4 == 2 && (bits >> k & 1))
                d[k] = copysignf(0, d[k]);
            if (i % 8 < 3)
                o[k] = rintf(o[k]);
        }
        if (d[0] == 0 && d[1] == 0 && d[2] == 0)
            d[bits >> 40 & 1] = 1;
        unit_float(d);
        rays_set(&s, i, o, d, i % 5 == 0 ? 5.0f : i % 97 == 0 ? RAY_NOT_CAST : RAY_FAR);
    }
    return s;
}

static void check_with(const ray_mesh *r, const ray_set *s, octree_limits limits, uint32_t least_hits) {
    octree o = octree_of(r, limits);
    assert_in_range(o.depth, 2, limits.depth);
    ray_hits tree = octree_cast(&device, &o, s), all = octree_cast_at_all(&device, &o, s);
    uint32_t hits = 0;
    for (uint32_t i = 0; i < s->n; i++) {
        hits += all.triangle[i] != VIT_NONE;
        all.occluded[i] = all.triangle[i] != VIT_NONE;
    }
    hits_equal(&all, &tree);
    assert_in_range(hits, least_hits, s->n);
    hits_free(&tree);
    hits_free(&all);
    octree_free(&o);
}

static void check_trees(ray_mesh *r, uint32_t least_hits) {
    static const octree_limits limits[] = {{10, 8}, {OCTREE_DEEPEST, 24}, {7, 1}, {3, 4}};
    mesh_bake(r);
    ray_set s = mixed_rays();
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++)
        check_with(r, &s, limits[i], least_hits);
    free(s.plane);
    mesh_free(r);
}

static void nearest_hits_on_random_triangles_are_those_of_the_loop_over_all(void **state) {
    ray_mesh r;
    (void)state;
    make_random(&r, 400);
    check_trees(&r, RAYS / 4);
}

static void nearest_hits_on_whole_numbers_are_those_of_the_loop_over_all(void **state) {
    ray_mesh r;
    (void)state;
    make_lattice(&r, 60);
    check_trees(&r, RAYS / 4);
}

/* Boxes of edge 1 about the triangle x + y + z = 3; the last is apart from it across an edge alone. */
static void a_triangle_touches_the_boxes_that_it_meets(void **state) {
    static const vit_triangle t = {.v0 = {3, 0, 0}, .v1 = {0, 3, 0}, .v2 = {0, 0, 3}};
    static const double half[3] = {0.5, 0.5, 0.5};
    static const struct {
        double middle[3];
        bool touches;
    } cases[] = {{{1, 1, 1}, true},         {{0, 0, 0}, false},      {{0.4, 0.4, 0.6}, false}, {{0.5, 0.5, 0.6}, true},
                 {{1.6, 1.6, 1.6}, false},  {{1.4, 1.4, 1.4}, true}, {{3.4, 0, 0}, true},      {{3.6, 0, 0}, false},
                 {{2.4, 1.4, -0.6}, false}, {{1.9, 1.9, 0.4}, true}, {{2.1, 2.1, 0.4}, false}, {{2.1, 2.0, -0.45}, false}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        if (octree_touches(cases[i].middle, half, &t) != cases[i].touches)
            fail_msg("box %zu", i);
}

/* Equal rays, equal meshes: rays out of a closed mesh that find nothing, by the watertight test and by Moeller-Trumbore. */
static void check_leaks(const closed_mesh *c) {
    ray_mesh r;
    uint64_t state = 7;
    mesh_cube(&r, c->squares, c->place);
    mesh_bake(&r);
    octree o = octree_of(&r, OCTREE_USUAL);
    ray_set s = rays_new(AIMED);
    closed_aim(&s, &r, &state, c->half);
    ray_hits ours = rays_cast(&device, 1, &r, &s), plain = octree_cast(&device, &o, &s);
    const uint32_t kept = hits_leaks(&ours), lost = hits_leaks(&plain);
    uint32_t checked;
    const uint32_t still = octree_lost_without_tree(&device, &o, &s, &plain, 256, &checked);
    printf("%-36s of %u rays leak: %u ours, %u Moeller-Trumbore; of %u of these without the octree too: %u\n", c->what, s.n,
           kept, lost, checked, still);
    assert_int_equal(kept, 0);
    assert_in_range(lost, 1, s.n);
    assert_int_equal(still, checked);
    hits_free(&ours);
    hits_free(&plain);
    free(s.plane);
    octree_free(&o);
    mesh_free(&r);
}

static void rays_that_leak_through_a_ball_of_moeller_and_trumbore_do_not_leak_through_ours(void **state) {
    (void)state;
    check_leaks(closed_meshes + CLOSED_BALL);
}

static void rays_that_leak_through_a_box_of_moeller_and_trumbore_do_not_leak_through_ours(void **state) {
    (void)state;
    check_leaks(closed_meshes + CLOSED_BOX);
}

static void rays_that_leak_through_a_crumpled_ball_of_moeller_and_trumbore_do_not_leak_through_ours(void **state) {
    (void)state;
    check_leaks(closed_meshes + CLOSED_CRUMPLED);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_triangle_touches_the_boxes_that_it_meets),
        cmocka_unit_test(nearest_hits_on_random_triangles_are_those_of_the_loop_over_all),
        cmocka_unit_test(nearest_hits_on_whole_numbers_are_those_of_the_loop_over_all),
        cmocka_unit_test(rays_that_leak_through_a_ball_of_moeller_and_trumbore_do_not_leak_through_ours),
        cmocka_unit_test(rays_that_leak_through_a_box_of_moeller_and_trumbore_do_not_leak_through_ours),
        cmocka_unit_test(rays_that_leak_through_a_crumpled_ball_of_moeller_and_trumbore_do_not_leak_through_ours),
    };
    return cmocka_run_group_tests_name("octree", tests, open_device, close_device);
}
