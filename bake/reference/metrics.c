#include "reference/metrics.h"
#include "common/colour.h"
#include <math.h>
#include <stddef.h>

#define DARK 0.01 /* relMSE: share of the squared mean that keeps black pixels from counting without bound */
#define BLOCK 16u /* pixels of a block's edge, local error */
#define WINDOW 8u /* pixels of a window's edge, SSIM */
#define PART 64u  /* windows of a part's edge, whose lumas are kept */
#define MOST_DB 200.0

typedef struct pictures {
    const double *reference;
    const float *image;
    uint32_t width, height;
} pictures;

static double mean_of(const double *values, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += values[i];
    return sum / (double)count;
}

/* x / scale where both may be 0. */
static double over(double x, double scale) {
    return x > 0 || x < 0 ? x / scale : 0;
}

/* Luma of a pixel's display values; ITU-R BT.709. */
static double luma(double red, double green, double blue) {
    return luminance(srgb_encoded(red), srgb_encoded(green), srgb_encoded(blue));
}

/* Start of the i-th block of `size` on an edge of `length`: the last one ends with the picture. */
static uint32_t block_start(uint32_t i, uint32_t size, uint32_t length) {
    return (i + 1) * size <= length ? i * size : length - size;
}

static double block_error(const pictures *p, uint32_t x0, uint32_t y0, uint32_t w, uint32_t h) {
    double sum = 0;
    for (uint32_t y = y0; y < y0 + h; y++)
        for (uint32_t x = x0; x < x0 + w; x++)
            for (uint32_t k = 0; k < 3; k++) {
                const size_t i = 3 * ((size_t)y * p->width + x) + k;
                sum += (double)p->image[i] - p->reference[i];
            }
    return fabs(sum / (3.0 * w * h));
}

static double largest_block_error(const pictures *p) {
    const uint32_t w = p->width < BLOCK ? p->width : BLOCK, h = p->height < BLOCK ? p->height : BLOCK;
    double largest = 0;
    for (uint32_t j = 0; j * h < p->height; j++)
        for (uint32_t i = 0; i * w < p->width; i++) {
            const double e = block_error(p, block_start(i, w, p->width), block_start(j, h, p->height), w, h);
            largest = e > largest ? e : largest;
        }
    return largest;
}

/* Luma of both pictures over a part of them; small enough for the stack. */
typedef struct lumas {
    uint32_t x0, y0, width, height;
    double reference[PART + WINDOW][PART + WINDOW], image[PART + WINDOW][PART + WINDOW];
} lumas;

static void read_lumas(const pictures *p, lumas *l) {
    for (uint32_t y = 0; y < l->height; y++)
        for (uint32_t x = 0; x < l->width; x++) {
            const size_t i = 3 * ((size_t)(l->y0 + y) * p->width + l->x0 + x);
            const double *r = p->reference + i;
            l->reference[y][x] = luma(r[0], r[1], r[2]);
            l->image[y][x] = luma((double)p->image[i], (double)p->image[i + 1], (double)p->image[i + 2]);
        }
}

/* Wang, Bovik, Sheikh, Simoncelli 2004, equation 13, of the window at x0, y0 of a part. */
static double window_similarity(const lumas *l, uint32_t x0, uint32_t y0, uint32_t w, uint32_t h) {
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03, n = (double)w * h;
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    for (uint32_t y = y0; y < y0 + h; y++)
        for (uint32_t x = x0; x < x0 + w; x++) {
            const double s = l->reference[y][x], t = l->image[y][x];
            a += s;
            b += t;
            aa += s * s;
            bb += t * t;
            ab += s * t;
        }
    a /= n;
    b /= n;
    const double va = aa / n - a * a, vb = bb / n - b * b, vab = ab / n - a * b;
    return (2 * a * b + c1) * (2 * vab + c2) / ((a * a + b * b + c1) * (va + vb + c2));
}

static uint32_t least(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

/* Sum over the windows that start in the part at x0, y0. */
static double part_similarity(const pictures *p, uint32_t x0, uint32_t y0, uint32_t w, uint32_t h) {
    const uint32_t across = least(PART, p->width - w + 1 - x0), down = least(PART, p->height - h + 1 - y0);
    lumas l = {.x0 = x0, .y0 = y0, .width = across + w - 1, .height = down + h - 1};
    double sum = 0;
    read_lumas(p, &l);
    for (uint32_t y = 0; y < down; y++)
        for (uint32_t x = 0; x < across; x++)
            sum += window_similarity(&l, x, y, w, h);
    return sum;
}

static double similarity(const pictures *p) {
    const uint32_t w = least(WINDOW, p->width), h = least(WINDOW, p->height);
    double sum = 0;
    for (uint32_t y = 0; y + h <= p->height; y += PART)
        for (uint32_t x = 0; x + w <= p->width; x += PART)
            sum += part_similarity(p, x, y, w, h);
    return sum / ((double)(p->width - w + 1) * (p->height - h + 1));
}

static double psnr(const pictures *p, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        const double e = srgb_encoded((double)p->image[i]) - srgb_encoded(p->reference[i]);
        sum += e * e;
    }
    const double db = sum > 0 ? 10 * log10((double)count / sum) : MOST_DB;
    return db < MOST_DB ? db : MOST_DB;
}

cost_error metrics_compare(const double *reference, const float *image, const double *scale, uint32_t width, uint32_t height) {
    const pictures p = {reference, image, width, height};
    const size_t count = 3 * (size_t)width * height;
    double error = 0, squares = 0, relative = 0;
    if (count == 0)
        return (cost_error){.psnr = MOST_DB, .ssim = 1};
    const double mean = mean_of(scale ? scale : reference, count);
    for (size_t i = 0; i < count; i++) {
        const double e = (double)image[i] - reference[i];
        error += e;
        squares += e * e;
        relative += over(e * e, reference[i] * reference[i] + DARK * mean * mean);
    }
    return (cost_error){.nmse = over(squares / (double)count, mean * mean),
                        .relmse = relative / (double)count,
                        .bias = over(error / (double)count, mean),
                        .psnr = psnr(&p, count),
                        .ssim = similarity(&p),
                        .local = over(largest_block_error(&p), mean)};
}
