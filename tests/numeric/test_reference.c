/* The reference against what can be computed without it.
 *
 * What makes it hard to test is that it is the judge of everything else: nothing here may be compared with the runtime.
 * Instead: rooms whose light is known from energy alone, pairs of plates whose form factors are known in closed form, and the
 * Cornell box by another method (quadrature over areas in double with rays of its own). A frame's pixels lie evenly on a
 * surface (reference_lab.h), so that means over frames are means over surfaces. Each check prints how far off it is, and the
 * noise that the reference itself states, which must be honest too: errors over stated standard errors must be about 1. */
#include "catalogue.h"
#include "reference_lab.h"
#include <stdio.h>

#define WITHIN 1e-3

static const float lab_corner[WALLS][3] = {{-1, -1, 1}, {1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {-1, -1, -1}, {1, -1, 1}};
static const float lab_u[WALLS][3] = {{0, 0, -2}, {0, 0, 2}, {2, 0, 0}, {2, 0, 0}, {2, 0, 0}, {-2, 0, 0}};
static const float lab_v[WALLS][3] = {{0, 2, 0}, {0, 2, 0}, {0, 0, -2}, {0, 0, 2}, {0, 2, 0}, {0, 2, 0}};

static double worst; /* of all that was expected */

static void expect(const char *what, double found, double wanted) {
    worst = fmax(worst, fabs(found / wanted - 1));
    printf("%-58s %12.6g, wanted %12.6g: %+.3f %%\n", what, found, wanted, 100 * (found / wanted - 1));
    if (!(fabs(found / wanted - 1) < WITHIN))
        fail_msg("%s: %.6g, wanted %.6g", what, found, wanted);
}

/* The closed cube with a point light of 1, 2, 3 W/sr; one frame a wall. */
static void open_cube(reference_lab *l, room *r, uint32_t side, uint32_t bounces) {
    static const float eye[3] = {0.1f, 0.05f, -0.2f};
    r->lights[0] = room_point_light(-0.2f, 0.15f, 0.3f, 16);
    lab_open(l, r, side, 1, bounces);
    for (uint32_t w = 0; w < WALLS; w++)
        lab_look(l, w, eye, lab_corner[w], lab_u[w], lab_v[w]);
}

/* Every reflection takes in all the light of the one before and gives back albedo of it: mean irradiance is power / area times
 * albedo^k after k reflections, whatever the room's shape and the light's place. */
static void check_furnace(float albedo, uint32_t samples) {
    enum { BOUNCES = 5 };
    reference_lab l;
    double direct = 0, limited = 0, unlimited = 0, series = 0;
    char what[64];
    open_cube(&l, room_closed(albedo), 32, BOUNCES);
    l.in.max_samples = samples;
    for (uint32_t w = 0; w < WALLS; w++) {
        reference r = lab_render(&l, w);
        direct += lab_irradiance(&r, r.direct, 1, (double)albedo) / WALLS;
        limited += lab_irradiance(&r, r.limited, 1, (double)albedo) / WALLS;
        unlimited += lab_irradiance(&r, r.unlimited, 1, (double)albedo) / WALLS;
        reference_free(&r);
    }
    const double first = 4 * LAB_PI * 2 / 24, rho = (double)albedo;
    for (int k = 1; k < BOUNCES; k++)
        series += pow(rho, k);
    (void)snprintf(what, sizeof what, "furnace, albedo %g: direct", rho);
    expect(what, direct, first);
    (void)snprintf(what, sizeof what, "furnace, albedo %g: direct + 4 reflections", rho);
    expect(what, direct + limited, first * (1 + series));
    (void)snprintf(what, sizeof what, "furnace, albedo %g: direct + all reflections", rho);
    expect(what, direct + unlimited, first / (1 - rho));
    lab_close(&l);
}

static void a_closed_room_has_the_light_that_its_albedo_says(void **state) {
    (void)state;
    check_furnace(0.2f, 64);
    check_furnace(0.5f, 256);
    check_furnace(0.8f, 256);
}

/* A closed room of many colours with a block in it: what surfaces do not reflect adds up to what the light gives. Walls are
 * seen from close by, since the block is in the way. */
static void what_goes_in_is_absorbed(void **state) {
    (void)state;
    enum { BLOCK = 6, SIDE = 48 };
    static const float grey[ROOM_MATERIALS][3] = {{0.9f, 0.2f, 0.1f}, {0.1f, 0.7f, 0.3f}, {0.5f, 0.5f, 0.5f},
                                                  {0.8f, 0.8f, 0.8f}, {0.6f, 0.4f, 0.7f}, {0.05f, 0.3f, 0.6f},
                                                  {0.7f, 0.6f, 0.2f}};
    room *r = room_closed(0);
    reference_lab l;
    float corner[2 * WALLS][3], u[2 * WALLS][3], v[2 * WALLS][3];
    double absorbed[3] = {0, 0, 0};
    for (uint32_t i = 0; i <= BLOCK; i++)
        room_paint(r, i, grey[i][0], grey[i][1], grey[i][2]);
    for (int w = 0; w < WALLS; w++)
        for (int k = 0; k < 3; k++) {
            /* A block of 0.6 m about (0.2, -0.3, 0): each face is the wall opposite, shrunk, and so faces outwards. */
            const float centre = k == 0 ? 0.2f : k == 1 ? -0.3f : 0.0f;
            corner[w][k] = lab_corner[w][k];
            u[w][k] = lab_u[w][k];
            v[w][k] = lab_v[w][k];
            corner[WALLS + w][k] = centre + 0.3f * lab_corner[w ^ 1][k];
            u[WALLS + w][k] = 0.3f * lab_u[w ^ 1][k];
            v[WALLS + w][k] = 0.3f * lab_v[w ^ 1][k];
        }
    for (int w = 0; w < WALLS; w++)
        room_quad(r, corner[WALLS + w], u[WALLS + w], v[WALLS + w], BLOCK);
    r->lights[0] = room_point_light(-0.5f, 0.55f, 0.4f, 16);
    lab_open(&l, r, SIDE, 1, 4);
    l.in.max_samples = 128;
    for (uint32_t w = 0; w < 2 * WALLS; w++) {
        const float *c = corner[w], off = w % 2 ? -0.05f : 0.05f; /* from the walls inwards, from the block's faces outwards */
        float eye[3];
        const bool inwards = w < WALLS;
        for (uint32_t k = 0; k < 3; k++)
            eye[k] = c[k] + 0.5f * (u[w][k] + v[w][k]) + (k == w % WALLS / 2 ? off : 0.0f);
        lab_look(&l, w, eye, c, u[w], v[w]);
        reference f = lab_render(&l, w);
        for (uint32_t k = 0; k < 3; k++) {
            const double albedo = (double)grey[inwards ? w : BLOCK][k], area = inwards ? 4 : 0.36;
            absorbed[k] +=
                area * (1 - albedo) * (lab_irradiance(&f, f.direct, k, albedo) + lab_irradiance(&f, f.unlimited, k, albedo));
        }
        reference_free(&f);
    }
    for (uint32_t k = 0; k < 3; k++) {
        char what[64];
        (void)snprintf(what, sizeof what, "energy absorbed in a room with a block, channel %u", k);
        expect(what, absorbed[k], 4 * LAB_PI * (k + 1.0));
    }
    lab_close(&l);
}

/* Light that comes from so far away that it is parallel, 1 W/m2 across it, from the unit direction d. */
static photons_light sunlight(const float d[3]) {
    const float far = 20000.0f;
    photons_light l = room_point_light(d[0] * far, d[1] * far, d[2] * far, 16);
    for (int k = 0; k < 3; k++)
        l.light.intensity[k] = far * far;
    return l;
}

/* Form factor from a point to a rectangle a x b in a parallel plane c away, one corner of which is right opposite the point
 * (Hottel). */
static double corner_factor(double a, double b, double c) {
    const double x = a / c, y = b / c, p = sqrt(1 + x * x), q = sqrt(1 + y * y);
    return (x / p * atan(y / p) + y / q * atan(x / q)) / (2 * LAB_PI);
}

/* From a point of one of two opposite unit squares, 1 apart, to the other; 0 <= x, y <= 1. */
static double opposite_factor(double x, double y) {
    return corner_factor(x, y, 1) + corner_factor(1 - x, y, 1) + corner_factor(x, 1 - y, 1) + corner_factor(1 - x, 1 - y, 1);
}

/* The sun comes in between two plates from the side and lights the lower one, which lights the upper one's underside. */
static void one_plate_lights_another_as_their_form_factor_says(void **state) {
    (void)state;
    enum { SIDE = 32 };
    static const float eye[3] = {0, 0, 0}, low[3] = {-0.5f, -0.5f, 0.5f}, high[3] = {-0.5f, 0.5f, -0.5f}, x[3] = {1, 0, 0},
                       z[3] = {0, 0, 1}, back[3] = {0, 0, -1}, sun[3] = {0.8660254f, 0.5f, 0};
    const float albedo = 0.7f;
    room *r = room_empty(albedo);
    reference_lab l;
    room_quad(r, low, x, back, 0);
    room_quad(r, high, x, z, 1);
    r->lights[0] = sunlight(sun);
    lab_open(&l, r, SIDE, 1, 2);
    lab_look(&l, 0, eye, high, x, z);
    lab_look(&l, 1, eye, low, x, back);
    l.in.max_samples = 2048;
    reference f = lab_render(&l, 1);
    expect("lower plate, direct light", lab_irradiance(&f, f.direct, 0, (double)albedo), 0.5);
    reference_free(&f);
    f = lab_render(&l, 0);
    /* Howell's catalogue of configuration factors, C-11, for squares as far apart as they are wide. */
    const double factor = 2 / LAB_PI * (log(sqrt(4.0 / 3)) + 2 * sqrt(2) * atan(1 / sqrt(2)) - LAB_PI / 2);
    expect("upper plate, one reflection: the plates' form factor",
           lab_irradiance(&f, f.limited, 0, (double)albedo) / (0.5 * (double)albedo), factor);
    double squares = 0, stated = 0, direct = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const double px = (i % SIDE + 0.5) / SIDE, py = (i / SIDE + 0.5) / SIDE;
        const double wanted = (double)albedo / LAB_PI * (double)albedo * 0.5 * opposite_factor(px, py);
        squares += pow(f.limited[3 * i] - wanted, 2);
        stated += f.limited_variance[3 * i];
        direct += f.direct[3 * i];
    }
    printf("upper plate, pixel by pixel: squared errors over the stated variance: %.3f\n", squares / stated);
    assert_true(squares / stated > 0.8 && squares / stated < 1.25);
    assert_true(direct == 0);
    reference_free(&f);
    lab_close(&l);
}

/* Two squares that share an edge, lit by the sun at 45 degrees to both. Frame 0 sees the floor, frame 1 the wall. `bend`: how
 * far the floor's shading normals lean towards the wall, as a slope. */
static void open_corner(reference_lab *l, float bend) {
    static const float eye[3] = {0.6f, 0.5f, 0.5f}, corner[3] = {0, 0, 0}, top[3] = {0, 0, 1}, x[3] = {1, 0, 0},
                       y[3] = {0, 1, 0}, back[3] = {0, 0, -1}, z[3] = {0, 0, 1}, sun[3] = {0.70710678f, 0.70710678f, 0};
    room *r = room_empty(0);
    room_paint(r, 0, 0.5f, 0.5f, 0.5f);
    room_paint(r, 1, 0.8f, 0.8f, 0.8f);
    room_quad(r, top, x, back, 0);
    for (uint32_t i = 0; i < 4; i++) {
        r->normal[3 * i] = -bend / sqrtf(1 + bend * bend);
        r->normal[3 * i + 1] = 1 / sqrtf(1 + bend * bend);
    }
    room_quad(r, corner, y, z, 1);
    r->lights[0] = sunlight(sun);
    lab_open(l, r, 32, 1, 2);
    lab_look(l, 0, eye, top, x, back);
    lab_look(l, 1, eye, corner, y, z);
    l->in.max_samples = 2048;
}

/* Howell's catalogue, C-14, for squares. */
static double square_corner_factor(void) {
    return (LAB_PI / 2 - sqrt(2) * atan(1 / sqrt(2)) + log(0.75) / 4) / LAB_PI;
}

/* Each gets from the other what their form factor says. */
static void the_sides_of_a_corner_light_each_other(void **state) {
    (void)state;
    reference_lab l;
    open_corner(&l, 0);
    reference floor_seen = lab_render(&l, 0), wall_seen = lab_render(&l, 1);
    expect("corner, floor: the squares' form factor",
           lab_irradiance(&floor_seen, floor_seen.limited, 0, 0.5) / (0.8 * sqrt(0.5)), square_corner_factor());
    expect("corner, wall: the squares' form factor", lab_irradiance(&wall_seen, wall_seen.limited, 0, 0.8) / (0.5 * sqrt(0.5)),
           square_corner_factor());
    reference_free(&floor_seen);
    reference_free(&wall_seen);
    lab_close(&l);
}

/* A floor whose shading normals lean towards the wall gets more light from it, but not about its geometric normals. Direct
 * light is about shading normals either way. */
static void about_geometric_normals_shading_normals_do_not_count_for_indirect_light(void **state) {
    (void)state;
    reference_lab l;
    open_corner(&l, 0.6f);
    reference shading = lab_render(&l, 0);
    l.in.face_normals = true;
    reference faces = lab_render(&l, 0);
    const double bent = lab_irradiance(&shading, shading.limited, 0, 0.5) / (0.8 * sqrt(0.5));
    printf("floor with bent shading normals: %.3f of what its form factor says\n", bent / square_corner_factor());
    assert_true(bent > 1.1 * square_corner_factor());
    expect("the same about geometric normals", lab_irradiance(&faces, faces.limited, 0, 0.5) / (0.8 * sqrt(0.5)),
           square_corner_factor());
    assert_memory_equal(shading.direct, faces.direct, sizeof(double) * 3 * 32 * 32);
    reference_free(&shading);
    reference_free(&faces);
    lab_close(&l);
}

static void the_worst_of_all_is_a_row_of_the_catalogue(void **state) {
    (void)state;
    assert_true(worst > 0);
    catalogue_row("reference", "the path tracer against closed forms", worst, WITHIN, "relative");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_closed_room_has_the_light_that_its_albedo_says),
        cmocka_unit_test(what_goes_in_is_absorbed),
        cmocka_unit_test(one_plate_lights_another_as_their_form_factor_says),
        cmocka_unit_test(the_sides_of_a_corner_light_each_other),
        cmocka_unit_test(about_geometric_normals_shading_normals_do_not_count_for_indirect_light),
        cmocka_unit_test(the_worst_of_all_is_a_row_of_the_catalogue),
    };
    return cmocka_run_group_tests_name("reference", tests, NULL, NULL);
}
