#include "motion/curves.h"
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

bool curves_make(curves *c, int keys, int components) {
    const size_t values = (size_t)keys * (size_t)components;
    *c = (curves){.keys = keys, .components = components};
    c->time = calloc((size_t)keys, sizeof *c->time);
    c->value = calloc(values, sizeof *c->value);
    c->slope = calloc(values, sizeof *c->slope);
    if (c->time && c->value && c->slope)
        return true;
    curves_free(c);
    return false;
}

static double value_at(const curves *c, int key, int component) {
    return c->value[(size_t)key * (size_t)c->components + (size_t)component];
}

static double secant(const curves *c, int key, int component) {
    return (value_at(c, key + 1, component) - value_at(c, key, component)) / (c->time[key + 1] - c->time[key]);
}

static void smooth_component(curves *c, int component) {
    double *slope = c->slope + component;
    const ptrdiff_t step = c->components;
    const int last = c->keys - 1;
    for (int k = 0; k <= last; k++) {
        const double before = secant(c, k > 0 ? k - 1 : 0, component);
        const double after = secant(c, k < last ? k : last - 1, component);
        slope[k * step] = before * after > 0.0 ? 0.5 * (before + after) : 0.0;
    }
    /* Pull (alpha, beta) back into the circle of radius 3, inside which the piece is monotone. */
    for (int k = 0; k < last; k++) {
        const double d = secant(c, k, component);
        if (d == 0.0) {
            slope[k * step] = slope[(k + 1) * step] = 0.0;
            continue;
        }
        const double alpha = slope[k * step] / d, beta = slope[(k + 1) * step] / d;
        const double square = alpha * alpha + beta * beta;
        if (square > 9.0) {
            slope[k * step] = 3.0 / sqrt(square) * alpha * d;
            slope[(k + 1) * step] = 3.0 / sqrt(square) * beta * d;
        }
    }
}

void curves_smooth(curves *c) {
    for (int i = 0; c->keys > 1 && i < c->components; i++)
        smooth_component(c, i);
}

/* Largest key whose time is <= t; 0 <= key < keys - 1. */
static int find_key(const curves *c, double t) {
    int low = 0, high = c->keys - 1;
    while (high - low > 1) {
        const int middle = low + (high - low) / 2;
        if (c->time[middle] <= t)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void curves_at(const curves *c, double t, double *out) {
    const int last = c->keys - 1;
    if (last == 0 || t <= c->time[0] || t >= c->time[last]) {
        for (int i = 0; i < c->components; i++)
            out[i] = value_at(c, last == 0 || t <= c->time[0] ? 0 : last, i);
        return;
    }
    const int k = find_key(c, t);
    const double h = c->time[k + 1] - c->time[k], x = (t - c->time[k]) / h, y = 1.0 - x;
    for (int i = 0; i < c->components; i++) {
        const double p0 = value_at(c, k, i), p1 = value_at(c, k + 1, i);
        const double m0 = c->slope[(size_t)k * (size_t)c->components + (size_t)i] * h;
        const double m1 = c->slope[(size_t)(k + 1) * (size_t)c->components + (size_t)i] * h;
        /* Hermite basis, written so that equal keys of slope 0 give the key itself, to the bit. */
        out[i] = p0 + (p1 - p0) * (x * x * (3.0 - 2.0 * x)) + m0 * (x * y * y) - m1 * (x * x * y);
    }
}

void curves_free(curves *c) {
    free(c->time);
    free(c->value);
    free(c->slope);
    *c = (curves){0};
}
