/* report_pictures.c: which settings are shown, and their frames and errors as pictures of at most MOST_PIXELS pixels. */
#include "report/report_parts.h"
#include "common/colour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A picture of noise takes up to 4 bytes per pixel in base64 as colours and 1.2 as one map: 14 x (4 + 2 x 1.2) x 70 000 = 6.3
 * MB.
 */
enum { MOST_PIXELS = 70000, MOST_SETTINGS = 14, WORST = 3 };

static bool shown(const report_pictures *p, uint32_t setting) {
    for (uint32_t i = 0; i < p->count; i++)
        /* The first `count` are set. NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult) */
        if (p->settings[i] == setting)
            return true;
    return false;
}

static void show(report_pictures *p, const cost_results *r, uint32_t setting, uint32_t most) {
    if (p->count < most && r->settings[setting].image && !shown(p, setting))
        p->settings[p->count++] = setting;
}

/* The setting of the largest NMSE that is not shown yet; r->count: none. */
static uint32_t worst(const report_pictures *p, const cost_results *r) {
    uint32_t found = r->count;
    for (uint32_t i = 0; i < r->count; i++)
        if (r->settings[i].image && !shown(p, i) &&
            (found == r->count || r->settings[i].total.nmse > r->settings[found].total.nmse))
            found = i;
    return found;
}

bool report_pictures_choose(const cost_results *r, report_pictures *out) {
    const reference *f = &r->reference;
    *out = (report_pictures){.block = 1};
    if (!f->direct || !f->limited || f->width == 0 || f->height == 0)
        return true;
    while ((uint64_t)(f->width / out->block) * (f->height / out->block) > MOST_PIXELS)
        out->block++;
    out->width = (f->width + out->block - 1) / out->block;
    out->height = (f->height + out->block - 1) / out->block;
    out->settings = malloc(MOST_SETTINGS * sizeof out->settings[0]);
    uint32_t *pareto = malloc(r->count * sizeof pareto[0]);
    if (!out->settings || !pareto) {
        free(pareto);
        report_pictures_free(out);
        return false;
    }
    show(out, r, 0, MOST_SETTINGS);
    for (report_measure by = REPORT_NMSE; by <= REPORT_RELMSE; by++) {
        const uint32_t count = report_pareto_front(r, by, pareto), room = MOST_SETTINGS - WORST;
        for (uint32_t k = 0; k < room && count > 0; k++) /* evenly along a front that is longer than the room */
            show(out, r, pareto[count <= room ? (k < count ? k : count - 1) : k * (count - 1) / (room - 1)], room);
    }
    for (uint32_t k = 0, w; k < WORST && (w = worst(out, r)) < r->count; k++)
        show(out, r, w, MOST_SETTINGS);
    free(pareto);
    return true;
}

void report_pictures_free(report_pictures *p) {
    free(p->settings);
    p->settings = NULL;
    p->count = 0;
}

static double of_reference(const cost_results *r, size_t i) {
    return r->reference.direct[i] + r->reference.limited[i];
}

/* What one pixel of a picture is made from: sums over the grid's pixels that it covers. */
typedef struct block_sums {
    double reference[3], frame[3], squared; /* squared: of the error, over channels too */
    double pixels;
} block_sums;

static block_sums sum_block(const cost_results *r, const float *image, const report_pictures *p, uint32_t x, uint32_t y) {
    const uint32_t width = r->reference.width, height = r->reference.height;
    block_sums s = {.pixels = 0};
    for (uint32_t j = y * p->block; j < (y + 1) * p->block && j < height; j++)
        for (uint32_t i = x * p->block; i < (x + 1) * p->block && i < width; i++, s.pixels++)
            for (size_t c = 0; c < 3; c++) {
                const size_t at = ((size_t)j * width + i) * 3 + c;
                const double want = of_reference(r, at), have = image ? (double)image[at] : want;
                s.reference[c] += want;
                s.frame[c] += have;
                s.squared += (have - want) * (have - want);
            }
    return s;
}

static uint8_t to_srgb(double linear) {
    return (uint8_t)lround(255 * srgb_encoded(linear));
}

static bool print_picture(const cost_results *r, const float *image, const report_pictures *p, FILE *to) {
    uint8_t *rgb = malloc((size_t)p->width * p->height * 3);
    if (!rgb)
        return false;
    uint8_t *out = rgb;
    for (uint32_t y = 0; y < p->height; y++)
        for (uint32_t x = 0; x < p->width; x++) {
            const block_sums s = sum_block(r, image, p, x, y);
            for (int c = 0; c < 3; c++)
                *out++ = to_srgb(s.frame[c] / s.pixels);
        }
    const bool done = report_png_rgb(to, rgb, p->width, p->height);
    free(rgb);
    return done;
}

bool report_reference_uri(const cost_results *r, const report_pictures *p, FILE *to) {
    return print_picture(r, NULL, p, to);
}

bool report_frame_uri(const cost_setting *s, const cost_results *r, const report_pictures *p, FILE *to) {
    return print_picture(r, s->image, p, to);
}

static double reference_mean(const cost_results *r) {
    const size_t count = (size_t)r->reference.width * r->reference.height * 3;
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += of_reference(r, i);
    return sum / (double)count;
}

/* Error over what relMSE divides by, of luminance: the mean of its square is about relMSE. -1 .. 1 */
static double signed_error(const block_sums *s, double mean) {
    const double want = luminance(s->reference[0], s->reference[1], s->reference[2]) / s->pixels,
                 have = luminance(s->frame[0], s->frame[1], s->frame[2]) / s->pixels;
    const double scale = sqrt(want * want + 0.01 * mean * mean);
    return scale > 0 ? (have - want) / scale : have > want ? 1 : 0;
}

/* A pixel's part of NMSE, on the logarithmic scale of report_map_squared. -1 .. 1 for 1e-4 .. 10 */
static double squared_error(const block_sums *s, double mean) {
    const double part = mean > 0 ? s->squared / (3 * s->pixels) / (mean * mean) : 0;
    return part > 0 ? (log10(part) + 4) / 2.5 - 1 : -1;
}

static bool print_map(const cost_results *r, const float *image, const report_pictures *p, const report_map *map,
                      double (*value)(const block_sums *, double), FILE *to) {
    const double mean = reference_mean(r);
    uint8_t *index = malloc((size_t)p->width * p->height), *out = index;
    if (!index)
        return false;
    for (uint32_t y = 0; y < p->height; y++)
        for (uint32_t x = 0; x < p->width; x++) {
            const block_sums s = sum_block(r, image, p, x, y);
            const double v = value(&s, mean);
            *out++ = (uint8_t)lround(fmin(fmax(isnan(v) ? 1 : v, -1), 1) * (REPORT_COLOURS / 2) + REPORT_COLOURS / 2);
        }
    const bool done = report_png_map(to, index, p->width, p->height, map);
    free(index);
    return done;
}

bool report_signed_uri(const cost_setting *s, const cost_results *r, const report_pictures *p, FILE *to) {
    const report_map map = report_map_signed();
    return print_map(r, s->image, p, &map, signed_error, to);
}

bool report_squared_uri(const cost_setting *s, const cost_results *r, const report_pictures *p, FILE *to) {
    const report_map map = report_map_squared();
    return print_map(r, s->image, p, &map, squared_error, to);
}
