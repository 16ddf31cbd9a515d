/* Points on area lights: where they lie, how evenly, and how much they shine together; and the photons that leave there. The
 * room is tests/photon_room.h's; its lamps are quads of it. What a lamp gives is known: pi times radiance times area, of each
 * open side. */
#include "photon_room.h"

enum { LAMP = WALLS, OTHER };
#define RADIANCE 3.0f
#define PI 3.14159265358979

/* The room with what the test has put in, its lamps alight. */
static void light_up(room *r, float lamp, float other) {
    room_finish(r, 0, 6);
    const float l[3] = {lamp, 0.5f * lamp, 0.25f * lamp}, o[3] = {other, 0.5f * other, 0.25f * other};
    memcpy(r->materials[LAMP].emission, l, sizeof l);
    memcpy(r->materials[OTHER].emission, o, sizeof o);
    r->materials[LAMP].lights = r->materials[OTHER].lights = 1;
}

static area_lights find(const room *r, unsigned threads) {
    const photon_scene s = room_scene(r);
    const vit_camera eye = {.eye = {0.9f, -0.9f, 0.9f}};
    area_lights e;
    vit_text why = {""};
    if (area_lights_find(&s, &eye, 1, threads, &e, &why) != VIT_OK)
        fail_msg("%s", why.text);
    return e;
}

/* A square lamp of edge 1 at height y, its front down. */
static void square(room *r, float y, uint32_t material) {
    room_quad(r, (const float[]){-0.5f, y, -0.5f}, (const float[]){1, 0, 0}, (const float[]){0, 0, 1}, material);
}

static vit_light_sample *sets(const area_lights *e, uint32_t samples) {
    vit_light_sample *s = calloc(VIT_PATTERNS * samples, sizeof *s);
    assert_non_null(s);
    vit_text why = {""};
    assert_int_equal(area_lights_sets(e, samples, s, &why), VIT_OK);
    return s;
}

static void close_to(double is, double should, double within) {
    if (!(fabs(is / should - 1.0) <= within))
        fail_msg("%.9g should be %.9g within %g", is, should, within);
}

static void both_sides_of_a_hanging_lamp_shine(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    square(r, 0.5f, LAMP);
    light_up(r, RADIANCE, 0);
    area_lights e = find(r, 2);
    assert_int_equal(e.count, 4);
    close_to(e.area, 2.0, 1e-6);
    close_to(e.flux[0], 2 * PI * 3.0, 1e-6);
    close_to(e.flux[2], 2 * PI * 0.75, 1e-6);
    area_lights_free(&e);
    room_drop(r);
}

static void a_side_that_no_light_reaches_does_not(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    square(r, 0.5f, LAMP);
    light_up(r, RADIANCE, 0);
    for (uint32_t i = 0; i < r->m.triangles; i++)
        if ((r->g.attributes[i].material & VIT_MATERIAL_INDEX) == LAMP)
            r->g.attributes[i].material |= VIT_SIDE_DARK_BACK;
    area_lights e = find(r, 1);
    assert_int_equal(e.count, 2);
    vit_light_sample *s = sets(&e, 4);
    for (int i = 0; i < 4 * VIT_PATTERNS; i++) {
        assert_true(fabsf(s[i].normal[1]) > 0.999f);
        assert_true((s[i].normal[1] < 0) == (r->g.triangles[e.side[0] / 2].ny < 0)); /* the front's */
        close_to(0.5 - (double)s[i].position[1], -(double)s[i].normal[1] * (double)r->g.ray_offset, 0.01);
    }
    free(s);
    area_lights_free(&e);
    room_drop(r);
}

/* Against the ceiling, in two sheets nearer to one another than rays keep from surfaces, and in two in one place: what shines
 * is what one sees. */
static void covered_sides_do_not_shine_and_doubled_ones_once(void **state) {
    (void)state;
    for (int k = 0; k < 4; k++) {
        room *r = room_closed(0.5f);
        square(r, k == 0 ? 1.0f - 2e-6f : 0.5f, LAMP);
        if (k > 0) /* below, above, in the same place */
            square(r, k == 1 ? 0.5f - 2e-6f : k == 2 ? 0.5f + 2e-6f : 0.5f, LAMP);
        light_up(r, RADIANCE, 0);
        area_lights e = find(r, 2);
        close_to(e.area, k == 0 ? 1.0 : 2.0, 1e-5);
        close_to(e.flux[0], (k == 0 ? 1 : 2) * PI * 3.0, 1e-5);
        area_lights_free(&e);
        room_drop(r);
    }
}

static void every_set_shines_as_much_as_the_lamps(void **state) {
    (void)state;
    static const uint32_t counts[] = {1, 5, 16, 100};
    room *r = room_closed(0.5f);
    square(r, 0.99f, LAMP);
    room_ball(r, (const float[]){0.3f, -0.4f, 0.1f}, 0.2f, OTHER);
    light_up(r, RADIANCE, 7.0f);
    for (uint32_t i = 0; i < r->m.triangles; i++) /* the ball is closed */
        if ((r->g.attributes[i].material & VIT_MATERIAL_INDEX) == OTHER)
            r->g.attributes[i].material |= VIT_SIDE_DARK_BACK;
    area_lights e = find(r, 2);
    for (size_t n = 0; n < sizeof counts / sizeof *counts; n++) {
        vit_light_sample *s = sets(&e, counts[n]);
        double all = 0, area = 0;
        for (uint32_t k = 0; k < VIT_PATTERNS; k++) {
            double power = 0;
            for (uint32_t i = 0; i < counts[n]; i++) {
                power += (double)s[k * counts[n] + i].power[0];
                area += (double)s[k * counts[n] + i].radius2 * PI / VIT_PATTERNS;
            }
            if (counts[n] >= 100)
                close_to(power * PI, e.flux[0], 1e-5);
            all += power * PI / VIT_PATTERNS;
        }
        close_to(all, e.flux[0], 1e-5);
        if (counts[n] >= 100)
            close_to(area, e.area, 0.05);
        free(s);
    }
    area_lights_free(&e);
    room_drop(r);
}

/* One open side of a square: 16 random points have a mean that is 0.07 off an axis, 256 0.018. */
static void sets_are_even_over_a_square_and_so_are_neighbours_together(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    square(r, 1.0f - 2e-6f, LAMP);
    light_up(r, RADIANCE, 0);
    area_lights e = find(r, 1);
    vit_light_sample *s = sets(&e, 16);
    double all[2] = {0, 0}, worst = 0;
    uint32_t squares[8][8] = {{0}};
    for (int k = 0; k < VIT_PATTERNS; k++) {
        double mean[2] = {0, 0};
        for (int i = 0; i < 16; i++) {
            const float *p = s[16 * k + i].position;
            mean[0] += (double)p[0] / 16;
            mean[1] += (double)p[2] / 16;
            squares[(int)((p[0] + 0.5f) * 8)][(int)((p[2] + 0.5f) * 8)]++;
        }
        worst = fmax(worst, fmax(fabs(mean[0]), fabs(mean[1])));
        all[0] += mean[0] / VIT_PATTERNS;
        all[1] += mean[1] / VIT_PATTERNS;
    }
    print_message("a set's mean is %.4f off at most, all together %.5f, %.5f\n", worst, all[0], all[1]);
    assert_true(worst < 0.05);
    assert_true(fabs(all[0]) < 0.003 && fabs(all[1]) < 0.003);
    for (int i = 0; i < 64; i++) /* 4 points each, 256 in all */
        assert_in_range(squares[i / 8][i % 8], 2, 6);
    free(s);
    area_lights_free(&e);
    room_drop(r);
}

/* Twice as bright a lamp of half the area has as many points. */
static void points_follow_power(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    room_quad(r, (const float[]){-0.8f, 0, -0.5f}, (const float[]){0.2f, 0, 0}, (const float[]){0, 0, 1}, LAMP);
    room_quad(r, (const float[]){0.3f, 0, -0.5f}, (const float[]){0.4f, 0, 0}, (const float[]){0, 0, 1}, OTHER);
    light_up(r, 8.0f, 4.0f);
    area_lights e = find(r, 1);
    vit_light_sample *s = sets(&e, 32);
    for (int k = 0; k < VIT_PATTERNS; k++) {
        uint32_t left = 0;
        for (int i = 0; i < 32; i++)
            left += s[32 * k + i].position[0] < 0;
        assert_in_range(left, 15, 17);
    }
    free(s);
    area_lights_free(&e);
    room_drop(r);
}

/* The back of a lamp that hangs a hundredth below the ceiling lights the gap: few points for it, each so much stronger. */
static void a_side_that_lights_a_gap_has_few_points(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    square(r, 0.99f, LAMP);
    light_up(r, RADIANCE, 0);
    area_lights e = find(r, 2);
    vit_light_sample *s = sets(&e, 64);
    uint32_t up = 0;
    double power[2] = {0, 0};
    for (int i = 0; i < 64 * VIT_PATTERNS; i++) {
        up += s[i].normal[1] > 0;
        power[s[i].normal[1] > 0] += (double)s[i].power[0] / VIT_PATTERNS;
    }
    assert_in_range(up, 64 * VIT_PATTERNS / 16, 64 * VIT_PATTERNS / 4);
    close_to(power[0], 3.0, 1e-5);
    close_to(power[1], 3.0, 1e-5);
    free(s);
    area_lights_free(&e);
    room_drop(r);
}

/* A closed body of quads round a middle: edges, and whether it is a ball instead. */
typedef struct body {
    const char *what;
    float edge[3]; /* m; a ball: its diameter first */
    bool ball;
} body;

static void add_body(room *r, const body *b, const float middle[3]) {
    if (b->ball) {
        room_ball(r, middle, 0.5f * b->edge[0], LAMP);
        return;
    }
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 2; side++) {
            float corner[3], u[3] = {0, 0, 0}, v[3] = {0, 0, 0};
            for (int k = 0; k < 3; k++)
                corner[k] = middle[k] - 0.5f * b->edge[k];
            corner[axis] += side ? b->edge[axis] : 0.0f;
            const int first = (axis + (side ? 1 : 2)) % 3, second = (axis + (side ? 2 : 1)) % 3; /* its front outside */
            u[first] = b->edge[first];
            v[second] = b->edge[second];
            room_quad(r, corner, u, v, LAMP);
        }
}

/* Irradiance at p on a surface facing n of points that shine, in units of radiance. */
static double irradiance(const vit_light_sample *points, uint32_t count, const double p[3], const double n[3]) {
    double sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        const vit_light_sample *e = points + i;
        double to[3], d2 = 0, here = 0, there = 0;
        for (int k = 0; k < 3; k++) {
            to[k] = (double)e->position[k] - p[k];
            d2 += to[k] * to[k];
            here += to[k] * n[k];
            there -= to[k] * (double)e->normal[k];
        }
        sum += (double)e->power[0] * fmax(here, 0) * fmax(there, 0) / (d2 * fmax(d2, (double)e->radius2));
    }
    return sum / 3.0;
}

/* The same of the outsides of all triangles, each cut into many. */
static double irradiance_of_outside(const area_lights *e, const double p[3], const double n[3], const float middle[3]) {
    enum { CUTS = 24 };
    double sum = 0;
    for (uint32_t i = 0; i < e->count; i++) {
        const vit_triangle *t = e->scene.triangles + e->side[i] / 2;
        const double sign = e->side[i] & 1 ? -0.5 : 0.5;
        for (int a = 0; a < CUTS; a++)
            for (int b = 0; b < 2 * (CUTS - a) - 1; b++) {
                const double w1 = (a + (b % 2 ? 2.0 : 1.0) / 3) / CUTS, w2 = (b / 2 + (b % 2 ? 2.0 : 1.0) / 3) / CUTS;
                const double area[3] = {(double)t->nx * sign, (double)t->ny * sign, (double)t->nz * sign};
                double to[3], d2 = 0, here = 0, there = 0, out = 0;
                for (int k = 0; k < 3; k++) {
                    const double q = (double)t->v0[k] + w1 * (double)(t->v1[k] - t->v0[k]) + w2 * (double)(t->v2[k] - t->v0[k]);
                    to[k] = q - p[k];
                    d2 += to[k] * to[k];
                    here += to[k] * n[k];
                    there -= to[k] * area[k];
                    out += (q - (double)middle[k]) * area[k];
                }
                if (out > 0)
                    sum += fmax(here, 0) * fmax(there, 0) / (d2 * d2) / (CUTS * CUTS);
            }
    }
    return sum;
}

/* Insides have points, too; a set that has none of them must not shine more outside. The mean over sets is what a block of 4 x
 * 4 pixels shows. */
static void closed_bodies_shine_as_much_as_their_outsides(void **state) {
    (void)state;
    enum { PLACES = 5 };
    static const body bodies[] = {{"ball", {0.3f, 0, 0}, true},          {"small ball", {0.05f, 0, 0}, true},
                                  {"cube", {0.3f, 0.3f, 0.3f}, false},   {"large cube", {0.9f, 0.9f, 0.9f}, false},
                                  {"panel", {0.6f, 0.02f, 0.6f}, false}, {"tube", {0.03f, 0.03f, 1.0f}, false}};
    static const float middle[3] = {0.05f, 0.1f, -0.02f};
    static const double at[PLACES][2][3] = {{{0, -0.99, 0}, {0, 1, 0}},
                                            {{0.6, -0.99, 0.5}, {0, 1, 0}},
                                            {{-0.99, 0, 0.3}, {1, 0, 0}},
                                            {{0.2, 0.1, 0.99}, {0, 0, -1}},
                                            {{0.3, 0.99, 0.4}, {0, -1, 0}}};
    for (size_t b = 0; b < sizeof bodies / sizeof *bodies; b++) {
        room *r = room_closed(0.5f);
        add_body(r, bodies + b, middle);
        light_up(r, RADIANCE, 0);
        area_lights e = find(r, 2);
        for (uint32_t samples = 16; samples <= 64; samples *= 4) {
            vit_light_sample *s = sets(&e, samples);
            double should[PLACES], found[PLACES] = {0}, all = 0, all_found = 0;
            for (size_t i = 0; i < PLACES; i++) {
                double squares = 0;
                should[i] = irradiance_of_outside(&e, at[i][0], at[i][1], middle);
                for (uint32_t k = 0; k < VIT_PATTERNS; k++) {
                    vit_light_sample *set = s + k * samples;
                    for (uint32_t j = 0; j < samples; j++) { /* insides, if there are points, are not seen from here */
                        double out = 0;
                        for (int c = 0; c < 3; c++)
                            out += (double)((set[j].position[c] - middle[c]) * set[j].normal[c]);
                        if (out < 0)
                            memset(set[j].power, 0, sizeof set[j].power);
                    }
                    const double is = irradiance(set, samples, at[i][0], at[i][1]);
                    found[i] += is / VIT_PATTERNS;
                    squares += pow(is / should[i] - 1, 2) / VIT_PATTERNS;
                }
                all += should[i] / PLACES;
                all_found += found[i] / PLACES;
                print_message("  %-10s %u points: %.4f of right, sets vary by %.3f\n", bodies[b].what, samples,
                              found[i] / should[i], sqrt(squares));
            }
            close_to(all_found, all, 0.015);
            for (size_t i = 0; i < PLACES; i++)
                assert_true(fabs(found[i] - should[i]) < 0.06 * all); /* 256 points in all */
            free(s);
        }
        area_lights_free(&e);
        room_drop(r);
    }
}

/* What lights only itself lights nothing that is seen, unless the camera is in there. */
static void insides_of_closed_bodies_have_no_points_but_walls_round_the_camera_do(void **state) {
    (void)state;
    static const body cube = {"cube", {0.3f, 0.3f, 0.3f}, false};
    for (int k = 0; k < 3; k++) { /* closed; one wall open; a camera inside */
        room *r = room_closed(0.5f);
        add_body(r, &cube, k == 2 ? (const float[]){0.8f, -0.8f, 0.8f} : (const float[]){0, 0, 0});
        r->m.triangles -= k == 1 ? 2 : 0;
        light_up(r, RADIANCE, 0);
        area_lights e = find(r, 2);
        close_to(e.area, (k == 0 ? 6 : k == 1 ? 10 : 12) * 0.09, 1e-5);
        area_lights_free(&e);
        room_drop(r);
    }
}

static void holes_of_a_lamp_are_black(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    square(r, 0.5f, LAMP);
    room_texture(r, LAMP, 0, 255, 255, 255, 0);
    r->model_materials[LAMP].cutoff = 0.5f;
    light_up(r, RADIANCE, 0);
    area_lights e = find(r, 1);
    vit_light_sample *s = sets(&e, 64);
    double power = 0;
    for (int i = 0; i < 64 * VIT_PATTERNS; i++) {
        power += (double)s[i].power[0] / VIT_PATTERNS;
        assert_true((s[i].power[0] > 0) == (s[i].position[0] < 0) || fabsf(s[i].position[0]) < 0.02f);
    }
    close_to(power, 3.0, 0.02); /* two sides, a half each */
    free(s);
    area_lights_free(&e);
    room_drop(r);
}

/* In a closed room each reflection takes in all light of the one before: the watts of its photons are known. */
static void photons_of_a_lamp_carry_its_flux(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    square(r, 0.6f, LAMP);
    r->model_materials[LAMP].albedo[0] = 0.5f;
    light_up(r, RADIANCE, 0);
    area_lights e = find(r, 2);
    const photons_light l = {.paths = 8192, .area = &e};
    r->in.lights = &l;
    r->in.light_count = 1;
    uint32_t count;
    vit_photon *p = room_bake(r, 2, &count);
    double watts[3] = {0};
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            watts[k] += room_watts(p + i, k);
    const double part = 0.5 + 0.25 + 0.125 + 0.0625 + 0.03125;
    assert_int_equal(count, 8192 * 5);
    close_to(watts[0], e.flux[0] * part, 1e-4);
    close_to(watts[2], e.flux[2] * part, 1e-4);
    free(p);
    area_lights_free(&e);
    room_drop(r);
}

static void one_thread_and_three_find_the_same(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    room_ball(r, (const float[]){0.3f, -0.4f, 0.1f}, 0.2f, LAMP);
    square(r, 0.9f, OTHER);
    light_up(r, RADIANCE, 1);
    area_lights a = find(r, 1), b = find(r, 3);
    assert_int_equal(a.count, b.count);
    assert_memory_equal(a.side, b.side, a.count * sizeof *a.side);
    assert_memory_equal(a.sum, b.sum, a.count * sizeof *a.sum);
    area_lights_free(&a);
    area_lights_free(&b);
    room_drop(r);
}

static void without_lamps_there_is_nothing(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    square(r, 0.5f, LAMP);
    light_up(r, RADIANCE, 0);
    r->materials[LAMP].lights = 0; /* seen, but lighting nothing */
    area_lights e = find(r, 1);
    assert_int_equal(e.count, 0);
    assert_true(e.flux[0] == 0.0);
    area_lights_free(&e);
    room_drop(r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_sides_of_a_hanging_lamp_shine),
        cmocka_unit_test(a_side_that_no_light_reaches_does_not),
        cmocka_unit_test(covered_sides_do_not_shine_and_doubled_ones_once),
        cmocka_unit_test(every_set_shines_as_much_as_the_lamps),
        cmocka_unit_test(sets_are_even_over_a_square_and_so_are_neighbours_together),
        cmocka_unit_test(points_follow_power),
        cmocka_unit_test(a_side_that_lights_a_gap_has_few_points),
        cmocka_unit_test(closed_bodies_shine_as_much_as_their_outsides),
        cmocka_unit_test(insides_of_closed_bodies_have_no_points_but_walls_round_the_camera_do),
        cmocka_unit_test(holes_of_a_lamp_are_black),
        cmocka_unit_test(photons_of_a_lamp_carry_its_flux),
        cmocka_unit_test(one_thread_and_three_find_the_same),
        cmocka_unit_test(without_lamps_there_is_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
