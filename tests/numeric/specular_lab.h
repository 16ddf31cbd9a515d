/* The functions of kernels/specular.clh at many inputs and at every width. Who includes it defines `kernels` first. */
#ifndef VIT_TESTS_SPECULAR_LAB_H
#define VIT_TESTS_SPECULAR_LAB_H

#include "catalogue.h"
#include "kernel_lab.h"
#include <math.h>

enum { COUNT = 1 << 18, IN = 12, OUT = 8 };
#define PI 3.14159265358979323846

typedef struct bench {
    float *in, *out[LAB_WIDTHS];
} bench;

/* The kernel at every width; they agree to the bit. */
static inline void run(bench *b, const char *kernel, unsigned planes) {
    for (unsigned w = 0; w < LAB_WIDTHS; w++) {
        lab l = lab_open(lab_lanes[w], VIT_BIT(GLASS) | VIT_BIT(SPECULAR), kernels);
        const cl_mem a[] = {lab_buffer(&l, b->in, IN * (size_t)COUNT * 4), lab_buffer(&l, NULL, OUT * (size_t)COUNT * 4)};
        lab_run(&l, kernel, COUNT / lab_lanes[w], a, 2);
        lab_read(&l, a[1], b->out[w], planes * (size_t)COUNT * 4);
        clReleaseMemObject(a[0]);
        clReleaseMemObject(a[1]);
        lab_close(&l);
        assert_memory_equal(b->out[w], b->out[0], planes * (size_t)COUNT * 4);
    }
}

static inline int set_up(void **state) {
    static bench b;
    b.in = calloc(IN * (size_t)COUNT, 4);
    for (unsigned w = 0; w < LAB_WIDTHS; w++)
        b.out[w] = calloc(OUT * (size_t)COUNT, 4);
    *state = &b;
    return b.in && b.out[0] && b.out[1] && b.out[2] ? 0 : -1;
}

static inline int tear_down(void **state) {
    bench *b = *state;
    free(b->in);
    for (unsigned w = 0; w < LAB_WIDTHS; w++)
        free(b->out[w]);
    return 0;
}

static inline double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void put(bench *b, unsigned plane, uint32_t i, const double v[3]) {
    for (unsigned k = 0; k < 3; k++)
        b->in[(plane + k) * (size_t)COUNT + i] = (float)v[k];
}

static inline void get(const float *planes, unsigned plane, uint32_t i, double v[3]) {
    for (unsigned k = 0; k < 3; k++)
        v[k] = (double)planes[(plane + k) * (size_t)COUNT + i];
}

static inline void random_unit(uint64_t *random, double v[3]) {
    const double z = 2 * (double)lab_uniform(random) - 1, r = sqrt(1 - z * z), a = 2 * PI * (double)lab_uniform(random);
    v[0] = r * cos(a);
    v[1] = r * sin(a);
    v[2] = z;
}

/* Two unit vectors square to n. */
static inline void axes(const double n[3], double t[3], double s[3]) {
    const int k = fabs(n[0]) < 0.6 ? 0 : 1;
    double length = sqrt(1 - n[k] * n[k]);
    for (int i = 0; i < 3; i++)
        t[i] = ((i == k) - n[k] * n[i]) / length;
    for (int i = 0; i < 3; i++)
        s[i] = n[(i + 1) % 3] * t[(i + 2) % 3] - n[(i + 2) % 3] * t[(i + 1) % 3];
}

#endif
