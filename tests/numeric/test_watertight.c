/* Rays aimed at vertices, along edges and anywhere from inside closed meshes.
 *
 * What can go wrong: two triangles that share an edge each find the ray just outside themselves, and light comes through. Where
 * it can happen has measure zero, so three rays of four go exactly there. The bound is none at all, because an edge's sign is
 * computed from the same numbers, exactly opposite, in its two triangles (kernels/ray.clh), and a box never rejects what its
 * triangles hold. Packets share a triangle to aim at, so that they are fast: ten million under `make numeric`. */
#include "catalogue.h"
#include "closed_meshes.h"

#define BATCH (1u << 16)

static void check_closed(const closed_mesh *c) {
    const uint32_t batches = catalogue_whole() ? 40 : 8; /* 4 meshes: 10 or 2 million rays */
    ray_mesh r;
    vit_scene constants;
    uint64_t state = 7, leaks = 0;
    mesh_cube(&r, c->squares, c->place);
    mesh_bake(&r);
    const host_lab_mesh m = host_mesh(&r, &constants);
    ray_set s = rays_new(BATCH);
    for (uint32_t i = 0; i < batches; i++) {
        closed_aim(&s, &r, &state, c->half);
        ray_hits h = host_cast(&m, &s);
        leaks += hits_leaks(&h);
        hits_free(&h);
    }
    catalogue_none("watertight", c->what, leaks, (uint64_t)batches * BATCH, "rays");
    free(s.plane);
    mesh_free(&r);
}

static void no_ray_leaves_a_ball(void **state) {
    (void)state;
    check_closed(closed_meshes + CLOSED_BALL);
}

static void no_ray_leaves_a_box(void **state) {
    (void)state;
    check_closed(closed_meshes + CLOSED_BOX);
}

static void no_ray_leaves_a_box_on_whole_numbers(void **state) {
    (void)state;
    check_closed(closed_meshes + CLOSED_LATTICE);
}

static void no_ray_leaves_a_crumpled_ball(void **state) {
    (void)state;
    check_closed(closed_meshes + CLOSED_CRUMPLED);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_ray_leaves_a_ball),
        cmocka_unit_test(no_ray_leaves_a_box),
        cmocka_unit_test(no_ray_leaves_a_box_on_whole_numbers),
        cmocka_unit_test(no_ray_leaves_a_crumpled_ball),
    };
    return cmocka_run_group_tests_name("watertight", tests, NULL, NULL);
}
