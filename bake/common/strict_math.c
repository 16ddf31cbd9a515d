#include "common/strict_math.h"
#include <math.h>

#define HALF_PI_HIGH 1.57079632673412561417 /* 33 bits: its multiples by less than 2^20 are exact */
#define HALF_PI_LOW 6.07710050650619224932e-11
#define HALF_PI 1.57079632679489661923
#define LN2_HIGH 6.93147180369123816490e-01 /* likewise */
#define LN2_LOW 1.90821492927058770002e-10

/* sum of coefficient[i] * x^i */
static double polynomial(const double *coefficient, int count, double x) {
    double sum = coefficient[count - 1];
    for (int i = count - 2; i >= 0; i--)
        sum = sum * x + coefficient[i];
    return sum;
}

/* sin(x + quarter * Pi / 2): Taylor's series on a quarter of a turn about 0; what is left out is below 2^-60. */
static double sine(double x, int quarter) {
    static const double odd[] = {1.0,
                                 -1.0 / 6,
                                 1.0 / 120,
                                 -1.0 / 5040,
                                 1.0 / 362880,
                                 -1.0 / 39916800,
                                 1.0 / 6227020800,
                                 -1.0 / 1307674368000,
                                 1.0 / 355687428096000};
    static const double even[] = {1.0,
                                  -1.0 / 2,
                                  1.0 / 24,
                                  -1.0 / 720,
                                  1.0 / 40320,
                                  -1.0 / 3628800,
                                  1.0 / 479001600,
                                  -1.0 / 87178291200,
                                  1.0 / 20922789888000,
                                  -1.0 / 6402373705728000};
    const double n = nearbyint(x / HALF_PI), r = (x - n * HALF_PI_HIGH) - n * HALF_PI_LOW, r2 = r * r;
    const unsigned q = (unsigned)((int)n + quarter) & 3u;
    const double s =
        q & 1u ? polynomial(even, sizeof even / sizeof *even, r2) : r * polynomial(odd, sizeof odd / sizeof *odd, r2);
    return q & 2u ? -s : s;
}

double strict_sin(double x) {
    return sine(x, 0);
}

double strict_cos(double x) {
    return sine(x, 1);
}

double strict_tan(double x) {
    return strict_sin(x) / strict_cos(x);
}

/* Halves the angle twice: then x is below 0.2, and the series ends with x^23. */
double strict_atan(double x) {
    static const double series[] = {1.0,      -1.0 / 3,  1.0 / 5,  -1.0 / 7,  1.0 / 9,  -1.0 / 11,
                                    1.0 / 13, -1.0 / 15, 1.0 / 17, -1.0 / 19, 1.0 / 21, -1.0 / 23};
    double a = fabs(x);
    if (a > 1.0)
        return x > 0.0 ? HALF_PI - strict_atan(1.0 / x) : -HALF_PI - strict_atan(1.0 / x);
    for (int i = 0; i < 2; i++)
        a = a / (1.0 + sqrt(1.0 + a * a));
    return copysign(4.0 * a * polynomial(series, sizeof series / sizeof *series, a * a), x);
}

/* x = m 2^e with m about 1; log m = 2 artanh((m - 1) / (m + 1)), of at most 0.172: the series ends with its 23rd power. */
double strict_log(double x) {
    static const double series[] = {1.0,      1.0 / 3,  1.0 / 5,  1.0 / 7,  1.0 / 9,  1.0 / 11,
                                    1.0 / 13, 1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21, 1.0 / 23};
    int e;
    double m = frexp(x, &e);
    if (m < 0.70710678118654752) {
        m *= 2.0;
        e--;
    }
    const double s = (m - 1.0) / (m + 1.0), part = 2.0 * s * polynomial(series, sizeof series / sizeof *series, s * s);
    return (double)e * LN2_HIGH + (part + (double)e * LN2_LOW);
}

/* x^2.4 = x^2 times the fifth root of x^2, by Newton from 1: from there the root of 0.008, the least, takes 10 steps. */
double srgb_linear(double c) {
    if (c <= 0.04045)
        return c / 12.92;
    const double x = (c + 0.055) / 1.055, x2 = x * x;
    double root = 1.0;
    for (int i = 0; i < 14; i++)
        root -= (root - x2 / (root * root * root * root)) / 5.0;
    return x2 * root;
}
