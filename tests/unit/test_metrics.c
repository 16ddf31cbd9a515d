/* Metrics of pictures whose errors can be worked out by hand. */
#include "reference/metrics.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

enum { EDGE = 32, VALUES = 3 * EDGE * EDGE };

static void about(double found, double wanted) {
    if (!(fabs(found - wanted) <= 1e-6 * (1 + fabs(wanted))))
        fail_msg("%.9g, wanted %.9g", found, wanted);
}

static void fill(double *reference, float *image, double r, double i) {
    for (int k = 0; k < VALUES; k++) {
        reference[k] = r;
        image[k] = (float)i;
    }
}

static void equal_pictures_have_no_error(void **state) {
    (void)state;
    double reference[VALUES];
    float image[VALUES];
    for (int k = 0; k < VALUES; k++) {
        image[k] = (float)(k % 7) / 4.0f;
        reference[k] = (double)image[k];
    }
    const cost_error e = metrics_compare(reference, image, NULL, EDGE, EDGE);
    assert_true(e.nmse == 0 && e.relmse == 0 && e.bias == 0 && e.local == 0 && e.psnr == 200);
    about(e.ssim, 1);
}

static void a_constant_error_is_what_its_formulas_say(void **state) {
    (void)state;
    double reference[VALUES];
    float image[VALUES];
    fill(reference, image, 0.5, 0.75);
    const cost_error e = metrics_compare(reference, image, NULL, EDGE, EDGE);
    about(e.nmse, 0.0625 / 0.25);
    about(e.relmse, 0.0625 / (0.25 + 0.01 * 0.25));
    about(e.bias, 0.5);
    about(e.local, 0.5);
    /* sRGB: 0.5 -> 0.735357, 0.75 -> 0.880825; flat windows have only the luminance term of SSIM. */
    const double a = 1.055 * pow(0.5, 1 / 2.4) - 0.055, b = 1.055 * pow(0.75, 1 / 2.4) - 0.055;
    about(a, 0.7353569831);
    about(e.psnr, -20 * log10(b - a));
    about(e.ssim, (2 * a * b + 1e-4) / (a * a + b * b + 1e-4));
}

static void errors_of_both_signs_have_no_bias(void **state) {
    (void)state;
    double reference[VALUES];
    float image[VALUES];
    fill(reference, image, 1, 1);
    for (int k = 0; k < VALUES; k++)
        image[k] += (k / 3) % 2 ? 0.5f : -0.5f; /* columns */
    const cost_error e = metrics_compare(reference, image, NULL, EDGE, EDGE);
    about(e.bias, 0);
    about(e.local, 0);
    about(e.nmse, 0.25);
    about(e.relmse, 0.25 / 1.01);
    /* What is brighter than white shows as white: only the darker half errs. */
    const double d = 1 - (1.055 * pow(0.5, 1 / 2.4) - 0.055);
    about(e.psnr, 10 * log10(2 / (d * d)));
    /* Flat reference, stripes of mean m and variance v in each window: no covariance. */
    const double m = 1 - d / 2, v = d * d / 4;
    about(e.ssim, (2 * m + 1e-4) * 9e-4 / ((1 + m * m + 1e-4) * (v + 9e-4)));
}

static void dark_places_count_in_relmse(void **state) {
    (void)state;
    double reference[VALUES];
    float image[VALUES];
    fill(reference, image, 2, 2);
    for (int k = 0; k < VALUES / 2; k++) { /* a dark half that is wrong by 0.1 */
        reference[k] = 0;
        image[k] = 0.1f;
    }
    const cost_error e = metrics_compare(reference, image, NULL, EDGE, EDGE);
    about(e.nmse, 0.005);             /* 0.01 / 2 over mean 1 squared */
    about(e.relmse, 0.01 / 0.01 / 2); /* 1 % of the squared mean is all there is to divide by */
    about(e.bias, 0.05);
    about(e.local, 0.1);
}

static void the_largest_block_error_is_found_at_the_edge_too(void **state) {
    (void)state;
    enum { W = 35, H = 17 }; /* blocks end with the picture: the last one starts at 19, 1 */
    static double reference[3 * W * H];
    static float image[3 * W * H];
    for (int k = 0; k < 3 * W * H; k++) {
        reference[k] = 1;
        image[k] = 1;
    }
    for (int k = 0; k < 3; k++)
        image[3 * (16 * W + 34) + k] = 1 - 25.6f;
    const cost_error e = metrics_compare(reference, image, NULL, W, H);
    about(e.local, 0.1);
    about(e.bias, -25.6 / (W * H));
}

static void the_indirect_part_can_be_measured_against_the_total(void **state) {
    (void)state;
    double reference[VALUES], total[VALUES];
    float image[VALUES];
    fill(reference, image, 0.5, 0.75);
    fill(total, image, 2, 0.75);
    const cost_error e = metrics_compare(reference, image, total, EDGE, EDGE);
    about(e.nmse, 0.0625 / 4);
    about(e.relmse, 0.0625 / (0.25 + 0.04));
    about(e.bias, 0.125);
    about(e.local, 0.125);
}

/* One window: SSIM as Wang et al. write it, from sums worked out here. */
static void similarity_of_one_window(void **state) {
    (void)state;
    enum { N = 8 };
    double reference[3 * N * N], mean[2] = {0, 0}, var[2] = {0, 0}, cov = 0;
    float image[3 * N * N];
    double shown[2][N * N];
    for (int i = 0; i < N * N; i++) {
        const double linear[2] = {(double)(i % 8) / 8, (double)((i * 5) % 16) / 16};
        for (int k = 0; k < 3; k++) {
            reference[3 * i + k] = linear[0];
            image[3 * i + k] = (float)linear[1];
        }
        for (int p = 0; p < 2; p++) {
            shown[p][i] = linear[p] <= 0.0031308 ? 12.92 * linear[p] : 1.055 * pow(linear[p], 1 / 2.4) - 0.055;
            mean[p] += shown[p][i] / (N * N);
        }
    }
    for (int i = 0; i < N * N; i++) {
        const double a = shown[0][i] - mean[0], b = shown[1][i] - mean[1];
        var[0] += a * a / (N * N);
        var[1] += b * b / (N * N);
        cov += a * b / (N * N);
    }
    const cost_error e = metrics_compare(reference, image, NULL, N, N);
    about(e.ssim, (2 * mean[0] * mean[1] + 1e-4) * (2 * cov + 9e-4) /
                      ((mean[0] * mean[0] + mean[1] * mean[1] + 1e-4) * (var[0] + var[1] + 9e-4)));
}

/* Windows at every place, in however many parts they are worked through. */
static void similarity_is_the_mean_over_all_windows(void **state) {
    (void)state;
    enum { W = 150, H = 71 };
    static double reference[3 * W * H];
    static float image[3 * W * H];
    double sum = 0;
    for (int i = 0; i < W * H; i++)
        for (int k = 0; k < 3; k++) {
            reference[3 * i + k] = (double)(i * 37 % 101) / 101;
            image[3 * i + k] = (float)(i * 53 % 97) / 97.0f;
        }
    for (int y = 0; y + 8 <= H; y++)
        for (int x = 0; x + 8 <= W; x++) {
            double r[3 * 64];
            float i[3 * 64];
            for (int k = 0; k < 3 * 64; k++) {
                const int from = 3 * ((y + k / 24) * W + x) + k % 24;
                r[k] = reference[from];
                i[k] = image[from];
            }
            sum += metrics_compare(r, i, NULL, 8, 8).ssim;
        }
    about(metrics_compare(reference, image, NULL, W, H).ssim, sum / ((W - 7) * (H - 7)));
}

static void black_pictures_and_no_pictures_are_no_trouble(void **state) {
    (void)state;
    double reference[VALUES];
    float image[VALUES];
    fill(reference, image, 0, 0);
    cost_error e = metrics_compare(reference, image, NULL, EDGE, EDGE);
    assert_true(e.nmse == 0 && e.relmse == 0 && e.bias == 0 && e.local == 0);
    image[5] = 1;
    e = metrics_compare(reference, image, NULL, EDGE, EDGE);
    assert_true(isinf(e.nmse) && isinf(e.relmse) && isinf(e.bias));
    e = metrics_compare(reference, image, NULL, 0, EDGE);
    assert_true(e.nmse == 0 && e.ssim == 1);
    e = metrics_compare(reference, image, NULL, 1, 1);
    assert_true(e.nmse == 0 && e.psnr == 200);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_pictures_have_no_error),
        cmocka_unit_test(a_constant_error_is_what_its_formulas_say),
        cmocka_unit_test(errors_of_both_signs_have_no_bias),
        cmocka_unit_test(dark_places_count_in_relmse),
        cmocka_unit_test(the_largest_block_error_is_found_at_the_edge_too),
        cmocka_unit_test(the_indirect_part_can_be_measured_against_the_total),
        cmocka_unit_test(similarity_of_one_window),
        cmocka_unit_test(similarity_is_the_mean_over_all_windows),
        cmocka_unit_test(black_pictures_and_no_pictures_are_no_trouble),
    };
    return cmocka_run_group_tests_name("metrics", tests, NULL, NULL);
}
