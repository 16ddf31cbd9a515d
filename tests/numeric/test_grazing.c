/* Rays that graze surfaces, up to 89.99 degrees from the normal.
 *
 * What can go wrong: along the ray a distance is n . a / n . d, and n . d goes to 0: an error of an ulp in it moves the hit by
 * metres. That cannot be helped, and need not be: measured across the surface, error times cosine, it must stay what rounding
 * the coordinates costs, at every angle, for that is by how much a shadow ray may start behind the surface. The bound is 2^-22
 * of the largest coordinate, four ulps and a quarter of what box_pad grows boxes by; measured against double on a turned box.
 */
#include "catalogue.h"
#include "host_rays.h"
#include "oracle/exact_ray.h"

#define RAYS (1u << 15)

/* A turned box, 100 m wide; rays come from 20 m away at most. */
static void turned_box(float p[3]) {
    static const double m[3][3] = {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}};
    const double q[3] = {50 * (double)p[0], 30 * (double)p[1], 50 * (double)p[2]};
    for (int k = 0; k < 3; k++)
        p[k] = (float)(m[k][0] * q[0] + m[k][1] * q[1] + m[k][2] * q[2] + 7);
}

/* Rays to random triangles, from the front, at `degrees` from their normals. */
static ray_set grazing_rays(const ray_mesh *r, double degrees) {
    ray_set s = rays_new(RAYS);
    uint64_t state = 37;
    for (uint32_t i = 0; i < s.n; i++) {
        const vit_triangle *t = r->packed.triangles + lab_random(&state) % r->m.triangles;
        float n[3] = {t->nx, t->ny, t->nz}, o[3], d[3], p[3], b1, b2;
        triangle_place(&state, 3, &b1, &b2);
        triangle_point(t, b1, b2, p);
        unit_float(n);
        random_direction(&state, d);
        const float along = d[0] * n[0] + d[1] * n[1] + d[2] * n[2], back = 20 * lab_uniform(&state);
        for (int k = 0; k < 3; k++)
            d[k] -= along * n[k];
        unit_float(d);
        for (int k = 0; k < 3; k++)
            d[k] = (float)((double)d[k] * sin(degrees * 0.0174532925) - (double)n[k] * cos(degrees * 0.0174532925));
        unit_float(d);
        for (int k = 0; k < 3; k++)
            o[k] = p[k] - back * d[k];
        rays_set(&s, i, o, d, RAY_FAR);
    }
    return s;
}

typedef struct wrongs {
    double across, along; /* of the largest coordinate; m */
} wrongs;

static wrongs try_angle(const ray_mesh *r, const host_lab_mesh *m, double degrees) {
    ray_set s = grazing_rays(r, degrees);
    ray_hits h = host_cast(m, &s);
    wrongs w = {0};
    uint32_t hits = 0;
    for (uint32_t i = 0; i < s.n; i++) {
        float o[3], d[3];
        rays_get(&s, i, o, d);
        if (h.triangle[i] == VIT_NONE)
            continue;
        hits++;
        const exact_hit x = exact_cast(r->packed.triangles + h.triangle[i], o, d);
        const double off = fabs((double)h.distance[i] - x.t);
        w.across = fmax(w.across, off * x.cosine / ((double)r->tree.box_pad * 0x1p20));
        w.along = fmax(w.along, off);
    }
    assert_true(hits > s.n / 2);
    hits_free(&h);
    free(s.plane);
    return w;
}

static void across_the_surface_no_angle_is_worse_than_another(void **state) {
    static const double degrees[] = {0, 45, 80, 89, 89.9, 89.97, 89.99};
    enum { ANGLES = sizeof degrees / sizeof degrees[0] };
    catalogue_point along[ANGLES];
    ray_mesh r;
    vit_scene constants;
    double across = 0;
    (void)state;
    mesh_cube(&r, 32, turned_box);
    mesh_bake(&r);
    const host_lab_mesh m = host_mesh(&r, &constants);
    for (size_t i = 0; i < ANGLES; i++) {
        const wrongs w = try_angle(&r, &m, degrees[i]);
        along[i] = (catalogue_point){1 / cos(degrees[i] * 0.0174532925), w.along};
        (void)printf("%6.2f degrees: wrong by %.3g of the largest coordinate across the surface, %.3g m along the ray\n",
                     degrees[i], w.across, w.along);
        across = fmax(across, w.across);
    }
    catalogue_sweep("angle", "1 / cosine", "distance wrong along the ray (m)", along, ANGLES);
    catalogue_row("grazing rays", "0 to 89.99 degrees: distance wrong across the surface", across, 0x1p-22,
                  "of the largest coordinate");
    mesh_free(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(across_the_surface_no_angle_is_worse_than_another)};
    return cmocka_run_group_tests_name("grazing", tests, NULL, NULL);
}
