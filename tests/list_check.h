/* What an open pack's list estimate gives at its samples, against the sum over all photons in double (oracle/list_estimate.h).
 */
#ifndef VIT_TESTS_LIST_CHECK_H
#define VIT_TESTS_LIST_CHECK_H

#include "oracle/list_estimate.h"
#include "read_buffer.h"

typedef struct list_check {
    uint64_t samples, lit; /* compared; with light */
    double worst;          /* error over the largest irradiance of the frame */
    double largest;        /* W/m2 */
    uint64_t not_finite;
} list_check;

/* After a frame; every `stride`-th sample. */
static inline list_check list_check_frame(const open_pack *p, uint32_t stride) {
    const vit_scene *s = p->v->pack.scene;
    const uint32_t n = s->samples;
    float *position = read_buffer(p, B_position), *indirect = read_buffer(p, B_indirect);
    uint32_t *normal = read_buffer(p, B_normal), *hit = read_buffer(p, B_hit_triangle), *keys = read_buffer(p, B_keys);
    vit_photon *photons = read_buffer(p, B_photons);
    uint32_t *accept = s->effects & VIT_EFFECT_BIT_ZONES ? read_buffer(p, B_accept) : NULL;
    float *inverse = s->effects & VIT_EFFECT_BIT_AREA ? read_buffer(p, B_inverse_area) : NULL;
    list_check c = {0};
    double worst = 0;
    for (uint32_t i = 0; i < n; i += stride) {
        if (hit[i] == VIT_NONE || keys[i] == VIT_NONE)
            continue;
        oracle_sample at = {.accept = accept ? accept[i] : 0, .inverse_area = inverse ? (double)inverse[i] : 1};
        double e[3], doubt;
        for (uint32_t k = 0; k < 3; k++)
            at.position[k] = (double)position[(size_t)k * n + i];
        oracle_normal(normal[i], at.normal);
        oracle_list_estimate(s, photons, &at, e, &doubt);
        for (uint32_t k = 0; k < 3; k++) {
            const double got = (double)indirect[(size_t)k * n + i];
            c.not_finite += isfinite(got) ? 0 : 1;
            c.largest = fmax(c.largest, e[k]);
            worst = fmax(worst, fmax(e[k] - got, got - e[k] - doubt));
        }
        c.samples++;
        c.lit += e[0] > 0;
    }
    c.worst = c.largest > 0 ? worst / c.largest : worst;
    free(position);
    free(indirect);
    free(normal);
    free(hit);
    free(keys);
    free(photons);
    free(accept);
    free(inverse);
    return c;
}

#endif
