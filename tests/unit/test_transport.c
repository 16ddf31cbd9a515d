/* Baked indirect light against closed forms: transport between receivers and light, and receivers' places.
 *
 * Why this is hard: rays are random, and light that is lost or made at one step can hide in another's noise. Strategy: closed
 * rooms in which energy is kept, whatever their shape: what a light sends comes to the walls once for each reflection, times
 * the albedo each time, so that sums over evenly spread receivers are powers of the albedo; and a function that is linear on a
 * plane, which interpolation between receivers gives back as far as they are where it takes them to be. */
#include "photon_room.h"
#include "radiosity/transport.h"

#define PI 3.14159265358979324

enum { EVENLY = 24 /* receivers along a wall's edge */, RAYS = 128, CELLS = 8192 };

typedef struct lab {
    room *r;
    photon_scene scene;
    photon_rays rays;
} lab;

static void open_lab(lab *l, room *r) {
    room_finish(r, 0, 2);
    for (uint32_t i = 0; i < r->m.triangles; i++) /* light stays inside; what stands there has two sides */
        r->g.attributes[i].material |= r->g.attributes[i].material < WALLS ? VIT_SIDE_DARK_BACK : 0;
    l->r = r;
    l->scene = room_scene(r);
    assert_true(photon_rays_open(&l->scene, 1, &l->rays));
}

static void close_lab(lab *l) {
    photon_rays_close(&l->rays);
    room_drop(l->r);
}

/* EVENLY^2 places on each side that light reaches, each for a like part of its area. */
static receiver *spread_receivers(const lab *l, uint32_t *count) {
    const uint32_t each = EVENLY * EVENLY;
    receiver *all = calloc(2 * (size_t)l->r->m.triangles * each, sizeof *all);
    assert_non_null(all);
    *count = 0;
    for (uint32_t s = 0; s < 2 * l->r->m.triangles; s++)
        for (uint32_t i = 0; i < each && !side_is_dark(&l->r->g, s);
             i++) { /* row i has 2 i + 1 like triangles; their middles */
            const uint32_t row = (uint32_t)sqrt((double)i), k = i - row * row;
            const float b1 = ((float)(k / 2) + (k % 2 ? 2.0f : 1.0f) / 3.0f) / (float)EVENLY;
            const float down = ((float)row + (k % 2 ? 1.0f : 2.0f) / 3.0f) / (float)EVENLY;
            all[(*count)++] = (receiver){.side = s, .b1 = b1, .b2 = down - b1};
        }
    return all;
}

/* Power of indirect light that comes to all walls in each state, over that of its light, 4 Pi W by the first channel's
 * intensity. */
static void arriving(const lab *l, const transport_state *states, uint32_t state_count, uint32_t reflections, double *out) {
    uint32_t count;
    receiver *places = spread_receivers(l, &count);
    float *irradiance = calloc((size_t)count * state_count * 3, sizeof *irradiance);
    assert_non_null(irradiance);
    const transport_input in = {.rays = &l->rays,
                                .geometry = &l->r->g,
                                .receivers = places,
                                .receiver_count = count,
                                .states = states,
                                .state_count = state_count,
                                .reflections = reflections,
                                .cells = CELLS,
                                .receiver_rays = RAYS,
                                .bounce_rays = 128 * CELLS};
    transport_report report;
    vit_text why = {""};
    if (transport_find(&in, irradiance, &report, &why) != VIT_OK)
        fail_msg("%s", why.text);
    for (uint32_t s = 0; s < state_count; s++)
        for (uint32_t k = 0; k < 3; k++) {
            double sum = 0.0;
            for (uint32_t i = 0; i < count; i++)
                sum += (double)irradiance[((size_t)i * state_count + s) * 3 + k] * (double)side_area(&l->r->g, places[i].side) /
                       (EVENLY * EVENLY);
            out[3 * s + k] = sum / (4.0 * PI * (double)states[s].lights[0].light.intensity[k]);
        }
    free(irradiance);
    free(places);
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
    arriving(&l, states, 2, reflections, got);
    for (int i = 0; i < 6; i++) {
        const double albedo = (double)albedos[i % 3];
        double right = albedo / (1 - albedo);
        if (reflections != TRANSPORT_CONVERGED)
            right *= 1 - pow(albedo, reflections);
        if (!(fabs(got[i] / right - 1) < 4e-3))
            fail_msg("%u reflections, albedo %g, light %d: %.5f of the light comes, %.5f is right", reflections, albedo, i / 3,
                     got[i], right);
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

/* ---- receivers ---- */

/* Cameras in the room's middle that see all walls. */
static const vit_camera *look_about(void) {
    static vit_camera cameras[6];
    for (int i = 0; i < 6; i++) {
        vit_camera *c = &cameras[i];
        const int axis = i / 2, across = (axis + 1) % 3, down = (axis + 2) % 3;
        memset(c, 0, sizeof *c);
        c->corner[axis] = i % 2 ? 1.0f : -1.0f;
        c->corner[across] = c->corner[down] = -1.0f;
        c->right[across] = c->down[down] = 2.0f / 64.0f;
    }
    return cameras;
}

static double linear(vec3 p) {
    return 1.0 + 0.6 * (double)p.x - 0.3 * (double)p.y + 0.2 * (double)p.z;
}

/* The weights of a place between a cell's corners. */
static void weigh(const cell_corners *c, float b1, float b2, double w[3]) {
    const double x1 = (double)(c->b1[1] - c->b1[0]), y1 = (double)(c->b2[1] - c->b2[0]), x2 = (double)(c->b1[2] - c->b1[0]),
                 y2 = (double)(c->b2[2] - c->b2[0]), x = (double)(b1 - c->b1[0]), y = (double)(b2 - c->b2[0]);
    w[1] = (x * y2 - y * x2) / (x1 * y2 - y1 * x2);
    w[2] = (y * x1 - x * y1) / (x1 * y2 - y1 * x2);
    w[0] = 1 - w[1] - w[2];
}

/* The largest error of what is interpolated between receivers that have linear(), over what it changes by along a cell's edge:
 * how far receivers are from the corners that they stand for, in edges. */
static double worst_of_linear(const lab *l, const receivers *found) {
    const uint32_t sides = 2 * l->r->m.triangles;
    cells c = {.sides = found->sides, .side_of = calloc(found->cell_count + 1u, sizeof *c.side_of), .count = found->cell_count};
    double worst = 0.0;
    assert_non_null(c.side_of);
    for (uint32_t s = 0; s < sides; s += 2) {
        const uint32_t parts = c.sides[s] >> VIT_SIDE_PARTS_SHIFT, first = c.sides[s] & VIT_SIDE_CELL;
        for (uint32_t k = 0; k < parts * parts; k++)
            c.side_of[first + k] = s;
        for (uint32_t i = 0; i < 4096; i++) {
            float b1 = (float)(i % 64 + 0.5) / 64, b2 = (float)(i / 64 + 0.5) / 64;
            if (b1 + b2 >= 1) {
                b1 = 1 - b1;
                b2 = 1 - b2;
            }
            const uint32_t cell = cells_at(&c, s, b1, b2);
            const cell_corners corners = cells_corners(&c, cell);
            double w[3], sum = 0.0, lo = INFINITY, hi = -INFINITY;
            weigh(&corners, b1, b2, w);
            for (int k = 0; k < 3; k++) {
                const receiver *r = found->receivers + found->cells[cell].receiver[k];
                const double at = linear(side_place(&l->r->g, s, corners.b1[k], corners.b2[k]));
                assert_int_equal(r->side % 2, 0);
                sum += w[k] * linear(side_place(&l->r->g, r->side, r->b1, r->b2));
                lo = fmin(lo, at);
                hi = fmax(hi, at);
            }
            worst = fmax(worst, fabs(sum - linear(side_place(&l->r->g, s, b1, b2))) / (hi - lo));
        }
    }
    free(c.side_of);
    return worst;
}

static void receivers_of_a_plane_interpolate_what_is_linear(void **state) {
    (void)state;
    static const float spacings[] = {2.5f, 6.0f, 12.0f, 24.0f};
    lab l;
    open_lab(&l, room_closed(0.5f));
    const tracks t = {.cameras = (vit_camera *)(uintptr_t)look_about()};
    for (size_t i = 0; i < sizeof spacings / sizeof *spacings; i++) {
        const receivers_input in = {.rays = &l.rays,
                                    .geometry = &l.r->g,
                                    .tracks = &t,
                                    .frames = 6,
                                    .width = 64,
                                    .height = 64,
                                    .size = 2.0f,
                                    .spacing = spacings[i],
                                    .most = 100000};
        receivers found;
        vit_text why = {""};
        assert_int_equal(receivers_place(&in, &found, &why), VIT_OK);
        assert_int_equal(found.split_count, 0);
        const double worst = worst_of_linear(&l, &found);
        print_message("spacing %g: %u receivers of %u cells, off by %.4f of what a cell changes\n", (double)spacings[i],
                      found.count, found.cell_count, worst);
        assert_true(worst < 0.03); /* corners are pulled in by 0.04 of the way to the middle, so that each sees its cell */
        receivers_free(&found);
    }
    close_lab(&l);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_closed_room_keeps_its_light),
                                       cmocka_unit_test(what_stands_in_a_room_keeps_it_too),
                                       cmocka_unit_test(receivers_of_a_plane_interpolate_what_is_linear)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
