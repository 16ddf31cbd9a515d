/* Triangle and attribute records. The decoder here is written anew from the formula in octahedral.h, in float, as the kernels
 * do it; the error bound of the normals is measured over directions that include the octahedron's edges and corners, where
 * encoders err. */
#include "geometry/bvh.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define NORMAL_ERROR 5e-5 /* radians; octahedral.h states it */

static void decode(vit_u32 word, float n[3]) {
    const float x = (float)(int16_t)(word & 0xffffu) / 32767.0f, y = (float)(int16_t)(word >> 16) / 32767.0f;
    n[0] = x;
    n[1] = y;
    n[2] = (1.0f - fabsf(x)) - fabsf(y);
    if (n[2] < 0.0f) {
        n[0] = (1.0f - fabsf(y)) * (x < 0.0f ? -1.0f : 1.0f);
        n[1] = (1.0f - fabsf(x)) * (y < 0.0f ? -1.0f : 1.0f);
    }
    const float l = sqrtf((n[0] * n[0] + n[1] * n[1]) + n[2] * n[2]);
    for (int k = 0; k < 3; k++)
        n[k] /= l;
}

static double angle(const float a[3], const float b[3]) {
    const double dx = (double)a[0] - (double)b[0], dy = (double)a[1] - (double)b[1], dz = (double)a[2] - (double)b[2];
    return 2.0 * asin(0.5 * sqrt(dx * dx + dy * dy + dz * dz));
}

/* `triangles` triangles with vertices of their own; the order is reversed, so that leaf order is seen to be used. */
typedef struct fixture {
    model m;
    bvh b;
} fixture;

static fixture make(uint32_t triangles) {
    fixture f = {.m = {.vertices = 3 * triangles, .triangles = triangles}};
    f.m.position = calloc(9 * (size_t)triangles, sizeof(float));
    f.m.normal = calloc(9 * (size_t)triangles, sizeof(float));
    f.m.uv = calloc(6 * (size_t)triangles, sizeof(float));
    f.m.index = calloc(3 * (size_t)triangles, sizeof(uint32_t));
    f.m.material = calloc(triangles, sizeof(uint32_t));
    f.m.materials = calloc(triangles, sizeof(model_material));
    f.b.order = calloc(triangles, sizeof(uint32_t));
    assert_true(f.m.position && f.m.normal && f.m.uv && f.m.index && f.m.material && f.m.materials && f.b.order);
    for (uint32_t i = 0; i < triangles; i++) {
        f.b.order[i] = triangles - 1 - i;
        f.m.material[i] = i;
        for (uint32_t c = 0; c < 3; c++) {
            const uint32_t v = 3 * i + c;
            f.m.index[v] = v;
            const float p[3] = {(float)i + (c == 1 ? 0.3f : 0.0f), c == 2 ? 0.7f : 0.0f, 0.1f * (float)c};
            memcpy(f.m.position + 3 * (size_t)v, p, sizeof p);
            f.m.normal[3 * (size_t)v + 2] = 1.0f;
            f.m.uv[2 * (size_t)v] = 0.25f * (float)v - 3.0f;
            f.m.uv[2 * (size_t)v + 1] = 17.5f;
        }
    }
    return f;
}

static void drop(fixture *f) {
    free(f->m.position);
    free(f->m.normal);
    free(f->m.uv);
    free(f->m.index);
    free(f->m.material);
    free(f->m.materials);
    free(f->b.order);
}

static geometry pack(const fixture *f) {
    geometry g;
    vit_text why = {""};
    if (geometry_pack(&f->m, &f->b, &g, &why) != VIT_OK)
        fail_msg("%s", why.text);
    return g;
}

static void normals_of_the_triangle_itself_are_not_interpolated(void **state) {
    (void)state;
    fixture f = make(2);
    geometry g = pack(&f);
    const vit_triangle *t = &g.triangles[0]; /* triangle 1 of the mesh */
    const float length = sqrtf(t->nx * t->nx + t->ny * t->ny + t->nz * t->nz);
    for (int c = 3; c < 6; c++) { /* one of them turned round */
        const float sign = c == 4 ? -1.0f : 1.0f, n[3] = {sign * t->nx / length, sign * t->ny / length, sign * t->nz / length};
        memcpy(f.m.normal + (size_t)3 * (size_t)c, n, sizeof n);
    }
    geometry_free(&g);
    g = pack(&f);
    assert_int_equal(g.attributes[0].material, 1);
    assert_int_equal(g.attributes[1].material, VIT_TRIANGLE_SMOOTH);
    geometry_free(&g);
    drop(&f);
}

static void records_follow_the_leaf_order_with_exact_vertices(void **state) {
    (void)state;
    fixture f = make(5);
    geometry g = pack(&f);
    for (uint32_t i = 0; i < 5; i++) {
        const uint32_t t = 4 - i;
        assert_memory_equal(g.triangles[i].v0, f.m.position + 9 * t, 12);
        assert_memory_equal(g.triangles[i].v1, f.m.position + 9 * t + 3, 12);
        assert_memory_equal(g.triangles[i].v2, f.m.position + 9 * t + 6, 12);
        assert_int_equal(g.attributes[i].material, t | VIT_TRIANGLE_SMOOTH); /* its normals are z, and not its own */
        assert_memory_equal(g.attributes[i].uv, f.m.uv + 6 * t, 24);
        assert_int_equal(g.attributes[i].tangent[0] | g.attributes[i].tangent[1], 0);
    }
    geometry_free(&g);
    drop(&f);
}

static void the_normal_is_exact_where_products_cancel(void **state) {
    (void)state;
    fixture f = make(1);
    /* a.y * b.z - a.z * b.y = (1 + 2^-12)^2 - 1 = 2^-11 + 2^-24; in float the product would lose the last bit */
    const float e = 1.0f + 0x1p-12f, corners[9] = {0, 0, 0, 0, e, 1, 0, 1, e};
    memcpy(f.m.position, corners, sizeof corners);
    geometry g = pack(&f);
    assert_true(g.triangles[0].nx == 0x1p-11f + 0x1p-24f);
    assert_true(g.triangles[0].ny == 0.0f && g.triangles[0].nz == 0.0f);
    geometry_free(&g);
    drop(&f);
}

static double encode_error(fixture *f, const double d[3]) {
    const double l = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const float n[3] = {(float)(d[0] / l), (float)(d[1] / l), (float)(d[2] / l)};
    for (size_t c = 0; c < 3; c++)
        memcpy(f->m.normal + 3 * c, n, sizeof n);
    geometry g = pack(f);
    float back[3];
    decode(g.attributes[0].normal[0], back);
    assert_int_not_equal(g.attributes[0].normal[0] & 0xffffu, 0x8000u); /* -32768 is no snorm16 */
    assert_int_not_equal(g.attributes[0].normal[0] >> 16, 0x8000u);
    const double length =
        sqrt((double)back[0] * (double)back[0] + (double)back[1] * (double)back[1] + (double)back[2] * (double)back[2]);
    assert_true(fabs(length - 1.0) < 3e-7);
    geometry_free(&g);
    return angle(n, back);
}

static void normals_are_right_within_the_stated_angle(void **state) {
    (void)state;
    fixture f = make(1);
    double worst = 0.0;
    const uint32_t n = 300000;
    for (uint32_t i = 0; i < n; i++) { /* Fibonacci points on the sphere */
        const double z = 1.0 - (2.0 * i + 1.0) / n, r = sqrt(1.0 - z * z), phi = 2.399963229728653 * i;
        const double d[3] = {r * cos(phi), r * sin(phi), z};
        worst = fmax(worst, encode_error(&f, d));
    }
    for (uint32_t i = 0; i <= 20000; i++) { /* the folds */
        const double t = -1.0 + i / 10000.0, eps = (i % 5 - 2.0) * 1e-6;
        const double folds[3][3] = {{t, 1.0 - fabs(t), eps}, {t, fabs(t) - 1.0, -eps}, {eps, t, -1.0}};
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, encode_error(&f, folds[k]));
    }
    print_message("worst normal error: %.3g radians\n", worst);
    assert_true(worst < NORMAL_ERROR);
    drop(&f);
}

static void the_six_axes_are_exact(void **state) {
    (void)state;
    fixture f = make(1);
    for (int axis = 0; axis < 6; axis++) {
        double d[3] = {0.0, 0.0, 0.0};
        d[axis % 3] = axis < 3 ? 1.0 : -1.0;
        assert_true(encode_error(&f, d) == 0.0);
    }
    drop(&f);
}

static void rays_start_well_clear_of_rounding_and_scale_with_the_scene(void **state) {
    (void)state;
    fixture f = make(4);
    geometry g = pack(&f);
    const float before = g.ray_offset;
    geometry_free(&g);
    assert_true(before > 0.0f && before < 1e-3f);
    for (uint32_t i = 0; i < 9 * f.m.triangles; i++)
        f.m.position[i] *= 1024.0f;
    g = pack(&f);
    assert_true(g.ray_offset == before * 1024.0f);
    geometry_free(&g);
    for (uint32_t i = 0; i < 3 * f.m.vertices; i++)
        f.m.position[i] = f.m.position[i] / 1024.0f + 8192.0f; /* far from the origin, float is coarser */
    g = pack(&f);
    assert_true(g.ray_offset >= 8192.0f * 0x1p-16f);
    geometry_free(&g);
    drop(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normals_of_the_triangle_itself_are_not_interpolated),
        cmocka_unit_test(records_follow_the_leaf_order_with_exact_vertices),
        cmocka_unit_test(the_normal_is_exact_where_products_cancel),
        cmocka_unit_test(normals_are_right_within_the_stated_angle),
        cmocka_unit_test(the_six_axes_are_exact),
        cmocka_unit_test(rays_start_well_clear_of_rounding_and_scale_with_the_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
