#include "radiosity/bounces.h"
#include "common/fail.h"
#include "common/parallel.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_BOUNCES 4096u
#define LEAST 1e-6 /* of the whole, that a bounce adds */

typedef struct bounce {
    const form_factors *f;
    const patch_set *p;
    uint32_t columns;
    const float *from;
    float *to;
} bounce;

/* One patch's reflected light: albedo times the irradiance that the others' light of the bounce before gives it. */
static void reflect(void *user, uint32_t i) {
    const bounce *b = user;
    float *to = b->to + (size_t)i * b->columns;
    memset(to, 0, b->columns * sizeof *to);
    for (size_t k = b->f->first[i]; k < b->f->first[i + 1]; k++) {
        const float *from = b->from + (size_t)b->f->to[k] * b->columns, factor = b->f->factor[k];
        for (uint32_t c = 0; c < b->columns; c++)
            to[c] += factor * from[c];
    }
    for (uint32_t c = 0; c < b->columns; c++)
        to[c] *= b->p->patch[i].albedo[c % 3];
}

/* Power of all patches' light, by area. */
static double power_of(const patch_set *p, const float *light, uint32_t columns) {
    double sum = 0.0;
    for (uint32_t i = 0; i < p->count; i++)
        for (uint32_t c = 0; c < columns; c++)
            sum += (double)p->patch[i].area * fabs((double)light[(size_t)i * columns + c]);
    return sum;
}

vit_status bounces_solve(const bounces_input *in, float *radiosity, double *spectral, vit_text *why) {
    const form_factors *f = in->factors;
    const uint32_t columns = in->columns, k = in->bounces;
    const size_t numbers = (size_t)f->count * columns;
    float *one = malloc((numbers + 1) * sizeof *one), *other = malloc((numbers + 1) * sizeof *other);
    vit_status status = one && other ? VIT_OK : VIT_FAILED;
    *spectral = 0.0;
    if (status == VIT_OK) {
        memcpy(radiosity, in->direct, numbers * sizeof *radiosity);
        memcpy(one, in->direct, numbers * sizeof *one);
        double before = power_of(in->patches, one, columns), all = before;
        uint32_t h = 0;
        for (; h < (k == BOUNCES_CONVERGED ? MOST_BOUNCES : k) && before > 0.0; h++) {
            bounce b = {f, in->patches, columns, one, other};
            parallel_for(in->threads, f->count, reflect, &b);
            for (size_t i = 0; i < numbers; i++)
                radiosity[i] += other[i];
            float *last = one;
            one = other;
            other = last;
            const double now = power_of(in->patches, one, columns);
            *spectral = now / before;
            before = now;
            all += now;
            if (k == BOUNCES_CONVERGED && now < LEAST * all * (1.0 - *spectral))
                break;
        }
        if (*spectral >= 1.0 || (k == BOUNCES_CONVERGED && h == MOST_BOUNCES)) {
            status = bake_fail(why, VIT_BAD_INPUT, "light between surfaces does not die out: each reflection leaves %.4g of it",
                               *spectral);
        }
    } else {
        status = bake_fail(why, VIT_FAILED, "bounces: out of memory");
    }
    free(one);
    free(other);
    return status;
}
