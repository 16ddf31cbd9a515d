#include "state.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static vit_status no_memory(vit_text *why) {
    snprintf(why->text, sizeof why->text, "reference: out of memory");
    return VIT_FAILED;
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

void state_direct(reference_state *s, const path_sums *batch) {
    for (uint32_t i = 0; i < s->pixels; i++)
        memcpy(s->sums[i].direct, batch[i].limited, sizeof s->sums[i].direct);
}

void state_add(reference_state *s, const path_sums *batch) {
    for (uint32_t i = 0; i < s->pixels; i++)
        for (int k = 0; k < 3; k++) {
            const double limited = batch[i].limited[k], unlimited = batch[i].unlimited[k];
            s->sums[i].limited[k] += limited;
            s->sums[i].limited2[k] += limited * limited;
            s->sums[i].unlimited[k] += unlimited;
            s->sums[i].unlimited2[k] += unlimited * unlimited;
        }
    s->batches++;
}

/* Variance of the mean of n batch means: their sample variance over n. */
static double variance(double sum, double squares, double n) {
    const double v = (squares - sum * sum / n) / (n * (n - 1));
    return v > 0 ? v : 0; /* rounding */
}

double state_error(const reference_state *s) {
    const double n = s->batches, values = 3.0 * s->pixels;
    double total = 0, noise = 0;
    if (s->batches < 2)
        return INFINITY;
    for (uint32_t i = 0; i < s->pixels; i++)
        for (int k = 0; k < 3; k++) {
            total += s->sums[i].direct[k] + s->sums[i].limited[k] / n;
            noise += variance(s->sums[i].limited[k], s->sums[i].limited2[k], n);
        }
    const double mean = total / values;
    return noise > 0 ? noise / values / (mean * mean) : 0;
}

vit_status state_finish(const reference_state *s, reference *out, vit_text *why) {
    const double n = s->batches;
    double **const images[] = {&out->direct, &out->limited, &out->unlimited, &out->limited_variance, &out->unlimited_variance};
    *out = (reference){.width = s->width,
                       .height = s->height,
                       .samples = s->batches * REFERENCE_BATCH,
                       .error = state_error(s),
                       .seconds = s->seconds,
                       .rays = s->rays};
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++)
        if (!(*images[i] = calloc(s->pixels, 3 * sizeof **images[i]))) {
            reference_free(out);
            return no_memory(why);
        }
    for (uint32_t i = 0; i < s->pixels; i++)
        for (uint32_t k = 0; k < 3; k++) {
            const pixel_sums *p = s->sums + i;
            const size_t at = 3 * (size_t)i + k;
            out->direct[at] = p->direct[k];
            out->limited[at] = p->limited[k] / n;
            out->unlimited[at] = p->unlimited[k] / n;
            out->limited_variance[at] = variance(p->limited[k], p->limited2[k], n);
            out->unlimited_variance[at] = variance(p->unlimited[k], p->unlimited2[k], n);
        }
    return VIT_OK;
}
