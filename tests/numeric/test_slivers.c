/* Closed meshes with triangles of no area, slivers of aspect 1e6, and triangles thinner than an ulp of their coordinates.
 *
 * What can go wrong: a normal is a cross product, and of a sliver nearly all of it would be rounding in float: the distance
 * n . a / n . d may be anything, and a triangle whose normal rounds to 0 cannot be hit at all, so that light comes through
 * where it closes the mesh. The baker computes normals in double (bake/common/triangle.h) and drops triangles that have no area
 * even so; this mesh does the same. The bounds: no ray leaves, since the edge test does not use the normal; and distances are
 * as good as any triangle's, at every aspect (the sweep: flat). What stays open: of a triangle without area whose three
 * vertices are in three places nothing is left but a vertex on its neighbours' edge, where rounding makes cracks; one ray in
 * 1e4 that are aimed at such places finds one. */
#include "catalogue.h"
#include "host_rays.h"
#include "oracle/exact_ray.h"
#include "common/triangle.h"

#define RAYS (1u << 17)
#define SQUARES 24

static double thinnest; /* width of a thin strip over a wide one */

/* Grid lines come in pairs, moved together until they are `thinnest` apart; the outermost stay where they are. */
static double squeezed(double u) {
    const double line = floor((u + 1) * SQUARES / 2 + 0.5), below = floor(line / 2) * 2;
    const double moved = line - below < 0.5 || line > SQUARES - 1.5 ? line : below + 2 * thinnest;
    return moved * 2 / SQUARES - 1;
}

/* Blown up to a ball, so that nothing is parallel to an axis. */
static void thin_ball(float p[3]) {
    double q[3], l2 = 0;
    for (int k = 0; k < 3; k++) {
        q[k] = squeezed((double)p[k]);
        l2 += q[k] * q[k];
    }
    for (int k = 0; k < 3; k++)
        p[k] = (float)(q[k] * 10 / sqrt(l2) + 3 - 2 * k);
}

/* As the importer: triangles whose normal is 0. Returns how many of them had their vertices in three places. */
static uint32_t drop_areas_of_zero(ray_mesh *r) {
    uint32_t collinear = 0;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < r->m.triangles; i++) {
        const uint32_t *c = r->m.index + 3 * (size_t)i;
        const float *v0 = r->m.position + 3 * (size_t)c[0], *v1 = r->m.position + 3 * (size_t)c[1],
                    *v2 = r->m.position + 3 * (size_t)c[2];
        float n[3];
        triangle_normal(v0, v1, v2, n);
        if (n[0] != 0 || n[1] != 0 || n[2] != 0)
            memmove(r->m.index + 3 * (size_t)kept++, c, 3 * sizeof *c);
        else
            collinear += memcmp(v0, v1, sizeof n) != 0 && memcmp(v1, v2, sizeof n) != 0 && memcmp(v2, v0, sizeof n) != 0;
    }
    r->m.triangles = kept;
    return collinear;
}

static ray_set rays_out(const ray_mesh *r) {
    ray_set s = rays_new(RAYS);
    uint64_t state = 31;
    for (uint32_t i = 0; i < s.n; i++) {
        const vit_triangle *t = r->packed.triangles + lab_random(&state) % r->m.triangles;
        float o[3], d[3], b1, b2;
        triangle_place(&state, i, &b1, &b2);
        triangle_point(t, b1, b2, d);
        for (int k = 0; k < 3; k++) {
            o[k] = (float)(3 - 2 * k) + 8 * lab_uniform(&state) - 4;
            d[k] -= o[k];
        }
        unit_float(d);
        rays_set(&s, i, o, d, RAY_FAR);
    }
    return s;
}

typedef struct thin_result {
    uint64_t leaks, collinear; /* rays; triangles dropped though their vertices are in three places */
    double across;             /* largest error of a distance across the surface, of the largest coordinate */
} thin_result;

static thin_result try_width(double width) {
    ray_mesh r;
    vit_scene constants;
    thin_result v = {0};
    thinnest = width;
    mesh_cube(&r, SQUARES, thin_ball);
    v.collinear = drop_areas_of_zero(&r);
    mesh_bake(&r);
    const host_lab_mesh m = host_mesh(&r, &constants);
    ray_set s = rays_out(&r);
    ray_hits h = host_cast(&m, &s);
    v.leaks = hits_leaks(&h);
    for (uint32_t i = 0; i < s.n; i++) {
        float o[3], d[3];
        rays_get(&s, i, o, d);
        if (h.triangle[i] == VIT_NONE)
            continue;
        const vit_triangle *t = r.packed.triangles + h.triangle[i];
        const exact_hit x = exact_cast(t, o, d);
        v.across = fmax(v.across, fabs((double)h.distance[i] - x.t) * x.cosine / ((double)r.tree.box_pad * 0x1p20));
    }
    hits_free(&h);
    free(s.plane);
    mesh_free(&r);
    return v;
}

static thin_result check_width(const char *name, double width) {
    const thin_result v = try_width(width);
    char what[96];
    (void)printf("%s: %llu triangles without area, of three places, dropped\n", name, (unsigned long long)v.collinear);
    (void)snprintf(what, sizeof what, "%s: distance wrong across the surface", name);
    catalogue_row("slivers", what, v.across, 1e-6, "of the largest coordinate");
    if (v.collinear == 0) {
        (void)snprintf(what, sizeof what, "%s: rays out of a closed mesh", name);
        catalogue_none("slivers", what, v.leaks, RAYS, "rays");
    }
    return v;
}

static void slivers_let_no_light_through(void **state) {
    (void)state;
    (void)check_width("aspect 1e3", 1e-3);
    (void)check_width("aspect 1e6", 1e-6);
    (void)check_width("without area", 0);
}

static void where_a_vertex_is_left_on_an_edge_hardly_any_light_comes_through(void **state) {
    (void)state;
    const thin_result ulp = check_width("an ulp wide", 4e-7), half = check_width("half an ulp wide", 1e-7);
    assert_true(ulp.collinear > 0 && half.collinear > 0);
    catalogue_row("slivers", "an ulp wide and less: rays out where vertices are left on edges",
                  (double)(ulp.leaks + half.leaks), 25, "of 262144 rays");
}

static void the_aspect_does_not_matter(void **state) {
    catalogue_point p[16];
    size_t n = 0;
    (void)state;
    for (double width = 0.25; width > 1e-7; width /= 16) {
        const thin_result v = try_width(width);
        p[n++] = (catalogue_point){1 / width, v.across};
    }
    catalogue_sweep("aspect", "aspect", "distance wrong across the surface (of the largest coordinate)", p, n);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slivers_let_no_light_through),
        cmocka_unit_test(where_a_vertex_is_left_on_an_edge_hardly_any_light_comes_through),
        cmocka_unit_test(the_aspect_does_not_matter),
    };
    return cmocka_run_group_tests_name("slivers", tests, NULL, NULL);
}
