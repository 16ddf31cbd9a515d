/* report_axes.c: logarithmic axes with ticks at 1, 2 and 5. */
#include "report/report_parts.h"

#include <math.h>

bool report_axis_of(const double *values, uint32_t count, double pad_low, double pad_high, report_axis *out) {
    double low = INFINITY, high = 0;
    for (uint32_t i = 0; i < count; i++)
        if (values[i] > 0 && isfinite(values[i])) {
            low = fmin(low, values[i]);
            high = fmax(high, values[i]);
        }
    if (!(high > 0))
        return false;
    if (high < 1.5 * low) { /* one value, or as good as one */
        low /= 1.3;
        high *= 1.3;
    }
    const double span = high / low;
    *out = (report_axis){low * pow(span, -pad_low), high * pow(span, pad_high)};
    return true;
}

double report_axis_at(report_axis a, double value) {
    return log(value / a.low) / log(a.high / a.low);
}

void report_axis_print(FILE *to, const char *letter, report_axis a, const char *title) {
    const double decades = log10(a.high / a.low);
    (void)fprintf(to, "set logscale %s\nset %srange [%.9g:%.9g]\nset %slabel '%s' tc rgb '#0101%02x'\nset %stics (", letter,
                  letter, a.low, a.high, letter, title, SOFT, letter);
    const char *comma = "";
    for (int exponent = (int)floor(log10(a.low)); exponent <= (int)ceil(log10(a.high)); exponent++)
        for (int digit = 1; digit < 10; digit++) {
            const double v = digit * pow(10, exponent);
            if (v < a.low || v > a.high)
                continue;
            const bool labelled = digit == 1 || (decades <= 2.6 && (digit == 2 || digit == 5)) ||
                                  (decades <= 1.3 && (digit == 3 || digit == 7)) || (decades <= 0.7 && digit == 4);
            if (labelled)
                (void)fprintf(to, "%s'%g' %.9g", comma, v, v);
            else
                (void)fprintf(to, "%s'' %.9g 1", comma, v);
            comma = ",";
        }
    (void)fprintf(to, ") tc rgb '#0101%02x'\n", SOFT);
}
