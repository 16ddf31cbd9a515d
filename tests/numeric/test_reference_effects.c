/* The reference with mirrors, glass, lobes, lights that are not points, and filters, against what can be computed without it.
 *
 * Closed forms throughout: form factors of squares, Fresnel's equations for a pane and for a slab with all its inner
 * reflections, the lobe's formula, integrals of pictures of skies, and furnaces: where all that can be seen has one radiance,
 * so has everything that reflects or lets through all light. What is drawn at random is held to five times the standard error
 * that the reference states, and that error to a bound, so that no check passes for its noise. */
#include "catalogue.h"
#include "reference/paths.h"
#include "reference_lab.h"
#include <stdio.h>

#define WITHIN 1e-3
#define EXACT 2e-5 /* what is not random: floats, and rays that leave surfaces by an offset */

static double worst;

static void expect_within(const char *what, double found, double wanted, double bound) {
    const double off = wanted != 0 ? fabs(found / wanted - 1) : fabs(found);
    worst = fmax(worst, off / bound * WITHIN);
    printf("%-66s %12.6g, wanted %12.6g: %+.4f %%\n", what, found, wanted,
           wanted != 0 ? 100 * (found / wanted - 1) : 100 * found);
    if (!(off < bound))
        fail_msg("%s: %.8g, wanted %.8g", what, found, wanted);
}

static void expect(const char *what, double found, double wanted) {
    expect_within(what, found, wanted, WITHIN);
}

/* Errors of `frames` frames' direct light in the first channel, pixel by pixel, against `wanted`: their squares over the stated
 * variances, 1 on average; the mean, within 5 standard errors and WITHIN. The frames differ in their random numbers alone. */
static void expect_pixels(const char *what, reference_lab *l, uint32_t frames, const double *wanted) {
    const size_t pixels = (size_t)l->meta.width * l->meta.height;
    double squares = 0, stated = 0, sum = 0, sum_wanted = 0;
    for (uint32_t f = 0; f < frames; f++) {
        l->cameras[f] = l->cameras[0];
        reference r = lab_render(l, f);
        for (size_t i = 0; i < pixels; i++) {
            squares += pow(r.direct[3 * i] - wanted[i], 2);
            stated += r.direct_variance[3 * i];
            sum += r.direct[3 * i];
            sum_wanted += wanted[i];
        }
        reference_free(&r);
    }
    printf("%s: squared errors over the stated variance: %.3f; standard error %.4f %%\n", what, squares / stated,
           100 * sqrt(stated) / sum_wanted);
    expect(what, sum / (double)pixels / frames, sum_wanted / (double)pixels / frames);
    assert_true(stated > 0 && squares / stated > 1 / 1.4 && squares / stated < 1.4);
    assert_true(fabs(sum - sum_wanted) < 5 * sqrt(stated));
}

static const float origin[3] = {0, 0, 0}, x_axis[3] = {1, 0, 0}, z_axis[3] = {0, 0, 1}, back[3] = {0, 0, -1};

static void material_of(reference_lab *l, uint32_t i, uint32_t kind, float specular, float exponent, float ior) {
    vit_material *m = l->room->materials + i;
    m->kind = kind;
    m->exponent = exponent;
    m->ior = ior;
    for (int k = 0; k < 3; k++) {
        m->specular[k] = specular;
        if (kind != VIT_MATTE)
            m->albedo[k] = 0;
    }
}

static void emits(reference_lab *l, uint32_t i, float radiance, uint32_t lights) {
    vit_material *m = l->room->materials + i;
    m->lights = lights;
    for (int k = 0; k < 3; k++)
        m->emission[k] = radiance * (float)(k + 1);
}

static void sky_of(reference_lab *l, float radiance) {
    l->meta.effects |= VIT_BIT(SKY_LIGHT);
    for (int k = 0; k < 3; k++)
        l->meta.background[k] = radiance * (float)(k + 1);
}

/* A floor of the unit square about the origin at y = -1/2, normal up, material 0; frame 0 sees it all from `eye`. */
static const float floor_corner[3] = {-0.5f, -0.5f, 0.5f};

static void add_floor(room *r) {
    room_quad(r, floor_corner, x_axis, back, 0);
}

static void see_floor(reference_lab *l, const float eye[3]) {
    lab_look(l, 0, eye, floor_corner, x_axis, back);
}

/* Where pixel i's ray meets the floor. */
static void floor_point(uint32_t side, uint32_t i, double p[3]) {
    p[0] = -0.5 + (i % side + 0.5) / side;
    p[1] = -0.5;
    p[2] = 0.5 - (i / side + 0.5) / side;
}

/* Hottel's form factor from a point to a rectangle a x b in a parallel plane c away, a corner of which is right opposite. */
static double corner_factor(double a, double b, double c) {
    const double x = a / c, y = b / c, p = sqrt(1 + x * x), q = sqrt(1 + y * y);
    return (x / p * atan(y / p) + y / q * atan(x / q)) / (2 * LAB_PI);
}

static double opposite_factor(double x, double y) {
    return corner_factor(x, y, 1) + corner_factor(1 - x, y, 1) + corner_factor(x, 1 - y, 1) + corner_factor(1 - x, 1 - y, 1);
}

/* The lobe's BRDF over its reflectance, from the formula in records.clh; v, l unit. */
static double lobe(const double n[3], const double v[3], const double l[3], double m) {
    double nv = 0, nl = 0, vl = 0;
    for (int k = 0; k < 3; k++) {
        nv += n[k] * v[k];
        nl += n[k] * l[k];
        vl += v[k] * l[k];
    }
    return (m + 2) / (2 * LAB_PI) * pow(fmax(2 * nv * nl - vl, 0), m);
}

static double unit_to(const double from[3], const double to[3], double d[3]) {
    double length = 0;
    for (int k = 0; k < 3; k++)
        length += (to[k] - from[k]) * (to[k] - from[k]);
    length = sqrt(length);
    for (int k = 0; k < 3; k++)
        d[k] = (to[k] - from[k]) / length;
    return length;
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

/* A mirror shows a wall that shines, by its reflectance. */
static void a_mirror_shows_what_is_before_it(void **state) {
    (void)state;
    enum { SIDE = 8 };
    static const float wall[3] = {-3, 2, -3}, wide[3] = {6, 0, 0}, deep[3] = {0, 0, 6}, eye[3] = {0, 0.5f, 0};
    reference_lab l;
    room *r = room_empty(0.5f);
    add_floor(r);
    room_quad(r, wall, wide, deep, 1);
    lab_open(&l, r, SIDE, 0, 2);
    see_floor(&l, eye);
    material_of(&l, 0, VIT_MIRROR, 0.8f, 1, 1);
    emits(&l, 1, 3, 0);
    reference f = lab_render(&l, 0);
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        expect_within("a mirror's pixel", f.direct[3 * i], (double)0.8f * 3, EXACT);
    reference_free(&f);
    lab_close(&l);
}

/* Fresnel's part at an angle of incidence i, from outside, as in textbooks. */
static double fresnel(double i, double ior) {
    const double t = asin(sin(i) / ior);
    if (i < 1e-6)
        return pow((ior - 1) / (ior + 1), 2);
    return 0.5 * (pow(sin(i - t) / sin(i + t), 2) + pow(tan(i - t) / tan(i + t), 2));
}

/* A floor that shines, seen through glass: a pane, and a slab with light bouncing to and fro in it, some of which it absorbs.
 */
static void glass_lets_through_what_fresnel_leaves(void **state) {
    (void)state;
    enum { SIDE = 16 };
    static const float pane[3] = {-2, 0.25f, 2}, lower[3] = {-2, 0, -2}, wide[3] = {4, 0, 0}, deep[3] = {0, 0, 4},
                       away[3] = {0, 0, -4}, low_wide[3] = {-8, -0.5f, 8}, eye[3] = {0, 1, 0}, wide_floor[3] = {16, 0, 0},
                       deep_floor[3] = {0, 0, -16};
    const double ior = 1.5, absorption = 1.2, thick = 0.25, radiance = 2;
    for (int slab = 0; slab < 2; slab++) {
        reference_lab l;
        double wanted[SIDE * SIDE];
        room *r = room_empty(0);
        room_quad(r, low_wide, wide_floor, deep_floor, 0);
        room_quad(r, pane, wide, away, 1); /* normal up */
        if (slab)
            room_quad(r, lower, wide, deep, 1); /* normal down: out of the glass; the sides are too far off to matter */
        lab_open(&l, r, SIDE, 0, 2);
        see_floor(&l, eye);
        emits(&l, 0, (float)radiance, 0);
        material_of(&l, 1, slab ? VIT_GLASS : VIT_THIN_GLASS, slab ? 1 : 0.9f, 1, (float)ior);
        for (int k = 0; slab && k < 3; k++)
            l.room->materials[1].absorption[k] = (float)absorption;
        l.in.max_samples = 2048;
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            double p[3];
            floor_point(SIDE, i, p);
            const double angle = acos(1.5 / sqrt(p[0] * p[0] + 2.25 + p[2] * p[2])), part = fresnel(angle, ior);
            const double way = thick / cos(asin(sin(angle) / ior)), left = exp(-absorption * way);
            wanted[i] = slab ? radiance * (1 - part) * (1 - part) * left / (1 - part * part * left * left)
                             : radiance * (double)0.9f * (1 - 2 * part / (1 + part));
        }
        expect_pixels(slab ? "through a slab that absorbs" : "through a pane", &l, 1, wanted);
        lab_close(&l);
    }
}

/* A pane between a lamp and the floor: light that went through it is no direct light, and of the runtime's paths of so many
 * hits. */
static void a_pane_lets_a_lamp_through(void **state) {
    (void)state;
    enum { SIDE = 12 };
    static const float pane[3] = {-4, 0.2f, 4}, wide[3] = {8, 0, 0}, away[3] = {0, 0, -8}, eye[3] = {0.1f, 0, 0};
    const double lamp[3] = {0.2, 0.6, -0.1};
    double wanted[SIDE * SIDE] = {0}, sum = 0;
    reference_lab l;
    room *r = room_empty(0.5f);
    add_floor(r);
    room_quad(r, pane, wide, away, 1);
    r->lights[0] = room_point_light((float)lamp[0], (float)lamp[1], (float)lamp[2], 16);
    lab_open(&l, r, SIDE, 1, 2);
    see_floor(&l, eye);
    material_of(&l, 1, VIT_THIN_GLASS, 0.9f, 1, 1.5f);
    reference f = lab_render(&l, 0);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        double p[3], d[3];
        floor_point(SIDE, i, p);
        const double far = unit_to(p, lamp, d), part = fresnel(acos(d[1]), 1.5);
        wanted[i] = 0.5 / LAB_PI * d[1] / far / far * (double)0.9f * (1 - 2 * part / (1 + part));
        expect_within("lamp behind a pane", f.limited[3 * i], wanted[i], 5e-4);
        assert_true(f.direct[3 * i] == 0);
        assert_true(f.unlimited[3 * i] >= f.limited[3 * i]);
    }
    reference_free(&f);
    l.in.bounces = 1; /* paths of one hit end at the pane */
    f = lab_render(&l, 0);
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        sum += f.limited[3 * i];
    assert_true(sum == 0 && f.unlimited[0] > 0);
    reference_free(&f);
    lab_close(&l);
}

/* A glossy floor: of a lamp, exactly its formula; of a constant sky, its integral. */
static void a_lobe_reflects_by_its_formula(void **state) {
    (void)state;
    enum { SIDE = 12, STEPS = 400 };
    static const float eye[3] = {0.3f, 0.2f, 0.4f};
    const double lamp[3] = {-0.2, 0.3, -0.3}, exponent = 40, matt = 0.3, specular = 0.5, n[3] = {0, 1, 0},
                 from[3] = {(double)0.3f, (double)0.2f, (double)0.4f};
    double wanted[SIDE * SIDE], integral = 0;
    reference_lab l;
    room *r = room_empty((float)matt);
    add_floor(r);
    r->lights[0] = room_point_light((float)lamp[0], (float)lamp[1], (float)lamp[2], 16);
    lab_open(&l, r, SIDE, 1, 2);
    see_floor(&l, eye);
    material_of(&l, 0, VIT_MATTE, (float)specular, (float)exponent, 1);
    reference f = lab_render(&l, 0);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        double p[3], v[3], d[3];
        floor_point(SIDE, i, p);
        (void)unit_to(p, from, v);
        const double far = unit_to(p, lamp, d);
        const double radiance = (matt / LAB_PI + specular * lobe(n, v, d, exponent)) * d[1] / far / far;
        expect_within("lamp in a glossy floor", f.direct[3 * i], radiance, 5e-4);
    }
    reference_free(&f);
    l.meta.lights = 0;
    sky_of(&l, 2);
    l.in.max_samples = 1024;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        double p[3], v[3], sum = 0;
        floor_point(SIDE, i, p);
        (void)unit_to(p, from, v);
        for (int a = 0; a < STEPS; a++)
            for (int b = 0; b < STEPS; b++) {
                const double c = (a + 0.5) / STEPS, s = sqrt(1 - c * c), turn = 2 * LAB_PI * (b + 0.5) / STEPS;
                const double d[3] = {s * cos(turn), c, s * sin(turn)};
                sum += lobe(n, v, d, exponent) * c * 2 * LAB_PI / STEPS / STEPS;
            }
        wanted[i] = 2 * (matt + specular * sum);
        integral += wanted[i] / (SIDE * SIDE);
    }
    assert_true(integral < 2 * (matt + specular) * 0.999); /* lobes lose light where they go under the surface */
    expect_pixels("glossy floor under a constant sky", &l, 1, wanted);
    lab_close(&l);
}

/* Small light by chance and by looking for it: a little bright square in a glossy floor, sharp and blunt. */
static void a_lobe_reflects_a_square(void **state) {
    (void)state;
    enum { SIDE = 16, STEPS = 48 };
    static const float eye[3] = {0.3f, 0.2f, 0.4f}, corner[3] = {-0.3f, 0.3f, -0.4f}, wide[3] = {0.2f, 0, 0},
                       deep[3] = {0, 0, 0.2f};
    static const double exponents[] = {5, 2000};
    const double n[3] = {0, 1, 0}, matt = 0.3, specular = 0.5, from[3] = {(double)0.3f, (double)0.2f, (double)0.4f};
    for (size_t e = 0; e < 2; e++) {
        double wanted[SIDE * SIDE];
        reference_lab l;
        room *r = room_empty((float)matt);
        add_floor(r);
        room_quad(r, corner, wide, deep, 1);
        lab_open(&l, r, SIDE, 0, 2);
        see_floor(&l, eye);
        material_of(&l, 0, VIT_MATTE, (float)specular, (float)exponents[e], 1);
        emits(&l, 1, 10, 1);
        l.room->materials[1].albedo[0] = 0;
        l.in.max_samples = 512;
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            double p[3], v[3], d[3], sum = 0;
            floor_point(SIDE, i, p);
            (void)unit_to(p, from, v);
            for (int a = 0; a < STEPS * STEPS; a++) {
                const double q[3] = {(double)corner[0] + 0.2 * (a % STEPS + 0.5) / STEPS, (double)corner[1],
                                     (double)corner[2] + 0.2 * (a / STEPS + 0.5) / STEPS};
                const double far = unit_to(p, q, d);
                sum += (matt / LAB_PI + specular * lobe(n, v, d, exponents[e])) * d[1] * d[1] / far / far;
            }
            wanted[i] = 10 * sum * 0.04 / STEPS / STEPS;
        }
        /* A sharp one is in few pixels, too few for their squared errors to be about what is stated. */
        expect_pixels(e ? "square in a floor of sharp gloss" : "square in a floor of blunt gloss", &l, LAB_FRAMES, wanted);
        lab_close(&l);
    }
}

/* Means of an image against means of what is wanted over the inner half of the frame, within `bound`, and over its quarters
 * within four times as much: photons blur edges. */
static void expect_blurred(const char *what, const reference *r, const double *image, const double *wanted, double bound) {
    const uint32_t side = r->width;
    double sum[4] = {0}, all[4] = {0};
    for (uint32_t y = side / 4; y < side - side / 4; y++)
        for (uint32_t x = side / 4; x < side - side / 4; x++) {
            const int quarter = (x >= side / 2) + 2 * (y >= side / 2);
            sum[quarter] += image[3 * (y * side + x)];
            all[quarter] += wanted[y * side + x];
        }
    for (int q = 0; q < 4; q++)
        expect_within("a quarter of what follows", sum[q], all[q], 4 * bound);
    expect_within(what, sum[0] + sum[1] + sum[2] + sum[3], all[0] + all[1] + all[2] + all[3], bound);
}

/* Paths that end at the bounce limit bring what the same paths bring that go on. */
static void limited_paths_are_the_others_cut_short(void **state) {
    (void)state;
    enum { SIDE = 4, PATHS = 64 };
    static const float eye[3] = {0.1f, 0.05f, -0.2f}, corner[3] = {-1, 1, -1}, right[3] = {2, 0, 0}, down[3] = {0, -2, 0};
    reference_lab l;
    path_scene p;
    uint64_t rays = 0;
    lab_open(&l, room_closed(0.5f), SIDE, 0, 3);
    emits(&l, WALL_CEILING, 3, 1);
    material_of(&l, WALL_LEFT, VIT_MIRROR, 0.9f, 1, 1);
    material_of(&l, WALL_RIGHT, VIT_MATTE, 0.4f, 20, 1);
    lab_look(&l, 0, eye, corner, right, down);
    assert_true(paths_open(&l.in, 1, &p));
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        view_sample v;
        path_sums cut, whole;
        paths_view(&p, i % SIDE, i / SIDE, &v, &rays);
        paths_trace(&p, NULL, &v, i, 0, PATHS, true, &cut, &rays);
        paths_trace(&p, NULL, &v, i, 0, PATHS, false, &whole, &rays);
        assert_true(v.hit && whole.limited[0] > 0);
        assert_memory_equal(cut.limited, whole.limited, sizeof cut.limited);
        assert_memory_equal(cut.direct, whole.direct, sizeof cut.direct);
    }
    paths_close(&p);
    lab_close(&l);
}

/* A lamp beside a mirror lights the floor a second time from behind it. */
static void a_mirror_sends_a_lamp_s_light_on(void **state) {
    (void)state;
    enum { SIDE = 16 };
    static const float wide_corner[3] = {-2, -0.5f, 2}, wide[3] = {4, 0, 0}, away[3] = {0, 0, -4}, eye[3] = {0.1f, 0, 0},
                       mirror[3] = {1.5f, -0.5f, -3}, up[3] = {0, 3, 0}, along[3] = {0, 0, 6};
    const double lamp[3] = {0.2, 0.6, -0.1}, image[3] = {2.8, 0.6, -0.1};
    double wanted[SIDE * SIDE];
    reference_lab l;
    room *r = room_empty(0.5f);
    room_quad(r, wide_corner, wide, away, 0);
    room_quad(r, mirror, up, along, 1);
    r->lights[0] = room_point_light((float)lamp[0], (float)lamp[1], (float)lamp[2], 16);
    lab_open(&l, r, SIDE, 1, 2);
    see_floor(&l, eye);
    material_of(&l, 1, VIT_MIRROR, 0.9f, 1, 1);
    l.in.max_samples = 1024;
    reference f = lab_render(&l, 0);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        double p[3], d[3];
        floor_point(SIDE, i, p);
        const double far = unit_to(p, image, d);
        wanted[i] = 0.5 / LAB_PI * d[1] / far / far * (double)0.9f;
    }
    expect_blurred("floor lit by a lamp's image in a mirror", &f, f.limited, wanted, 5e-3);
    reference_free(&f);
    static const bool direct_only[ROOM_LIGHTS] = {true};
    l.in.direct_only = direct_only;
    f = lab_render(&l, 0);
    assert_true(f.direct[0] > 0 && f.limited[0] == 0 && f.unlimited[0] == 0);
    reference_free(&f);
    lab_close(&l);
}

/* The sun through a slab of glass: all its inner reflections leave in the same direction. */
static void a_slab_lets_the_sun_through(void **state) {
    (void)state;
    enum { SIDE = 16 };
    static const float wide_corner[3] = {-2, -0.5f, 2}, wide[3] = {4, 0, 0}, away[3] = {0, 0, -4}, eye[3] = {0.1f, 0, 0},
                       upper[3] = {-3, 0.4f, 3}, lower[3] = {-3, 0.3f, -3}, slab_wide[3] = {6, 0, 0}, slab_deep[3] = {0, 0, 6},
                       slab_away[3] = {0, 0, -6};
    const double absorption = 3, ior = 1.5, thick = (double)(0.4f - 0.3f);
    double wanted[SIDE * SIDE];
    reference_lab l;
    room *r = room_empty(0.5f);
    room_quad(r, wide_corner, wide, away, 0);
    room_quad(r, upper, slab_wide, slab_away, 1);
    room_quad(r, lower, slab_wide, slab_deep, 1);
    lab_open(&l, r, SIDE, 1, 8);
    see_floor(&l, eye);
    material_of(&l, 1, VIT_GLASS, 1, 1, (float)ior);
    for (int k = 0; k < 3; k++)
        l.room->materials[1].absorption[k] = (float)absorption;
    l.room->materials[0].albedo[0] = 0.01f; /* little comes back from the floor and the glass */
    for (uint32_t i = 0; i < LAB_FRAMES; i++)
        l.lights[i] = (vit_light){.kind = VIT_LIGHT_DIRECTIONAL,
                                  .position = {-1.8f, 2.4f, 0},
                                  .direction = {0.6f, -0.8f, 0},
                                  .cos_outer = 1,
                                  .spot_scale = 2.2f,
                                  .intensity = {5, 5, 5}};
    l.in.max_samples = 512;
    reference f = lab_render(&l, 0);
    const double part = fresnel(acos(0.8), ior), left = exp(-absorption * thick / cos(asin(0.6 / ior)));
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        wanted[i] = (double)0.01f / LAB_PI * 5 * 0.8 * (1 - part) * (1 - part) * left / (1 - part * part * left * left);
    expect_blurred("floor in the sun under a slab", &f, f.limited, wanted, 5e-3);
    reference_free(&f);
    lab_close(&l);
}

/* A block about (0, -0.2, 0) of material 2. */
static void add_block(room *r) {
    static const float corner[WALLS][3] = {{-1, -1, 1}, {1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {-1, -1, -1}, {1, -1, 1}};
    static const float u[WALLS][3] = {{0, 0, -2}, {0, 0, 2}, {2, 0, 0}, {2, 0, 0}, {2, 0, 0}, {-2, 0, 0}};
    static const float v[WALLS][3] = {{0, 2, 0}, {0, 2, 0}, {0, 0, -2}, {0, 0, 2}, {0, 2, 0}, {0, 2, 0}};
    for (int w = 0; w < WALLS; w++) {
        float c[3], across[3], along[3];
        for (int k = 0; k < 3; k++) {
            c[k] = 0.2f * corner[w ^ 1][k] - (k == 1 ? 0.2f : 0); /* the wall opposite, shrunk: it faces outwards */
            across[k] = 0.2f * u[w][k];
            along[k] = 0.2f * v[w][k];
        }
        room_quad(r, c, across, along, 2);
    }
}

/* A white floor under a block, in a sky of one radiance, or in a room whose walls shine so that they have it, too: all has it.
 */
static void furnaces_stay_as_they_are(void **state) {
    (void)state;
    enum { SIDE = 16 };
    static const struct {
        const char *name;
        uint32_t kind;
        float albedo, specular;
    } materials[] = {{"matt white", VIT_MATTE, 1, 0},
                     {"mirror", VIT_MIRROR, 0, 1},
                     {"glass", VIT_GLASS, 0, 1},
                     {"thin glass", VIT_THIN_GLASS, 0, 1}};
    static const float eye[3] = {0.45f, 0.3f, 0.5f}, corner[3] = {-1, 1, -1}, right[3] = {2, 0, 0}, down[3] = {0, -2, 0};
    for (size_t i = 0; i < sizeof materials / sizeof *materials; i++)
        for (int closed = 0; closed < 2; closed++) {
            char what[80];
            reference_lab l;
            const double rho = 0.6, radiance = 2;
            double sum = 0, stated = 0;
            room *r = closed ? room_closed((float)rho) : room_empty(1); /* 1. a floor or walls, and the block */
            if (!closed)
                add_floor(r);
            if (closed)
                for (int k = 0; k < 3; k++)
                    r->model_materials[WALLS].albedo[k] = 0;
            add_block(r);
            lab_open(&l, r, SIDE, 0, 3);
            see_floor(&l, eye);
            if (closed) { /* 2. the same radiance from all round, by walls or by the sky */
                lab_look(&l, 0, eye, corner, right, down);
                for (uint32_t w = 0; w < WALLS; w++)
                    emits(&l, w, (float)(radiance * (1 - rho)), 1);
                /* The block's material is a wall's number here: give it one of its own. */
                for (uint32_t t = 0; t < l.meta.triangles; t++) {
                    const vit_triangle *g = l.room->g.triangles + t;
                    if (fabsf(g->v0[0]) < 0.5f && fabsf(g->v0[1]) < 0.5f && fabsf(g->v0[2]) < 0.5f)
                        l.room->g.attributes[t].material = (l.room->g.attributes[t].material & ~VIT_MATERIAL_INDEX) | 8u;
                }
            } else
                sky_of(&l, (float)radiance);
            const uint32_t block = closed ? 8 : 2; /* 3. what the block is made of */
            material_of(&l, block, materials[i].kind, materials[i].specular, 1, 1.5f);
            for (int k = 0; k < 3; k++)
                l.room->materials[block].albedo[k] = materials[i].albedo;
            l.in.max_samples = 512;
            reference f = lab_render(&l, 0); /* 4. every pixel sees that radiance */
            for (uint32_t p = 0; p < SIDE * SIDE; p++) {
                const double total = f.direct[3 * p] + f.unlimited[3 * p];
                sum += total / (SIDE * SIDE);
                stated += (f.direct_variance[3 * p] + f.unlimited_variance[3 * p]) / pow(SIDE, 4);
                if (!(fabs(total / radiance - 1) < 0.25)) /* one by one, roughly: an edge too bright, a side too dark */
                    fail_msg("%s: pixel %u is %g of %g", materials[i].name, p, total, radiance);
            }
            (void)snprintf(what, sizeof what, "furnace of a %s block %s", materials[i].name,
                           closed ? "among shining walls" : "in the sky");
            expect_within(what, sum, radiance, 2 * WITHIN);
            assert_true(fabs(sum - radiance) < 6 * sqrt(stated) + EXACT);
            reference_free(&f);
            lab_close(&l);
        }
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

static void the_worst_of_all_is_a_row_of_the_catalogue(void **state) {
    (void)state;
    assert_true(worst > 0);
    catalogue_row("reference", "mirrors; glass; lobes; area lights and skies: of what is allowed", worst / WITHIN, 1, "bounds");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_square_lights_another_as_their_form_factor_says),
        cmocka_unit_test(walls_that_shine_make_a_geometric_series),
        cmocka_unit_test(floors_under_open_skies),
        cmocka_unit_test(a_floor_under_a_picture_of_the_sky),
        cmocka_unit_test(a_mirror_shows_what_is_before_it),
        cmocka_unit_test(glass_lets_through_what_fresnel_leaves),
        cmocka_unit_test(a_pane_lets_a_lamp_through),
        cmocka_unit_test(a_lobe_reflects_by_its_formula),
        cmocka_unit_test(a_lobe_reflects_a_square),
        cmocka_unit_test(limited_paths_are_the_others_cut_short),
        cmocka_unit_test(a_mirror_sends_a_lamp_s_light_on),
        cmocka_unit_test(a_slab_lets_the_sun_through),
        cmocka_unit_test(furnaces_stay_as_they_are),
        cmocka_unit_test(pixels_are_means_under_their_filter),
        cmocka_unit_test(the_worst_of_all_is_a_row_of_the_catalogue),
    };
    return cmocka_run_group_tests_name("reference effects", tests, NULL, NULL);
}
