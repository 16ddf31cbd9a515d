#include "times.h"
#include <stdlib.h>
#include <string.h>

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double middle(const double *sorted, size_t count) {
    return (sorted[(count - 1) / 2] + sorted[count / 2]) / 2;
}

static double rank(const double *sorted, size_t count, unsigned percentile) {
    return sorted[(count * percentile + 99) / 100 - 1];
}

times times_of(const double *column, size_t count, double *scratch) {
    times t = {0};
    if (count == 0)
        return t;
    memcpy(scratch, column, count * sizeof *column);
    qsort(scratch, count, sizeof *scratch, by_size);
    t.p50 = middle(scratch, count);
    t.p95 = rank(scratch, count, 95);
    t.p99 = rank(scratch, count, 99);
    t.max = scratch[count - 1];
    for (size_t i = 0; i < count; i++)
        scratch[i] = scratch[i] < t.p50 ? t.p50 - scratch[i] : scratch[i] - t.p50;
    qsort(scratch, count, sizeof *scratch, by_size);
    t.mad = middle(scratch, count);
    return t;
}

double times_percentile(const times *t, unsigned percentile) {
    switch (percentile) {
    case 50:
        return t->p50;
    case 95:
        return t->p95;
    case 99:
        return t->p99;
    default:
        return t->max;
    }
}

const char *times_percentile_name(unsigned percentile) {
    switch (percentile) {
    case 50:
        return "p50";
    case 95:
        return "p95";
    case 99:
        return "p99";
    default:
        return "max";
    }
}
