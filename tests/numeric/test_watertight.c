/* Rays aimed at vertices, along edges and anywhere from inside closed meshes.
 *
 * What can go wrong: two triangles that share an edge each find the ray just outside themselves, and light comes through. Where
 * it can happen has measure zero, so three rays of four go exactly there. The bound is none at all, because an edge's sign is
 * computed from the same numbers, exactly opposite, in its two triangles (kernels/ray.clh), and a box never rejects what its
 * triangles hold. Packets share a triangle to aim at, so that they are fast: ten million under `make numeric`. */
#include "catalogue.h"
#include "host_rays.h"

#define BATCH (1u << 16)

/* Whole numbers: every aim is exact. */
static void lattice(float p[3]) {
    p[0] = p[0] * 64 + 3;
    p[1] = p[1] * 32 - 2;
    p[2] = p[2] * 64 + 5;
}

static void aim(ray_set *s, const ray_mesh *r, uint64_t *state, float half) {
    static const float middle[3] = {3, -2, 5};
    const vit_triangle *t = r->packed.triangles;
    for (uint32_t i = 0; i < s->n; i++) {
        float o[3], d[3], b1, b2;
        if (i % HOST_LAB_LANES == 0)
            t = r->packed.triangles + lab_random(state) % r->m.triangles;
        triangle_place(state, i, &b1, &b2);
        triangle_point(t, b1, b2, d);
        for (int k = 0; k < 3; k++) {
            o[k] = middle[k] + half * (2 * lab_uniform(state) - 1);
            if (i % 3 == 0)
                o[k] = rintf(o[k]);
            d[k] -= o[k];
        }
        unit_float(d);
        rays_set(s, i, o, d, RAY_FAR);
    }
}

static void check_closed(const char *what, mesh_place_fn *place, int squares, float half) {
    const uint32_t batches = catalogue_whole() ? 40 : 8; /* 4 meshes: 10 or 2 million rays */
    ray_mesh r;
    vit_scene constants;
    uint64_t state = 7, leaks = 0;
    mesh_cube(&r, squares, place);
    mesh_bake(&r);
    const host_lab_mesh m = host_mesh(&r, &constants);
    ray_set s = rays_new(BATCH);
    for (uint32_t i = 0; i < batches; i++) {
        aim(&s, &r, &state, half);
        ray_hits h = host_cast(&m, &s);
        leaks += hits_leaks(&h);
        hits_free(&h);
    }
    catalogue_none("watertight", what, leaks, (uint64_t)batches * BATCH, "rays");
    free(s.plane);
    mesh_free(&r);
}

static void no_ray_leaves_a_ball(void **state) {
    (void)state;
    check_closed("rays out of a ball", place_ball, 64, 5);
}

static void no_ray_leaves_a_box(void **state) {
    (void)state;
    check_closed("rays out of a box", place_box, 48, 4);
}

static void no_ray_leaves_a_box_on_whole_numbers(void **state) {
    (void)state;
    check_closed("rays out of a box on whole numbers", lattice, 32, 20);
}

static void no_ray_leaves_a_crumpled_ball(void **state) {
    (void)state;
    check_closed("rays out of a crumpled ball", place_crumpled, 64, 0.5f);
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
