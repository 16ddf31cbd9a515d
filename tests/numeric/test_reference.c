/* The reference against what can be computed without it.
 *
 * What makes it hard to test is that it is the judge of everything else: nothing here may be compared with the runtime.
 * Instead: rooms whose light is known from energy alone, pairs of plates whose form factors are known in closed form, and the
 * Cornell box by another method (quadrature over areas in double with rays of its own). A frame's pixels lie evenly on a
 * surface (reference_lab.h), so that means over frames are means over surfaces. Each check prints how far off it is, and the
 * noise that the reference itself states, which must be honest too: errors over stated standard errors must be about 1. */
#include "reference_lab.h"
#include <stdio.h>

#define WITHIN 1e-3

static const float lab_corner[WALLS][3] = {{-1, -1, 1}, {1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {-1, -1, -1}, {1, -1, 1}};
static const float lab_u[WALLS][3] = {{0, 0, -2}, {0, 0, 2}, {2, 0, 0}, {2, 0, 0}, {2, 0, 0}, {-2, 0, 0}};
static const float lab_v[WALLS][3] = {{0, 2, 0}, {0, 2, 0}, {0, 0, -2}, {0, 0, 2}, {0, 2, 0}, {0, 2, 0}};

static void expect(const char *what, double found, double wanted) {
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
    open_cube(&l, room_closed(albedo), 24, BOUNCES);
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
    check_furnace(0.2f, 256);
    check_furnace(0.5f, 1024);
    check_furnace(0.8f, 1024);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_closed_room_has_the_light_that_its_albedo_says),
    };
    return cmocka_run_group_tests_name("reference", tests, NULL, NULL);
}
