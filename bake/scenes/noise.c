#include "noise.h"
#include "vector.h"

/* PCG-RXS-M-XS (O'Neill 2014), once a coordinate. */
static uint32_t hashed(uint32_t x) {
    x = x * 747796405u + 2891336453u;
    x = ((x >> ((x >> 28) + 4u)) ^ x) * 277803737u;
    return (x >> 22) ^ x;
}

double noise_cell(int x, int y, uint32_t seed) {
    return hashed((uint32_t)x + hashed((uint32_t)y + hashed(seed))) / 4294967296.0;
}

static int wrapped(int x, int period) {
    int r = x % period;
    return r < 0 ? r + period : r;
}

double noise_value(double u, double v, int period, uint32_t seed) {
    double x = u * period, y = v * period, fx = floor(x), fy = floor(y);
    int x0 = wrapped((int)fx, period), y0 = wrapped((int)fy, period);
    int x1 = wrapped(x0 + 1, period), y1 = wrapped(y0 + 1, period);
    double a = smoothstep(0, 1, x - fx), b = smoothstep(0, 1, y - fy);
    return lerp(lerp(noise_cell(x0, y0, seed), noise_cell(x1, y0, seed), a),
                lerp(noise_cell(x0, y1, seed), noise_cell(x1, y1, seed), a), b);
}

double noise_fractal(double u, double v, int period, int octaves, uint32_t seed) {
    double sum = 0.0, weight = 0.5, total = 0.0;
    for (int i = 0; i < octaves; i++) {
        sum += weight * noise_value(u, v, period << i, seed + (uint32_t)i);
        total += weight;
        weight *= 0.5;
    }
    return sum / total;
}

double noise_veins(double u, double v, int period, int octaves, double sharp, uint32_t seed) {
    double du = 0.06 * noise_fractal(u, v, period * 2, 3, seed + 100),
           dv = 0.06 * noise_fractal(u, v, period * 2, 3, seed + 200);
    double away = fabs(noise_fractal(u + du, v + dv, period, octaves, seed) - 0.5) * 2.0;
    double line = clamp01(1.0 - away * sharp);
    return line * line;
}
