/* Indirect irradiance by its definition, in double: the sum over all photons that count for a sample, no clusters, no lists. */
#ifndef VIT_TESTS_LIST_ESTIMATE_H
#define VIT_TESTS_LIST_ESTIMATE_H

#include "vitrine_pack.h"

#include <math.h>

typedef struct oracle_sample {
    double position[3], normal[3]; /* normal: unit */
    uint32_t accept;               /* zones, if the pack has them */
    double inverse_area;           /* 1 without areas */
} oracle_sample;

/* As octahedral codes are decoded, but for rounding. */
static inline void oracle_normal(uint32_t code, double n[3]) {
    const double x = (double)(int16_t)(code & 0xffffu) / 32767, y = (double)(int16_t)(code >> 16) / 32767;
    const double z = 1 - fabs(x) - fabs(y);
    n[0] = z < 0 ? (1 - fabs(y)) * (x < 0 ? -1 : 1) : x;
    n[1] = z < 0 ? (1 - fabs(x)) * (y < 0 ? -1 : 1) : y;
    n[2] = z;
    const double l = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++)
        n[k] /= l;
}

/* W/m2 a channel. *doubt: what of it comes from photons so near to their radius or to grazing that rounding decides whether
 * they count, the greatest channel's. */
static inline void oracle_list_estimate(const vit_scene *s, const vit_photon *photons, const oracle_sample *at, double e[3],
                                        double *doubt) {
    e[0] = e[1] = e[2] = *doubt = 0;
    for (uint32_t i = 0; i < s->photons; i++) {
        const vit_photon *q = photons + i;
        double d2 = 0, off = 0, front = 0;
        for (int k = 0; k < 3; k++) {
            const double o = at->position[k] - (double)q->position[k];
            d2 += o * o;
            off += o * at->normal[k];
            front += at->normal[k] * (double)q->direction[k];
        }
        if (s->effects & VIT_BIT(FLATTENED))
            d2 += off * off * (double)s->flatten;
        if (!(q->radius2 > 0) || d2 >= (double)q->radius2)
            continue;
        const double weight = (1 - d2 / (double)q->radius2) * at->inverse_area;
        if (!(s->effects & VIT_BIT(ZONES)) && fabs(front) < 1e-6) {
            *doubt += weight * (double)fmaxf(q->power[0], fmaxf(q->power[1], q->power[2]));
            continue;
        }
        if (s->effects & VIT_BIT(ZONES) ? (at->accept & q->zone) == 0 : front >= 0)
            continue;
        for (int k = 0; k < 3; k++)
            e[k] += weight * (double)q->power[k];
    }
}

#endif
