/* The kernels of kernels/transfer_product.cl on the first OpenCL device. */
#ifndef VIT_TESTS_TRANSFER_DEVICE_H
#define VIT_TESTS_TRANSFER_DEVICE_H

#include "kernel_lab.h"
#include "vitrine_pack.h"

enum { TRANSFER_PROJECT, TRANSFER_MIX, TRANSFER_PARTIAL, TRANSFER_SUM, TRANSFER_KERNELS };

typedef struct transfer_device {
    cl_mem code, x, projected, mixed, sums, y;
    cl_kernel kernel[TRANSFER_KERNELS];
    size_t items[TRANSFER_KERNELS]; /* 0: it is not called */
} transfer_device;

/* Floats between the kernels. */
static inline size_t transfer_column_chunks(const vit_transfer *h) {
    return (h->stride + VIT_TRANSFER_CHUNK - 1) / VIT_TRANSFER_CHUNK;
}

static inline size_t transfer_sums(const vit_transfer *h) {
    return h->dense_chunks + h->sparse_chunks + (h->rank > 0);
}

static inline size_t transfer_projected_floats(const vit_transfer *h) {
    return 3 * transfer_column_chunks(h) * h->rank + 1;
}

static inline size_t transfer_sums_floats(const vit_transfer *h) {
    return 3 * transfer_sums(h) * h->stride + 1;
}

static inline cl_kernel transfer_kernel(lab *l, const char *name, const cl_mem *arguments, cl_uint count) {
    cl_int e;
    cl_kernel k = clCreateKernel(l->program, name, &e);
    lab_check(e, name);
    for (cl_uint i = 0; i < count; i++)
        lab_check(clSetKernelArg(k, i, sizeof(cl_mem), &arguments[i]), "clSetKernelArg");
    return k;
}

/* The lab's program is compiled with -DVIT_TRANSFER_PRODUCT. */
static inline transfer_device transfer_device_open(lab *l, unsigned lanes, const uint32_t *words) {
    const vit_transfer *h = (const vit_transfer *)(const void *)words;
    transfer_device d = {.code = lab_buffer(l, words, (size_t)h->words * 4),
                         .x = lab_buffer(l, NULL, 16 * (size_t)h->stride),
                         .projected = lab_buffer(l, NULL, 4 * transfer_projected_floats(h)),
                         .mixed = lab_buffer(l, NULL, 12 * (size_t)h->rank + 4),
                         .sums = lab_buffer(l, NULL, 4 * transfer_sums_floats(h)),
                         .y = lab_buffer(l, NULL, 12 * (size_t)h->stride),
                         .items = {h->rank / lanes * transfer_column_chunks(h), 3 * h->rank / lanes,
                                   h->stride / lanes * transfer_sums(h), h->stride / lanes}};
    d.kernel[0] = transfer_kernel(l, "transfer_project", (cl_mem[]){d.code, d.x, d.projected}, 3);
    d.kernel[1] = transfer_kernel(l, "transfer_mix", (cl_mem[]){d.code, d.projected, d.mixed}, 3);
    d.kernel[2] = transfer_kernel(l, "transfer_partial", (cl_mem[]){d.code, d.x, d.mixed, d.sums}, 4);
    d.kernel[3] = transfer_kernel(l, "transfer_sum", (cl_mem[]){d.code, d.sums, d.y}, 3);
    return d;
}

static inline void transfer_device_close(transfer_device *d) {
    const cl_mem all[] = {d->code, d->x, d->projected, d->mixed, d->sums, d->y};
    for (int i = 0; i < TRANSFER_KERNELS; i++)
        clReleaseKernel(d->kernel[i]);
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        clReleaseMemObject(all[i]);
}

/* y = S x, of what is in x, and waits. */
static inline void transfer_device_run(lab *l, const transfer_device *d) {
    for (int i = 0; i < TRANSFER_KERNELS; i++)
        if (d->items[i])
            lab_check(clEnqueueNDRangeKernel(l->queue, d->kernel[i], 1, NULL, &d->items[i], NULL, 0, NULL, NULL),
                      "clEnqueueNDRangeKernel");
    lab_check(clFinish(l->queue), "clFinish");
}

#endif
