/* metrics.c: how far a picture is from the reference. Formulas and sources: bake/reference/README.md. */
#ifndef VIT_COST_METRICS_H
#define VIT_COST_METRICS_H

#include <stdint.h>

typedef struct cost_error {
    double nmse;   /* mean of squared error / squared mean of the reference */
    double relmse; /* mean of squared error / (value^2 + 1 % of the squared mean): dark places count */
    double bias;   /* mean of error / mean of the reference */
    double psnr;   /* after the transfer curve, dB; at most 200 */
    double ssim;   /* after the transfer curve, of luma, 8 x 8 windows; 1: equal */
    double local;  /* largest |mean error| of a block of 16 x 16 / mean of the reference */
} cost_error;

/* Both images 3 linear channels a pixel, row by row; `scale`: whose mean nmse, relmse's 1 %, bias and local are relative to, as
 * an image (the total light when only the indirect part is compared), NULL: the reference itself. relmse's value is the
 * reference's. Where that mean is 0, an error of 0 counts as 0 and any other as infinite. No pixels: all errors 0. */
cost_error metrics_compare(const double *reference, const float *image, const double *scale, uint32_t width, uint32_t height);

#endif
