/* Patches, form factors and bounces against closed forms.
 *
 * Why this is hard: form factors by rays are random, and the cases where they matter most, patches that touch, are where a
 * formula between two points is singular. Strategy: rooms and pairs of squares whose form factors and radiosity have closed
 * forms, cut into many patches, so that sums over patches are the closed forms' whatever the cut. */
#include "photon_room.h"
#include "radiosity/bounces.h"
#include "radiosity/live.h"

typedef struct lab {
    room *r;
    photon_scene scene;
    photon_rays rays;
    patch_set p;
    form_factors f;
} lab;

static void open_lab(lab *l, room *r, uint32_t count, uint32_t samples) {
    vit_text why = {""};
    room_finish(r, 0, 2);
    for (uint32_t i = 0; i < r->m.triangles; i++) /* light stays inside */
        r->g.attributes[i].material |= VIT_SIDE_DARK_BACK;
    l->r = r;
    l->scene = room_scene(r);
    assert_true(photon_rays_open(&l->scene, 1, &l->rays));
    /* A camera in the room's middle that turns: it sees every wall. */
    static vit_camera cameras[6];
    for (int i = 0; i < 6; i++) {
        vit_camera *c = &cameras[i];
        const int axis = i / 2, across = (axis + 1) % 3, down = (axis + 2) % 3;
        memset(c, 0, sizeof *c);
        c->eye[0] = 0.1f; /* beside what stands in the middle */
        c->corner[axis] = i % 2 ? 1.0f : -1.0f;
        c->corner[across] = c->corner[down] = -1.0f;
        c->right[across] = c->down[down] = 2.0f / 64.0f;
    }
    const tracks t = {.cameras = cameras};
    const patches_input in = {
        .rays = &l->rays, .geometry = &r->g, .tracks = &t, .frames = 6, .width = 64, .height = 64, .count = count};
    assert_int_equal(patches_make(&in, &l->p, &why), VIT_OK);
    const form_factors_input shoot = {.rays = &l->rays, .geometry = &r->g, .patches = &l->p, .samples = samples};
    assert_int_equal(form_factors_find(&shoot, &l->f, &why), VIT_OK);
}

static void close_lab(lab *l) {
    form_factors_free(&l->f);
    patches_free(&l->p);
    photon_rays_close(&l->rays);
    room_drop(l->r);
}

/* Form factor from all patches for which `from` holds to those for which `to` does. */
static double between(const lab *l, bool (*from)(const radiosity_patch *), bool (*to)(const radiosity_patch *)) {
    double sum = 0.0, area = 0.0;
    for (uint32_t i = 0; i < l->p.count; i++) {
        if (!from(&l->p.patch[i]))
            continue;
        area += (double)l->p.patch[i].area;
        for (size_t k = l->f.first[i]; k < l->f.first[i + 1]; k++)
            if (to(&l->p.patch[l->f.to[k]]))
                sum += (double)l->p.patch[i].area * (double)l->f.factor[k];
    }
    return sum / area;
}

static bool is_floor(const radiosity_patch *p) {
    return p->normal.y > 0.9f && p->center.y < 0.0f;
}

static bool is_ceiling(const radiosity_patch *p) {
    return p->normal.y < -0.9f && p->center.y > 0.0f;
}

static bool is_wall(const radiosity_patch *p) {
    return p->normal.x > 0.9f && p->center.x < 0.0f;
}

/* Squares of edge 2, 2 apart: as squares of edge 1 at distance 1 (Howell, C-11). */
static void parallel_squares_have_their_form_factor(void **state) {
    (void)state;
    const double x = 1.0, right = 2.0 / (3.14159265358979 * x * x) *
                                  (log(sqrt((1 + x * x) * (1 + x * x) / (1 + 2 * x * x))) +
                                   2 * x * sqrt(1 + x * x) * atan(x / sqrt(1 + x * x)) - 2 * x * atan(x));
    for (uint32_t count = 4; count <= 1024; count *= 16) {
        lab l;
        room *r = room_empty(0.5f);
        room_wall(r, WALL_FLOOR);
        room_wall(r, WALL_CEILING);
        open_lab(&l, r, count, 4194304u / count > 65536u ? 65536u : 4194304u / count);
        const double up = between(&l, is_floor, is_ceiling), down = between(&l, is_ceiling, is_floor);
        if (fabs(up / right - 1.0) > 1e-3 || fabs(down / right - 1.0) > 1e-3)
            fail_msg("%u patches: %.6f up, %.6f down, right is %.6f", l.p.count, up, down, right);
        close_lab(&l);
    }
}

/* Squares that share an edge (Howell, C-14). */
static void squares_that_share_an_edge_have_their_form_factor(void **state) {
    (void)state;
    const double right =
        1.0 / 3.14159265358979 * (2 * atan(1.0) - sqrt(2.0) * atan(1.0 / sqrt(2.0)) + 0.25 * log(4.0 / 3.0 * 0.75 * 0.75));
    for (uint32_t count = 4; count <= 1024; count *= 16) {
        lab l;
        room *r = room_empty(0.5f);
        room_wall(r, WALL_FLOOR);
        room_wall(r, WALL_LEFT);
        open_lab(&l, r, count, 4194304u / count > 65536u ? 65536u : 4194304u / count);
        const double up = between(&l, is_floor, is_wall), down = between(&l, is_wall, is_floor);
        if (fabs(up / right - 1.0) > 1e-3 || fabs(down / right - 1.0) > 1e-3)
            fail_msg("%u patches: %.6f up, %.6f down, right is %.6f", l.p.count, up, down, right);
        close_lab(&l);
    }
}

static void rows_of_a_closed_room_sum_to_one_and_are_reciprocal(void **state) {
    (void)state;
    lab l;
    open_lab(&l, room_closed(0.5f), 600, 2048);
    assert_int_equal(l.p.count, 600);
    assert_true(fabs(l.p.area - 24.0) < 1e-4);
    for (uint32_t i = 0; i < l.p.count; i++) {
        double sum = 0.0;
        for (size_t k = l.f.first[i]; k < l.f.first[i + 1]; k++) {
            const uint32_t j = l.f.to[k];
            sum += (double)l.f.factor[k];
            size_t back = l.f.first[j];
            while (back < l.f.first[j + 1] && l.f.to[back] != i)
                back++;
            assert_true(back < l.f.first[j + 1]);
            const double there = (double)l.p.patch[i].area * (double)l.f.factor[k],
                         here = (double)l.p.patch[j].area * (double)l.f.factor[back];
            assert_true(fabs(there - here) <= 1e-5 * (there + here));
        }
        assert_true(sum <= 1.0 && sum > 1.0 - 1e-4);
        assert_true(fabs((double)l.f.open[i]) < 1e-6);
    }
    close_lab(&l);
}

/* Each of k reflections leaves the albedo's share of the light in a closed room that is lit evenly. */
static void a_furnace_is_a_geometric_series(void **state) {
    (void)state;
    const float albedo[] = {0.0f, 0.5f, 0.9f, 0.99f};
    const uint32_t bounces[] = {1, 3, 64, BOUNCES_CONVERGED};
    for (int a = 0; a < 4; a++) {
        lab l;
        room *r = room_closed(albedo[a] > 0.0f ? albedo[a] : 0.25f);
        open_lab(&l, r, 300, 1024);
        for (uint32_t i = 0; i < l.p.count; i++)
            for (int c = 0; c < 3; c++)
                l.p.patch[i].albedo[c] = albedo[a];
        float *direct = malloc(3 * l.p.count * sizeof *direct), *all = malloc(3 * l.p.count * sizeof *all);
        assert_true(direct && all);
        for (uint32_t i = 0; i < 3 * l.p.count; i++)
            direct[i] = 2.0f;
        for (int b = 0; b < 4; b++) {
            double spectral, right = 0.0, term = 2.0;
            vit_text why = {""};
            for (uint32_t h = 0; h <= (bounces[b] == BOUNCES_CONVERGED ? 5000 : bounces[b]); h++, term *= (double)albedo[a])
                right += term;
            const bounces_input in = {
                .factors = &l.f, .patches = &l.p, .bounces = bounces[b], .columns = 3, .direct = direct, .threads = 1};
            assert_int_equal(bounces_solve(&in, all, &spectral, &why), VIT_OK);
            assert_true(fabs(spectral - (double)albedo[a]) < 1e-3);
            for (uint32_t i = 0; i < 3 * l.p.count; i++)
                if (fabs((double)all[i] / right - 1.0) > 1e-3)
                    fail_msg("albedo %g, %u bounces: %g at patch %u, right is %g", (double)albedo[a], bounces[b],
                             (double)all[i], i / 3, right);
        }
        free(direct);
        free(all);
        close_lab(&l);
    }
}

/* A thin wall in the middle of the floor: no patch lies on both sides of it, and hardly any light comes through under it. */
static void no_patch_lies_on_both_sides_of_a_wall(void **state) {
    (void)state;
    lab l;
    room *r = room_closed(0.5f);
    room_quad(r, (const float[]){0.01f, -1, -1}, (const float[]){0, 0, 2}, (const float[]){0, 2, 0}, WALL_LEFT);
    room_quad(r, (const float[]){-0.01f, -1, 1}, (const float[]){0, 0, -2}, (const float[]){0, 2, 0}, WALL_RIGHT);
    open_lab(&l, r, 200, 256);
    for (uint32_t i = 0; i < l.p.count; i++) {
        int left = 0, right = 0;
        for (uint32_t k = l.p.patch[i].first; k < l.p.patch[i + 1].first; k++) {
            const float x = cells_center(&l.p.cells, &r->g, l.p.cell[k]).x;
            left += x < -0.02f;
            right += x > 0.02f;
        }
        if (left && right && fabsf(l.p.patch[i].normal.x) < 0.5f)
            fail_msg("patch %u at (%g, %g, %g) has %d cells on the left of the wall and %d on the right", i,
                     (double)l.p.patch[i].center.x, (double)l.p.patch[i].center.y, (double)l.p.patch[i].center.z, left, right);
    }
    close_lab(&l);
}

static void points_have_room_in_16_bits(void **state) {
    (void)state;
    static const uint32_t patches[] = {16, 2048, 4096, 8192, 16384}, each[] = {4094, 30, 14, 6, 2};
    for (size_t i = 0; i < sizeof patches / sizeof *patches; i++) {
        const uint32_t most = live_points_room(patches[i]);
        assert_int_equal(most, each[i]);
        assert_true(codec_stride(patches[i]) + (patches[i] * most + 15u) / 16u * 16u <= VIT_MAX_COLUMNS);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parallel_squares_have_their_form_factor),
        cmocka_unit_test(squares_that_share_an_edge_have_their_form_factor),
        cmocka_unit_test(rows_of_a_closed_room_sum_to_one_and_are_reciprocal),
        cmocka_unit_test(a_furnace_is_a_geometric_series),
        cmocka_unit_test(no_patch_lies_on_both_sides_of_a_wall),
        cmocka_unit_test(points_have_room_in_16_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
