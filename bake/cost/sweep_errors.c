/* Errors of all settings against the reference. */
#include "cost/sweep_parts.h"
#include "common/fail.h"
#include <math.h>
#include <stdlib.h>

/* direct + indirect. NULL: out of memory. */
static double *sum_of(const double *direct, const double *indirect, size_t values) {
    double *sum = calloc(values, sizeof *sum);
    for (size_t i = 0; sum && i < values; i++)
        sum[i] = direct[i] + indirect[i];
    return sum;
}

bool sweep_own_error_off(const sweep *s) {
    return s->in->to_choose && !s->in->relmse;
}

static void compare_all(sweep *s, const double *limited, const double *unlimited) {
    cost_results *r = s->out;
    const uint32_t width = r->reference.width, height = r->reference.height;
    for (uint32_t i = 0; i < r->count; i++) {
        cost_setting *c = &r->settings[i];
        c->total = metrics_compare(limited, c->image, NULL, width, height);
        if (sweep_own_error_off(s))
            c->total.nmse = fmax(c->total.nmse - r->reference.error, 0);
        c->unlimited = metrics_compare(unlimited, c->image, NULL, width, height);
        c->indirect = metrics_compare(r->reference.limited, s->indirect[i], limited, width, height);
    }
}

vit_status sweep_errors(sweep *s, vit_text *why) {
    const reference *r = &s->out->reference;
    const size_t values = 3 * s->points;
    double *limited = sum_of(r->direct, r->limited, values), *unlimited = sum_of(r->direct, r->unlimited, values);
    float *picture = calloc(values, sizeof *picture);
    vit_status status = VIT_OK;
    if (limited && unlimited && picture) {
        compare_all(s, limited, unlimited);
        for (size_t i = 0; i < values; i++)
            picture[i] = (float)limited[i];
        s->out->truncation = metrics_compare(unlimited, picture, NULL, r->width, r->height);
    } else
        status = bake_fail(why, VIT_FAILED, "out of memory");
    free(limited);
    free(unlimited);
    free(picture);
    return status;
}

double sweep_smallest_error(const sweep *s) {
    double least = INFINITY;
    for (uint32_t i = 0; i < s->out->count; i++)
        least = fmin(least, s->out->settings[i].total.nmse);
    return least;
}
