/* What the kernels promise about rays without any other engine: closed meshes let no ray out, and the nearest hit is a function
 * of ray and triangles alone.
 *
 * What makes this hard to test: where it can go wrong has measure zero (vertices, edges, planes that hold the ray, ties), so
 * random rays never go there. Half of these rays are aimed at such places exactly, and meshes on whole numbers make the aim
 * exact in float. The oracle for "ray and triangles alone" is the loop over all triangles, and trees that nobody would build.
 */
#include "ray_trees.h"

#define RAYS (1u << 20)
#define FEW (1u << 16)

/* Origins in a cube of the given half edge around the mesh's middle. Of four rays one goes to a vertex, one to the middle of an
 * edge, two anywhere. */
static ray_set rays_from_inside(const ray_mesh *r, uint32_t count, float half) {
    static const float middle[3] = {3, -2, 5};
    ray_set s = rays_new(count);
    uint64_t state = 7;
    for (uint32_t i = 0; i < s.n; i++) {
        float o[3], d[3];
        random_direction(&state, d);
        const vit_triangle *t = r->packed.triangles + lab_random(&state) % r->m.triangles;
        for (int k = 0; k < 3; k++) {
            o[k] = middle[k] + half * (2 * lab_uniform(&state) - 1);
            const float target = i % 4 == 0 ? t->v0[k] : 0.5f * (t->v0[k] + t->v1[k]);
            if (i % 4 < 2)
                d[k] = target - o[k];
        }
        unit_float(d);
        rays_set(&s, i, o, d, RAY_FAR);
    }
    return s;
}

static void check_closed(mesh_place_fn *place, int squares, uint32_t rays, float half) {
    ray_mesh r;
    mesh_cube(&r, squares, place);
    mesh_bake(&r);
    ray_set s = rays_from_inside(&r, rays, half);
    lab l = lab_open(8, 0, ray_lab_kernels);
    ray_hits h = rays_cast(&l, 8, &r, &s);
    lab_close(&l);
    uint32_t out = 0;
    for (uint32_t i = 0; i < s.n; i++)
        out += h.triangle[i] == VIT_NONE || h.occluded[i] == 0;
    assert_int_equal(out, 0);
    hits_free(&h);
    free(s.plane);
    mesh_free(&r);
}

static void no_ray_leaves_a_closed_ball(void **state) {
    (void)state;
    check_closed(place_ball, 96, RAYS, 5);
}

static void no_ray_leaves_a_closed_box(void **state) {
    (void)state;
    check_closed(place_box, 64, RAYS, 4);
}

static void no_ray_leaves_a_crumpled_ball(void **state) {
    (void)state;
    check_closed(place_crumpled, 96, RAYS / 4, 0.5f);
}

/* Origins on the lattice's points, lines, planes and off them; directions along axes, diagonals, planes, at lattice points and
 * anywhere, with zeros of both signs. */
static ray_set lattice_rays(void) {
    ray_set s = rays_new(FEW);
    uint64_t state = 13;
    for (uint32_t i = 0; i < s.n; i++) {
        float o[3], d[3];
        const uint64_t bits = lab_random(&state);
        random_direction(&state, d);
        for (int k = 0; k < 3; k++) {
            o[k] = 20 * lab_uniform(&state) - 10;
            if (bits >> k & 1)
                o[k] = floorf(o[k]);
            if (i % 4 == 0)
                d[k] = (float)((int)(bits >> (8 + 8 * k) & 15) % 3 - 1);
            if (i % 4 == 1 && (bits >> (3 + k) & 1))
                d[k] = copysignf(0, d[k]);
            if (i % 4 == 2)
                d[k] = (float)((int)(bits >> (8 + 8 * k) & 15) - 8) - o[k];
        }
        if (d[0] == 0 && d[1] == 0 && d[2] == 0)
            d[bits >> 40 & 1] = 1;
        unit_float(d);
        rays_set(&s, i, o, d, i % 5 == 0 ? 5.0f : RAY_FAR);
    }
    return s;
}

/* Through every tree and at every width, the same hits as the loop over all triangles. */
static void check_trees(const ray_mesh *r, const ray_set *s) {
    lab l = lab_open(8, 0, ray_lab_kernels);
    ray_hits all = rays_cast_through(&l, "nearest_of_all", 8, r, r->tree.nodes, r->tree.node_count, s);
    lab_close(&l);
    for (unsigned w = 0; w < LAB_WIDTHS; w++) {
        lab k = lab_open(lab_lanes[w], 0, ray_lab_kernels);
        ray_hits h = rays_cast(&k, lab_lanes[w], r, s);
        hits_equal(&all, &h);
        hits_free(&h);
        for (uint64_t seed = 1; seed <= 2; seed++) {
            odd_tree o = make_odd_tree(r, seed);
            h = rays_cast_through(&k, "nearest_and_any", lab_lanes[w], r, o.nodes, o.count, s);
            hits_equal(&all, &h);
            hits_free(&h);
            free(o.nodes);
        }
        lab_close(&k);
    }
    uint32_t hits = 0;
    for (uint32_t i = 0; i < all.n; i++)
        hits += all.triangle[i] != VIT_NONE;
    assert_in_range(hits, all.n / 4, all.n);
    hits_free(&all);
}

static void rays_in_the_planes_of_triangles_hit_the_same_through_any_tree(void **state) {
    ray_mesh r;
    (void)state;
    make_lattice(&r, 60);
    turn(&r);
    mesh_bake(&r);
    ray_set s = rays_in_planes(&r, FEW);
    check_trees(&r, &s);
    free(s.plane);
    mesh_free(&r);
}

static void the_nearest_hit_depends_on_ray_and_triangles_alone(void **state) {
    ray_mesh r;
    (void)state;
    make_lattice(&r, 60);
    mesh_bake(&r);
    ray_set s = lattice_rays();
    check_trees(&r, &s);
    free(s.plane);
    mesh_free(&r);
}

static void of_coincident_triangles_the_smallest_index_is_hit(void **state) {
    ray_mesh r;
    (void)state;
    make_lattice(&r, 60);
    mesh_bake(&r);
    ray_set s = lattice_rays();
    lab l = lab_open(8, 0, ray_lab_kernels);
    ray_hits h = rays_cast(&l, 8, &r, &s);
    lab_close(&l);
    uint32_t checked = 0;
    for (uint32_t i = 0; i < s.n; i++)
        for (uint32_t j = 0; h.triangle[i] != VIT_NONE && j < r.m.triangles; j++)
            if (j != h.triangle[i] &&
                memcmp(r.packed.triangles + j, r.packed.triangles + h.triangle[i], sizeof(vit_triangle)) == 0) {
                assert_true(h.triangle[i] < j);
                checked++;
            }
    assert_in_range(checked, 1000, s.n);
    hits_free(&h);
    free(s.plane);
    mesh_free(&r);
}

static void a_scene_of_one_triangle_is_hit_and_missed(void **state) {
    static const float origins[][3] = {{0.25f, 0.25f, 1}, {0.25f, 0.25f, 0}, {2, 2, 1}, {0, 0, 1}, {0.5f, 0.5f, 1}, {-1, 0, 0}};
    static const float directions[][3] = {{0, 0, -1}, {0, 0, -1}, {0, 0, -1}, {0, 0, -1}, {0, 0, -1}, {1, 0, 0}};
    static const vit_u32 hit[] = {0, VIT_NONE, VIT_NONE,
                                  0, 0,        VIT_NONE}; /* origin on it: no; beside; vertex; edge; in its plane: no */
    ray_mesh r;
    (void)state;
    mesh_reserve(&r, 3, 1);
    mesh_vertex(&r, 0, 0, 0);
    mesh_vertex(&r, 1, 0, 0);
    mesh_vertex(&r, 0, 1, 0);
    mesh_triangle(&r, 0, 1, 2);
    mesh_bake(&r);
    ray_set s = rays_new(16);
    for (uint32_t i = 0; i < 16; i++)
        rays_set(&s, i, origins[i % 6], directions[i % 6], RAY_FAR);
    for (unsigned w = 0; w < LAB_WIDTHS; w++) {
        lab l = lab_open(lab_lanes[w], 0, ray_lab_kernels);
        ray_hits h = rays_cast(&l, lab_lanes[w], &r, &s);
        for (uint32_t i = 0; i < 16; i++) {
            assert_int_equal(h.triangle[i], hit[i % 6]);
            assert_int_equal(h.occluded[i], hit[i % 6] == 0 ? ~0u : 0);
            assert_true(h.distance[i] == (hit[i % 6] == 0 ? 1.0f : RAY_FAR));
        }
        hits_free(&h);
        lab_close(&l);
    }
    free(s.plane);
    mesh_free(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_ray_leaves_a_closed_ball),
        cmocka_unit_test(no_ray_leaves_a_closed_box),
        cmocka_unit_test(no_ray_leaves_a_crumpled_ball),
        cmocka_unit_test(the_nearest_hit_depends_on_ray_and_triangles_alone),
        cmocka_unit_test(rays_in_the_planes_of_triangles_hit_the_same_through_any_tree),
        cmocka_unit_test(of_coincident_triangles_the_smallest_index_is_hit),
        cmocka_unit_test(a_scene_of_one_triangle_is_hit_and_missed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
