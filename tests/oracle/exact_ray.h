/* A ray and a triangle in double. */
#ifndef VIT_TESTS_EXACT_RAY_H
#define VIT_TESTS_EXACT_RAY_H

#include "vitrine_pack.h"

#include <math.h>
#include <stdbool.h>

/* What engines in float round. */
typedef struct exact_hit {
    bool inside;   /* the ray's line passes through the triangle */
    double t;      /* metres along the ray to the triangle's plane */
    double edge;   /* metres from the ray's line to the nearest edge */
    double cosine; /* between ray and normal, absolute */
} exact_hit;

static inline double exact_segment(const double a[2], const double b[2]) {
    const double ex = b[0] - a[0], ey = b[1] - a[1], l2 = ex * ex + ey * ey;
    double s = l2 > 0 ? -(a[0] * ex + a[1] * ey) / l2 : 0;
    s = s < 0 ? 0 : s > 1 ? 1 : s;
    return hypot(a[0] + s * ex, a[1] + s * ey);
}

static inline exact_hit exact_cast(const vit_triangle *t, const float o[3], const float d[3]) {
    const float *v[3] = {t->v0, t->v1, t->v2};
    double p[3][3], x[3] = {0}, y[3], q[3][2], n[3], e[2][3];
    const double dd[3] = {(double)d[0], (double)d[1], (double)d[2]};
    const double l = sqrt(dd[0] * dd[0] + dd[1] * dd[1] + dd[2] * dd[2]);
    int k = fabs(dd[0]) < fabs(dd[1]) ? 0 : 1;
    if (fabs(dd[2]) < fabs(dd[k]))
        k = 2;
    /* x = unit(e_k x d), y = d x x / |d| */
    x[(k + 1) % 3] = -dd[(k + 2) % 3];
    x[(k + 2) % 3] = dd[(k + 1) % 3];
    const double lx = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    for (int i = 0; i < 3; i++)
        x[i] /= lx;
    for (int i = 0; i < 3; i++)
        y[i] = (dd[(i + 1) % 3] * x[(i + 2) % 3] - dd[(i + 2) % 3] * x[(i + 1) % 3]) / l;
    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 3; c++)
            p[i][c] = (double)v[i][c] - (double)o[c];
        q[i][0] = p[i][0] * x[0] + p[i][1] * x[1] + p[i][2] * x[2];
        q[i][1] = p[i][0] * y[0] + p[i][1] * y[1] + p[i][2] * y[2];
    }
    for (int c = 0; c < 3; c++) {
        e[0][c] = p[1][c] - p[0][c];
        e[1][c] = p[2][c] - p[0][c];
    }
    for (int i = 0; i < 3; i++)
        n[i] = e[0][(i + 1) % 3] * e[1][(i + 2) % 3] - e[0][(i + 2) % 3] * e[1][(i + 1) % 3];
    exact_hit h;
    const double u = q[1][0] * q[2][1] - q[1][1] * q[2][0], w = q[0][0] * q[1][1] - q[0][1] * q[1][0],
                 s = q[2][0] * q[0][1] - q[2][1] * q[0][0];
    h.inside = (u >= 0 && s >= 0 && w >= 0) || (u <= 0 && s <= 0 && w <= 0);
    const double across = n[0] * dd[0] + n[1] * dd[1] + n[2] * dd[2];
    h.t = (n[0] * p[0][0] + n[1] * p[0][1] + n[2] * p[0][2]) / across;
    h.cosine = fabs(across) / (l * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]));
    h.edge = fmin(exact_segment(q[0], q[1]), fmin(exact_segment(q[1], q[2]), exact_segment(q[2], q[0])));
    return h;
}

#endif
