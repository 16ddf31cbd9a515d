/* Irradiance between coarse samples by its definition, in double: kernels/sparse.cl's weights, over pixels. */
#ifndef VIT_TESTS_INTERPOLATION_H
#define VIT_TESTS_INTERPOLATION_H

#include "view_sample.h"

#define ORACLE_LEAST 0.1 /* sum of weights below which a sample has no neighbours */

/* Pixels between coarse samples. */
static inline uint32_t oracle_coarse_step(const vit_scene *s) {
    return s->effects & VIT_BIT(SPARSE_16) ? 4 : 2;
}

/* Of sample i, whose pixel is a coarse one: a block's are side by side, the one of the least pixel first. */
static inline uint32_t oracle_coarse_number(const vit_scene *s, uint32_t i) {
    const uint32_t step = oracle_coarse_step(s), row = 4 / step;
    return i / 16 * row * row + i % 16 / 4 / step * row + i % 4 / step;
}

/* 1 - (distance from the sample's tangent plane / step)^2 times the 8th power of the normals' cosine; each at least 0. With
 * zones, 0 if they do not take the same photons. step: metres between coarse samples there. */
static inline double oracle_agreement(const vit_scene *s, const oracle_sample *own, const oracle_sample *coarse, double step) {
    double o[3];
    for (int k = 0; k < 3; k++)
        o[k] = own->position[k] - coarse->position[k];
    const double off = oracle_dot(o, own->normal) / step, cosine = fmax(oracle_dot(own->normal, coarse->normal), 0);
    if (s->effects & VIT_BIT(ZONES) && own->accept != coarse->accept)
        return 0;
    return fmax(1 - off * off, 0) * pow(cosine, 8);
}

/* What pixel (x, y)'s sample gets from the coarse ones around it: e, before the area; returns the sum of weights. at(data, x,
 * y, sample, sum): the coarse sample of a pixel and its estimate; false: it has none. */
typedef int oracle_coarse_at(const void *data, uint32_t x, uint32_t y, oracle_sample *sample, double sum[3]);

static inline double oracle_interpolate(const vit_scene *s, const vit_camera *camera, const oracle_sample *own, uint32_t x,
                                        uint32_t y, oracle_coarse_at *at, const void *data, double e[3]) {
    const uint32_t step = oracle_coarse_step(s), x0 = x / step * step, y0 = y / step * step;
    double weights = 0, pixel = 0, depth = 0;
    for (int k = 0; k < 3; k++) {
        e[k] = 0;
        pixel += (double)camera->right[k] * (double)camera->right[k];
        depth += (own->position[k] - (double)camera->eye[k]) * (double)camera->forward[k];
    }
    for (uint32_t corner = 0; corner < 4; corner++) {
        const uint32_t cx = x0 + (corner & 1) * step, cy = y0 + (corner >> 1) * step;
        const double tent = (1 - fabs((double)x - cx) / step) * (1 - fabs((double)y - cy) / step);
        oracle_sample coarse;
        double sum[3];
        if (tent <= 0 || !at(data, cx, cy, &coarse, sum))
            continue;
        const double w = tent * oracle_agreement(s, own, &coarse, step * sqrt(pixel) * depth);
        weights += w;
        for (int k = 0; k < 3; k++)
            e[k] += w * sum[k];
    }
    for (int k = 0; k < 3 && weights > 0; k++)
        e[k] /= weights;
    return weights;
}

#endif
