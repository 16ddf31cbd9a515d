#include "import/radiance.h"
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE 256 /* bytes of a header's line that are looked at */

/* The next line without its end, cut to LINE - 1; false where the bytes end before it does. */
static bool next_line(const uint8_t *bytes, size_t size, size_t *at, char line[LINE]) {
    const uint8_t *end = memchr(bytes + *at, '\n', size - *at);
    if (!end)
        return false;
    const size_t length = (size_t)(end - (bytes + *at));
    snprintf(line, LINE, "%.*s", (int)(length < LINE ? length : LINE - 1), (const char *)bytes + *at);
    *at += length + 1;
    return true;
}

/* Multiplies the divisors by the numbers in the text, one each; false if one is no positive number. */
static bool multiply(const char *text, double divisor[3]) {
    char *end;
    for (int k = 0; k < 3; k++, text = end) {
        const double factor = strtod(text, &end);
        if (end == text || !(factor > 0.0 && factor < HUGE_VAL))
            return false;
        divisor[k] *= factor;
    }
    return true;
}

/* Rows that are stored pixel by pixel: four bytes each, where (1, 1, 1, n) means n more of the pixel before. */
static const char *check_flat(const uint8_t *pixels, size_t size, size_t count) {
    for (size_t i = 0; i < count && i < size / 4; i++)
        if (pixels[4 * i] == 1 && pixels[4 * i + 1] == 1 && pixels[4 * i + 2] == 1)
            return "has run lengths of the old kind, which are not read: save it again";
    return size / 4 < count ? "is cut short" : NULL;
}

const char *radiance_check(const uint8_t *bytes, size_t size, int width, int height, double divisor[3]) {
    char line[LINE];
    size_t at = 0;
    bool more;
    divisor[0] = divisor[1] = divisor[2] = 1.0;
    while ((more = next_line(bytes, size, &at, line)) && line[0]) {
        char three[3 * LINE];
        const char *factors = strncmp(line, "COLORCORR=", 10) == 0 ? line + 10 : NULL;
        if (strncmp(line, "EXPOSURE=", 9) == 0) { /* one for all channels */
            snprintf(three, sizeof three, "%s %s %s", line + 9, line + 9, line + 9);
            factors = three;
        }
        if (factors && !multiply(factors, divisor))
            return "has an EXPOSURE or COLORCORR that is no positive number";
    }
    if (!more || !next_line(bytes, size, &at, line)) /* the resolution */
        return "is broken";
    const uint8_t *pixels = bytes + at;
    const bool by_component =
        width >= 8 && width < 32768 && size - at >= 4 && pixels[0] == 2 && pixels[1] == 2 && pixels[2] < 128;
    return by_component ? NULL : check_flat(pixels, size - at, (size_t)width * (size_t)height);
}
