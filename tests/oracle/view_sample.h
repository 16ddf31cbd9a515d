/* View samples by their definition, in double: which pixel's it is, where it is, where it should be. */
#ifndef VIT_TESTS_VIEW_SAMPLE_H
#define VIT_TESTS_VIEW_SAMPLE_H

#include "list_estimate.h"

/* The sample of pixel (x, y): tile after tile, in a tile blocks of 4 x 4 pixels. */
static inline uint32_t oracle_number(const vit_scene *s, uint32_t x, uint32_t y) {
    const uint32_t t = s->tile, u = x % t, v = y % t;
    return (y / t * s->tiles_x + x / t) * t * t + (v / 4 * (t / 4) + u / 4) * 16 + v % 4 * 4 + u % 4;
}

/* Where sample i is stored: three planes of floats, or of 16-bit steps on the scene's grid. */
static inline void oracle_position(const vit_scene *s, const void *planes, uint32_t i, double p[3]) {
    for (size_t k = 0; k < 3; k++) {
        const size_t at = k * s->samples + i;
        if (s->effects & VIT_BIT(SMALL_SAMPLES))
            p[k] = (double)s->grid_low[k] + (double)((const uint16_t *)planes)[at] * (double)s->grid_step;
        else
            p[k] = (double)((const float *)planes)[at];
    }
}

static inline double oracle_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The place on pixel (x, y)'s ray that is the ray offset before the plane of t; of rays that graze it, 8 offsets back from
 * there and the rest along face, the unit normal of the side that the ray comes from. Returns the distance of the plane from
 * the eye, m. */
static inline double oracle_hit_point(const vit_scene *s, const vit_camera *camera, const vit_triangle *t, uint32_t x,
                                      uint32_t y, double p[3], double face[3]) {
    double d[3], a[3], b[3], to[3];
    for (int k = 0; k < 3; k++) {
        d[k] = (double)camera->corner[k] + (x + 0.5) * (double)camera->right[k] + (y + 0.5) * (double)camera->down[k];
        a[k] = (double)t->v1[k] - (double)t->v0[k];
        b[k] = (double)t->v2[k] - (double)t->v0[k];
        to[k] = (double)t->v0[k] - (double)camera->eye[k];
    }
    for (int k = 0; k < 3; k++)
        face[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    const double across = oracle_dot(face, d), far = oracle_dot(face, to) / across;
    const double unit = (across > 0 ? -1 : 1) / sqrt(oracle_dot(face, face));
    for (int k = 0; k < 3; k++)
        face[k] *= unit;
    const double length = sqrt(oracle_dot(d, d)), cosine = fabs(oracle_dot(face, d)) / length, off = (double)s->ray_offset;
    const double back = fmin(off / fmax(cosine, 0.125), far * length), rest = fmax(off - back * cosine, 0);
    for (int k = 0; k < 3; k++)
        p[k] = (double)camera->eye[k] + (far - back / length) * d[k] + rest * face[k];
    return far * length;
}

#endif
