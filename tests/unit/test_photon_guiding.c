/* Guided photons: a dark room with a small hole in its ceiling, in a wide field. Even paths hardly ever come in; guided ones
 * must, and must bring as much light as comes in by geometry: the light's flux through the hole, times the albedo for every
 * reflection, less what leaves by the hole again (1 in 140 at most). */
#include "light/photon_guiding.h"
#include "photon_room.h"

#define PI 3.14159265358979
#define ALBEDO 0.5
#define HOLE 0.3f /* m, a side */

enum { PATHS = 131072, FRAMES = 2, HITS = 3 };

/* The ceiling but for its hole, in four parts, and the field round the room. */
static room *room_with_a_hole(void) {
    room *r = room_empty((float)ALBEDO);
    const float h = HOLE / 2, wide = 1.0f - h;
    for (int w = 0; w < WALLS; w++)
        if (w != WALL_CEILING)
            room_wall(r, w);
    room_quad(r, (float[]){-1, 1, -1}, (float[]){2, 0, 0}, (float[]){0, 0, wide}, WALL_CEILING);
    room_quad(r, (float[]){-1, 1, h}, (float[]){2, 0, 0}, (float[]){0, 0, wide}, WALL_CEILING);
    room_quad(r, (float[]){-1, 1, -h}, (float[]){wide, 0, 0}, (float[]){0, 0, HOLE}, WALL_CEILING);
    room_quad(r, (float[]){h, 1, -h}, (float[]){wide, 0, 0}, (float[]){0, 0, HOLE}, WALL_CEILING);
    room_quad(r, (float[]){-20, -1.01f, 20}, (float[]){40, 0, 0}, (float[]){0, 0, -40}, WALL_FLOOR);
    for (int k = 0; k < 3; k += 2) {
        r->m.lo[k] = -20;
        r->m.hi[k] = 20;
    }
    return r;
}

typedef struct guided {
    room *r;
    tracks t;
    vit_camera cameras[FRAMES];
    vit_light lights[FRAMES];
    bool still, gives;
    photon_guiding found;
} guided;

static photons_light sun(void) {
    return (photons_light){.light = {.position = {0, 30, 0},
                                     .kind = VIT_LIGHT_DIRECTIONAL,
                                     .direction = {0, -1, 0},
                                     .cos_outer = 1.0f,
                                     .intensity = {1.0f, 2.0f, 3.0f},
                                     .spot_scale = 28.3f},
                           .paths = PATHS};
}

/* Looks at the floor from a corner under the ceiling; guides of the one light, or of the sky. */
static void find(guided *g, const photons_light *l, unsigned threads) {
    vit_text why = {""};
    g->t = (tracks){.cameras = g->cameras, .lights = g->lights, .light_count = l->sky ? 0 : 1, .still = &g->still};
    g->still = g->gives = true;
    for (int f = 0; f < FRAMES; f++) {
        g->lights[f] = l->light;
        g->cameras[f] = (vit_camera){.eye = {-0.9f, 0.8f, -0.9f},
                                     .corner = {-0.2f, -0.3f, 1.0f},
                                     .right = {0.12f, 0.0f, -0.12f},
                                     .down = {-0.02f, -0.1f, -0.02f}};
    }
    const photon_guiding_input in = {.scene = room_scene(g->r),
                                     .tracks = &g->t,
                                     .frames = FRAMES,
                                     .width = 16,
                                     .height = 9,
                                     .bounces = HITS,
                                     .gives_photons = &g->gives,
                                     .sky = l->sky ? l : NULL,
                                     .threads = threads};
    if (photon_guiding_find(&in, &g->found, &why) != VIT_OK)
        fail_msg("%s", why.text);
}

/* Watts of photons in the room, channel c, over flux * (albedo + albedo^2). */
static double share_inside(guided *g, photons_light l, double flux, int c, uint32_t *inside) {
    uint32_t count;
    double watts = 0;
    g->r->lights[0] = l;
    vit_photon *photons = room_bake(g->r, 1, &count);
    *inside = 0;
    for (uint32_t i = 0; i < count; i++)
        if (fabsf(photons[i].position[0]) < 1 && fabsf(photons[i].position[2]) < 1 && fabsf(photons[i].position[1]) < 1) {
            watts += room_watts(photons + i, c);
            ++*inside;
        }
    free(photons);
    return watts / (flux * (ALBEDO + ALBEDO * ALBEDO));
}

static void holds(photons_light l, const double flux[3], uint32_t source) {
    guided g = {.r = room_with_a_hole()};
    uint32_t even, inside;
    room_finish(g.r, 1, HITS);
    find(&g, &l, 1);
    assert_true(g.found.worth[source] > 0.999);
    (void)share_inside(&g, l, flux[0], 0, &even);
    l.guide = photon_guiding_of(&g.found, source);
    l.around = g.found.around;
    assert_non_null(l.guide);
    for (int c = 0; c < 3; c++) {
        const double got = share_inside(&g, l, flux[c], c, &inside);
        if (fabs(got - 1) > 0.03)
            fail_msg("channel %d: %g of the light, by %u photons inside", c, got, inside);
    }
    if (inside < PATHS / 4 || even > inside / 50)
        fail_msg("%u photons inside, %u of even paths", inside, even);
    photon_guiding_free(&g.found);
    room_drop(g.r);
}

static void the_suns_light_comes_in_by_a_small_hole(void **state) {
    (void)state;
    const double area = (double)HOLE * (double)HOLE;
    holds(sun(), (const double[]){area, 2 * area, 3 * area}, 0);
}

static void so_does_a_lamps_from_outside(void **state) {
    (void)state;
    photons_light l = room_point_light(0.3f, 3.0f, 0.1f, PATHS);
    /* solid angle of the hole, seen from 2 m above its plane */
    const double d2 = 4 + 0.09 + 0.01, solid = (double)HOLE * (double)HOLE * 2 / (d2 * sqrt(d2)); /* to 0.3 % */
    holds(l, (const double[]){solid, 2 * solid, 3 * solid}, 0);
}

static void so_does_the_skys(void **state) {
    (void)state;
    environment s;
    sky_constant((const double[]){1.0, 2.0, 3.0}, &s);
    const photons_light l = {.light = {.position = {0, 0, 0}, .spot_scale = 28.4f}, .paths = PATHS, .sky = &s};
    const double flux = PI * (double)HOLE * (double)HOLE;
    holds(l, (const double[]){flux, 2 * flux, 3 * flux}, 1);
    sky_free(&s);
}

/* The hole's light alone would do; but what was not found must still be hit in proportion, or light would be left out. */
static void paths_are_weighed_by_their_density(void **state) {
    (void)state;
    enum { SAMPLES = 5000, POINTS = 200000 };
    static guiding_tree_sample samples[SAMPLES];
    guiding_tree g;
    for (uint32_t i = 0; i < SAMPLES; i++) /* in the corner of a box of 1/16 */
        for (int k = 0; k < 3; k++) {
            samples[i].at[k] = unit_float(pcg(3 * i + (uint32_t)k)) * 0.0625f;
            samples[i].weight = 1.0f + unit_float(pcg(i));
        }
    assert_true(guiding_tree_build(samples, SAMPLES, 3, &g));
    double corner = 0, half = 0, all = 0;
    uint32_t in_corner = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        float at[GUIDING_DIMENSIONS];
        const double part = 1.0 / ((double)guiding_tree_point(&g, POINTS, i, i, at) * POINTS);
        const bool in = at[0] < 0.0625f && at[1] < 0.0625f && at[2] < 0.0625f;
        for (int k = 0; k < GUIDING_DIMENSIONS; k++)
            assert_true(at[k] >= 0.0f && at[k] < 1.0f);
        assert_true(part * POINTS <= 1.0 / (double)GUIDING_EVENLY * 1.0001);
        corner += in ? part : 0;
        half += at[1] > 0.5f ? part : 0;
        all += part;
        in_corner += in;
    }
    assert_true(in_corner > POINTS * 0.78 && g.gain > 2000);
    assert_true(fabs(corner * 4096 - 1) < 0.01 && fabs(half - 0.5) < 0.01 && fabs(all - 1) < 0.01);
    guiding_tree_free(&g);
}

static void guides_are_the_same_with_any_number_of_threads(void **state) {
    (void)state;
    guided a = {.r = room_with_a_hole()}, b = {.r = a.r};
    const photons_light l = sun();
    room_finish(a.r, 1, HITS);
    find(&a, &l, 1);
    find(&b, &l, 3);
    assert_int_equal(a.found.guide[0].count, b.found.guide[0].count);
    assert_memory_equal(a.found.guide[0].nodes, b.found.guide[0].nodes,
                        a.found.guide[0].count * sizeof *a.found.guide[0].nodes);
    assert_memory_equal(a.found.worth, b.found.worth, a.found.count * sizeof *a.found.worth);
    photon_guiding_free(&a.found);
    photon_guiding_free(&b.found);
    room_drop(a.r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_suns_light_comes_in_by_a_small_hole),
        cmocka_unit_test(so_does_a_lamps_from_outside),
        cmocka_unit_test(so_does_the_skys),
        cmocka_unit_test(paths_are_weighed_by_their_density),
        cmocka_unit_test(guides_are_the_same_with_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
