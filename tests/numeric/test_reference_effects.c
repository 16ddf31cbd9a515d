/* The reference with mirrors, glass and lobes, against what can be computed without it.
 *
 * Closed forms throughout: Fresnel's equations for a pane and for a slab with all its inner reflections, the lobe's formula,
 * and furnaces: where all that can be seen has one radiance, so has everything that reflects or lets through all light
 * (reference_checks.h). */
#include "reference/paths.h"
#include "reference_checks.h"

/* Where pixel i's ray meets the floor. */
static void floor_point(uint32_t side, uint32_t i, double p[3]) {
    p[0] = -0.5 + (i % side + 0.5) / side;
    p[1] = -0.5;
    p[2] = 0.5 - (i / side + 0.5) / side;
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

static double dot3(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* glTF 2.0, appendix B: D V F of a reflectance at normal incidence. */
static double facets_of(const double n[3], const double v[3], const double l[3], double alpha, double specular) {
    const double a2 = alpha * alpha, h[3] = {l[0] + v[0], l[1] + v[1], l[2] + v[2]}, length = sqrt(dot3(h, h));
    const double nh = dot3(n, h) / length, nl = dot3(n, l), nv = dot3(n, v), q = nh * nh * (a2 - 1) + 1;
    const double smith = nl * sqrt(nv * nv * (1 - a2) + a2) + nv * sqrt(nl * nl * (1 - a2) + a2);
    return a2 / (LAB_PI * q * q) * 0.5 / smith * (specular + (1 - specular) * pow(1 - dot3(v, h) / length, 5));
}

/* Metal floors under a constant sky, which paths find by the lobe's directions: their integral. */
static void facets_reflect_a_sky(void **state) {
    (void)state;
    enum { SIDE = 8, STEPS = 600 };
    static const float eye[3] = {0.3f, 0.2f, 0.4f};
    static const double alphas[] = {0.09, 0.25, 1};
    const double specular = 0.5, n[3] = {0, 1, 0}, from[3] = {(double)0.3f, (double)0.2f, (double)0.4f};
    for (size_t e = 0; e < sizeof alphas / sizeof *alphas; e++) {
        double wanted[SIDE * SIDE];
        reference_lab l;
        room *r = room_empty(0);
        add_floor(r);
        lab_open(&l, r, SIDE, 0, 2);
        see_floor(&l, eye);
        material_of(&l, 0, VIT_MATTE, (float)specular, 1, 1);
        l.room->materials[0].alpha = (float)alphas[e];
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
                    sum += facets_of(n, v, d, alphas[e], specular) * c * 2 * LAB_PI / STEPS / STEPS;
                }
            wanted[i] = 2 * sum;
        }
        expect_pixels("metal floor under a constant sky", &l, 1, wanted);
        lab_close(&l);
    }
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

static void the_worst_of_all_is_a_row_of_the_catalogue(void **state) {
    (void)state;
    checks_row("mirrors; glass; lobes: of what is allowed");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mirror_shows_what_is_before_it),
        cmocka_unit_test(glass_lets_through_what_fresnel_leaves),
        cmocka_unit_test(a_pane_lets_a_lamp_through),
        cmocka_unit_test(a_lobe_reflects_by_its_formula),
        cmocka_unit_test(a_lobe_reflects_a_square),
        cmocka_unit_test(facets_reflect_a_sky),
        cmocka_unit_test(limited_paths_are_the_others_cut_short),
        cmocka_unit_test(a_mirror_sends_a_lamp_s_light_on),
        cmocka_unit_test(a_slab_lets_the_sun_through),
        cmocka_unit_test(furnaces_stay_as_they_are),
        cmocka_unit_test(the_worst_of_all_is_a_row_of_the_catalogue),
    };
    return cmocka_run_group_tests_name("reference effects", tests, NULL, NULL);
}
