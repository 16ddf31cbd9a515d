/* Baked indirect light against closed forms: transport between receivers and light.
 *
 * Why this is hard: rays are random, and light that is lost or made at one step can hide in another's noise. Strategy: closed
 * rooms in which energy is kept, whatever their shape: what a light sends comes to the walls once for each reflection, times
 * the albedo each time, so that sums over evenly spread receivers are powers of the albedo. */
#include "photon_lab.h"
#include "radiosity/transport.h"

#define PI 3.14159265358979324

/* How much is asked of a search for light. */
typedef struct effort {
    uint32_t each; /* receivers along a wall's edge */
    uint32_t rays; /* of each */
    uint32_t cells, bounce_rays;
} effort;

enum { CELLS = 8192, LOOKS = 384 };
static const effort usual = {24, 128, CELLS, 128 * CELLS};

typedef struct places {
    receiver *each;
    uint32_t count;
} places;

/* evenly^2 places on each side that light reaches, each for a like part of its area. */
static receiver *spread_receivers(const lab *l, uint32_t evenly, uint32_t *count) {
    const uint32_t each = evenly * evenly;
    receiver *all = calloc(2 * (size_t)l->r->m.triangles * each, sizeof *all);
    assert_non_null(all);
    *count = 0;
    for (uint32_t s = 0; s < 2 * l->r->m.triangles; s++)
        for (uint32_t i = 0; i < each && !side_is_dark(&l->r->g, s);
             i++) { /* row i has 2 i + 1 like triangles; their middles */
            const uint32_t row = (uint32_t)sqrt((double)i), k = i - row * row;
            const float b1 = ((float)(k / 2) + (k % 2 ? 2.0f : 1.0f) / 3.0f) / (float)evenly;
            const float down = ((float)row + (k % 2 ? 1.0f : 2.0f) / 3.0f) / (float)evenly;
            all[(*count)++] = (receiver){.side = s, .b1 = b1, .b2 = down - b1};
        }
    return all;
}

/* Irradiance of places spread over all walls, places x states x 3; both are the caller's. */
static float *light_of(const lab *l, const transport_state *states, uint32_t state_count, uint32_t reflections, effort e,
                       places *at) {
    at->each = spread_receivers(l, e.each, &at->count);
    float *irradiance = calloc((size_t)at->count * state_count * 3, sizeof *irradiance);
    assert_non_null(irradiance);
    const transport_input in = {.rays = &l->rays,
                                .geometry = &l->r->g,
                                .receivers = at->each,
                                .receiver_count = at->count,
                                .states = states,
                                .state_count = state_count,
                                .reflections = reflections,
                                .cells = e.cells,
                                .receiver_rays = e.rays,
                                .bounce_rays = e.bounce_rays,
                                .looks = LOOKS};
    transport_report report;
    vit_text why = {""};
    if (transport_find(&in, &(transport_light){.irradiance = irradiance}, &report, &why) != VIT_OK)
        fail_msg("%s", why.text);
    return irradiance;
}

/* Power of indirect light that comes to all walls in each state, W a channel. */
static void arriving(const lab *l, const transport_state *states, uint32_t state_count, uint32_t reflections, effort e,
                     double *out) {
    places at;
    float *irradiance = light_of(l, states, state_count, reflections, e, &at);
    for (uint32_t k = 0; k < 3 * state_count; k++) {
        out[k] = 0.0;
        for (uint32_t i = 0; i < at.count; i++)
            out[k] += (double)irradiance[(size_t)i * state_count * 3 + k] * (double)side_area(&l->r->g, at.each[i].side) /
                      (e.each * e.each);
    }
    free(irradiance);
    free(at.each);
}

/* What comes of a watt in a closed room whose walls have this albedo. */
static double right_part(double albedo, uint32_t reflections) {
    return albedo / (1 - albedo) * (reflections == TRANSPORT_CONVERGED ? 1 : 1 - pow(albedo, reflections));
}

/* Lights in the middle and near a corner, each alone. */
static const float lamps[2][3] = {{0.0f, 0.0f, 0.0f}, {0.8f, 0.7f, -0.75f}};
static const float albedos[3] = {0.3f, 0.6f, 0.9f}; /* a channel */

static void keeps_light(room *r, uint32_t reflections) {
    lab l;
    for (uint32_t m = 0; m < ROOM_MATERIALS; m++)
        room_paint(r, m, albedos[0], albedos[1], albedos[2]);
    open_lab(&l, r);
    photons_light light[2];
    transport_state states[2];
    for (int i = 0; i < 2; i++) {
        light[i] = room_point_light(lamps[i][0], lamps[i][1], lamps[i][2], 1);
        states[i] = (transport_state){&light[i], 1};
    }
    double got[6];
    arriving(&l, states, 2, reflections, usual, got);
    for (int i = 0; i < 6; i++) {
        const double albedo = (double)albedos[i % 3], part = got[i] / (4 * PI * (i % 3 + 1)),
                     right = right_part(albedo, reflections);
        if (!(fabs(part / right - 1) < 4e-3))
            fail_msg("%u reflections, albedo %g, light %d: %.5f of the light comes, %.5f is right", reflections, albedo, i / 3,
                     part, right);
    }
    close_lab(&l);
}

static void a_closed_room_keeps_its_light(void **state) {
    (void)state;
    static const uint32_t reflections[] = {1, 3, TRANSPORT_CONVERGED};
    for (size_t k = 0; k < sizeof reflections / sizeof *reflections; k++)
        keeps_light(room_closed(0.5f), reflections[k]);
}

/* A wall without thickness, as white as the room's. */
static void what_stands_in_a_room_keeps_it_too(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    room_quad(r, (const float[]){-0.3f, -1, -1}, (const float[]){0, 0, 1.4f}, (const float[]){0, 1.5f, 0}, WALLS);
    keeps_light(r, TRANSPORT_CONVERGED);
}

/* One state of a room in which all is painted; what comes is right within a part of it. */
static void expect(const lab *l, const photons_light *lights, uint32_t count, const double watts[3], uint32_t reflections,
                   effort e, double within) {
    double got[3];
    const transport_state only = {lights, count};
    arriving(l, &only, 1, reflections, e, got);
    for (int k = 0; k < 3; k++) {
        const double part = got[k] / watts[k], right = right_part((double)albedos[k], reflections);
        if (!(fabs(part / right - 1) < within))
            fail_msg("albedo %g: %.5f of the light comes, %.5f is right", (double)albedos[k], part, right);
    }
}

static void open_painted(lab *l, room *r) {
    for (uint32_t m = 0; m < ROOM_MATERIALS; m++)
        room_paint(r, m, albedos[0], albedos[1], albedos[2]);
    open_lab(l, r);
}

static const double of_points[3] = {4 * PI, 8 * PI, 12 * PI}; /* W of room_point_light() */

/* A lamp 3 cm over the floor: half of its light falls on what a cell or two are. */
static void a_bright_spot_is_kept(void **state) {
    (void)state;
    lab l;
    open_painted(&l, room_closed(0.5f));
    const photons_light lamp = room_point_light(0.13f, -0.97f, -0.21f, 1);
    expect(&l, &lamp, 1, of_points, TRANSPORT_CONVERGED, (effort){16, 64, CELLS, 64 * CELLS}, 0.02);
    close_lab(&l);
}

/* Discs of light smaller than a cell, which most looks at the cell miss. What looks have found must not decide how many more a
 * cell gets, or what they missed stays missed: half of the light. Few rays leave a look each to most cells: 8 % of noise. */
static void small_spots_that_are_mostly_missed_are_kept(void **state) {
    (void)state;
    enum { BEAMS = 1024 };
    static photons_light lamp[BEAMS]; /* large for a stack */
    const double away = 0.2, outer = cos(atan(0.0085 / away)), inner = cos(atan(0.0076 / away));
    double watts[3] = {0};
    lab l;
    open_painted(&l, room_closed(0.5f));
    for (uint32_t i = 0; i < BEAMS; i++) {
        vit_light *of = &lamp[i].light;
        const uint32_t axis = i % 3;
        const float sign = i / 3 % 2 ? 1.0f : -1.0f;
        lamp[i] = room_point_light(0.0f, 0.0f, 0.0f, 1);
        of->kind = VIT_LIGHT_SPOT;
        of->position[axis] = sign * (float)(1 - away);
        of->position[(axis + 1) % 3] = 1.9f * lattice_u(i, 1) - 0.95f;
        of->position[(axis + 2) % 3] = 1.9f * lattice_v(i, 7) - 0.95f;
        memset(of->direction, 0, sizeof of->direction);
        of->direction[axis] = sign;
        of->cos_outer = (float)outer;
        of->spot_scale = (float)(1 / (inner - outer));
        of->spot_offset = (float)(-outer / (inner - outer));
        for (int k = 0; k < 3; k++)
            watts[k] += (double)of->intensity[k] * 2 * PI * (1 - inner + (inner - outer) / 3);
    }
    expect(&l, lamp, BEAMS, watts, 1, (effort){34, 1, 4 * CELLS, 1}, 0.25);
    close_lab(&l);
}

/* Few receivers with few rays know few of many cells, and rays of the last cells that are found meet others mostly: those that
 * they know stand for all. Lamps that are dark take most of the looks at lights, for a shorter test. */
static void rays_that_meet_unknown_cells_lose_no_light(void **state) {
    (void)state;
    enum { LAMPS = 64 };
    photons_light lamp[LAMPS];
    lab l;
    open_painted(&l, room_closed(0.5f));
    for (int i = 0; i < LAMPS; i++) {
        lamp[i] = room_point_light(0.0f, 0.0f, 0.0f, 1);
        for (int k = 0; k < 3 && i > 0; k++)
            lamp[i].light.intensity[k] = 0.0f;
    }
    expect(&l, lamp, LAMPS, of_points, TRANSPORT_CONVERGED, (effort){1, 64, 8 * CELLS, 1}, 0.2);
    close_lab(&l);
}

/* A plate that shines on both sides, 5 mm under the ceiling. */
static void light_from_very_near_is_kept(void **state) {
    (void)state;
    lab l;
    room *r = room_closed(0.5f);
    room_quad(r, (const float[]){-0.2f, 0.995f, -0.2f}, (const float[]){0.4f, 0, 0}, (const float[]){0, 0, 0.4f}, WALLS);
    open_painted(&l, r);
    for (int k = 0; k < 3; k++)
        r->materials[WALLS].emission[k] = (float)(k + 1);
    r->materials[WALLS].lights = 1;
    const vit_camera eye = {.eye = {0.9f, -0.9f, 0.9f}};
    area_lights plate;
    vit_text why = {""};
    assert_int_equal(area_lights_find(&l.scene, &eye, 1, 1, &plate, &why), VIT_OK);
    assert_true(fabs(plate.area - 0.32) < 1e-6);
    const photons_light lamp = {.area = &plate};
    expect(&l, &lamp, 1, plate.flux, 1, (effort){16, 128, CELLS / 4, 1}, 0.02);
    area_lights_free(&plate);
    close_lab(&l);
}

/* What a place of the wall x = -1 gets of a light by way of the floor alone, over the floor's albedo, in the first channel: the
 * floor's radiosity times the form factor, summed over strips that grow away from the wall. */
static double by_way_of_the_floor(const vit_light *light, double y, double z) {
    enum { ACROSS = 400, ALONG = 800 };
    const double high = (double)light->position[1] + 1, up = y + 1;
    double sum = 0;
    for (int i = 0; i < ACROSS; i++) {
        const double from = 2.0 * i * i / (ACROSS * ACROSS), to = 2.0 * (i + 1) * (i + 1) / (ACROSS * ACROSS),
                     away = (from + to) / 2, x = away - 1 - (double)light->position[0];
        for (int k = 0; k < ALONG; k++) {
            const double at = -1 + 2 * (k + 0.5) / ALONG, lz = at - (double)light->position[2],
                         l2 = x * x + high * high + lz * lz, d2 = away * away + up * up + (at - z) * (at - z);
            sum += high / (l2 * sqrt(l2)) * away * up / (PI * d2 * d2) * (to - from) * 2 / ALONG;
        }
    }
    return sum;
}

/* Places of the wall x = -1 round a lamp near its foot. */
static uint32_t beside_the_lamp(const lab *l, float z, receiver *at, uint32_t most) {
    uint32_t count = 0;
    for (uint32_t s = 0; s < 2 * l->r->m.triangles; s++)
        for (uint32_t i = 0; i < 20000 && side_face(&l->r->g, s).x > 0.99f && count < most; i++) {
            const receiver r = {.side = s, .b1 = unit_float(pcg(i)), .b2 = unit_float(pcg(i + 20000))};
            const vec3 p = side_place(&l->r->g, s, r.b1, r.b2);
            if (r.b1 + r.b2 < 1 && p.x < -0.99f && p.y < -0.86f && p.y > -0.97f && fabsf(p.z - z) < 0.15f)
                at[count++] = r;
        }
    return count;
}

/* A lamp close over the floor, beside a wall: much of what the wall gets comes from a spot no further away than cells are
 * large. */
static void light_of_a_spot_close_by_comes_from_where_it_is(void **state) {
    (void)state;
    enum { PLACES = 12 };
    lab l;
    open_painted(&l, room_closed(0.5f));
    const photons_light lamp = room_point_light(-0.93f, -0.96f, 0.13f, 1);
    const transport_state only = {&lamp, 1};
    receiver at[PLACES];
    float irradiance[3 * PLACES];
    const transport_input in = {.rays = &l.rays,
                                .geometry = &l.r->g,
                                .receivers = at,
                                .receiver_count = beside_the_lamp(&l, 0.13f, at, PLACES),
                                .states = &only,
                                .state_count = 1,
                                .reflections = 1,
                                .cells = 256,
                                .receiver_rays = 4096,
                                .bounce_rays = 1,
                                .looks = LOOKS};
    transport_report report;
    vit_text why = {""};
    assert_int_equal(in.receiver_count, PLACES);
    assert_int_equal(transport_find(&in, &(transport_light){.irradiance = irradiance}, &report, &why), VIT_OK);
    for (int i = 0; i < PLACES; i++) {
        const vec3 p = side_place(&l.r->g, at[i].side, at[i].b1, at[i].b2);
        const double right = by_way_of_the_floor(&lamp.light, (double)p.y, (double)p.z) * (double)albedos[0],
                     got = (double)irradiance[3 * i];
        print_message("%g above the floor: %.4f for %.4f\n", (double)p.y + 1, got, right);
        assert_true(got > right && got < 1.1 * right); /* other walls add a little */
    }
    close_lab(&l);
}

enum { ROOMS = 4 };

/* Four rooms, parted by two walls that cross in the middle; a lamp in one. Cells of floor and ceiling go on beneath the walls,
 * and those in the middle have parts in all four. */
static void light_does_not_get_past_walls_that_cross(void **state) {
    (void)state;
    lab l;
    room *r = room_closed(0.5f);
    room_quad(r, (const float[]){0.07f, -1, -1}, (const float[]){0, 0, 2}, (const float[]){0, 2, 0}, WALLS);
    room_quad(r, (const float[]){-1, -1, 0.05f}, (const float[]){2, 0, 0}, (const float[]){0, 2, 0}, WALLS);
    open_painted(&l, r);
    const photons_light lamp = room_point_light(0.4f, 0.1f, 0.3f, 1);
    const transport_state only = {&lamp, 1};
    places at;
    float *irradiance = light_of(&l, &only, 1, TRANSPORT_CONVERGED, (effort){8, 512, 256, 65536}, &at);
    double got[ROOMS] = {0};
    for (uint32_t i = 0; i < at.count; i++) {
        const receiver *from = at.each + i;
        const vec3 p = vec3_along(side_place(&l.r->g, from->side, from->b1, from->b2), side_face(&l.r->g, from->side), 1e-3f);
        got[2 * (p.x < 0.07f) + (p.z < 0.05f)] += (double)irradiance[3 * i];
    }
    print_message("light of the dark rooms over that of the lit one: %g %g %g\n", got[1] / got[0], got[2] / got[0],
                  got[3] / got[0]);
    for (int i = 1; i < ROOMS; i++)
        assert_true(got[i] < 1e-3 * got[0]);
    free(irradiance);
    free(at.each);
    close_lab(&l);
}

/* A wall with two faces across the room, thick or thin, at five places each: of cells that go on beneath it some have a single
 * one of the places that are looked at beyond it, which must not count as inside of the wall, and some have none within it. */
static void light_does_not_get_past_walls_with_two_faces(void **state) {
    (void)state;
    for (int k = 0; k < 10; k++) {
        lab l;
        room *r = room_closed(0.5f);
        const float left = 0.01f + 0.026f * (float)(k % 5), right = left + (k < 5 ? 0.11f : 0.007f);
        room_quad(r, (const float[]){left, -1, -1}, (const float[]){0, 0, 2}, (const float[]){0, 2, 0}, WALLS);
        room_quad(r, (const float[]){right, -1, -1}, (const float[]){0, 2, 0}, (const float[]){0, 0, 2}, WALLS);
        open_painted(&l, r);
        const photons_light lamp = room_point_light(-0.4f, 0.1f, 0.3f, 1);
        const transport_state only = {&lamp, 1};
        places at;
        float *irradiance = light_of(&l, &only, 1, TRANSPORT_CONVERGED, (effort){8, 512, 256, 65536}, &at);
        double lit = 0, beyond = 0;
        for (uint32_t i = 0; i < at.count; i++) {
            const receiver *from = at.each + i;
            const vec3 p =
                vec3_along(side_place(&l.r->g, from->side, from->b1, from->b2), side_face(&l.r->g, from->side), 1e-3f);
            *(p.x < left ? &lit : &beyond) += (double)irradiance[3 * i];
        }
        print_message("wall from %g to %g: light within and beyond it over that before it: %g\n", (double)left, (double)right,
                      beyond / lit);
        assert_true(beyond < 1e-6 * lit);
        free(irradiance);
        free(at.each);
        close_lab(&l);
    }
}

/* Two rooms with a gap under the wall between them: most places of the dark one see lit cells, but none of their light. What
 * cells' means and light close by add up to is 0 there, and not less. */
static void light_is_never_less_than_none(void **state) {
    (void)state;
    lab l;
    room *r = room_closed(0.5f);
    room_quad(r, (const float[]){0.07f, -0.98f, -1}, (const float[]){0, 0, 2}, (const float[]){0, 1.98f, 0}, WALLS);
    open_painted(&l, r);
    const photons_light lamp = room_point_light(0.6f, -0.7f, 0.3f, 1);
    const transport_state only = {&lamp, 1};
    places at;
    uint32_t dark = 0;
    float *irradiance = light_of(&l, &only, 1, 1, (effort){32, 64, 256, 1}, &at);
    for (uint32_t i = 0; i < 3 * at.count; i++) {
        assert_true(irradiance[i] >= 0);
        dark += irradiance[i] < 1e-6f;
    }
    print_message("%u of %u without light\n", dark, 3 * at.count);
    assert_true(dark > 0);
    free(irradiance);
    free(at.each);
    close_lab(&l);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_closed_room_keeps_its_light),
        cmocka_unit_test(what_stands_in_a_room_keeps_it_too),
        cmocka_unit_test(a_bright_spot_is_kept),
        cmocka_unit_test(small_spots_that_are_mostly_missed_are_kept),
        cmocka_unit_test(rays_that_meet_unknown_cells_lose_no_light),
        cmocka_unit_test(light_from_very_near_is_kept),
        cmocka_unit_test(light_of_a_spot_close_by_comes_from_where_it_is),
        cmocka_unit_test(light_does_not_get_past_walls_that_cross),
        cmocka_unit_test(light_does_not_get_past_walls_with_two_faces),
        cmocka_unit_test(light_is_never_less_than_none),
    };
    return cmocka_run_group_tests_name("transport", tests, NULL, NULL);
}
