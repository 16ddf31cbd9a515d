/* Positions of view samples in 16 bits a coordinate: stored and read back by the kernels' own functions. A position may move by
 * little more than a step, but never behind its surface, or the surface would shadow itself. */
#include "kernel_lab.h"
#include <math.h>

enum { POINTS = 1 << 14 };

static const char kernels[] =
    "kernel void there_and_back(global const vit_scene *scene, global const float *in, global const float *face,\n"
    "                           global float *position, global float *out, global float *gathered)\n"
    "{\n"
    "    uint n = scene->samples, first = (uint)get_global_id(0) * VIT_LANES;\n"
    "    lv3 p = lv3_load_planes(in, n, first), f = lv3_load_planes(face, n, first);\n"
    "    li hit = L_NE(L_FROM_INT((int)first + L_INDEX), (lf)7);\n" /* sample 7 hits nothing */
    "    sample_store_position(scene, p, f, hit, position, first);\n"
    "    lv3_store_planes(sample_position(scene, position, first), out, n, first);\n"
    "    lv3_store_planes(sample_position_of(scene, position, (int)first + L_INDEX), gathered, n, first);\n"
    "}\n";

typedef struct points {
    float in[3 * POINTS], face[3 * POINTS], out[3 * POINTS], gathered[3 * POINTS];
    uint16_t stored[3 * POINTS];
} points;

static const vit_scene scene = {.samples = POINTS, .grid_low = {-17.25f, -0.5f, 3.0f}, .grid_step = 0.0007f};

static void points_make(points *p) {
    uint64_t random = 11;
    for (int i = 0; i < POINTS; i++) {
        float n[3], length = 0;
        for (int k = 0; k < 3; k++) {
            p->in[k * POINTS + i] = scene.grid_low[k] + (0.01f + 0.98f * lab_uniform(&random)) * 65535.0f * scene.grid_step;
            n[k] = i % 4 == k ? 1.0f : i % 4 < 3 ? 0.0f : lab_uniform(&random) - 0.5f;
            length += n[k] * n[k];
        }
        for (int k = 0; k < 3; k++)
            p->face[k * POINTS + i] = n[k] / sqrtf(length);
    }
}

static void run(points *p, unsigned lanes) {
    lab l = lab_open(lanes, VIT_BIT(SMALL_SAMPLES), kernels);
    const cl_mem b[] = {lab_buffer(&l, &scene, sizeof scene),    lab_buffer(&l, p->in, sizeof p->in),
                        lab_buffer(&l, p->face, sizeof p->face), lab_buffer(&l, NULL, sizeof p->stored),
                        lab_buffer(&l, NULL, sizeof p->out),     lab_buffer(&l, NULL, sizeof p->gathered)};
    lab_run(&l, "there_and_back", POINTS / lanes, b, 6);
    lab_read(&l, b[3], p->stored, sizeof p->stored);
    lab_read(&l, b[4], p->out, sizeof p->out);
    lab_read(&l, b[5], p->gathered, sizeof p->gathered);
    for (int i = 0; i < 6; i++)
        clReleaseMemObject(b[i]);
    lab_close(&l);
}

static void a_position_moves_little_and_never_behind_its_surface(void **state) {
    (void)state;
    static points p;
    double farthest = 0, lowest = 1;
    points_make(&p);
    run(&p, 1);
    for (int i = 0; i < POINTS; i++) {
        double d2 = 0, off = 0;
        for (int k = 0; k < 3 && i != 7; k++) {
            const double d = (double)p.out[k * POINTS + i] - (double)p.in[k * POINTS + i];
            d2 += d * d;
            off += d * (double)p.face[k * POINTS + i];
        }
        farthest = fmax(farthest, sqrt(d2));
        lowest = i == 7 ? lowest : fmin(lowest, off);
    }
    print_message("moved by at most %g steps, off the surface by at least %g\n", farthest / (double)scene.grid_step,
                  lowest / (double)scene.grid_step);
    assert_true(farthest < 1.75 * (double)scene.grid_step && farthest > (double)scene.grid_step);
    assert_true(lowest > -0.01 * (double)scene.grid_step);
    for (int k = 0; k < 3; k++)
        assert_int_equal(p.stored[k * POINTS + 7], 0);
}

static void every_width_stores_and_reads_the_same(void **state) {
    (void)state;
    static points narrow, wide;
    points_make(&narrow);
    points_make(&wide);
    run(&narrow, 1);
    assert_memory_equal(narrow.out, narrow.gathered, sizeof narrow.out);
    for (unsigned w = 1; w < LAB_WIDTHS; w++) {
        run(&wide, lab_lanes[w]);
        assert_memory_equal(&narrow, &wide, sizeof narrow);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_position_moves_little_and_never_behind_its_surface),
        cmocka_unit_test(every_width_stores_and_reads_the_same),
    };
    return cmocka_run_group_tests_name("small samples", tests, NULL, NULL);
}
