/* Shadow rays that start on surfaces: do they hit the surface that they leave?
 *
 * What can go wrong: a hit's position is wrong by some ulps of the largest coordinate, so it may lie behind the surface, and a
 * ray from there is blocked at once: acne. The baker moves starts off by ray_offset (bake/geometry/geometry.c), at least 2^-16
 * of the largest coordinate and 1e-5 of the scene's diagonal. The room is a turned box with convex inside: between two places
 * in it nothing is in the way, so whatever blocks is wrong. The bound is none, at each scale from 1e-4 to 1e6 m, and moved from
 * the origin by up to 1000 times the room's size. One thing remains: a hit within some ulps of an edge may lie behind the next
 * wall, which its own wall's normal does not move it away from; such places are as rare as they are thin, and the row says how
 * thin. Farther off, positions have too few bits left: the offset is a part of the room (1.6 % at 1000 sizes) and at 2^16 sizes
 * it is all of it; the sweep shows it. */
#include "catalogue.h"
#include "host_rays.h"

#define RAYS (1u << 15)

static double scale_of, shift_of;

static void turned_box(float p[3]) {
    static const double m[3][3] = {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}};
    const double q[3] = {(double)p[0] * 0.7, (double)p[1] * 0.4, (double)p[2] * 0.5};
    for (int k = 0; k < 3; k++)
        p[k] = (float)(scale_of * (m[k][0] * q[0] + m[k][1] * q[1] + m[k][2] * q[2] + shift_of * (k == 1 ? -0.7 : 1.0)));
}

/* A place in the room: between its middle and a random point of its surface, `depth` of the way. */
static void place_within(const ray_mesh *r, uint64_t *state, double depth, float p[3]) {
    const vit_triangle *t = r->packed.triangles + lab_random(state) % r->m.triangles;
    float b1, b2, q[3];
    triangle_place(state, 3, &b1, &b2);
    triangle_point(t, b1, b2, q);
    for (int k = 0; k < 3; k++) {
        const double middle = scale_of * shift_of * (k == 1 ? -0.7 : 1.0);
        p[k] = (float)(middle + depth * ((double)q[k] - middle));
    }
}

static float towards(const float o[3], const float p[3], float d[3]) {
    double l2 = 0;
    for (int k = 0; k < 3; k++) {
        d[k] = p[k] - o[k];
        l2 += (double)d[k] * (double)d[k];
    }
    unit_float(d);
    return (float)sqrt(l2);
}

/* Of RAYS places on the surface, those that do not see a place within the room: because of the wall that they are on, or
 * because of another one; those are near its edge, and `edge` is how far the farthest was from it. */
typedef struct blocked {
    uint64_t own, other;
    double edge; /* of the largest coordinate */
} blocked;

/* Distance of p from the plane of a triangle, m. */
static double plane_distance(const vit_triangle *t, const float p[3]) {
    const double n[3] = {(double)t->nx, (double)t->ny, (double)t->nz}, l = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    double sum = 0;
    for (int k = 0; k < 3; k++)
        sum += n[k] / l * ((double)p[k] - (double)t->v0[k]);
    return fabs(sum);
}

static void judge(blocked *b, const ray_mesh *r, uint32_t by, const float face[3], const float o[3]) {
    const vit_triangle *t = r->packed.triangles + by;
    float n[3] = {t->nx, t->ny, t->nz};
    unit_float(n);
    if (fabsf(n[0] * face[0] + n[1] * face[1] + n[2] * face[2]) > 0.5f)
        b->own++;
    else {
        b->other++;
        b->edge = fmax(b->edge, plane_distance(t, o) / ((double)r->tree.box_pad * 0x1p20));
    }
}

/* Rays to the surface; from there to places within; what was in the way. */
static blocked try_room(double size, double shift) {
    ray_mesh r;
    vit_scene constants;
    uint64_t state = 41;
    blocked b = {0};
    scale_of = size;
    shift_of = shift;
    mesh_cube(&r, 1, turned_box);
    mesh_bake(&r);
    const host_lab_mesh m = host_mesh(&r, &constants);
    ray_set s = rays_new(RAYS);
    for (uint32_t i = 0; i < s.n; i++) {
        float o[3], p[3], d[3];
        place_within(&r, &state, 0.5, o);
        place_within(&r, &state, 1.0, p);
        (void)towards(o, p, d);
        rays_set(&s, i, o, d, RAY_FAR);
    }
    ray_hits h = host_cast(&m, &s);
    float *surface = ray_lab_array(12 * (size_t)s.n, sizeof(float));
    host_lab_find()->surfaces(&m, s.plane, h.distance, h.triangle, s.n, surface);
    for (uint32_t i = 0; i < s.n; i++) {
        float o[3], p[3], d[3];
        for (size_t k = 0; k < 3; k++)
            o[k] = surface[k * s.n + i];
        place_within(&r, &state, 0.95 * (double)lab_uniform(&state), p);
        const float far = towards(o, p, d);
        rays_set(&s, i, o, d, h.triangle[i] == VIT_NONE ? RAY_NOT_CAST : far);
    }
    host_lab_find()->nearest(&m, s.plane, s.n, h.distance, h.triangle, h.occluded);
    for (uint32_t i = 0; i < s.n; i++) {
        float o[3], d[3], face[3];
        rays_get(&s, i, o, d);
        for (size_t k = 0; k < 3; k++)
            face[k] = surface[(3 + k) * s.n + i];
        if (rays_limit(&s)[i] == RAY_NOT_CAST)
            b.own++;
        else if (h.triangle[i] != VIT_NONE)
            judge(&b, &r, h.triangle[i], face, o);
    }
    free(surface);
    hits_free(&h);
    free(s.plane);
    mesh_free(&r);
    return b;
}

static void no_surface_shadows_itself_at_any_scale(void **state) {
    uint64_t own = 0, other = 0, count = 0;
    (void)state;
    for (double size = 1e-4; size <= 1.1e6; size *= 10, count += RAYS) {
        const blocked b = try_room(size, 0);
        own += b.own;
        other += b.other;
    }
    catalogue_none("self-hits", "rooms of 1e-4 to 1e6 m: rays blocked by the surface they leave", own, count, "rays");
    catalogue_none("self-hits", "rooms of 1e-4 to 1e6 m: rays blocked by the next wall", other, count, "rays");
}

static void no_surface_shadows_itself_within_1000_sizes_of_the_origin(void **state) {
    uint64_t own = 0, other = 0, count = 0;
    double edge = 0;
    (void)state;
    for (double size = 1e-4; size <= 1.1e3; size *= 1e3)
        for (double shift = 1; shift <= 1e3; shift *= 10, count += RAYS) {
            const blocked b = try_room(size, shift);
            own += b.own;
            other += b.other;
            edge = fmax(edge, b.edge);
        }
    catalogue_none("self-hits", "1 to 1000 sizes from the origin: rays blocked by the surface they leave", own, count, "rays");
    (void)printf("%llu of %llu rays blocked by the next wall\n", (unsigned long long)other, (unsigned long long)count);
    catalogue_row("self-hits", "1 to 1000 sizes off: how near the edge is where the next wall blocks", edge, 0x1p-22,
                  "of the largest coordinate");
}

static void farther_off_the_offset_swallows_the_room(void **state) {
    catalogue_point p[32];
    size_t n = 0;
    double first = 0;
    (void)state;
    for (double shift = 1; shift <= 1.1e6; shift *= 2, n++) {
        const blocked b = try_room(1, shift);
        p[n] = (catalogue_point){shift, (double)(b.own + b.other) / RAYS};
        first = first == 0 && b.own > 0 ? shift : first;
    }
    (void)printf("the first surface shadows itself at %g sizes from the origin\n", first);
    catalogue_sweep("offset", "distance from the origin (sizes of the room)", "shadow rays blocked by mistake (fraction)", p,
                    n);
    assert_true(first > 1000);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_surface_shadows_itself_at_any_scale),
        cmocka_unit_test(no_surface_shadows_itself_within_1000_sizes_of_the_origin),
        cmocka_unit_test(farther_off_the_offset_swallows_the_room),
    };
    return cmocka_run_group_tests_name("self-hits", tests, NULL, NULL);
}
