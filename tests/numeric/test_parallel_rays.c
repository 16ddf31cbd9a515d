/* Rays parallel to faces and in their planes, along their edges, and through their corners.
 *
 * What can go wrong: a component of the direction is 0, so that 1 / d is infinite and 0 * infinity in a slab is no number; the
 * ray lies in a box's face, and rounding decides whether it is in the box; the distance to the plane that holds the ray is 0 /
 * 0. Then the hit depends on which boxes stand above a triangle. The bound: the bits of the loop over all triangles, for every
 * ray and tree. (Rays in planes of turned boxes at every width and on OpenCL: tests/golden/test_ray_nearest.c.) */
#include "catalogue.h"
#include "host_rays.h"
#include "ray_trees.h"

/* Origins on a box's corners, edges, faces, whole numbers; directions along axes or in coordinate planes, zeros of both signs,
 * or just off an axis by what vanishes beside 1. */
static ray_set parallel_rays(const ray_mesh *r) {
    ray_set s = rays_new(catalogue_whole() ? 1u << 17 : 1u << 14);
    uint64_t state = 23;
    for (uint32_t i = 0; i < s.n; i++) {
        const vit_triangle *t = r->packed.triangles + lab_random(&state) % r->m.triangles;
        const uint64_t bits = lab_random(&state);
        const uint32_t axis = (uint32_t)(bits % 3);
        float o[3], d[3], b1, b2;
        triangle_place(&state, i, &b1, &b2);
        triangle_point(t, b1, b2, o);
        for (uint32_t k = 0; k < 3; k++) {
            const float zeros[4] = {0.0f, -0.0f, 1e-20f, -1e-38f}, zero = zeros[bits >> (8 + 2 * k) & 3];
            d[k] = k == axis ? (bits >> 20 & 1 ? 1.0f : -1.0f) : zero;
            if (i % 2 && k == (axis + 1) % 3)
                d[k] = (float)((int)(bits >> 24 & 7) - 3);
        }
        unit_float(d);
        for (int k = 0; k < 3; k++) {
            o[k] -= d[k] * (float)(bits >> 32 & 15);
            if (i % 3 == 0)
                o[k] = rintf(o[k]);
        }
        rays_set(&s, i, o, d, i % 5 == 0 ? 5.0f : RAY_FAR);
    }
    return s;
}

/* Rays that hit other triangles, or at other distances, than the loop over all triangles does, through five trees. */
static uint64_t apart_in_five_trees(const ray_mesh *r, const ray_set *s) {
    vit_scene constants;
    host_lab_mesh m = host_mesh(r, &constants);
    ray_hits all = host_cast_at_all(&m, s), h = host_cast(&m, s);
    uint64_t apart = hits_apart(&all, &h), hits = 0;
    for (uint32_t i = 0; i < s->n; i++)
        hits += h.triangle[i] != VIT_NONE;
    assert_in_range(hits, s->n / 4, s->n);
    hits_free(&h);
    for (uint64_t seed = 1; seed <= 4; seed++) {
        odd_tree o = make_odd_tree(r, seed);
        m.nodes = o.nodes;
        h = host_cast(&m, s);
        apart += hits_apart(&all, &h);
        hits_free(&h);
        free(o.nodes);
    }
    hits_free(&all);
    return apart;
}

static void rays_in_faces_hit_what_the_loop_over_all_triangles_hits(void **state) {
    ray_mesh r;
    (void)state;
    make_lattice(&r, 60);
    mesh_bake(&r);
    ray_set s = parallel_rays(&r);
    catalogue_none("rays in faces", "not as the loop over all triangles in 5 trees", apart_in_five_trees(&r, &s),
                   5 * (uint64_t)s.n, "rays");
    free(s.plane);
    mesh_free(&r);
}

static void so_do_rays_in_the_planes_of_turned_boxes(void **state) {
    ray_mesh r;
    (void)state;
    make_lattice(&r, 60);
    turn(&r);
    mesh_bake(&r);
    ray_set s = rays_in_planes(&r, catalogue_whole() ? 1u << 17 : 1u << 14);
    catalogue_none("rays in faces", "in planes of turned boxes: not as the loop over all triangles in 5 trees",
                   apart_in_five_trees(&r, &s), 5 * (uint64_t)s.n, "rays");
    free(s.plane);
    mesh_free(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(rays_in_faces_hit_what_the_loop_over_all_triangles_hits),
                                       cmocka_unit_test(so_do_rays_in_the_planes_of_turned_boxes)};
    return cmocka_run_group_tests_name("parallel rays", tests, NULL, NULL);
}
