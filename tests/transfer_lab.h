/* Patches and form factors by formula, for tests of transfer matrices: no geometry, no rays. */
#ifndef VIT_TESTS_TRANSFER_LAB_H
#define VIT_TESTS_TRANSFER_LAB_H

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/kernel_math.h"
#include "radiosity/transfer_matrix.h"

typedef struct transfer_lab {
    patch_set patches;
    form_factors factors;
    float *area;
} transfer_lab;

static inline void *transfer_array(size_t count, size_t size) {
    void *p = calloc(count + 1, size);
    assert_non_null(p);
    return p;
}

/* F_ij for all pairs, 0: there is no entry. */
static inline transfer_lab transfer_lab_open(uint32_t n, float (*factor)(uint32_t n, uint32_t i, uint32_t j)) {
    transfer_lab l = {.patches = {.count = n, .patch = transfer_array(n + 1, sizeof(radiosity_patch))},
                      .factors = {.count = n,
                                  .first = transfer_array(n + 1, sizeof(size_t)),
                                  .to = transfer_array((size_t)n * n, sizeof(uint32_t)),
                                  .factor = transfer_array((size_t)n * n, sizeof(float)),
                                  .open = transfer_array(n, sizeof(float))},
                      .area = transfer_array(n, sizeof(float))};
    size_t at = 0;
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t j = 0; j < n; j++)
            if (factor(n, i, j) > 0.0f) {
                l.factors.to[at] = j;
                l.factors.factor[at++] = factor(n, i, j);
            }
        l.factors.first[i + 1] = at;
        l.area[i] = l.patches.patch[i].area = 0.01f + unit_float(pcg(i + 77u));
        for (uint32_t c = 0; c < 3; c++)
            l.patches.patch[i].albedo[c] = 0.2f + 0.6f * unit_float(pcg(3 * i + c));
    }
    return l;
}

static inline void transfer_lab_paint(transfer_lab *l, float albedo) {
    for (uint32_t i = 0; i < l->patches.count; i++)
        for (uint32_t c = 0; c < 3; c++)
            l->patches.patch[i].albedo[c] = albedo;
}

static inline void transfer_lab_close(transfer_lab *l) {
    form_factors_free(&l->factors);
    free(l->patches.patch);
    free(l->area);
}

static inline transfer_matrix transfer_lab_matrix(const transfer_lab *l, uint32_t bounces, unsigned threads) {
    transfer_matrix m;
    vit_text why = {""};
    const transfer_matrix_input in = {.factors = &l->factors, .patches = &l->patches, .bounces = bounces, .threads = threads};
    if (transfer_matrix_make(&in, &m, &why) != VIT_OK)
        fail_msg("%s", why.text);
    return m;
}

/* Everything sees everything alike: F F = F. */
static inline float factor_even(uint32_t n, uint32_t i, uint32_t j) {
    (void)i;
    (void)j;
    return 1.0f / (float)n;
}

/* As in a room: near patches exchange thousands of times what far ones do, every third pair does not see each other, and every
 * eleventh patch nobody. Rows sum to less than 1. */
static inline float factor_room(uint32_t n, uint32_t i, uint32_t j) {
    const uint32_t low = i < j ? i : j, high = i < j ? j : i;
    const float apart = (float)(high - low) / (float)n;
    if (i == j || pcg(low * 4099u + high) % 3 == 0 || i % 11 == 5 || j % 11 == 5)
        return 0.0f;
    return 0.25f * (0.5f + unit_float(pcg(high * 4099u + low))) / ((float)n * (0.02f + 30.0f * apart * apart));
}

#endif
