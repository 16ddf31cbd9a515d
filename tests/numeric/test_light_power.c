/* Lights where they should not be, and as weak and as strong as they may be.
 *
 * What can go wrong: on a surface or in a corner the squared distance is 0; a closed box round a light gives every photon back
 * and nothing of it outside; powers near the largest float overflow on their way, and infinity times a weight of 0 is no
 * number; powers of subnormal size round, or a device flushes them to 0 and its bits are other ones. The bounds: no float that
 * is none; a light's power times 2^k gives every linear float times 2^k, exactly, since nothing but products and sums is done
 * with it; the same bits on `host` and on OpenCL for a light of 1e-38 W. What could overflow is refused. */
#include "catalogue.h"
#include "rig.h"
#include <float.h>

enum { SIZE = 48 };

typedef struct lit_room {
    rig r;
    vit_camera camera;
    vit_light light;
} lit_room;

/* Photons of the light are traced in the frame. */
static void begin_lit_room(lit_room *l, vit_light light, mesh_place_fn *place) {
    rig *r = &l->r;
    rig_begin(r, SIZE, SIZE);
    rig_room(r, 2, place);
    l->camera = rig_camera_at(&r->scene, 0.1f, -0.2f, 0.3f);
    r->cameras = &l->camera;
    l->light = light;
    l->light.path_count = 1024;
    r->lights = &l->light;
    r->scene.lights = 1;
    r->scene.paths = 1024;
    r->scene.radius = 0.3f;
    r->scene.slice_count = 16;
    r->scene.max_list = 1u << 22;
    r->scene.effects = VIT_BIT(LIGHTS) | VIT_BIT(INDIRECT) | VIT_BIT(PHOTONS) | VIT_BIT(TRACED) | VIT_BIT(LIST);
    r->material.albedo[0] = 0.9f;
    r->material.albedo[1] = 0.5f;
    r->material.albedo[2] = 0.1f;
}

static void begin_lit(lit_room *l, vit_light light) {
    begin_lit_room(l, light, rig_keep);
}

/* The frame's floats; free() them. *bad: those that are none. */
static float *frame_of(lit_room *l, vit_open_info how, uint64_t *bad) {
    open_pack p;
    rig_open(&l->r, &p, how);
    pack_frame(&p, 0);
    *bad += rig_not_finite(&p);
    float *pixels = malloc(p.need.frame_bytes);
    assert_non_null(pixels);
    memcpy(pixels, p.frame, p.need.frame_bytes);
    pack_close(&p);
    return pixels;
}

static void lights_in_hard_places_give_numbers(void **state) {
    static const float places[][3] = {{0, 0, -1},          {0, -1, 0},        {1, 1, -1},          {-1, -1, -1},
                                      {0.99999994f, 0, 0}, {0.5f, -0.5f, -1}, {0.1f, -0.2f, 0.3f}, {0, 5, 0}};
    static const float powers[] = {0, 1e-6f, 1, 1e9f};
    uint64_t bad = 0, count = 0;
    (void)state;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++)
        for (size_t k = 0; k < sizeof powers / sizeof *powers; k++) {
            lit_room l;
            begin_lit(&l, rig_light(places[i][0], places[i][1], places[i][2], powers[k]));
            free(frame_of(&l, rig_on_host(), &bad));
            count += (uint64_t)4 * SIZE * SIZE;
            rig_free(&l.r);
        }
    catalogue_none("lights", "on walls, in corners, at the eye, outside, 0 to 1e9 W: floats that are none", bad, count,
                   "floats");
}

static void power_times_2_to_the_k_is_light_times_2_to_the_k(void **state) {
    static const int powers[] = {-20, -1, 1, 10, 30};
    uint64_t wrong = 0, count = 0, bad = 0;
    (void)state;
    lit_room one;
    begin_lit(&one, rig_light(0.2f, 0.7f, -0.1f, 1));
    float *a = frame_of(&one, rig_on_host(), &bad);
    for (size_t i = 0; i < sizeof powers / sizeof *powers; i++) {
        lit_room l;
        begin_lit(&l, rig_light(0.2f, 0.7f, -0.1f, ldexpf(1, powers[i])));
        float *b = frame_of(&l, rig_on_host(), &bad);
        for (size_t k = 0; k < (size_t)4 * SIZE * SIZE; k++, count++)
            wrong += b[k] != (k % 4 == 3 ? 1.0f : ldexpf(a[k], powers[i]));
        free(b);
        rig_free(&l.r);
    }
    assert_int_equal(bad, 0);
    assert_true(a[0] > 0);
    free(a);
    rig_free(&one.r);
    catalogue_none("lights", "powers times 2^k: floats that are not exactly times 2^k", wrong, count, "floats");
}

static void a_light_in_a_closed_box_lights_nothing_outside(void **state) {
    lit_room l;
    uint64_t bad = 0, lit = 0;
    (void)state;
    begin_lit(&l, rig_light(0.2f, 0.7f, -0.1f, 1e9f));
    l.camera = rig_camera_at(&l.r.scene, 0, 0, 4);
    float *a = frame_of(&l, rig_on_host(), &bad);
    open_pack p;
    rig_open(&l.r, &p, rig_on_host());
    pack_frame(&p, 0);
    uint32_t *hit = read_buffer(&p, B_hit_triangle);
    float *direct = read_buffer(&p, B_direct);
    const uint32_t n = p.v->pack.scene->samples;
    uint64_t seen = 0;
    for (uint32_t i = 0; i < n; i++) {
        seen += hit[i] != VIT_NONE;
        lit += direct[i] > 0;
    }
    assert_true(seen > n / 16);
    free(direct);
    free(hit);
    pack_close(&p);
    free(a);
    rig_free(&l.r);
    catalogue_none("lights", "1e9 W in a closed box: samples lit outside", lit + bad, seen, "samples");
}

static void what_could_overflow_is_refused(void **state) {
    static const float powers[] = {FLT_MAX, 1e38f, 1e30f};
    uint64_t taken = 0;
    (void)state;
    for (size_t i = 0; i < sizeof powers / sizeof *powers; i++) {
        lit_room l;
        vit_requirements need;
        vit_text why = {""};
        size_t size;
        begin_lit(&l, rig_light(0.2f, 0.7f, -0.1f, 1));
        for (int k = 0; k < 3; k++)
            l.light.intensity[k] = powers[i];
        void *bytes = rig_pack(&l.r, &size);
        const vit_open_info info = {.pack = bytes, .pack_size = size, .device = VIT_DEVICE_HOST};
        taken += vit_require(&info, &need, &why) != VIT_BAD_INPUT || strstr(why.text, "intensity") == NULL;
        free(bytes);
        rig_free(&l.r);
    }
    catalogue_none("lights", "intensities near FLT_MAX taken", taken, sizeof powers / sizeof *powers, "packs");
}

/* A room of half the edge `size`: the largest intensity that is taken, near a wall that mirrors light in the sharpest lobe
 * there is, with the largest exposure, and with none. */
static float half_edge;

static void of_size(float p[3]) {
    for (int k = 0; k < 3; k++)
        p[k] *= half_edge;
}

static bool is_taken(lit_room *l, float intensity) {
    vit_requirements need;
    vit_text why = {""};
    size_t size;
    for (int k = 0; k < 3; k++)
        l->light.intensity[k] = intensity;
    void *bytes = rig_pack(&l->r, &size);
    const vit_open_info info = {.pack = bytes, .pack_size = size, .device = VIT_DEVICE_HOST};
    const vit_status status = vit_require(&info, &need, &why);
    if (status != VIT_OK && !strstr(why.text, "light could be") && !strstr(why.text, "photons' power"))
        fail_msg("%s", why.text);
    free(bytes);
    return status == VIT_OK;
}

static void the_strongest_light_that_a_size_takes_gives_numbers(void **state) {
    static const float sizes[] = {1e-9f, 1e-6f, 1e-3f, 0.1f, 1, 1e3f}, exposures[] = {VIT_MAX_EXPOSURE, 1, 0};
    uint64_t bad = 0, count = 0, weaker = 0;
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (size_t e = 0; e < sizeof exposures / sizeof *exposures; e++) {
            lit_room l;
            half_edge = sizes[i];
            /* Nearer to the wall that is seen than the least distance is: samples lie ray_offset off it. */
            begin_lit_room(&l, rig_light(0, 0, -sizes[i] + 4e-5f * sizes[i], 1), of_size);
            l.camera = rig_camera_at(&l.r.scene, 0.1f * sizes[i], -0.2f * sizes[i], 0.3f * sizes[i]);
            l.camera.exposure = exposures[e];
            l.r.scene.radius = 0.3f * sizes[i];
            l.r.scene.slice_near = 0.1f * sizes[i];
            l.r.scene.effects |= VIT_BIT(SPECULAR);
            l.r.material.exponent = VIT_MAX_EXPONENT;
            l.r.material.specular[0] = l.r.material.specular[1] = 0.1f;
            float low = 0, high = VIT_MAX_INTENSITY;
            if (!is_taken(&l, high))
                for (weaker++; high / 2 > low;) {
                    const float middle = low > 0 ? sqrtf(low) * sqrtf(high) : high * 1e-6f;
                    if (is_taken(&l, middle))
                        low = middle;
                    else
                        high = middle;
                }
            assert_true(is_taken(&l, low > 0 ? low : high));
            free(frame_of(&l, rig_on_host(), &bad));
            count += (uint64_t)4 * SIZE * SIZE;
            rig_free(&l.r);
        }
    assert_true(weaker > 0); /* sizes that would overflow with the largest intensity are among them */
    catalogue_none("lights", "the strongest that rooms of 1e-9 to 1e3 m take: floats that are none", bad, count, "floats");
}

/* The largest that is taken, a micrometre from a wall, with the largest exposure. */
static void the_strongest_light_that_is_taken_gives_numbers(void **state) {
    lit_room l;
    uint64_t bad = 0;
    (void)state;
    begin_lit(&l, rig_light(0, 0, -0.999999f, 1));
    for (int k = 0; k < 3; k++)
        l.light.intensity[k] = VIT_MAX_INTENSITY;
    l.camera.exposure = VIT_MAX_EXPOSURE;
    free(frame_of(&l, rig_on_host(), &bad));
    rig_free(&l.r);
    catalogue_none("lights", "1e15 W/sr a micrometre from a wall, exposure 1e9: floats that are none", bad, 4 * SIZE * SIZE,
                   "floats");
}

static void subnormal_light_has_the_same_bits_on_host_and_opencl(void **state) {
    static const float powers[] = {1e-36f, 1e-38f, 1e-41f};
    uint64_t apart = 0, count = 0, bad = 0, small = 0;
    (void)state;
    for (size_t i = 0; i < sizeof powers / sizeof *powers; i++) {
        lit_room l;
        begin_lit(&l, rig_light(0.2f, 0.7f, -0.1f, powers[i]));
        float *host = frame_of(&l, rig_on_host(), &bad);
        float *cl = frame_of(&l, (vit_open_info){.format = VIT_FORMAT_RGBA32F}, &bad);
        for (size_t k = 0; k < (size_t)4 * SIZE * SIZE; k++, count++) {
            apart += memcmp(host + k, cl + k, 4) != 0;
            small += host[k] > 0 && host[k] < FLT_MIN;
        }
        free(host);
        free(cl);
        rig_free(&l.r);
    }
    assert_true(small > 1000);
    catalogue_none("lights", "1e-36 to 1e-41 W: floats that differ between host and OpenCL", apart + bad, count, "floats");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(lights_in_hard_places_give_numbers),
                                       cmocka_unit_test(power_times_2_to_the_k_is_light_times_2_to_the_k),
                                       cmocka_unit_test(a_light_in_a_closed_box_lights_nothing_outside),
                                       cmocka_unit_test(what_could_overflow_is_refused),
                                       cmocka_unit_test(the_strongest_light_that_a_size_takes_gives_numbers),
                                       cmocka_unit_test(the_strongest_light_that_is_taken_gives_numbers),
                                       cmocka_unit_test(subnormal_light_has_the_same_bits_on_host_and_opencl)};
    return cmocka_run_group_tests_name("light power", tests, NULL, NULL);
}
