/* How samples are clustered: one cluster for all, a cluster a sample, and what lies between.
 *
 * What can go wrong: a list is made for a cluster's box, so a photon that counts for one of its samples must never be left out
 * for its box; rounding decides at the sphere's surface and at grazing angles. The bound: the same bits of indirect light
 * however samples are clustered, since lists are in the order of photons and what does not count adds exactly 0. Photons fly
 * within 1e-7 of a wall's plane and lie on the samples' very spheres, where the two roundings part if they ever do. */
#include "catalogue.h"
#include "rig.h"

enum { SIZE = 64, PHOTONS = 1 << 12 };

static void turned_room(float p[3]) {
    static const double m[3][3] = {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}};
    const double q[3] = {(double)p[0], (double)p[1], (double)p[2]};
    for (int k = 0; k < 3; k++)
        p[k] = (float)(m[k][0] * q[0] + m[k][1] * q[1] + m[k][2] * q[2]);
}

/* Indirect light of all pixels, in the order of pixels; free() it. */
static float *indirect_of(rig *r, uint32_t *clusters, uint32_t *list) {
    open_pack p;
    vit_open_info how = rig_on_host();
    how.view = VIT_VIEW_indirect;
    rig_open(r, &p, how);
    pack_frame(&p, 0);
    const vit_statistics s = pack_stats(&p);
    assert_int_equal(s.dropped_entries + s.dropped_samples, 0);
    *clusters = s.clusters;
    *list = s.pairs;
    float *pixels = malloc(p.need.frame_bytes);
    assert_non_null(pixels);
    memcpy(pixels, p.frame, p.need.frame_bytes);
    pack_close(&p);
    return pixels;
}

/* Photons at the samples of a first frame: a random one's place, moved by exactly the radius along an axis or by anything less;
 * flying anywhere, or in the plane of that sample's wall but for roundings. */
static void photons_at_samples(rig *r, vit_photon *photons, float radius, bool all_on_spheres) {
    open_pack p;
    uint64_t state = 43;
    const float down[3] = {0, -1, 0}, nowhere[3] = {0, 0, 0};
    const int count = (int)r->scene.baked;
    for (int i = 0; i < count; i++)
        photons[i] = rig_photon(nowhere, down, radius, 1);
    rig_open(r, &p, rig_on_host());
    pack_frame(&p, 0);
    const uint32_t n = p.v->pack.scene->samples;
    float *position = read_buffer(&p, B_position);
    uint32_t *hit = read_buffer(&p, B_hit_triangle);
    pack_close(&p);
    for (int i = 0; i < count; i++) {
        uint32_t at;
        do
            at = (uint32_t)(lab_random(&state) % n);
        while (hit[at] == VIT_NONE);
        const vit_triangle *t = r->mesh.packed.triangles + hit[at];
        const float normal[3] = {t->nx, t->ny, t->nz},
                    edge[3] = {t->v1[0] - t->v0[0], t->v1[1] - t->v0[1], t->v1[2] - t->v0[2]};
        float q[3], d[3];
        random_direction(&state, d);
        if (i % 2) {
            const float l2 = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
            const float along = (d[0] * normal[0] + d[1] * normal[1] + d[2] * normal[2]) / l2;
            for (int k = 0; k < 3; k++)
                d[k] = i % 4 == 1 ? edge[k] : d[k] - along * normal[k];
            unit_float(d);
        }
        const int axis = (int)(lab_random(&state) % 3);
        const float far = i % 3 || all_on_spheres ? radius : radius * lab_uniform(&state);
        for (int k = 0; k < 3; k++)
            q[k] = position[(size_t)k * n + at] + (k == axis ? far : 0);
        photons[i] = rig_photon(q, d, radius, 1 + lab_uniform(&state));
    }
    free(position);
    free(hit);
}

typedef struct clustering {
    const char *name;
    uint32_t tile, slices;
    float scale; /* slices a doubling of depth */
    uint32_t effects;
} clustering;

static const clustering all[] = {
    {"one cluster", 64, 1, 1, 0},
    {"tiles of 64", 64, 64, 8, 0},
    {"tiles of 32", 32, 64, 8, 0},
    {"tiles of 16", 16, 64, 8, 0},
    {"tiles of 8", 8, 64, 8, 0},
    {"tiles of 8 and normals", 8, 64, 8, VIT_BIT(NORMAL_KEYS)},
    {"tiles of 64 and normals", 64, 1, 1, VIT_BIT(NORMAL_KEYS)},
    {"a cluster nearly every sample", 8, 4096, 1000, VIT_BIT(NORMAL_KEYS)},
};

/* Pixels whose indirect light depends on the clustering, of `count` photons. */
static void check_clusterings(const char *what, uint32_t count, float radius, bool all_on_spheres) {
    static vit_photon photons[PHOTONS];
    rig r;
    uint64_t apart = 0, compared = 0, lit = 0;
    float *first = NULL;
    rig_begin(&r, SIZE, SIZE);
    rig_room(&r, 4, turned_room);
    r.scene.max_nodes = 1u << 17;
    r.scene.max_list = 1u << 25;
    vit_camera camera = rig_camera_at(&r.scene, 0.1f, -0.2f, 0.3f);
    r.cameras = &camera;
    rig_photons(&r, photons, count, radius);
    photons_at_samples(&r, photons, radius, all_on_spheres);
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        uint32_t clusters, list;
        r.scene.tile = all[i].tile;
        r.scene.slice_count = all[i].slices;
        r.scene.slice_scale = all[i].scale;
        r.scene.effects = (r.scene.effects & ~VIT_BIT(NORMAL_KEYS)) | all[i].effects;
        float *pixels = indirect_of(&r, &clusters, &list);
        (void)printf("%-32s %5u clusters, %8u pairs\n", all[i].name, clusters, list);
        assert_true(i > 0 || clusters == 1);
        for (size_t k = 0; k < (size_t)SIZE * SIZE; k++) {
            lit += pixels[4 * k] > 0;
            apart += first && memcmp(first + 4 * k, pixels + 4 * k, 16) != 0;
        }
        compared += first ? (uint64_t)SIZE * SIZE : 0;
        if (first)
            free(pixels);
        else
            first = pixels;
    }
    assert_true(lit > compared / 50);
    free(first);
    catalogue_none("clustering", what, apart, compared, "pixels");
    rig_free(&r);
}

static void estimates_are_the_same_bits_however_samples_are_clustered(void **state) {
    (void)state;
    check_clusterings("pixels whose indirect light depends on how samples are clustered", PHOTONS, 0.3f, false);
}

/* Few photons, so that the least weight of one is not lost in a sum; 1 / r^2 rounds down, so that there is such a weight on the
 * sphere. */
static void also_where_samples_lie_on_the_photons_spheres(void **state) {
    float radius = 0.25f;
    (void)state;
    while (!(fmaf(radius * radius, -(1 / (radius * radius)), 1) > 0))
        radius += 0x1p-6f;
    check_clusterings("the same where samples lie on the spheres of photons", 96, radius, true);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(estimates_are_the_same_bits_however_samples_are_clustered),
                                       cmocka_unit_test(also_where_samples_lie_on_the_photons_spheres)};
    return cmocka_run_group_tests_name("clusters", tests, NULL, NULL);
}
