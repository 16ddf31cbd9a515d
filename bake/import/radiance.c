#include "import/radiance.h"
#include <math.h>
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

/* The offset of the resolution line; 0: there is none. */
static size_t resolution_line(const uint8_t *bytes, size_t size, bool *rgbe) {
    char line[LINE];
    size_t at = 0;
    *rgbe = true;
    while (next_line(bytes, size, &at, line)) {
        if (!line[0])
            return at;
        if (strncmp(line, "FORMAT=", 7) == 0)
            *rgbe = strcmp(line + 7, "32-bit_rle_xyze") != 0;
    }
    return 0;
}

const char *radiance_stand(uint8_t *bytes, size_t size, radiance_order *order) {
    char line[LINE], sign[2], axis[2];
    int sides[2], used = 0;
    bool rgbe;
    const size_t start = resolution_line(bytes, size, &rgbe);
    size_t at = start;
    *order = (radiance_order){.columns = false};
    if (!rgbe)
        return "holds CIE XYZ, which is not read: save it as RGB";
    if (start == 0 || !next_line(bytes, size, &at, line) ||
        /* NOLINTNEXTLINE(cert-err34-c): nine digits do not overflow. */
        sscanf(line, "%c%c %9d %c%c %9d%n", &sign[0], &axis[0], &sides[0], &sign[1], &axis[1], &sides[1], &used) != 6 ||
        used != (int)strlen(line) || axis[0] + axis[1] != 'X' + 'Y' || axis[0] < 'X' || axis[0] > 'Y' ||
        !strchr("+-", sign[0]) || !strchr("+-", sign[1]))
        return "is not an image that can be read: it has no resolution (\"-Y height +X width\")";
    order->columns = axis[0] == 'X';
    order->from_bottom = sign[order->columns] == '+';
    order->from_right = sign[!order->columns] == '-';
    const uint8_t *second = memchr(bytes + start + 1, sign[1], size - start - 1);
    uint8_t *first_axis = bytes + start, *second_axis = bytes + (second - bytes);
    first_axis[0] = '-';
    first_axis[1] = 'Y';
    second_axis[0] = '+';
    second_axis[1] = 'X';
    return NULL;
}

bool radiance_turn(float **rgb, int *width, int *height, const radiance_order *order) {
    const size_t scans = (size_t)*height, pixels = (size_t)*width;
    const size_t wide = order->columns ? scans : pixels, high = order->columns ? pixels : scans;
    if (!order->columns && !order->from_bottom && !order->from_right)
        return true;
    float *from = *rgb, *to = malloc(3 * wide * high * sizeof *to);
    for (size_t i = 0; to && i < scans * pixels; i++) {
        const size_t scan = i / pixels, pixel = i % pixels, x = order->columns ? scan : pixel,
                     y = order->columns ? pixel : scan;
        const size_t column = order->from_right ? wide - 1 - x : x, row = order->from_bottom ? high - 1 - y : y;
        memcpy(to + 3 * (row * wide + column), from + 3 * i, 3 * sizeof *to);
    }
    free(from);
    *rgb = to;
    *width = (int)wide;
    *height = (int)high;
    return to != NULL;
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
