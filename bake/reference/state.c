#include "reference/state.h"
#include "common/fail.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static vit_status no_memory(vit_text *why) {
    return bake_fail(why, VIT_FAILED, "reference: out of memory");
}

vit_status state_make(uint32_t width, uint32_t height, reference_state *out, vit_text *why) {
    *out = (reference_state){.width = width, .height = height, .pixels = width * height}; /* at most 7680 x 4320 */
    out->sums = calloc(out->pixels, sizeof *out->sums);
    return out->sums ? VIT_OK : no_memory(why);
}

void state_free(reference_state *s) {
    free(s->sums);
    *s = (reference_state){0};
}

void state_add(reference_state *s, const pixel_sums *round) {
    for (uint32_t i = 0; i < s->pixels; i++) {
        memcpy(s->sums[i].direct, round[i].direct, sizeof s->sums[i].direct);
        for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++)
            for (int k = 0; k < 3; k++) {
                s->sums[i].paths[q].direct[k] += round[i].paths[q].direct[k];
                s->sums[i].paths[q].limited[k] += round[i].paths[q].limited[k];
                s->sums[i].paths[q].unlimited[k] += round[i].paths[q].unlimited[k];
            }
    }
    s->rounds++;
}

/* Mean of the sequences' means and its variance, from their sums over `paths` paths each. */
typedef struct estimate {
    double mean, variance;
} estimate;

static estimate estimate_of(const double sums[REFERENCE_SEQUENCES], double paths) {
    const double n = REFERENCE_SEQUENCES;
    double sum = 0, squares = 0;
    for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++)
        sum += sums[q] / paths;
    const double mean = sum / n;
    for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++)
        squares += (sums[q] / paths - mean) * (sums[q] / paths - mean);
    return (estimate){mean, squares / (n * (n - 1))};
}

static double paths_a_sequence(const reference_state *s) {
    return (double)s->rounds * (REFERENCE_ROUND / REFERENCE_SEQUENCES);
}

/* Of direct light without what view samples see by themselves. */
static estimate direct_of(const reference_state *s, uint32_t pixel, int channel) {
    double sums[REFERENCE_SEQUENCES];
    for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++)
        sums[q] = s->sums[pixel].paths[q].direct[channel];
    return estimate_of(sums, paths_a_sequence(s));
}

/* Of both together, which the same paths find. */
static estimate total_of(const reference_state *s, uint32_t pixel, int channel) {
    double sums[REFERENCE_SEQUENCES];
    for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++)
        sums[q] = s->sums[pixel].paths[q].limited[channel] + s->sums[pixel].paths[q].direct[channel];
    return estimate_of(sums, paths_a_sequence(s));
}

static estimate limited_of(const reference_state *s, uint32_t pixel, int channel) {
    double sums[REFERENCE_SEQUENCES];
    for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++)
        sums[q] = s->sums[pixel].paths[q].limited[channel];
    return estimate_of(sums, paths_a_sequence(s));
}

static estimate unlimited_of(const reference_state *s, uint32_t pixel, int channel) {
    double sums[REFERENCE_SEQUENCES];
    for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++)
        sums[q] = s->sums[pixel].paths[q].unlimited[channel];
    return estimate_of(sums, paths_a_sequence(s));
}

double state_error(const reference_state *s) {
    const double values = 3.0 * s->pixels;
    double total = 0, noise = 0;
    if (s->rounds == 0)
        return INFINITY;
    for (uint32_t i = 0; i < s->pixels; i++)
        for (int k = 0; k < 3; k++) {
            const estimate e = total_of(s, i, k);
            total += s->sums[i].direct[k] + e.mean;
            noise += e.variance;
        }
    const double mean = total / values;
    return noise > 0 ? noise / values / (mean * mean) : 0;
}

vit_status state_finish(const reference_state *s, reference *out, vit_text *why) {
    double **const images[] = {&out->direct,          &out->limited,          &out->unlimited,
                               &out->direct_variance, &out->limited_variance, &out->unlimited_variance};
    *out = (reference){.width = s->width,
                       .height = s->height,
                       .samples = s->rounds * REFERENCE_ROUND,
                       .error = state_error(s),
                       .seconds = s->seconds,
                       .rays = s->rays};
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++)
        if (!(*images[i] = calloc(s->pixels, 3 * sizeof **images[i]))) {
            reference_free(out);
            return no_memory(why);
        }
    for (uint32_t i = 0; i < s->pixels; i++)
        for (int k = 0; k < 3; k++) {
            const size_t at = 3 * (size_t)i + (size_t)k;
            const estimate direct = direct_of(s, i, k), limited = limited_of(s, i, k), unlimited = unlimited_of(s, i, k);
            out->direct[at] = s->sums[i].direct[k] + direct.mean;
            out->direct_variance[at] = direct.variance;
            out->limited[at] = limited.mean;
            out->limited_variance[at] = limited.variance;
            out->unlimited[at] = unlimited.mean;
            out->unlimited_variance[at] = unlimited.variance;
        }
    return VIT_OK;
}
