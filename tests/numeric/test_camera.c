/* Cameras in walls, on vertices, nearer to a surface than the first depth slice, and with nothing before them.
 *
 * What can go wrong: the eye lies in a triangle's plane, so that distances are 0; samples lie at no depth, or behind the near
 * plane of the slices; no sample has a cluster, and the hierarchy is a root alone. The bounds: no float that is none; where
 * nothing is before the camera every pixel is the background, to the bit; in the closed room every pixel sees a wall; and
 * indirect light is the sum over all photons wherever the eye is, because slices only sort samples. */
#include "catalogue.h"
#include "list_check.h"
#include "rig.h"

enum { SIZE = 48, PHOTONS = 512 };

typedef struct view {
    const char *what;
    float eye[3];
    int sees; /* 1: every pixel a wall; 0: nothing; -1: some of both */
} view;

/* Looking along -z in, on and out of the cube -1..1. */
static const view views[] = {
    {"within the room", {0.1f, -0.2f, 0.3f}, 1},
    {"a micrometre from the wall", {0.1f, -0.2f, -0.999999f}, 1},
    {"nearer than the first slice", {0.1f, -0.2f, -0.95f}, 1},
    {"in the wall behind", {0.1f, -0.2f, 1}, 1},
    {"in the wall before", {0.1f, -0.2f, -1}, 0},
    {"in a side wall", {1, 0.1f, 0}, -1},
    {"on an edge", {1, 1, 0.5f}, -1},
    {"on a vertex behind", {-1, 1, 1}, -1},
    {"on a vertex before", {1, -1, -1}, 0},
    {"out of the room", {0.3f, 0.2f, 4}, -1},
    {"beyond the room", {0.3f, 0.2f, -4}, 0},
    {"a million metres away", {0.3f, 0.2f, 1e6f}, -1},
};

typedef struct seen {
    uint64_t not_finite, wrong, pixels; /* wrong: neither a wall nor the background where one of them must be */
    double worst;                       /* of indirect light, see list_check */
} seen;

static void look(const view *v, vit_photon *photons, seen *all) {
    rig r;
    open_pack p;
    rig_begin(&r, SIZE, SIZE);
    rig_room(&r, 2, rig_keep);
    vit_camera camera = rig_camera_at(&r.scene, v->eye[0], v->eye[1], v->eye[2]);
    vit_light light = rig_light(0.2f, 0.7f, -0.1f, 40);
    r.cameras = &camera;
    r.lights = &light;
    r.scene.lights = 1;
    r.scene.slice_count = 64;
    r.scene.max_list = 1u << 22;
    for (int k = 0; k < 3; k++)
        r.scene.background[k] = 0.1f * (float)(k + 1);
    rig_photons(&r, photons, PHOTONS, 0.4f);
    rig_open(&r, &p, rig_on_host());
    pack_frame(&p, 0);
    assert_int_equal(pack_stats(&p).dropped_entries + pack_stats(&p).dropped_samples, 0);
    const list_check c = list_check_frame(&p, 1);
    all->not_finite += rig_not_finite(&p) + c.not_finite;
    all->worst = fmax(all->worst, c.worst);
    uint32_t *hit = read_buffer(&p, B_hit_triangle);
    const float *pixel = (const float *)(const void *)p.frame;
    uint64_t walls = 0, none = 0;
    for (uint32_t i = 0; i < p.v->pack.scene->samples; i++)
        walls += hit[i] != VIT_NONE;
    for (int i = 0; i < SIZE * SIZE; i++)
        none += memcmp(pixel + 4 * i, r.scene.background, 12) == 0;
    free(hit);
    const uint64_t count = (uint64_t)SIZE * SIZE;
    (void)printf("%-28s %4llu pixels see a wall\n", v->what, (unsigned long long)walls);
    all->wrong += walls + none != count ? count : v->sees == 1 ? none : v->sees == 0 ? walls : 0;
    all->pixels += count;
    pack_close(&p);
    rig_free(&r);
}

static void cameras_in_hard_places_show_what_is_there(void **state) {
    static vit_photon photons[PHOTONS];
    uint64_t random = 59;
    seen all = {0};
    (void)state;
    for (int i = 0; i < PHOTONS; i++) {
        const int axis = i % 3;
        float q[3], d[3];
        random_direction(&random, d);
        for (int k = 0; k < 3; k++)
            q[k] = k == axis ? (d[k] > 0 ? 1.0f : -1.0f) : 2 * lab_uniform(&random) - 1;
        photons[i] = rig_photon(q, d, 0.4f, 1);
    }
    for (size_t i = 0; i < sizeof views / sizeof *views; i++)
        look(&views[i], photons, &all);
    catalogue_none("cameras", "in walls, on vertices, near, far: floats that are none", all.not_finite, 4 * all.pixels,
                   "floats");
    catalogue_none("cameras", "pixels that are neither a wall nor the background where one must be", all.wrong, all.pixels,
                   "pixels");
    catalogue_row("cameras", "irradiance against the sum over all photons", all.worst, 2e-6, "of the largest irradiance");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(cameras_in_hard_places_show_what_is_there)};
    return cmocka_run_group_tests_name("camera", tests, NULL, NULL);
}
