/* The reference with lights that are not points, and filters, against what can be computed without it: form factors of squares,
 * geometric series, integrals of pictures of skies, means over pixels (reference_checks.h). */
#include "reference_checks.h"

/* Hottel's form factor from a point to a rectangle a x b in a parallel plane c away, a corner of which is right opposite. */
static double corner_factor(double a, double b, double c) {
    const double x = a / c, y = b / c, p = sqrt(1 + x * x), q = sqrt(1 + y * y);
    return (x / p * atan(y / p) + y / q * atan(x / q)) / (2 * LAB_PI);
}

static double opposite_factor(double x, double y) {
    return corner_factor(x, y, 1) + corner_factor(1 - x, y, 1) + corner_factor(x, 1 - y, 1) + corner_factor(1 - x, 1 - y, 1);
}

/* A square that shines, one above another that it lights. */
static void a_square_lights_another_as_their_form_factor_says(void **state) {
    (void)state;
    enum { SIDE = 24 };
    static const float high[3] = {-0.5f, 0.5f, -0.5f};
    const float albedo = 0.7f;
    double wanted[SIDE * SIDE];
    room *r = room_empty(albedo);
    reference_lab l;
    add_floor(r);
    room_quad(r, high, x_axis, z_axis, 1);
    lab_open(&l, r, SIDE, 0, 1);
    emits(&l, 1, 2, 1);
    see_floor(&l, origin);
    l.in.max_samples = 256;
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        wanted[i] = (double)albedo * 2 * opposite_factor((i % SIDE + 0.5) / SIDE, (i / SIDE + 0.5) / SIDE);
    expect_pixels("floor under a shining square", &l, 1, wanted);
    /* Seen, but not among the lights. */
    emits(&l, 1, 2, 0);
    reference f = lab_render(&l, 0);
    for (uint32_t i = 0; i < 3 * SIDE * SIDE; i++)
        assert_true(f.direct[i] == 0 && f.unlimited[i] == 0);
    reference_free(&f);
    lab_close(&l);
}

/* Closed rooms whose walls all shine by e and reflect rho of it: each reflection adds rho^k e; without end, all is e / (1 -
 * rho). */
static void walls_that_shine_make_a_geometric_series(void **state) {
    (void)state;
    enum { SIDE = 12, BOUNCES = 4 };
    static const float eye[3] = {0.1f, 0.05f, -0.2f}, corner[3] = {-1, 1, -1}, right[3] = {2, 0, 0}, down[3] = {0, -2, 0};
    reference_lab l;
    const double rho = 0.5, e = 3;
    double direct = 0, limited = 0, unlimited = 0;
    lab_open(&l, room_closed((float)rho), SIDE, 0, BOUNCES);
    for (uint32_t w = 0; w < WALLS; w++)
        emits(&l, w, (float)e, 1);
    lab_look(&l, 0, eye, corner, right, down);
    l.in.max_samples = 512;
    reference f = lab_render(&l, 0);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        direct += f.direct[3 * i] / (SIDE * SIDE);
        limited += f.limited[3 * i] / (SIDE * SIDE);
        unlimited += f.unlimited[3 * i] / (SIDE * SIDE);
    }
    expect("room of shining walls: emission and direct light", direct, e + rho * e);
    expect("room of shining walls: 3 reflections of it", limited, e * (rho * rho + pow(rho, 3) + pow(rho, 4)));
    expect("room of shining walls: all", direct + unlimited, e / (1 - rho));
    reference_free(&f);
    lab_close(&l);
}

/* Under a constant sky, a direction, ambient light: nothing is random. */
static void floors_under_open_skies(void **state) {
    (void)state;
    enum { SIDE = 8 };
    static const float eye[3] = {0.1f, 0.4f, 0.2f};
    const float down[3] = {0.6f, -0.8f, 0};
    reference_lab l;
    room *r = room_empty(0.6f);
    add_floor(r);
    lab_open(&l, r, SIDE, 1, 2);
    see_floor(&l, eye);
    l.meta.lights = 0;
    sky_of(&l, 2);
    reference f = lab_render(&l, 0);
    expect_within("floor under a constant sky", lab_irradiance(&f, f.direct, 1, (double)0.6f), LAB_PI * 4, EXACT);
    assert_true(f.error < 1e-12);
    reference_free(&f);
    l.meta.effects = 0;
    f = lab_render(&l, 0);
    assert_true(lab_irradiance(&f, f.direct, 1, 1) == 0);
    reference_free(&f);
    l.meta.ambient[0] = 0.5f;
    f = lab_render(&l, 0);
    expect_within("floor in ambient light alone", lab_irradiance(&f, f.direct, 0, (double)0.6f), LAB_PI * 0.5, EXACT);
    reference_free(&f);
    l.meta.ambient[0] = 0;
    l.meta.lights = 1;
    for (uint32_t i = 0; i < LAB_FRAMES; i++)
        l.lights[i] = (vit_light){.kind = VIT_LIGHT_DIRECTIONAL,
                                  .position = {0, 50, 0},
                                  .direction = {down[0], down[1], down[2]},
                                  .cos_outer = 1,
                                  .spot_scale = 2,
                                  .intensity = {5, 6, 7}};
    f = lab_render(&l, 0);
    expect_within("floor in light of a direction", lab_irradiance(&f, f.direct, 2, (double)0.6f), 7 * 0.8, EXACT);
    reference_free(&f);
    lab_close(&l);
}

enum { SKY = 32 };

/* The direction of a place in the octahedral square, -1..1: Cigolle et al. 2014. */
static void sky_direction(double u, double v, double d[3]) {
    const double z = 1 - fabs(u) - fabs(v);
    d[0] = z < 0 ? (1 - fabs(v)) * (u < 0 ? -1 : 1) : u;
    d[1] = z < 0 ? (1 - fabs(u)) * (v < 0 ? -1 : 1) : v;
    d[2] = z;
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int k = 0; k < 3; k++)
        d[k] /= length;
}

/* Irradiance of the picture on a floor, by quadrature over the sphere in latitude and longitude: another way than the
 * reference's. */
static double sky_irradiance(const vit_sky_texel *picture) {
    enum { STEPS = 1500 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < 2 * STEPS; j++) {
            const double theta = (i + 0.5) / STEPS * LAB_PI / 2, phi = (j + 0.5) / STEPS * LAB_PI;
            const double d[3] = {sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi)};
            const double size = fabs(d[0]) + fabs(d[1]) + fabs(d[2]), x = d[0] / size, y = d[1] / size;
            const double u = d[2] < 0 ? (1 - fabs(y)) * (x < 0 ? -1 : 1) : x,
                         v = d[2] < 0 ? (1 - fabs(x)) * (y < 0 ? -1 : 1) : y;
            const double px = (u + 1) / 2 * SKY - 0.5, py = (v + 1) / 2 * SKY - 0.5, fx = px - floor(px), fy = py - floor(py);
            const vit_sky_texel *t = picture + ((int)floor(py) + 1) * (SKY + 2) + (int)floor(px) + 1;
            const double radiance = (1 - fy) * ((1 - fx) * (double)t[0].radiance[0] + fx * (double)t[1].radiance[0]) +
                                    fy * ((1 - fx) * (double)t[SKY + 2].radiance[0] + fx * (double)t[SKY + 3].radiance[0]);
            sum += radiance * cos(theta) * sin(theta) * LAB_PI / 2 / STEPS * LAB_PI / STEPS;
        }
    return sum;
}

/* A picture of a smooth sky with a sun of two texels, which alone gives most of the light. */
static void a_floor_under_a_picture_of_the_sky(void **state) {
    (void)state;
    enum { SIDE = 32 };
    static const float eye[3] = {0.1f, 0.4f, 0.2f};
    static vit_sky_texel picture[(SKY + 2) * (SKY + 2)];
    double wanted[SIDE * SIDE];
    reference_lab l;
    room *r = room_empty(0.6f);
    add_floor(r); /* 1. the picture and its gutter */
    for (int y = -1; y <= SKY; y++)
        for (int x = -1; x <= SKY; x++) {
            double d[3];
            /* Beyond an edge the picture goes on on the other half of that edge. */
            const int inside = x >= 0 && x < SKY && y >= 0 && y < SKY,
                      sx = inside ? x
                                  : SKY - 1 -
                                        (x < 0      ? 0
                                         : x >= SKY ? SKY - 1
                                                    : x),
                      sy = inside ? y
                                  : SKY - 1 -
                                        (y < 0      ? 0
                                         : y >= SKY ? SKY - 1
                                                    : y);
            const int ix = !inside && x >= 0 && x < SKY ? sx
                           : x < 0                      ? 0
                           : x >= SKY                   ? SKY - 1
                                                        : x,
                      iy = !inside && y >= 0 && y < SKY ? sy
                           : y < 0                      ? 0
                           : y >= SKY                   ? SKY - 1
                                                        : y;
            sky_direction(2 * (ix + 0.5) / SKY - 1, 2 * (iy + 0.5) / SKY - 1, d);
            vit_sky_texel *t = picture + (y + 1) * (SKY + 2) + x + 1;
            for (int k = 0; k < 3; k++)
                t->radiance[k] = (float)(1 + 0.5 * d[1] + 0.3 * d[0]) * (float)(k + 1);
            if (iy == 26 && (ix == 14 || ix == 15))
                t->radiance[0] = 4000;
        }
    lab_open(&l, r, SIDE, 0, 2);
    see_floor(&l, eye); /* 2. the floor under it, against the sum over the picture's texels */
    l.meta.effects = VIT_BIT(SKY_LIGHT) | VIT_BIT(SKY_IMAGE);
    l.meta.sky_size = SKY;
    l.sections.data[VIT_SECTION_SKYT] = picture;
    l.in.max_samples = 2048;
    const double irradiance = sky_irradiance(picture);
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        wanted[i] = (double)0.6f / LAB_PI * irradiance;
    expect_pixels("floor under a picture of a sky with a sun", &l, 1, wanted);
    lab_close(&l);
}

/* An edge through pixels, under a box and under a tent. */
static void pixels_are_means_under_their_filter(void **state) {
    (void)state;
    enum { SIDE = 8 };
    static const float wall[3] = {-0.5f, -0.5f, -1}, up[3] = {0, 1, 0}, eye[3] = {0, 0, 0}, corner[3] = {-0.5f, 0.5f, -1},
                       down[3] = {0, -1, 0};
    const double edge = 0.4375 - 0.03; /* m; pixel 3 is 0.375 .. 0.5 of the way */
    for (int tent = 0; tent < 2; tent++) {
        reference_lab l;
        double wanted[SIDE * SIDE];
        const float wide[3] = {(float)edge, 0, 0};
        room *r = room_empty(0);
        room_quad(r, wall, wide, up, 0);
        lab_open(&l, r, SIDE, 0, 1);
        lab_look(&l, 0, eye, corner, x_axis, down);
        emits(&l, 0, 4, 0);
        l.meta.background[0] = 1;
        l.meta.copies = 4;
        l.meta.offset[2][1] = tent ? -0.75f : 0.5f;
        l.in.max_samples = 2048;
        reference f = lab_render(&l, 0);
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            const double at = edge * SIDE - (i % SIDE + 0.5); /* of the edge, pixels from the centre */
            const double a = fmin(fmax(at, -1), 1), box = fmin(fmax(at + 0.5, 0), 1),
                         tented = a < 0 ? 0.5 * (1 + a) * (1 + a) : 1 - 0.5 * (1 - a) * (1 - a);
            wanted[i] = 1 + 3 * box;
            /* The frame's left, upper and lower edges are the wall's too: an eighth of a tent lies beyond. */
            const bool first = i / SIDE == 0 || i / SIDE == SIDE - 1;
            if (tent)
                wanted[i] = 1 + 3 * (tented - (i % SIDE == 0 ? 0.125 : 0)) * (first ? 0.875 : 1);
            const double error = sqrt(f.direct_variance[3 * i]);
            if (!(fabs(f.direct[3 * i] - wanted[i]) <
                  8 * error + 2e-3)) /* strata in a row of pixels may err alike: no error is seen then */
                fail_msg("pixel %u: %g, wanted %g, standard error %g", i, f.direct[3 * i], wanted[i], error);
        }
        double sum = 0, all = 0;
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            sum += f.direct[3 * i];
            all += wanted[i];
        }
        expect(tent ? "an edge under tents" : "an edge in boxes", sum, all);
        reference_free(&f);
        lab_close(&l);
    }
}

/* The worst of all is a row of the catalogue. */
static int end_with_the_row(void **state) {
    (void)state;
    checks_row("area lights; skies; filters: of what is allowed");
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_square_lights_another_as_their_form_factor_says),
        cmocka_unit_test(walls_that_shine_make_a_geometric_series),
        cmocka_unit_test(floors_under_open_skies),
        cmocka_unit_test(a_floor_under_a_picture_of_the_sky),
        cmocka_unit_test(pixels_are_means_under_their_filter),
    };
    return cmocka_run_group_tests_name("reference lights", tests, NULL, end_with_the_row);
}
