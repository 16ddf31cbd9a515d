/* radiosity.cl behind the library's kernels on the first OpenCL device. */
#ifndef VIT_BASELINE_RADIOSITY_LAB_H
#define VIT_BASELINE_RADIOSITY_LAB_H

#include "radiosity/form_factors.h"
#include "transfer_device.h"

#define RADIOSITY_ROWS 16u

typedef struct radiosity_lab {
    cl_mem size, factors, albedo, light, other, sums, all, begin[2];
    cl_kernel gather[2], reflect[2][2]; /* light to other and back; of the first reflection and later */
    size_t items, rows;
} radiosity_lab;

/* The kernels' source; the caller frees it. Programs run from the repository's root. */
static inline char *radiosity_source(void) {
    FILE *f = fopen("tests/baselines/radiosity.cl", "rb");
    char *text = calloc(1, 1u << 16);
    assert_non_null(f);
    assert_non_null(text);
    const size_t read = fread(text, 1, (1u << 16) - 1, f);
    assert_in_range(read, 1, (1u << 16) - 2);
    assert_int_equal(fclose(f), 0);
    return text;
}

/* patch_at[i]: which patch is the i-th. */
static inline radiosity_lab radiosity_lab_open(lab *l, unsigned lanes, const form_factors *f, const patch_set *p,
                                               const uint32_t *patch_at) {
    const uint32_t n = f->count, stride = (n + RADIOSITY_ROWS - 1) / RADIOSITY_ROWS * RADIOSITY_ROWS;
    const uint32_t size[2] = {stride, (stride + VIT_TRANSFER_CHUNK - 1) / VIT_TRANSFER_CHUNK}, begin[2] = {0, 1};
    float *factors = calloc((size_t)stride * stride, sizeof *factors), *albedo = calloc(3 * (size_t)stride, sizeof *albedo);
    uint32_t *place = calloc(n + 1u, sizeof *place);
    assert_true(factors && albedo && place);
    for (uint32_t i = 0; i < n; i++)
        place[patch_at[i]] = i;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t patch = patch_at[i];
        for (size_t k = f->first[patch]; k < f->first[patch + 1]; k++)
            factors[((size_t)(i / RADIOSITY_ROWS) * stride + place[f->to[k]]) * RADIOSITY_ROWS + i % RADIOSITY_ROWS] =
                f->factor[k];
        for (uint32_t c = 0; c < 3; c++)
            albedo[c * stride + i] = p->patch[patch].albedo[c];
    }
    radiosity_lab r = {.size = lab_buffer(l, size, sizeof size),
                       .factors = lab_buffer(l, factors, (size_t)stride * stride * sizeof *factors),
                       .albedo = lab_buffer(l, albedo, 12 * (size_t)stride),
                       .light = lab_buffer(l, NULL, 16 * (size_t)stride),
                       .other = lab_buffer(l, NULL, 16 * (size_t)stride),
                       .sums = lab_buffer(l, NULL, 12 * (size_t)stride * size[1]),
                       .all = lab_buffer(l, NULL, 12 * (size_t)stride),
                       .begin = {lab_buffer(l, begin, 4), lab_buffer(l, begin + 1, 4)},
                       .items = stride / lanes * size[1],
                       .rows = stride / lanes};
    for (int k = 0; k < 2; k++) {
        const cl_mem to = k ? r.light : r.other;
        r.gather[k] = transfer_kernel(l, "radiosity_gather", (cl_mem[]){r.size, r.factors, k ? r.other : r.light, r.sums}, 4);
        for (int b = 0; b < 2; b++)
            r.reflect[k][b] =
                transfer_kernel(l, "radiosity_reflect", (cl_mem[]){r.size, r.albedo, r.sums, to, r.all, r.begin[b]}, 6);
    }
    free(factors);
    free(albedo);
    free(place);
    return r;
}

/* `all` becomes what `bounces` reflections add to what is in `light`, which is used up; waits. */
static inline void radiosity_lab_run(lab *l, const radiosity_lab *r, uint32_t bounces) {
    for (uint32_t h = 0; h < bounces; h++) {
        lab_check(clEnqueueNDRangeKernel(l->queue, r->gather[h % 2], 1, NULL, &r->items, NULL, 0, NULL, NULL),
                  "radiosity_gather");
        lab_check(clEnqueueNDRangeKernel(l->queue, r->reflect[h % 2][h == 0], 1, NULL, &r->rows, NULL, 0, NULL, NULL),
                  "radiosity_reflect");
    }
    lab_check(clFinish(l->queue), "clFinish");
}

static inline void radiosity_lab_close(radiosity_lab *r) {
    const cl_mem all[] = {r->size, r->factors, r->albedo, r->light, r->other, r->sums, r->all, r->begin[0], r->begin[1]};
    for (int k = 0; k < 2; k++) {
        clReleaseKernel(r->gather[k]);
        clReleaseKernel(r->reflect[k][0]);
        clReleaseKernel(r->reflect[k][1]);
    }
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        clReleaseMemObject(all[i]);
}

#endif
