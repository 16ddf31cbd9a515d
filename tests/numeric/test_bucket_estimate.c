/* Buckets of clusters, and what samples get from them, against their definitions in double.
 *
 * What can go wrong: a photon falls into no bucket, a wrong one or another cluster's; a cluster's box is not that of its
 * samples; a sample lies between the wrong eight clusters, or in another slice than its neighbours think. Each shows as a
 * photon's, or a cluster's, whole share. The bounds: a bucket is a sum over photons, one rounding an added one, of the largest
 * bucket in the frame. A sample is weighed between clusters by places in float, which round to 1e-7 of the scene, over a tile's
 * width there, of which a room has some ten, and by a logarithm that is off by 1e-7 and multiplied by the slices a doubling:
 * a few 1e-6 of a weight. What rounding decides is left out: photons within 1e-6 of a bucket's edge, or of coming from behind
 * for all of a cluster. */
#include "catalogue.h"
#include "edited_pack.h"
#include "list_check.h"
#include "oracle/buckets.h"

typedef struct bucket_frame {
    view_frame f;
    oracle_cluster *clusters; /* by key */
    size_t count;
    const float *buckets; /* of the first cluster; 4 floats each */
    uint32_t each;        /* buckets a cluster */
} bucket_frame;

static int by_key(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

static oracle_cluster *cluster_with(const bucket_frame *b, uint32_t key) {
    return bsearch(&key, b->clusters, b->count, sizeof *b->clusters, by_key);
}

static void widen_by(oracle_cluster *c, const oracle_sample *p) {
    c->accept |= p->accept;
    for (int k = 0; k < 3; k++) {
        c->lo[k] = fmin(c->lo[k], p->position[k]);
        c->hi[k] = fmax(c->hi[k], p->position[k]);
        c->nlo[k] = fmin(c->nlo[k], p->normal[k]);
        c->nhi[k] = fmax(c->nhi[k], p->normal[k]);
    }
}

/* Clusters from the samples' keys. The device numbers them in the order of keys. */
static void find_clusters(bucket_frame *b) {
    const uint32_t n = b->f.s->samples;
    const double far = INFINITY;
    uint32_t *keys = malloc(n * sizeof *keys);
    b->clusters = malloc(n * sizeof *b->clusters);
    assert_true(keys && b->clusters);
    memcpy(keys, b->f.keys, n * sizeof *keys);
    qsort(keys, n, sizeof *keys, by_key);
    b->count = 0;
    for (uint32_t i = 0; i < n && keys[i] != VIT_NONE; i++)
        if (i == 0 || keys[i] != keys[i - 1])
            b->clusters[b->count++] =
                (oracle_cluster){keys[i], 0, {far, far, far}, {-far, -far, -far}, {far, far, far}, {-far, -far, -far}};
    free(keys);
    for (uint32_t i = 0; i < n; i++) {
        const oracle_sample p = view_frame_sample(&b->f, i);
        if (b->f.keys[i] != VIT_NONE)
            widen_by(cluster_with(b, b->f.keys[i]), &p);
    }
}

static const oracle_cluster *cluster_at(const void *data, uint32_t key, const float **buckets) {
    const bucket_frame *b = data;
    const oracle_cluster *c = cluster_with(b, key);
    if (c)
        *buckets = b->buckets + 4 * (size_t)b->each * (size_t)(c - b->clusters);
    return c;
}

static list_check check_sums(const bucket_frame *b) {
    list_check c = {0};
    for (size_t i = 0; i < b->count; i += catalogue_whole() ? 1 : 3) {
        oracle_buckets sums;
        oracle_fill(b->f.s, b->f.photons, b->clusters + i, &sums);
        for (uint32_t k = 0; k < b->each; k++)
            list_check_add(&c, sums.sum[k], sums.doubt, b->buckets + 4 * (i * b->each + k), 1);
    }
    list_check_end(&c);
    return c;
}

static list_check check_samples(const bucket_frame *b, uint64_t *dark_wrong) {
    list_check c = {0};
    const vit_scene *s = b->f.s;
    for (uint32_t y = 0; y < s->height; y++)
        for (uint32_t x = 0; x < s->width; x++) {
            const uint32_t i = oracle_number(s, x, y);
            const oracle_sample own = view_frame_sample(&b->f, i);
            const float *is = b->f.indirect + i, *buckets = NULL;
            double e[3] = {0, 0, 0};
            if (b->f.keys[i] == VIT_NONE) {
                *dark_wrong += is[0] != 0 || is[s->samples] != 0 || is[2 * (size_t)s->samples] != 0;
                continue;
            }
            if (s->effects & VIT_BIT(RAW_BUCKETS)) {
                (void)cluster_at(b, b->f.keys[i], &buckets);
                oracle_bucket_light(s, buckets, own.normal, e);
            } else
                oracle_smooth_light(s, b->f.camera, &own, x, y, b->f.keys[i], cluster_at, b, e);
            list_check_add(&c, e, 0, is, s->samples);
        }
    list_check_end(&c);
    return c;
}

static void check_pack(const char *name, const char *pack_name, pack_edit *edit, double samples_bound) {
    open_pack p;
    uint64_t dark_wrong = 0;
    char text[96];
    pack_open_edited(&p, pack_name, edit);
    pack_frame(&p, p.need.frames - 1);
    const vit_statistics stats = pack_stats(&p);
    assert_int_equal(stats.dropped_entries + stats.dropped_samples, 0);
    bucket_frame b = {.f = view_frame_read(&p, p.need.frames - 1)};
    float *buckets = read_buffer(&p, B_buckets);
    find_clusters(&b);
    assert_int_equal(b.count, stats.clusters);
    b.each = b.f.s->effects & VIT_BIT(RAW_BUCKETS) ? ORACLE_DIRECTIONS : ORACLE_OCTANTS;
    b.buckets = buckets + 4 * (size_t)b.each * (stats.nodes - stats.clusters);
    const list_check sums = check_sums(&b), samples = check_samples(&b, &dark_wrong);
    (void)printf("%s: %zu clusters; %llu of %llu buckets lit\n", name, b.count, (unsigned long long)sums.lit,
                 (unsigned long long)sums.samples);
    (void)snprintf(text, sizeof text, "%s: buckets against sums over all photons", name);
    catalogue_row("buckets", text, sums.worst, 1e-6, "of the largest bucket");
    (void)snprintf(text, sizeof text, "%s: samples against the buckets' light in double", name);
    catalogue_row("buckets", text, samples.worst, samples_bound, "of the largest irradiance");
    assert_int_equal(dark_wrong, 0);
    assert_true(sums.lit > b.count && samples.lit > samples.samples / 4);
    free(b.clusters);
    free(buckets);
    view_frame_free(&b.f);
    pack_close(&p);
}

static void smooth_buckets(void **state) {
    (void)state;
    check_pack("buckets", "buckets", NULL, 1e-5);
    check_pack("room-buckets", "room-buckets", NULL, 1e-5);
}

static void fewer_slices(vit_scene *s, vit_camera *cameras, vit_light *lights) {
    (void)cameras;
    (void)lights;
    assert_true(s->slice_count > 3);
    s->slice_first++;
    s->slice_count -= 2;
}

static void samples_before_and_behind_all_slices(void **state) {
    (void)state;
    check_pack("buckets; slices too few", "buckets", fewer_slices, 1e-5);
}

static void flatten(vit_scene *s, vit_camera *cameras, vit_light *lights) {
    (void)cameras;
    (void)lights;
    s->effects |= VIT_BIT(FLATTENED);
    s->flatten = 15;
}

static void flattened_buckets(void **state) {
    (void)state;
    check_pack("buckets; flattened", "buckets", flatten, 1e-5);
}

static void buckets_with_zones_and_normal_keys(void **state) {
    (void)state;
    check_pack("zones-buckets", "zones-buckets", NULL, 1e-5);
}

static void raw_buckets(void **state) {
    (void)state;
    check_pack("raw", "raw", NULL, 5e-7);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(smooth_buckets), cmocka_unit_test(samples_before_and_behind_all_slices),
                                       cmocka_unit_test(flattened_buckets),
                                       cmocka_unit_test(buckets_with_zones_and_normal_keys), cmocka_unit_test(raw_buckets)};
    return cmocka_run_group_tests_name("bucket estimate", tests, NULL, NULL);
}
