#include "cache/fit.h"
#include <math.h>
#include <stdlib.h>

#define ITERATIONS 16
#define RELAXATION 1.5
#define CHANCE 1.0 /* variances of what is left by chance, that count for nothing */

static bool is_held_out(uint32_t row) {
    return row % CACHE_HELD_OUT == CACHE_HELD_OUT - 1;
}

static double read_row(const cache_met *m, const double *value, uint32_t row) {
    double sum = 0.0, weight = 0.0;
    for (size_t i = m->first[row]; i < m->first[row + 1]; i++)
        if (isfinite(value[m->reads[i].point])) {
            sum += (double)m->reads[i].weight * value[m->reads[i].point];
            weight += (double)m->reads[i].weight;
        }
    return weight > 0.0 ? sum / weight : NAN;
}

/* Adds to `sum` the rows' left-overs, or with `whole` their values themselves, times weights. */
static void spread(const cache_met *m, const float *value, const double *point, bool whole, double *sum) {
    for (uint32_t row = 0; row < m->taken_count; row++) {
        if (is_held_out(row))
            continue;
        const double left = (double)value[row] - (whole ? 0.0 : read_row(m, point, row));
        for (size_t i = m->first[row]; i < m->first[row + 1]; i++)
            sum[m->reads[i].point] += (double)m->reads[i].weight * left;
    }
}

static double error_of(const cache_met *m, const float *value, const double *point) {
    double square = 0.0;
    uint32_t count = 0;
    for (uint32_t row = 0; row < m->taken_count; row++) {
        const double left = is_held_out(row) ? (double)value[row] - read_row(m, point, row) : NAN;
        if (isfinite(left)) {
            square += left * left;
            count++;
        }
    }
    return count > 0 ? sqrt(square / count) : 0.0;
}

/* Variances of what spread() brings to points, of rows' chance. */
static void spread_variance(const cache_met *m, const float *noise, double *variance) {
    for (uint32_t row = 0; row < m->taken_count && noise; row++)
        for (size_t i = m->first[row]; i < m->first[row + 1] && !is_held_out(row); i++) {
            const double w = (double)m->reads[i].weight * (double)noise[row];
            variance[m->reads[i].point] += w * w;
        }
}

/* The part of what is left that is more than chance. */
static double more_than_chance(double left, double variance) {
    const double chance = CHANCE * variance;
    return chance > 0.0 ? (left * left > chance ? left - chance / left : 0.0) : left;
}

float *cache_fit(const cache_met *m, const float *value, const float *noise, double *error) {
    const size_t points = (size_t)m->cell_count * VIT_CACHE_POINTS;
    double *weight = calloc(points + 1, sizeof *weight), *sum = calloc(points + 1, sizeof *sum),
           *point = calloc(points + 1, sizeof *point), *variance = calloc(points + 1, sizeof *variance);
    float *out = malloc((points + 1) * sizeof *out);
    if (weight && sum && point && variance && out) {
        spread_variance(m, noise, variance);
        for (uint32_t row = 0; row < m->taken_count; row++)
            for (size_t i = m->first[row]; i < m->first[row + 1] && !is_held_out(row); i++)
                weight[m->reads[i].point] += (double)m->reads[i].weight;
        spread(m, value, point, true, sum);
        for (size_t p = 0; p < points; p++)
            point[p] = weight[p] > 0.0 ? sum[p] / weight[p] : NAN;
        for (int k = 0; k < ITERATIONS; k++) {
            for (size_t p = 0; p < points; p++)
                sum[p] = 0.0;
            spread(m, value, point, false, sum);
            for (size_t p = 0; p < points; p++)
                point[p] += weight[p] > 0.0 ? RELAXATION * more_than_chance(sum[p], variance[p]) / weight[p] : 0.0;
        }
        *error = error_of(m, value, point);
        for (size_t p = 0; p < points; p++)
            out[p] = (float)point[p];
    }
    const bool done = weight && sum && point && variance;
    free(variance);
    free(weight);
    free(sum);
    free(point);
    if (!done) {
        free(out);
        return NULL;
    }
    return out;
}
