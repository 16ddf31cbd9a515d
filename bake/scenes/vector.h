/* 3-vectors, and sine and cosine that give the same bits everywhere (libm's may differ in the last place). */
#ifndef VIT_SCENES_VECTOR_H
#define VIT_SCENES_VECTOR_H

#include <math.h>

#define PI 3.14159265358979323846

typedef struct v3 {
    double x, y, z;
} v3;

static inline v3 v3_of(double x, double y, double z) {
    return (v3){x, y, z};
}

static inline v3 v3_add(v3 a, v3 b) {
    return (v3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline v3 v3_sub(v3 a, v3 b) {
    return (v3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline v3 v3_scale(v3 a, double s) {
    return (v3){a.x * s, a.y * s, a.z * s};
}

static inline double v3_dot(v3 a, v3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline v3 v3_cross(v3 a, v3 b) {
    return (v3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* The zero vector stays zero. */
static inline v3 v3_unit(v3 a) {
    double l = sqrt(v3_dot(a, a));
    return l > 0.0 ? v3_scale(a, 1.0 / l) : a;
}

static inline double lerp(double a, double b, double t) {
    return a + (b - a) * t;
}

static inline double clamp01(double t) {
    return t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
}

/* 0 up to a, 1 from b on, smooth between. */
static inline double smoothstep(double a, double b, double t) {
    t = clamp01((t - a) / (b - a));
    return t * t * (3.0 - 2.0 * t);
}

/* Taylor series on [-pi/4, pi/4] after reduction by quarter turns; error below 1e-12 for |x| < 1000, far below what is written.
 */
static inline double sine(double x) {
    double quarter = floor(x / (PI / 2.0) + 0.5);
    double r = x - quarter * (PI / 2.0), r2 = r * r;
    double s = r * (1.0 + r2 * (-1.0 / 6 + r2 * (1.0 / 120 + r2 * (-1.0 / 5040 + r2 * (1.0 / 362880 - r2 / 39916800)))));
    double c = 1.0 + r2 * (-1.0 / 2 +
                           r2 * (1.0 / 24 + r2 * (-1.0 / 720 + r2 * (1.0 / 40320 + r2 * (-1.0 / 3628800 + r2 / 479001600)))));
    int q = (int)(quarter - 4.0 * floor(quarter / 4.0));
    return q == 0 ? s : q == 1 ? c : q == 2 ? -s : -c;
}

static inline double cosine(double x) {
    return sine(x + PI / 2.0);
}

#endif
