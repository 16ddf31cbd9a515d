/* What an open pack's list estimate gives at its samples, against the sum over all photons in double (oracle/list_estimate.h).
 */
#ifndef VIT_TESTS_LIST_CHECK_H
#define VIT_TESTS_LIST_CHECK_H

#include "view_frame.h"

typedef struct list_check {
    uint64_t samples, lit; /* compared; with light */
    double worst;          /* error over the largest irradiance of the frame, once list_check_end() was called */
    double largest;        /* W/m2 */
    uint64_t not_finite;
} list_check;

/* One more: what should be, what it may be less by, what there is at got, got + plane, got + 2 plane. */
static inline void list_check_add(list_check *c, const double e[3], double doubt, const float *got, size_t plane) {
    for (size_t k = 0; k < 3; k++) {
        const double is = (double)got[k * plane];
        c->not_finite += isfinite(is) ? 0 : 1;
        c->largest = fmax(c->largest, e[k]);
        c->worst = isfinite(is) ? fmax(c->worst, fmax(e[k] - is, is - e[k] - doubt)) : INFINITY;
    }
    c->samples++;
    c->lit += e[0] > 0;
}

static inline void list_check_end(list_check *c) {
    c->worst = c->largest > 0 ? c->worst / c->largest : c->worst;
}

/* After a frame; every `stride`-th sample. */
static inline list_check list_check_frame(const open_pack *p, uint32_t stride) {
    view_frame f = view_frame_read(p, 0);
    list_check c = {0};
    for (uint32_t i = 0; i < f.s->samples; i += stride) {
        if (f.hit[i] == VIT_NONE || f.keys[i] == VIT_NONE)
            continue;
        const oracle_sample at = view_frame_sample(&f, i);
        double e[3], doubt;
        oracle_list_estimate(f.s, f.photons, &at, e, &doubt);
        list_check_add(&c, e, doubt, f.indirect + i, f.s->samples);
    }
    list_check_end(&c);
    view_frame_free(&f);
    return c;
}

#endif
