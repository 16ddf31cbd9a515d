/* k reflections between patches for a moving directional light: classic radiosity (tests/baselines/), the transfer matrix as
 * floats and in each code, in turn in one run; bytes of them; their errors; and what the order of patches does to BC1's. In
 * Sibenik, or in our atrium where it is not at hand. Arguments: numbers of patches, default 1024 4096. */
#include "measure.h"
#include "baselines/radiosity_lab.h"
#include "radiosity/codec.h"
#include "radiosity/matrix_order.h"
#include "transfer_scene.h"

#define ROUNDS 9
#define BOUNCES 3u
#define RAYS 4096u /* a patch */
#define LIGHTS 8u  /* positions of the light */
#define ROOF 12.0f /* metres: what is farther does not shade, for light that falls on much of the scene */
#define COPY_PART (1u << 20)

static const char *const codec_names[] = {
#define X(macro, name, what) name,
    VIT_TRANSFERS(X)
#undef X
};
enum { WINDOWS, OPEN_ROOF, KINDS }; /* of light */

typedef struct race {
    transfer_scene t;
    uint32_t n, stride, *patch_at;
    float *area, *light[KINDS]; /* in that order; LIGHTS times 3 n */
    transfer_matrix matrix;
    coded code[VIT_TRANSFER_COUNT];
    codec_errors errors[VIT_TRANSFER_COUNT][KINDS];
    series classic, copy, ms[VIT_TRANSFER_COUNT];
    char size[16];
} race;

static void must(vit_status status, const vit_text *why) {
    if (status != VIT_OK)
        bench_fail("%s", why->text);
}

/* Areas and lights in the order at hand. */
static void order_inputs(race *r) {
    float *as_it_is = bench_array(3 * (size_t)r->n, sizeof *as_it_is);
    for (uint32_t i = 0; i < r->n; i++)
        r->area[i] = r->t.patches.patch[r->patch_at[i]].area;
    for (uint32_t kind = 0; kind < KINDS; kind++)
        for (uint32_t l = 0; l < LIGHTS; l++) {
            sun_on_patches(&r->t, (l + 0.5) / LIGHTS, kind == WINDOWS ? INFINITY : ROOF, as_it_is);
            for (uint32_t i = 0; i < r->n; i++)
                memcpy(r->light[kind] + ((size_t)l * r->n + i) * 3, as_it_is + 3 * r->patch_at[i], 3 * sizeof *as_it_is);
        }
    free(as_it_is);
}

static codec_input input_of(const race *r, uint32_t codec) {
    return (codec_input){.matrix = &r->matrix, .area = r->area, .codec = codec, .keep = -1.0};
}

static void judge(race *r, uint32_t codec) {
    vit_text why;
    const codec_input in = input_of(r, codec);
    for (int kind = 0; kind < KINDS; kind++)
        must(codec_judge(&in, &r->code[codec], r->light[kind], LIGHTS, &r->errors[codec][kind], &why), &why);
}

/* BC1 without another order, after one pass and after two; the matrix stays in the last. */
static void orders(race *r, csv *c) {
    static const char *const names[] = {"as made", "one pass", "two passes"};
    static const double source[3][3] = {{1.28e-6, 0.4622, 47.12}, {8.13e-7, 0.4684, 18.86}, {5.88e-7, 0.1524, 9.40}};
    transfer_matrix plain = r->matrix;
    vit_text why;
    printf("\nBC1 over the order of patches, %s patches: error of entries, beside the source's figures for its own scene and "
           "matrix; of reflected light through windows, with an open roof\n%-11s %9s %9s %9s  %9s %9s %9s  %8s %8s  %s\n",
           r->size, "order", "mean", "max", "sum", "source", "", "", "windows", "roof", "seconds");
    for (uint32_t passes = 0; passes <= MATRIX_ORDER_PASSES; passes++) {
        const double began = bench_seconds();
        must(matrix_order_find(&plain, passes, 0, r->patch_at, &why), &why);
        const double seconds = bench_seconds() - began;
        if (passes)
            transfer_matrix_free(&r->matrix);
        must(matrix_order_apply(&plain, r->patch_at, &r->matrix, &why), &why);
        order_inputs(r);
        const codec_input in = input_of(r, VIT_TRANSFER_BC1);
        must(codec_encode(&in, &r->code[VIT_TRANSFER_BC1], &why), &why);
        judge(r, VIT_TRANSFER_BC1);
        const codec_errors *e = r->errors[VIT_TRANSFER_BC1];
        printf("%-11s %9.3g %9.3g %9.4g  %9.3g %9.4g %9.4g  %8.4f %8.4f  %.1f\n", names[passes], e->mean, e->most, e->sum,
               source[passes][0], source[passes][1], source[passes][2], e[WINDOWS].light, e[OPEN_ROOF].light, seconds);
        const double values[] = {e->mean, e->most, e->sum, e[WINDOWS].light, e[OPEN_ROOF].light};
        static const char *const what[] = {"mean", "max", "sum", "light, windows", "light, open roof"};
        for (int k = 0; k < 5; k++) {
            const series s = series_exact(values[k]);
            char name[64];
            (void)snprintf(name, sizeof name, "BC1, %s: error, %s", names[passes], what[k]);
            csv_row(c, "transfer", r->size, name, &s, "1");
        }
        coded_free(&r->code[VIT_TRANSFER_BC1]);
    }
    transfer_matrix_free(&plain);
}

static void encode_all(race *r) {
    vit_text why;
    for (uint32_t k = 0; k < VIT_TRANSFER_COUNT; k++) {
        const codec_input in = input_of(r, k);
        const double began = bench_seconds();
        must(codec_encode(&in, &r->code[k], &why), &why);
        must(vit_transfer_check(r->code[k].words, r->code[k].count, &why), &why);
        const double seconds = bench_seconds() - began;
        judge(r, k);
        printf("%s: %.1f s to encode, %.1f s to judge\n", codec_names[k], seconds, bench_seconds() - began - seconds);
    }
}

/* ---- on the device ---- */

static unsigned lanes_of(const lab *l) {
    cl_device_type type;
    lab_check(clGetDeviceInfo(l->device, CL_DEVICE_TYPE, sizeof type, &type, NULL), "clGetDeviceInfo");
    return type & CL_DEVICE_TYPE_GPU ? 1 : 16;
}

typedef struct copying {
    char *to;
    const char *from;
} copying;

static void copy_part(void *user, uint32_t part) {
    const copying *c = user;
    memcpy(c->to + (size_t)part * COPY_PART, c->from + (size_t)part * COPY_PART, COPY_PART);
}

/* Direct light: four numbers a patch. */
static void light_of(const race *r, float *x) {
    for (uint32_t i = 0; i < r->n; i++)
        memcpy(x + 4 * (size_t)i, r->light[OPEN_ROOF] + 3 * (size_t)i, 3 * sizeof *x);
}

static void write_to(lab *l, cl_mem m, const float *x, uint32_t stride) {
    lab_check(clEnqueueWriteBuffer(l->queue, m, CL_TRUE, 0, 16 * (size_t)stride, x, 0, NULL, NULL), "clEnqueueWriteBuffer");
}

/* The codes' products are the baker's bits, and S as floats gives what reflecting one after the other gives. */
static void verify(race *r, lab *l, transfer_device *d, radiosity_lab *classic, const float *x) {
    const size_t numbers = 3 * (size_t)r->stride;
    float *y = bench_array(numbers, sizeof *y), *right = bench_array(numbers, sizeof *right);
    vit_text why;
    write_to(l, classic->light, x, r->stride);
    radiosity_lab_run(l, classic, BOUNCES);
    for (uint32_t k = 0; k < VIT_TRANSFER_COUNT; k++) {
        write_to(l, d[k].x, x, r->stride);
        transfer_device_run(l, &d[k]);
        lab_read(l, d[k].y, y, numbers * sizeof *y);
        must(codec_product(r->code[k].words, x, right, 0, &why), &why);
        if (memcmp(y, right, numbers * sizeof *y) != 0)
            bench_fail("%s: the device has other bits than the baker", codec_names[k]);
        if (k != VIT_TRANSFER_FLOAT32)
            continue;
        double off = 0.0, all = 0.0;
        lab_read(l, classic->all, right, numbers * sizeof *right);
        for (size_t i = 0; i < numbers; i++) {
            off += fabs((double)y[i] - (double)right[i]);
            all += (double)right[i];
        }
        if (!(off < 1e-5 * all))
            bench_fail("S gives %g of classic radiosity's light", 1.0 - off / all);
    }
    free(y);
    free(right);
}

static void time_all(race *r) {
    char options[] = " -DVIT_TRANSFER_PRODUCT", *source = radiosity_source();
    lab probe = {.device = lab_first_device()};
    const unsigned lanes = lanes_of(&probe);
    lab l = lab_open_with(lanes, 0, options, source);
    radiosity_lab classic = radiosity_lab_open(&l, lanes, &r->t.factors, &r->t.patches, r->patch_at);
    transfer_device d[VIT_TRANSFER_COUNT];
    const size_t copied = ((size_t)r->stride * r->stride * 12 + COPY_PART - 1) / COPY_PART * COPY_PART;
    copying c = {bench_array(copied, 1), bench_array(copied, 1)};
    float *x = bench_array(4 * (size_t)r->stride, sizeof *x);
    for (uint32_t k = 0; k < VIT_TRANSFER_COUNT; k++)
        d[k] = transfer_device_open(&l, lanes, r->code[k].words);
    light_of(r, x);
    verify(r, &l, d, &classic, x);
    for (int round = 0; round < bench_rounds(ROUNDS); round++) {
        write_to(&l, classic.light, x, r->stride);
        double began = bench_seconds();
        radiosity_lab_run(&l, &classic, BOUNCES);
        series_add(&r->classic, 1e3 * (bench_seconds() - began));
        for (uint32_t k = 0; k < VIT_TRANSFER_COUNT; k++) {
            began = bench_seconds();
            transfer_device_run(&l, &d[k]);
            series_add(&r->ms[k], 1e3 * (bench_seconds() - began));
        }
        began = bench_seconds();
        parallel_for(0, (uint32_t)(copied / COPY_PART), copy_part, &c);
        series_add(&r->copy, 1e3 * (bench_seconds() - began));
    }
    for (uint32_t k = 0; k < VIT_TRANSFER_COUNT; k++)
        transfer_device_close(&d[k]);
    radiosity_lab_close(&classic);
    lab_close(&l);
    free(c.to);
    free((void *)(size_t)c.from);
    free(source);
    free(x);
}

static void report(const race *r, csv *c) {
    const double f32 = 4.0 * r->n * r->n, classic = series_median(&r->classic), copied = 24.0 * r->stride * r->stride;
    const double copy = copied / series_median(&r->copy) * 1e-6;
    printf("\n%s patches, %u reflections, medians of %d; bytes: over those of F as floats and as half floats; GB/s of the "
           "code's bytes, and over a copy's %.1f GB/s, read and written; errors of entries, and of reflected light\n"
           "%-9s %8s %8s %9s %7s %7s %7s %6s  %9s %9s %9s  %8s %8s\n",
           r->size, BOUNCES, bench_rounds(ROUNDS), copy, "", "ms", "times", "MB", "of F", "of F/2", "GB/s", "copy", "mean",
           "max", "sum", "windows", "roof");
    printf("%-9s %8.3f %8.2f %9.2f %7.3f %7.3f %7.2f %6.2f\n", "classic", classic, 1.0, f32 * 1e-6, 1.0, 2.0,
           BOUNCES * f32 / classic * 1e-6, BOUNCES * f32 / classic * 1e-6 / copy);
    csv_row(c, "transfer", r->size, "classic", &r->classic, "ms");
    csv_row(c, "transfer", r->size, "copy", &r->copy, "ms");
    for (uint32_t k = 0; k < VIT_TRANSFER_COUNT; k++) {
        const codec_errors *e = r->errors[k];
        const double ms = series_median(&r->ms[k]), rate = e->bytes / ms * 1e-6;
        printf("%-9s %8.3f %8.2f %9.2f %7.3f %7.3f %7.2f %6.2f  %9.3g %9.3g %9.4g  %8.5f %8.5f\n", codec_names[k], ms,
               classic / ms, e->bytes * 1e-6, e->bytes / f32, 2.0 * e->bytes / f32, rate, rate / copy, e->mean, e->most, e->sum,
               e[WINDOWS].light, e[OPEN_ROOF].light);
        const double values[] = {classic / ms, e->bytes, rate, e->mean, e->most, e->sum, e[WINDOWS].light, e[OPEN_ROOF].light};
        static const char *const what[] = {"classic / this",
                                           "bytes",
                                           "bytes a time",
                                           "error, mean",
                                           "error, max",
                                           "error, sum",
                                           "error of light, windows",
                                           "error of light, open roof"};
        static const char *const units[] = {"ratio", "B", "GB/s", "1", "1", "1", "1", "1"};
        csv_row(c, "transfer", r->size, codec_names[k], &r->ms[k], "ms");
        for (int i = 0; i < 8; i++) {
            const series s = series_exact(values[i]);
            char name[64];
            (void)snprintf(name, sizeof name, "%s: %s", codec_names[k], what[i]);
            csv_row(c, "transfer", r->size, name, &s, units[i]);
        }
    }
}

static void run(csv *c, const char *pack, uint32_t count) {
    race *r = bench_array(1, sizeof *r);
    vit_text why;
    transfer_open(&r->t, pack, count, bench_smoke() ? 64 : RAYS);
    r->n = r->t.patches.count;
    r->stride = (r->n + VIT_TRANSFER_ROWS - 1) / VIT_TRANSFER_ROWS * VIT_TRANSFER_ROWS;
    (void)snprintf(r->size, sizeof r->size, "%u", r->n);
    r->patch_at = bench_array(r->n, sizeof *r->patch_at);
    r->area = bench_array(r->n, sizeof *r->area);
    for (int k = 0; k < KINDS; k++)
        r->light[k] = bench_array((size_t)LIGHTS * 3 * r->n, sizeof(float));
    const transfer_matrix_input in = {.factors = &r->t.factors, .patches = &r->t.patches, .bounces = BOUNCES};
    const double began = bench_seconds();
    must(transfer_matrix_make(&in, &r->matrix, &why), &why);
    printf("%s patches, of whose pairs %.3f see each other: S in %.1f s, spectral radius at most %.3f %.3f %.3f\n", r->size,
           (double)r->t.factors.first[r->n] / r->n / r->n, bench_seconds() - began, r->matrix.spectral[0],
           r->matrix.spectral[1], r->matrix.spectral[2]);
    orders(r, c);
    encode_all(r);
    time_all(r);
    report(r, c);
    for (uint32_t k = 0; k < VIT_TRANSFER_COUNT; k++)
        coded_free(&r->code[k]);
    for (int k = 0; k < KINDS; k++)
        free(r->light[k]);
    transfer_matrix_free(&r->matrix);
    transfer_close(&r->t);
    free(r->patch_at);
    free(r->area);
    free(r);
}

int main(int argc, char **argv) {
    static const uint32_t usual[] = {1024, 4096};
    char pack[BENCH_PATH];
    csv c = csv_open("transfer");
    if (!scene_pack(&bench_scenes[2], bench_size(0), pack) && !scene_pack(&bench_scenes[0], bench_size(0), pack))
        bench_fail("no scene");
    for (int i = 1; i < argc; i++)
        run(&c, pack, (uint32_t)strtoul(argv[i], NULL, 10));
    for (int i = 0; i < 2 && argc < 2; i++)
        if (!bench_smoke() || i == 0)
            run(&c, pack, bench_smoke() ? 96 : usual[i]);
    csv_close(&c, "transfer");
    return VIT_OK;
}
