/* Photons in hard places, of hard sizes, and in hard numbers.
 *
 * What can go wrong: on a corner of a cluster's box the distance is 0 for one cluster and rounding for its neighbours; 1 / r^2
 * of a tiny radius overflows; a photon larger than the scene is in every list; a cluster has none, or the root's list of 2^20
 * is cut in stretches, and an entry is lost where they join. The bounds: against the sum over all photons in double, one
 * rounding an added photon; and no float that is none. Radii of 0 and those whose square is no float are refused. */
#include "catalogue.h"
#include "list_check.h"
#include "rig.h"

enum { SIZE = 32 };

static void begin_room(rig *r, vit_camera *camera) {
    rig_begin(r, SIZE, SIZE);
    rig_room(r, 2, rig_keep);
    r->scene.slice_count = 16;
    r->scene.max_list = 1u << 24;
    r->scene.tile = 8;
    *camera = rig_camera_at(&r->scene, 0.1f, -0.2f, 0.3f);
    r->cameras = camera;
}

static list_check check(rig *r, uint32_t stride, vit_statistics *stats) {
    open_pack p;
    rig_open(r, &p, rig_on_host());
    pack_frame(&p, 0);
    *stats = pack_stats(&p);
    assert_int_equal(stats->dropped_entries + stats->dropped_samples, 0);
    list_check c = list_check_frame(&p, stride);
    c.not_finite += rig_not_finite(&p);
    pack_close(&p);
    return c;
}

/* On the walls, flying at them. */
static void place_photons(vit_photon *photons, uint32_t count, float radius) {
    uint64_t state = 47;
    for (uint32_t i = 0; i < count; i++) {
        const int axis = (int)(i % 3);
        const float side = i / 3 % 2 ? 1.0f : -1.0f;
        float q[3], d[3];
        random_direction(&state, d);
        d[axis] = fabsf(d[axis]) * side;
        for (int k = 0; k < 3; k++)
            q[k] = k == axis ? side : 2 * lab_uniform(&state) - 1;
        photons[i] = rig_photon(q, d, radius, 1.0f / (float)count);
    }
}

static void check_photons(const char *what, vit_photon *photons, uint32_t count, float radius, uint32_t stride, double bound) {
    rig r;
    vit_camera camera;
    vit_statistics stats;
    begin_room(&r, &camera);
    rig_photons(&r, photons, count, radius);
    const list_check c = check(&r, stride, &stats);
    (void)printf("%s: %u clusters, %u list entries, at most %u photons a cluster, %llu samples lit\n", what, stats.clusters,
                 stats.pairs, stats.largest, (unsigned long long)c.lit);
    assert_int_equal(c.not_finite, 0);
    catalogue_row("photons", what, c.worst, bound, "of the largest irradiance");
    rig_free(&r);
}

/* The corners of the boxes of all clusters of a frame, as photons. */
static void photons_on_corners(vit_photon *photons, uint32_t *count, uint32_t most, float radius) {
    rig r;
    vit_camera camera;
    open_pack p;
    static const float down[3] = {0, -1, 0}, nowhere[3] = {0, 0, 0};
    begin_room(&r, &camera);
    photons[0] = rig_photon(nowhere, down, radius, 1);
    rig_photons(&r, photons, 1, radius);
    rig_open(&r, &p, rig_on_host());
    pack_frame(&p, 0);
    const vit_statistics s = pack_stats(&p);
    int32_t *bounds = read_buffer(&p, B_bounds);
    *count = 0;
    for (uint32_t node = s.nodes - s.clusters; node < s.nodes; node++)
        for (uint32_t corner = 0; corner < 8 && *count < most; corner++) {
            float q[3], d[3] = {0.3f, -0.4f, -0.86f};
            for (uint32_t k = 0; k < 3; k++) {
                int32_t i = bounds[(size_t)(k + (corner >> k & 1 ? 3 : 0)) * r.scene.max_nodes + node];
                i ^= (i >> 31) & 0x7fffffff;
                memcpy(q + k, &i, 4);
            }
            unit_float(d);
            photons[(*count)++] = rig_photon(q, d, radius, 1);
        }
    free(bounds);
    pack_close(&p);
    rig_free(&r);
    assert_true(*count > 100);
}

static vit_photon photons[1u << 20];

static void on_corners_of_clusters(void **state) {
    uint32_t count;
    (void)state;
    photons_on_corners(photons, &count, 1u << 12, 0.2f);
    check_photons("on all corners of all clusters", photons, count, 0.2f, 1, 1e-6);
    photons_on_corners(photons, &count, 1u << 12, 1e-6f);
    check_photons("on all corners of all clusters, radius of 1e-6 m", photons, count, 1e-6f, 1, 2e-7);
}

static void of_a_nanometre_and_of_a_thousand_kilometres(void **state) {
    (void)state;
    place_photons(photons, 256, 1e-9f);
    check_photons("radius of 1e-9 m: meets no sample", photons, 256, 1e-9f, 1, 0);
    place_photons(photons, 256, 1e6f);
    check_photons("radius of 1e6 m: in every cluster", photons, 256, 1e6f, 1, 4e-6);
    place_photons(photons, 256, 10);
    check_photons("radius of 10 m: in every cluster", photons, 256, 10, 1, 4e-6);
}

static void none_one_and_a_million(void **state) {
    rig r;
    vit_camera camera;
    vit_statistics stats;
    (void)state;
    place_photons(photons, 16, 0.5f);
    for (int i = 1; i < 16; i++)
        photons[i] = (vit_photon){.radius2 = -1};
    check_photons("one photon and empty slots", photons, 16, 0.5f, 1, 5e-7);
    photons[0] = (vit_photon){.radius2 = -1};
    begin_room(&r, &camera);
    rig_photons(&r, photons, 1, 0.5f);
    const list_check c = check(&r, 1, &stats);
    assert_int_equal(stats.pairs, 0);
    catalogue_none("photons", "no photon: floats that are not 0", (uint64_t)(c.worst > 0 || c.not_finite > 0), c.samples,
                   "samples");
    rig_free(&r);
    place_photons(photons, 1u << 20, 0.1f);
    check_photons("2^20 photons", photons, 1u << 20, 0.1f, catalogue_whole() ? 1 : 5, 5e-6);
}

/* The loader's line for a scene with such a radius; empty if it takes it. */
static vit_text verdict(float radius) {
    rig r;
    vit_camera camera;
    vit_requirements need;
    vit_text why = {""};
    size_t size;
    begin_room(&r, &camera);
    place_photons(photons, 16, 0.5f);
    rig_photons(&r, photons, 16, radius);
    void *bytes = rig_pack(&r, &size);
    const vit_open_info info = {.pack = bytes, .pack_size = size, .device = VIT_DEVICE_HOST};
    const vit_status status = vit_require(&info, &need, &why);
    assert_int_equal(status == VIT_OK, why.text[0] == 0);
    free(bytes);
    rig_free(&r);
    return why;
}

static void radii_whose_square_is_no_float_are_refused(void **state) {
    static const float bad[] = {0, -1, 1e-38f, 1e-20f, 1e20f, INFINITY, NAN};
    enum { BAD = sizeof bad / sizeof *bad };
    uint64_t taken = 0;
    (void)state;
    for (int i = 0; i < BAD; i++)
        taken += strstr(verdict(bad[i]).text, "radius") == NULL;
    catalogue_none("photons", "radii taken of 0, below 0, infinite, or whose square is none", taken, BAD, "radii");
    assert_string_equal(verdict(1e-14f).text, "");
    assert_string_equal(verdict(1e14f).text, "");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(on_corners_of_clusters), cmocka_unit_test(of_a_nanometre_and_of_a_thousand_kilometres),
        cmocka_unit_test(none_one_and_a_million), cmocka_unit_test(radii_whose_square_is_no_float_are_refused)};
    return cmocka_run_group_tests_name("photons", tests, NULL, NULL);
}
