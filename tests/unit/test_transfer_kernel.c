/* The product with a coded transfer matrix: the kernels' bits are those of the baker's C function, compiled as C and on the
 * OpenCL device at every number of lanes. */
#include "host_lab.h"
#include "radiosity/codec_parts.h"
#include "transfer_device.h"
#include "transfer_lab.h"

enum { SIZES = 7, LARGEST = 560 };
static const uint32_t sizes[SIZES] = {1, 3, 5, 16, 47, 300, 545};

typedef struct sample {
    coded code[VIT_TRANSFER_COUNT];
    float x[4 * LARGEST], y[VIT_TRANSFER_COUNT][3 * LARGEST];
    uint32_t stride;
} sample;

static sample *sample_make(uint32_t n) {
    sample *s = transfer_array(1, sizeof *s);
    transfer_lab l = transfer_lab_open(n, factor_room);
    transfer_matrix m = transfer_lab_matrix(&l, 3, 0);
    s->stride = codec_stride(n);
    for (uint32_t i = 0; i < 4 * n; i++)
        s->x[i] = 10.0f * unit_float(pcg(i));
    for (uint32_t k = 0; k < VIT_TRANSFER_COUNT; k++) {
        const codec_input in = {.matrix = &m, .area = l.area, .codec = k, .keep = 0.6, .rank = n > 100 ? 48 : 16};
        assert_int_equal(codec_encode(&in, &s->code[k], NULL), VIT_OK);
        assert_int_equal(codec_product(s->code[k].words, s->x, s->y[k], 0, NULL), VIT_OK);
    }
    transfer_matrix_free(&m);
    transfer_lab_close(&l);
    return s;
}

static void sample_free(sample *s) {
    for (uint32_t k = 0; k < VIT_TRANSFER_COUNT; k++)
        coded_free(&s->code[k]);
    free(s);
}

static void compiled_as_c_it_has_the_bakers_bits(void **state) {
    (void)state;
    for (size_t i = 0; i < SIZES; i++) {
        sample *s = sample_make(sizes[i]);
        for (uint32_t k = 0; k < VIT_TRANSFER_COUNT; k++) {
            const vit_transfer *h = header_of(s->code[k].words);
            float *projected = transfer_array(transfer_projected_floats(h), 4), *mixed = transfer_array(3 * h->rank, 4);
            float *sums = transfer_array(transfer_sums_floats(h), 4), y[3 * LARGEST];
            host_lab_find()->transfer(h, s->x, projected, mixed, sums, y);
            if (memcmp(y, s->y[k], 3 * s->stride * sizeof *y) != 0)
                fail_msg("%u patches, codec %u: other bits", sizes[i], k);
            free(projected);
            free(mixed);
            free(sums);
        }
        sample_free(s);
    }
}

static void on_the_device_it_has_them_at_every_number_of_lanes(void **state) {
    (void)state;
    for (size_t w = 0; w < LAB_WIDTHS; w++) {
        lab l = lab_open_with(lab_lanes[w], 0, " -DVIT_TRANSFER_PRODUCT", "");
        for (size_t i = 0; i < SIZES; i++) {
            sample *s = sample_make(sizes[i]);
            for (uint32_t k = 0; k < VIT_TRANSFER_COUNT; k++) {
                float y[3 * LARGEST];
                const size_t bytes = 12 * (size_t)s->stride;
                transfer_device d = transfer_device_open(&l, lab_lanes[w], s->code[k].words);
                lab_check(clEnqueueWriteBuffer(l.queue, d.x, CL_TRUE, 0, bytes / 3 * 4, s->x, 0, NULL, NULL),
                          "clEnqueueWriteBuffer");
                transfer_device_run(&l, &d);
                lab_read(&l, d.y, y, bytes);
                if (memcmp(y, s->y[k], bytes) != 0)
                    fail_msg("%u lanes, %u patches, codec %u: other bits", lab_lanes[w], sizes[i], k);
                transfer_device_close(&d);
            }
            sample_free(s);
        }
        lab_close(&l);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(compiled_as_c_it_has_the_bakers_bits),
        cmocka_unit_test(on_the_device_it_has_them_at_every_number_of_lanes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
