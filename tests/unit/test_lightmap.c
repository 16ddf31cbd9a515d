/* Baked light of the sky and of area lights, at places and as a lightmap.
 *
 * Strategy: places where light is known in closed form, open, beside a wall without end, and under a rectangular lamp down to a
 * hundredth of its edge; and a room in which all that is found must not depend on threads. */
#include "photon_lab.h"
#include "radiosity/lightmap.h"
#include "radiosity/soft_light.h"

#define PI 3.14159265358979324
enum { LAMP = WALLS };

/* The side of the first triangle of a material that faces upwards, and a place on it. */
static uint32_t place_of(const lab *l, uint32_t material, float x, float y, float z, float *b1, float *b2) {
    for (uint32_t t = 0; t < l->r->m.triangles; t++) {
        const vit_triangle *q = l->r->g.triangles + t;
        if ((l->r->g.attributes[t].material & VIT_MATERIAL_INDEX) != material)
            continue;
        const vec3 a = vec3_load(q->v0), e1 = vec3_sub(vec3_load(q->v1), a), e2 = vec3_sub(vec3_load(q->v2), a),
                   p = vec3_sub((vec3){x, y, z}, a);
        const double d11 = (double)vec3_dot(e1, e1), d12 = (double)vec3_dot(e1, e2), d22 = (double)vec3_dot(e2, e2),
                     a1 = (double)vec3_dot(p, e1), a2 = (double)vec3_dot(p, e2), det = d11 * d22 - d12 * d12;
        *b1 = (float)((d22 * a1 - d12 * a2) / det);
        *b2 = (float)((d11 * a2 - d12 * a1) / det);
        if (*b1 >= 0.0f && *b2 >= 0.0f && *b1 + *b2 <= 1.0f)
            return 2 * t + (q->ny < 0.0f);
    }
    fail_msg("no triangle there");
    return 0;
}

static void open_lit(lab *l, room *r, float lamp) {
    room_finish(r, 0, 2);
    for (int k = 0; k < 3; k++)
        r->materials[LAMP].emission[k] = lamp;
    r->materials[LAMP].lights = lamp > 0.0f;
    l->r = r;
    l->scene = room_scene(r);
    assert_true(photon_rays_open(&l->scene, 1, &l->rays));
}

static double light_at(const lab *l, const area_lights *area, const environment *sky, float x, float y, float z) {
    const soft_lights s = {.rays = &l->rays, .geometry = &l->r->g, .area = area, .sky = sky, .error = 0.002f};
    float b1 = 0.0f, b2 = 0.0f, e[3];
    const uint32_t side = place_of(l, WALL_FLOOR, x, y, z, &b1, &b2);
    (void)soft_light_at(&s, side, b1, b2, e);
    return (double)e[0];
}

static void close_to(double is, double should, double within) {
    if (!(fabs(is / should - 1.0) <= within))
        fail_msg("%.9g should be %.9g within %g", is, should, within);
}

/* A floor of 120 x 120 m, and from x = 0 a wall of 1 m. */
static room *yard(bool wall) {
    room *r = room_empty(0.5f);
    room_quad(r, (const float[]){-60, 0, -60}, (const float[]){0, 0, 120}, (const float[]){120, 0, 0}, WALL_FLOOR);
    if (wall)
        room_quad(r, (const float[]){0, 0, -60}, (const float[]){0, 1, 0}, (const float[]){0, 0, 120}, WALL_LEFT);
    return r;
}

static void an_open_floor_has_pi_times_the_skys_radiance(void **state) {
    (void)state;
    lab l;
    environment sky;
    open_lit(&l, yard(false), 0.0f);
    sky_constant((const double[]){2.0, 1.0, 0.5}, &sky);
    close_to(light_at(&l, NULL, &sky, 3.0f, 0.0f, 5.0f), 2.0 * PI, 1e-5);
    close_lab(&l);
}

static void a_wall_without_end_hides_its_part_of_the_sky(void **state) {
    (void)state;
    lab l;
    environment sky;
    open_lit(&l, yard(true), 0.0f);
    sky_constant((const double[]){1.0, 1.0, 1.0}, &sky);
    for (double d = 0.02; d < 4.0; d *= 1.7)
        close_to(light_at(&l, NULL, &sky, (float)d, 0.0f, 0.3f), PI * (0.5 + 0.5 * d / sqrt(d * d + 1.0)), 0.01);
    close_lab(&l);
}

/* Irradiance by a lamp a x b of radiance 1 above, under its corner: Lambert's formula, e.g. in J. Howell's catalogue, B-4. */
static double under_corner(double a, double b, double h) {
    const double x = a / h, y = b / h, p = sqrt(1 + x * x), q = sqrt(1 + y * y);
    return 0.5 * (x / p * atan(y / p) + y / q * atan(x / q));
}

/* A lamp of 0.6 x 0.4 m, lit below, `h` above the floor: under its middle, its corner and its edge. */
static void a_lamp_over_a_floor_gives_what_its_form_factor_says(void **state) {
    (void)state;
    for (double h = 1.0; h > 0.004; h *= 0.4) {
        room *r = room_empty(0.5f); /* of 2 m: rays leave surfaces by far less than the least height */
        room_wall(r, WALL_FLOOR);
        room_quad(r, (const float[]){0, (float)h - 1.0f, 0}, (const float[]){0.6f, 0, 0}, (const float[]){0, 0, 0.4f}, LAMP);
        lab l;
        open_lit(&l, r, 1.0f);
        area_lights area;
        vit_text why = {""};
        const vit_camera eye = {.eye = {2, 1, 0}};
        assert_int_equal(area_lights_find(&l.scene, &eye, 1, 1, &area, &why), VIT_OK);
        close_to(light_at(&l, &area, NULL, 0.3f, -1.0f, 0.2f), 4 * under_corner(0.3, 0.2, h), 0.02);
        close_to(light_at(&l, &area, NULL, 0.01f, -1.0f, 0.01f),
                 under_corner(0.01, 0.01, h) + under_corner(0.59, 0.01, h) + under_corner(0.01, 0.39, h) +
                     under_corner(0.59, 0.39, h),
                 0.02);
        area_lights_free(&area);
        close_lab(&l);
    }
}

/* The middle of a floor under a lamp, with a post on it, seen from above. */
static void a_lightmap_has_the_same_bytes_on_any_number_of_threads(void **state) {
    (void)state;
    room *r = room_empty(0.5f);
    room_wall(r, WALL_FLOOR);
    room_quad(r, (const float[]){-0.1f, -1, 0}, (const float[]){0, 0.5f, 0}, (const float[]){0.2f, 0, 0}, WALL_LEFT);
    room_quad(r, (const float[]){-0.4f, 0, -0.4f}, (const float[]){0.8f, 0, 0}, (const float[]){0, 0, 0.8f}, LAMP);
    lab l;
    open_lit(&l, r, 1.0f);
    area_lights area;
    environment sky;
    vit_text why = {""};
    vit_camera eye = {.eye = {0, 0.5f, 3}, .corner = {-1, 0.2f, -1.6f}, .right = {2.0f / 64, 0, 0}, .down = {0, -1.6f / 48, 0}};
    const tracks t = {.cameras = &eye};
    sky_constant((const double[]){1.0, 2.0, 3.0}, &sky);
    assert_int_equal(area_lights_find(&l.scene, &eye, 1, 1, &area, &why), VIT_OK);
    lightmap m[2];
    for (unsigned i = 0; i < 2; i++) {
        const lightmap_input in = {.rays = &l.rays,
                                   .geometry = &r->g,
                                   .tracks = &t,
                                   .frames = 1,
                                   .width = 64,
                                   .height = 48,
                                   .area = &area,
                                   .sky = &sky,
                                   .size = 2.0,
                                   .spacing = 8,
                                   .error = 0.15,
                                   .threads = 1 + 2 * i};
        assert_int_equal(lightmap_find(&in, m + i, &why), VIT_OK);
    }
    const receivers *a = &m[0].receivers, *b = &m[1].receivers;
    assert_in_range(a->count, 100, 20000);
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->cell_count, b->cell_count);
    assert_int_equal(a->split_count, b->split_count);
    assert_memory_equal(a->cells, b->cells, a->cell_count * sizeof *a->cells);
    assert_memory_equal(m[0].light, m[1].light, a->count * sizeof *m[0].light);
    assert_true(m[0].rays == m[1].rays && m[0].rays > 0);
    for (uint32_t i = 0; i < a->count; i++) /* as much as the sky and the lamp together could give */
        assert_true(m[0].light[i].irradiance[0] >= 0.0f && m[0].light[i].irradiance[0] <= (float)(2.001 * PI));
    for (int i = 0; i < 2; i++)
        lightmap_free(m + i);
    area_lights_free(&area);
    close_lab(&l);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_open_floor_has_pi_times_the_skys_radiance),
        cmocka_unit_test(a_wall_without_end_hides_its_part_of_the_sky),
        cmocka_unit_test(a_lamp_over_a_floor_gives_what_its_form_factor_says),
        cmocka_unit_test(a_lightmap_has_the_same_bytes_on_any_number_of_threads),
    };
    return cmocka_run_group_tests_name("lightmap", tests, NULL, NULL);
}
