/* Surfaces in one place, and surfaces through one another.
 *
 * What can go wrong: two triangles at equal distance, or at distances that rounding makes equal, and the one that is found
 * first wins: then the picture depends on the tree and on the width of packets. The bounds: the same bits through any tree, and
 * of triangles with the same vertices in the same order always the one of smallest index, since they have the same distance to
 * the bit. In another order they have it on whole numbers only; elsewhere normals round apart, and the nearer by some ulps
 * wins, through any tree. Where surfaces cross at a small angle every distance is nearly a tie, so the boxes are turned by
 * little against one another. */
#include "catalogue.h"
#include "host_rays.h"
#include "ray_trees.h"

/* Every triangle a second time: in the same order, with its vertices in turn, wound the other way. */
static void double_triangles(ray_mesh *r) {
    const uint32_t count = r->m.triangles;
    r->m.index = realloc(r->m.index, 6 * (size_t)count * sizeof(uint32_t));
    r->m.material = realloc(r->m.material, 2 * (size_t)count * sizeof(uint32_t));
    assert_non_null(r->m.index);
    assert_non_null(r->m.material);
    memset(r->m.material, 0, 2 * (size_t)count * sizeof(uint32_t));
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t v[3] = {r->m.index[3 * i], r->m.index[3 * i + 1], r->m.index[3 * i + 2]};
        if (i % 3 == 0)
            mesh_triangle(r, v[1], v[2], v[0]);
        if (i % 3 == 1)
            mesh_triangle(r, v[0], v[2], v[1]);
        if (i % 3 == 2)
            mesh_triangle(r, v[0], v[1], v[2]);
    }
}

/* Turns box after box a little further: faces cross at angles down to 1e-6. */
static void turn_boxes(ray_mesh *r) {
    for (uint32_t i = 0; i < r->m.vertices; i++) {
        const double angle = pow(10, -6.0 + (double)(i / 8) * 0.1), c = cos(angle), s = sin(angle);
        float *p = r->m.position + 3 * (size_t)i;
        const double x = (double)p[0], z = (double)p[2];
        p[0] = (float)(c * x - s * z);
        p[2] = (float)(s * x + c * z);
    }
}

static ray_set rays_at(const ray_mesh *r) {
    ray_set s = rays_new(catalogue_whole() ? 1u << 17 : 1u << 15);
    uint64_t state = 29;
    for (uint32_t i = 0; i < s.n; i++) {
        const vit_triangle *t = r->packed.triangles + lab_random(&state) % r->m.triangles;
        float o[3], d[3], b1, b2;
        triangle_place(&state, i, &b1, &b2);
        triangle_point(t, b1, b2, d);
        for (int k = 0; k < 3; k++) {
            o[k] = 24 * lab_uniform(&state) - 12;
            d[k] -= o[k];
        }
        unit_float(d);
        rays_set(&s, i, o, d, RAY_FAR);
    }
    return s;
}

/* Have they the same three vertices, in the same order or in any? */
static bool same_place(const vit_triangle *a, const vit_triangle *b, bool any_order) {
    if (!any_order)
        return memcmp(a, b, sizeof *a) == 0;
    const float *v[3] = {a->v0, a->v1, a->v2}, *w[3] = {b->v0, b->v1, b->v2};
    int found = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            found |= memcmp(v[i], w[k], 3 * sizeof(float)) == 0 ? 1 << i : 0;
    return found == 7;
}

static void check_boxes(const char *what, bool turned) {
    ray_mesh r;
    vit_scene constants;
    make_lattice(&r, 40);
    if (turned)
        turn_boxes(&r);
    double_triangles(&r);
    mesh_bake(&r);
    host_lab_mesh m = host_mesh(&r, &constants);
    ray_set s = rays_at(&r);
    ray_hits all = host_cast_at_all(&m, &s), h = host_cast(&m, &s);
    uint64_t apart = hits_apart(&all, &h), later = 0, pairs = 0;
    for (uint32_t i = 0; i < s.n; i++)
        for (uint32_t j = 0; h.triangle[i] != VIT_NONE && j < r.m.triangles; j++)
            if (j != h.triangle[i] && same_place(r.packed.triangles + j, r.packed.triangles + h.triangle[i], !turned)) {
                later += j < h.triangle[i];
                pairs++;
            }
    hits_free(&h);
    for (uint64_t seed = 1; seed <= 4; seed++) {
        odd_tree o = make_odd_tree(&r, seed);
        m.nodes = o.nodes;
        h = host_cast(&m, &s);
        apart += hits_apart(&all, &h);
        hits_free(&h);
        free(o.nodes);
    }
    char text[96];
    (void)snprintf(text, sizeof text, "%s: other hits in 5 trees", what);
    catalogue_none("coincident surfaces", text, apart, 5 * (uint64_t)s.n, "rays");
    (void)snprintf(text, sizeof text, "%s: not the smallest index", what);
    catalogue_none("coincident surfaces", text, later, pairs, "pairs hit");
    hits_free(&all);
    free(s.plane);
    mesh_free(&r);
}

static void boxes_that_share_faces(void **state) {
    (void)state;
    check_boxes("boxes sharing faces", false);
}

static void boxes_turned_a_little_against_one_another(void **state) {
    (void)state;
    check_boxes("boxes turned by 1e-6 and more", true);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(boxes_that_share_faces),
                                       cmocka_unit_test(boxes_turned_a_little_against_one_another)};
    return cmocka_run_group_tests_name("coincident", tests, NULL, NULL);
}
