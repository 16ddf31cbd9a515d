/* Indirect light at few samples and at small ones, against its definition in double.
 *
 * What can go wrong: a coarse sample is another pixel's, a neighbour is weighed wrongly or lies in another tile, light comes
 * from one that takes other photons, a sample without neighbours stays dark. Each shows as a neighbour's whole share. The
 * bounds: sums over photons as in test_list_estimate.c, one rounding an added photon, of the largest irradiance in the frame;
 * also where 16 bits hold a coordinate, since the grid is where the sample is, for float and for double. Between coarse samples
 * the weights' roundings count on what the four differ by alone: a few of 6e-8. What rounding may decide is left out: weights
 * within 1e-4 of the least. */
#include "catalogue.h"
#include "edited_pack.h"
#include "list_check.h"
#include "oracle/interpolation.h"

static void row(const char *name, const char *what, const list_check *c, double bound) {
    char text[96];
    (void)snprintf(text, sizeof text, "%s: %s", name, what);
    catalogue_row("sparse estimate", text, c->worst, bound, "of the largest irradiance");
}

static void none(const char *name, const char *what, uint64_t wrong, uint64_t count, const char *things) {
    char text[96];
    (void)snprintf(text, sizeof text, "%s: %s", name, what);
    catalogue_none("sparse estimate", text, wrong, count, things);
}

static void small_samples_estimate_where_they_are(void **state) {
    open_pack p;
    (void)state;
    pack_open(&p, "small", (vit_open_info){.device = VIT_DEVICE_HOST});
    pack_frame(&p, p.need.frames - 1);
    const list_check c = list_check_frame(&p, catalogue_whole() ? 1 : 7);
    row("small", "irradiance against the sum over all photons", &c, 2e-6);
    assert_true(c.lit > c.samples / 4);
    pack_close(&p);
}

typedef struct sparse_frame {
    view_frame f;
    float *coarse; /* 9 floats each, the first three the estimate */
    uint32_t *flags;
} sparse_frame;

static int coarse_at(const void *data, uint32_t x, uint32_t y, oracle_sample *sample, double sum[3]) {
    const sparse_frame *f = data;
    const uint32_t tile = f->f.s->tile;
    if (x >= f->f.s->tiles_x * tile || y >= f->f.s->tiles_y * tile)
        return 0;
    const uint32_t i = oracle_number(f->f.s, x, y);
    if (f->f.keys[i] == VIT_NONE)
        return 0;
    *sample = view_frame_sample(&f->f, i);
    for (uint32_t k = 0; k < 3; k++)
        sum[k] = (double)f->coarse[9 * (size_t)oracle_coarse_number(f->f.s, i) + k];
    return 1;
}

typedef struct sparse_check {
    list_check coarse, between, flagged;
    uint64_t keyless, dark_wrong, decided, flags_wrong;
} sparse_check;

static void check_coarse(const sparse_frame *f, uint32_t i, sparse_check *c) {
    const float *is = f->coarse + 9 * (size_t)oracle_coarse_number(f->f.s, i);
    oracle_sample own = view_frame_sample(&f->f, i);
    double e[3], doubt;
    own.inverse_area = 1; /* each sample's own is applied after interpolation */
    oracle_list_estimate(f->f.s, f->f.photons, &own, e, &doubt);
    list_check_add(&c->coarse, e, doubt, is, 1);
}

static void check_sample(const sparse_frame *f, uint32_t x, uint32_t y, sparse_check *c) {
    const vit_scene *s = f->f.s;
    const uint32_t i = oracle_number(s, x, y), n = s->samples;
    const int flag = (int)(f->flags[i / 16] >> i % 16 & 1);
    const float *is = f->f.indirect + i;
    if (f->f.keys[i] == VIT_NONE) {
        c->keyless++;
        c->dark_wrong += flag || is[0] != 0 || is[n] != 0 || is[2 * (size_t)n] != 0;
        return;
    }
    const oracle_sample own = view_frame_sample(&f->f, i);
    double e[3], doubt = 0;
    const double weights = oracle_interpolate(s, f->f.camera, &own, x, y, coarse_at, f, e);
    if (fabs(weights - ORACLE_LEAST) > 1e-4) {
        c->decided++;
        c->flags_wrong += flag != (weights < ORACLE_LEAST);
    }
    if (flag)
        oracle_list_estimate(s, f->f.photons, &own, e, &doubt);
    for (int k = 0; k < 3 && !flag; k++)
        e[k] *= own.inverse_area;
    list_check_add(flag ? &c->flagged : &c->between, e, doubt, is, n);
}

static void check_sparse(const char *name, const char *pack_name, pack_edit *edit) {
    open_pack p;
    sparse_check c = {0};
    pack_open_edited(&p, pack_name, edit);
    pack_frame(&p, p.need.frames - 1);
    const vit_statistics stats = pack_stats(&p);
    assert_int_equal(stats.dropped_entries + stats.dropped_samples, 0);
    sparse_frame f = {.f = view_frame_read(&p, p.need.frames - 1)};
    f.coarse = read_buffer(&p, B_coarse);
    f.flags = read_buffer(&p, B_flags);
    const uint32_t step = oracle_coarse_step(f.f.s), stride = catalogue_whole() ? 1 : 5;
    for (uint32_t y = 0; y < f.f.s->height; y++)
        for (uint32_t x = 0; x < f.f.s->width; x++) {
            const uint32_t i = oracle_number(f.f.s, x, y);
            if (x % step == 0 && y % step == 0 && f.f.keys[i] != VIT_NONE && (x / step + y / step) % stride == 0)
                check_coarse(&f, i, &c);
            check_sample(&f, x, y, &c);
        }
    (void)printf("%s: %llu coarse, %llu between, %llu flagged\n", name, (unsigned long long)c.coarse.samples,
                 (unsigned long long)c.between.samples, (unsigned long long)c.flagged.samples);
    list_check_end(&c.coarse);
    list_check_end(&c.between);
    list_check_end(&c.flagged);
    row(name, "coarse samples against the sum over all photons", &c.coarse, 2e-6);
    row(name, "samples between against the weights in double", &c.between, 5e-7);
    if (c.flagged.samples)
        row(name, "flagged samples against the sum over all photons", &c.flagged, 2e-6);
    none(name, "flagged; but not by weight; or not flagged", c.flags_wrong, c.decided, "samples");
    if (c.keyless)
        none(name, "samples without a key that have light", c.dark_wrong, c.keyless, "samples");
    assert_true(c.coarse.lit > c.coarse.samples / 4 && c.between.lit > c.between.samples / 4);
    assert_true(c.flagged.lit > 0 || !c.flagged.samples);
    free(f.coarse);
    free(f.flags);
    view_frame_free(&f.f);
    pack_close(&p);
}

static void coarse_samples_and_those_between(void **state) {
    (void)state;
    check_sparse("sparse", "sparse", NULL);
    check_sparse("sparse-16", "sparse-16", NULL);
    check_sparse("small-sparse", "small-sparse", NULL);
    check_sparse("zones-sparse", "zones-sparse", NULL);
    check_sparse("sparse-zones-areas", "sparse-zones-areas", NULL);
}

/* A sixteenth of the picture, which shows the back wall alone: what lies past its edge is not its other edge. */
static void enlarge(vit_scene *s, vit_camera *cameras, vit_light *lights) {
    (void)lights;
    for (uint32_t i = 0; i < s->frames; i++)
        for (int k = 0; k < 3; k++) {
            vit_camera *c = cameras + i;
            c->corner[k] += 0.375f * (float)s->width * c->right[k] + 0.14f * (float)s->height * c->down[k];
            c->right[k] *= 0.25f;
            c->down[k] *= 0.25f;
        }
}

static void a_wall_from_edge_to_edge(void **state) {
    (void)state;
    check_sparse("sparse; enlarged", "sparse", enlarge);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(small_samples_estimate_where_they_are),
                                       cmocka_unit_test(coarse_samples_and_those_between),
                                       cmocka_unit_test(a_wall_from_edge_to_edge)};
    return cmocka_run_group_tests_name("sparse estimate", tests, NULL, NULL);
}
