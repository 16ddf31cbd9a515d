/* Photons of still lights. In a closed, empty, convex room every path goes on for ever and every photon tells where its path
 * was before, so that counts, powers and directions are known exactly, and the tests need few tolerances: what is random is
 * where photons go, not how many there are or what they carry. test_photons_kernel.c compares them with the kernel's. */
#include "photon_room.h"

#define PI 3.14159265358979

static void each_bounce_has_the_lights_power_times_a_power_of_the_albedo(void **state) {
    (void)state;
    enum { PATHS = 4096, STORED = 4 };
    static const float albedo[3] = {0.8f, 0.5f, 0.2f};
    room *r = room_closed(0.0f);
    for (uint32_t i = 0; i < ROOM_MATERIALS; i++)
        room_paint(r, i, albedo[0], albedo[1], albedo[2]);
    r->lights[0] = room_point_light(0.3f, -0.2f, 0.5f, PATHS);
    room_finish(r, 1, STORED + 1);
    uint32_t count;
    vit_photon *photons = room_bake(r, 1, &count);
    assert_int_equal(count, PATHS * STORED); /* no path is lost through a seam */
    for (int bounce = 0; bounce < STORED; bounce++)
        for (int c = 0; c < 3; c++) {
            double watts = 0.0;
            for (int p = 0; p < PATHS; p++)
                watts += room_watts(&photons[bounce * PATHS + p], c);
            const double expected = 4.0 * PI * (double)r->lights[0].light.intensity[c] * pow((double)albedo[c], bounce + 1);
            assert_true(fabs(watts / expected - 1.0) < 1e-5);
        }
    free(photons);
    room_drop(r);
}

static void photons_lie_just_off_the_walls_and_travel_towards_them(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    r->lights[0] = room_point_light(0.0f, 0.9f, 0.0f, 2048);
    room_finish(r, 1, 4);
    uint32_t count;
    vit_photon *photons = room_bake(r, 1, &count);
    for (uint32_t i = 0; i < count; i++) {
        const vit_photon *p = &photons[i];
        double squared = 0.0, gap = 2.0, towards = 0.0;
        for (int k = 0; k < 3; k++) {
            const double x = (double)p->position[k], d = (double)p->direction[k];
            squared += d * d;
            assert_true(fabs(x) < 1.0);
            if (1.0 - fabs(x) < gap) {
                gap = 1.0 - fabs(x);
                towards = x > 0 ? d : -d;
            }
        }
        assert_true(fabs(gap - (double)r->in.ray_offset) < 1e-6 && towards > 0.0 && fabs(squared - 1.0) < 1e-5);
        assert_true(p->radius2 == 0.0625f && p->inv_radius2 == 16.0f && p->zone == 0);
    }
    assert_int_equal(count, 3 * 2048);
    free(photons);
    room_drop(r);
}

/* A lamp between a plate and the ceiling 2 cm above it: what goes to and fro there must not be seen a radius beside the plate;
 * in the room photons are as wide as ever. */
static void light_in_a_gap_is_not_spread_beyond_it(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    room_quad(r, (const float[]){-0.4f, 0.98f, 0.4f}, (const float[]){0.8f, 0, 0}, (const float[]){0, 0, -0.8f}, WALL_FLOOR);
    r->lights[0] = room_point_light(0.01f, 0.99f, 0.02f, 4096);
    room_finish(r, 1, 4);
    uint32_t count, inside = 0, below = 0;
    vit_photon *photons = room_bake(r, 1, &count);
    for (uint32_t i = 0; i < count; i++) {
        const vit_photon *p = photons + i;
        const double way = 0.02 / fabs((double)p->direction[1]), width = sqrt((double)p->radius2);
        double least = 1;
        for (int k = 0; k < 3; k += 2) /* to the plate's edge, of where it came from as well */
            least = fmin(least, 0.4 - fmax(fabs((double)p->position[k]),
                                           fabs((double)(p->position[k]) - (double)p->direction[k] * way)));
        if (p->position[1] > 0.98f && least > 0) {
            const double wanted = fmin(0.25, fmax(0.4 * way, 0.25 / 64));
            assert_true(fabs(width / wanted - 1) < 0.01);
            inside++;
        } else if (p->position[1] < -0.9f) {
            assert_true(fabs(width - 0.25) < 1e-6);
            below++;
        }
        assert_true(fabs((double)p->radius2 * (double)p->inv_radius2 - 1) < 1e-6);
    }
    print_message("%u in the gap, %u on the floor\n", inside, below);
    assert_true(inside > 4000 && below > 20);
    free(photons);
    room_drop(r);
}

static void paths_that_leave_the_scene_store_nothing_more(void **state) {
    (void)state;
    room *r = room_empty(0.9f);
    room_wall(r, WALL_FLOOR);
    r->lights[0] = room_point_light(0.0f, 0.0f, 0.0f, 4096);
    room_finish(r, 1, 5);
    uint32_t count = 1;
    assert_null(room_bake(r, 1, &count)); /* from the floor alone, no second hit */
    assert_int_equal(count, 0);
    room_drop(r);
}

static void the_first_hit_is_left_to_direct_light(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    r->lights[0] = room_point_light(0.2f, 0.1f, 0.0f, 2048);
    room_finish(r, 1, 1);
    uint32_t count = 1;
    assert_null(room_bake(r, 1, &count));
    assert_int_equal(count, 0);
    r->in.bounces = 2;
    vit_photon *photons = room_bake(r, 1, &count);
    assert_int_equal(count, 2048);
    for (uint32_t i = 0; i < count; i++) { /* a photon that came straight from the light would be the light's direct light */
        double miss = 0.0, at[3], along = 0.0;
        const float *light = r->lights[0].light.position;
        for (int k = 0; k < 3; k++)
            along += ((double)photons[i].position[k] - (double)light[k]) * (double)photons[i].direction[k];
        for (int k = 0; k < 3; k++)
            miss += pow((double)photons[i].position[k] - (double)light[k] - along * (double)photons[i].direction[k], 2.0);
        const int from = room_origin(&photons[i], at), axis = from / 2;
        assert_false(miss < 1e-12);
        assert_true(fabs((double)photons[i].position[axis] - at[axis]) > 1e-3); /* on another wall than the path's first hit */
    }
    free(photons);
    room_drop(r);
}

static void a_point_light_shines_evenly_in_all_directions(void **state) {
    (void)state;
    enum { BANDS = 6, SECTORS = 8, PATHS = 48 * 500 };
    int bins[BANDS][SECTORS] = {{0}};
    room *r = room_closed(0.5f);
    r->lights[0] = room_point_light(0.0f, 0.0f, 0.0f, PATHS);
    room_finish(r, 1, 2);
    uint32_t count;
    vit_photon *photons = room_bake(r, 2, &count);
    assert_int_equal(count, PATHS);
    for (uint32_t i = 0; i < count; i++) {
        double at[3];
        room_origin(&photons[i], at);
        const double height = at[1] / sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]),
                     turn = atan2(at[2], at[0]) / (2.0 * PI);
        const int band = (int)((height + 1.0) / 2.0 * BANDS), sector = (int)((turn + 0.5) * SECTORS);
        bins[band < BANDS ? band : BANDS - 1][sector < SECTORS ? sector : SECTORS - 1]++;
    }
    double chi2 = 0.0;
    for (int c = 0; c < BANDS * SECTORS; c++)
        chi2 += pow(bins[c / SECTORS][c % SECTORS] - 500.0, 2.0) / 500.0;
    assert_true(chi2 < 72.4); /* 1 % quantile of 47 degrees of freedom; stratified paths stay far below */
    free(photons);
    room_drop(r);
}

static void a_spot_light_stays_in_its_cone_and_fades_towards_its_rim(void **state) {
    (void)state;
    enum { PATHS = 8192 };
    const double inner = cos(15.0 * PI / 180.0), outer = cos(30.0 * PI / 180.0);
    room *r = room_closed(0.5f);
    photons_light *l = &r->lights[0];
    *l = room_point_light(0.1f, 0.6f, -0.1f, PATHS);
    l->light.kind = VIT_LIGHT_SPOT;
    l->light.cos_outer = (float)outer;
    l->light.spot_scale = (float)(1.0 / (inner - outer));
    l->light.spot_offset = (float)(-outer / (inner - outer));
    room_finish(r, 1, 2);
    uint32_t count;
    vit_photon *photons = room_bake(r, 1, &count);
    double watts = 0.0, expected = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        double at[3], length = 0.0;
        room_origin(&photons[i], at);
        for (int k = 0; k < 3; k++)
            length += pow(at[k] - (double)l->light.position[k], 2.0);
        assert_true(((double)l->light.position[1] - at[1]) / sqrt(length) > outer - 1e-4);
        watts += room_watts(&photons[i], 2);
    }
    for (int i = 0; i < 10000; i++) { /* intensity over the cone, by midpoints */
        const double c = outer + (1.0 - outer) * (i + 0.5) / 10000.0, a = fmin(1.0, (c - outer) / (inner - outer));
        expected += 0.5 * 3.0 * a * a * 2.0 * PI * (1.0 - outer) / 10000.0;
    }
    assert_true(fabs(watts / expected - 1.0) < 2e-3);
    free(photons);
    room_drop(r);
}

static void a_lights_range_dims_its_photons_as_its_direct_light(void **state) {
    (void)state;
    for (uint32_t falloff = VIT_FALLOFF_INVERSE_SQUARE; falloff <= VIT_FALLOFF_WINDOW; falloff++) {
        room *r = room_closed(0.5f);
        r->lights[0] = room_point_light(0.0f, 0.0f, 0.0f, 1024);
        r->lights[0].light.inv_range2 = 1.0f / 2.0f; /* between the middle of a wall and a corner of the room */
        r->lights[0].light.falloff = falloff;
        room_finish(r, 1, 2);
        uint32_t count;
        vit_photon *photons = room_bake(r, 1, &count);
        assert_in_range(count, 400, 1023); /* nothing reaches the corners */
        for (uint32_t i = 0; i < count; i++) {
            double at[3];
            room_origin(&photons[i], at);
            const double d2 = at[0] * at[0] + at[1] * at[1] + at[2] * at[2], q = d2 / 2.0;
            const double factor = falloff == VIT_FALLOFF_WINDOW ? (1.0 - q) * d2 : 1.0 - q * q;
            assert_true(fabs(room_watts(&photons[i], 0) - 0.5 * 4.0 * PI / 1024.0 * factor) < 0.5 * 4.0 * PI / 1024.0 * 1e-3);
        }
        free(photons);
        room_drop(r);
    }
}

static void a_textured_floor_reflects_its_texels(void **state) {
    (void)state;
    enum { PATHS = 8192 };
    room *r = room_closed(0.0f);
    room_paint(r, WALL_FLOOR, 1.0f, 0.5f, 1.0f);
    room_texture(r, WALL_FLOOR, 0, 188, 255, 0, 255); /* left half: 0.503 of linear light; right half: black */
    r->lights[0] = room_point_light(0.0f, 0.0f, 0.0f, PATHS);
    room_finish(r, 1, 2);
    uint32_t count, plain = 0;
    vit_photon *photons = room_bake(r, 1, &count);
    assert_in_range(count, PATHS / 13, PATHS / 11); /* half of a sixth of the directions; the other walls are black */
    for (uint32_t i = 0; i < count; i++) {
        double at[3];
        assert_int_equal(room_origin(&photons[i], at), WALL_FLOOR);
        const double reflected = room_watts(&photons[i], 0) / (4.0 * PI / PATHS);
        const bool blurred = fabs(at[0]) < 0.1 || fabs(at[0]) > 0.9; /* next to the halves' border, which repeats */
        assert_true(at[0] < 0.1 || blurred);
        assert_true(blurred || fabs(reflected - 0.503) < 2e-3);
        assert_true(fabs(room_watts(&photons[i], 1) / (8.0 * PI / PATHS) - 0.5 * reflected) < 1e-5);
        plain += !blurred;
    }
    assert_true(plain > count / 2);
    free(photons);
    room_drop(r);
}

/* Where the line from a to b goes through the plane y = 0. */
static double crossing_x(const double a[3], const double b[3]) {
    return a[0] + (b[0] - a[0]) * a[1] / (a[1] - b[1]);
}

static void photons_pass_through_the_holes_of_a_cut_out_and_only_there(void **state) {
    (void)state;
    enum { PATHS = 8192, PLATE = WALLS };
    room *r = room_closed(0.5f);
    room_quad(r, (const float[]){-1, 0, 1}, (const float[]){2, 0, 0}, (const float[]){0, 0, -2}, PLATE);
    room_paint(r, PLATE, 0.0f, 0.0f, 0.0f);      /* so that every stored photon has met walls only */
    room_texture(r, PLATE, 0, 255, 255, 255, 0); /* holes where x > 0 */
    r->model_materials[PLATE].cutoff = 0.5f;
    r->lights[0] = room_point_light(0.0f, 0.5f, 0.0f, PATHS);
    room_finish(r, 1, 2);
    uint32_t count, first = 0, second = 0;
    vit_photon *photons = room_bake(r, 1, &count);
    for (uint32_t i = 0; i < count; i++) {
        double at[3];
        const double here[3] = {(double)photons[i].position[0], (double)photons[i].position[1], (double)photons[i].position[2]};
        const double light[3] = {0.0, 0.5, 0.0};
        if (fabs(here[1]) < 1e-3 && fabs(here[0]) < 0.999 && fabs(here[2]) < 0.999) {
            assert_true(here[0] < 1e-3); /* on the solid half of the plate */
            continue;
        }
        room_origin(&photons[i], at);
        const bool to_first = at[1] < 0.0, to_second = at[1] * here[1] < 0.0;
        assert_true(!to_first || crossing_x(light, at) > -1e-3);
        assert_true(!to_second || crossing_x(at, here) > -1e-3);
        first += to_first;
        second += to_second;
    }
    assert_true(first > PATHS / 10 && second > PATHS / 10);
    free(photons);
    room_drop(r);
}

static void of_faces_in_one_place_the_first_triangle_reflects(void **state) {
    (void)state;
    enum { PATHS = 4096, COPIES = 4 };
    room *r = room_closed(0.0f);
    for (int i = 0; i < COPIES; i++) {
        room_wall(r, WALL_FLOOR);
        r->m.material[r->m.triangles - 2] = r->m.material[r->m.triangles - 1] = (uint32_t)(WALLS + i);
        room_paint(r, (uint32_t)(WALLS + i), 0.2f * (float)(i + 1), 0.0f, 0.0f);
    }
    room_paint(r, WALL_FLOOR, 1.0f, 0.0f, 0.0f);
    r->lights[0] = room_point_light(0.0f, 0.0f, 0.0f, PATHS);
    room_finish(r, 1, 2);
    uint32_t count;
    vit_photon *photons = room_bake(r, 1, &count);
    assert_in_range(count, PATHS / 7, PATHS / 5);
    for (uint32_t i = 0; i < count; i++) {
        double at[3];
        room_origin(&photons[i], at);
        float expected = -1.0f; /* albedo of the first floor triangle, in the pack's order, whose half of the square it is */
        for (uint32_t t = 0; expected < 0.0f && t < r->m.triangles; t++) {
            const vit_triangle *g = &r->g.triangles[t];
            const double middle = ((double)g->v0[0] + (double)g->v1[0] + (double)g->v2[0] + (double)g->v0[2] +
                                   (double)g->v1[2] + (double)g->v2[2]) /
                                  3.0;
            const bool is_floor = g->v0[1] == -1.0f && g->v1[1] == -1.0f && g->v2[1] == -1.0f;
            if (is_floor && middle * (at[0] + at[2]) > 0.0)
                expected = r->materials[r->g.attributes[t].material].albedo[0];
        }
        const bool on_diagonal = fabs(at[0] + at[2]) < 1e-3;
        assert_true(on_diagonal || fabs(room_watts(&photons[i], 0) / (4.0 * PI / PATHS) - (double)expected) < 1e-5);
    }
    free(photons);
    room_drop(r);
}

typedef struct steps {
    double last;
    int calls;
    bool backwards;
} steps;

static void count_step(void *user, double done) {
    steps *s = user;
    s->backwards |= done < s->last || done > 1.0;
    s->last = done;
    s->calls++;
}

static void the_bytes_are_the_same_with_one_thread_and_with_more(void **state) {
    (void)state;
    room *r = room_closed(0.6f);
    room_wall(r, WALL_FLOOR); /* twice in one place */
    r->lights[0] = room_point_light(0.0f, 0.5f, 0.0f, 10000);
    r->lights[1] = room_point_light(0.5f, 0.0f, 0.5f, 6016);
    r->lights[1].light.inv_range2 = 0.5f; /* some paths end early */
    room_finish(r, 2, 5);
    steps s = {0.0, 0, false};
    uint32_t count[3];
    vit_photon *one = room_bake(r, 1, &count[0]);
    r->in.progress = count_step;
    r->in.user = &s;
    vit_photon *two = room_bake(r, 2, &count[1]);
    r->in.progress = NULL;
    vit_photon *seven = room_bake(r, 7, &count[2]);
    assert_in_range(count[0], 45000, 4 * 16016 - 1);
    assert_int_equal(count[0], count[1]);
    assert_int_equal(count[0], count[2]);
    assert_memory_equal(one, two, count[0] * sizeof *one);
    assert_memory_equal(one, seven, count[0] * sizeof *one);
    assert_true(s.calls >= 2 && s.last == 1.0 && !s.backwards);
    free(one);
    free(two);
    free(seven);
    room_drop(r);
}

static void a_light_has_the_same_photons_alone_and_among_others(void **state) {
    (void)state;
    room *r = room_closed(0.6f);
    r->lights[0] = room_point_light(0.0f, 0.5f, 0.0f, 512);
    r->lights[1] = room_point_light(0.5f, 0.0f, 0.5f, 512);
    room_finish(r, 2, 3);
    uint32_t both_count, alone_count;
    vit_photon *both = room_bake(r, 1, &both_count);
    r->in.lights = &r->lights[1];
    r->in.light_count = 1;
    r->in.first_path = 512;
    vit_photon *alone = room_bake(r, 1, &alone_count);
    assert_int_equal(both_count, 4 * 512);
    assert_int_equal(alone_count, 2 * 512);
    assert_memory_equal(alone, both + 2 * 512, alone_count * sizeof *alone);
    r->in.first_path = 0;
    vit_photon *other = room_bake(r, 1, &alone_count);
    assert_memory_not_equal(other, alone, alone_count * sizeof *alone);
    free(other);
    free(alone);
    free(both);
    room_drop(r);
}

static void too_many_paths_are_refused_by_name(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    r->lights[1] = room_point_light(0.0f, 0.0f, 0.0f, PHOTONS_MAX_PATHS + 1);
    room_finish(r, 2, 2);
    vit_photon *photons = NULL;
    uint32_t count;
    vit_text why = {""};
    assert_int_equal(photons_bake(&r->in, 1, &photons, &count, &why), VIT_BAD_INPUT);
    assert_non_null(strstr(why.text, "still light 1"));
    assert_null(photons);
    room_drop(r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_bounce_has_the_lights_power_times_a_power_of_the_albedo),
        cmocka_unit_test(photons_lie_just_off_the_walls_and_travel_towards_them),
        cmocka_unit_test(light_in_a_gap_is_not_spread_beyond_it),
        cmocka_unit_test(paths_that_leave_the_scene_store_nothing_more),
        cmocka_unit_test(the_first_hit_is_left_to_direct_light),
        cmocka_unit_test(a_point_light_shines_evenly_in_all_directions),
        cmocka_unit_test(a_spot_light_stays_in_its_cone_and_fades_towards_its_rim),
        cmocka_unit_test(a_lights_range_dims_its_photons_as_its_direct_light),
        cmocka_unit_test(a_textured_floor_reflects_its_texels),
        cmocka_unit_test(photons_pass_through_the_holes_of_a_cut_out_and_only_there),
        cmocka_unit_test(of_faces_in_one_place_the_first_triangle_reflects),
        cmocka_unit_test(the_bytes_are_the_same_with_one_thread_and_with_more),
        cmocka_unit_test(a_light_has_the_same_photons_alone_and_among_others),
        cmocka_unit_test(too_many_paths_are_refused_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
