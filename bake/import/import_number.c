/* Numbers in text files. The C library's strtod() takes the locale's decimal point, and hexadecimal digits. */
#include "import/importer.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* A number that lies halfway between two doubles has at most 767 digits that count. */
enum { DIGITS = 800, MOST_EXPONENT = 100000 };

/* mantissa * 10^exponent. */
typedef struct decimal {
    uint64_t mantissa;          /* the first 19 digits */
    int64_t exponent;           /* of those */
    int64_t last;               /* of all digits together as an integer */
    const char *first, *behind; /* its digits, with a point perhaps */
    bool longer;                /* than 19 digits */
    bool any;
} decimal;

static bool is_digit(const char *at, const char *end) {
    return at < end && *at >= '0' && *at <= '9';
}

static const char *read_digits(const char *at, const char *end, bool fraction, decimal *d) {
    for (; is_digit(at, end); at++) {
        d->any = true;
        d->last -= fraction;
        if (d->mantissa < UINT64_C(1000000000000000000)) {
            d->mantissa = 10 * d->mantissa + (uint64_t)(*at - '0');
            d->exponent -= fraction;
        } else {
            d->longer = true;
            d->exponent += !fraction;
        }
    }
    return at;
}

static const char *read_exponent(const char *at, const char *end, decimal *d) {
    const char *digits = at + 1;
    if (at >= end || (*at != 'e' && *at != 'E'))
        return at;
    const bool minus = digits < end && *digits == '-';
    digits += digits < end && (*digits == '-' || *digits == '+');
    int64_t value = 0;
    if (!is_digit(digits, end))
        return at;
    for (; is_digit(digits, end); digits++)
        value = value < MOST_EXPONENT ? 10 * value + (*digits - '0') : value;
    d->exponent += minus ? -value : value;
    d->last += minus ? -value : value;
    return digits;
}

/* As strtod() reads them without a point, which would be the locale's. Digits that are left out leave a 1 behind, if they are
 * not all 0. */
static double round_slowly(const decimal *d, bool single) {
    char text[DIGITS + 40];
    size_t used = 0;
    int64_t exponent = d->last;
    bool more = false;
    for (const char *c = d->first; c < d->behind; c++) {
        if (*c == '.' || (used == 0 && *c == '0'))
            continue;
        if (used < DIGITS)
            text[used++] = *c;
        else {
            exponent++;
            more = more || *c != '0';
        }
    }
    if (more) {
        text[used++] = '1';
        exponent--;
    }
    const int64_t most = 2 * MOST_EXPONENT;
    exponent = exponent > most ? most : exponent < -most ? -most : exponent;
    (void)snprintf(text + used, sizeof text - used, "%se%d", used ? "" : "0", (int)exponent);
    return single ? (double)strtof(text, NULL) : strtod(text, NULL);
}

/* Rounding to double and then to float goes wrong where the double lies halfway between two floats, and where floats have fewer
 * digits. */
static bool rounds_twice(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return (bits & 0x1fffffff) == 0x10000000 || (value != 0.0 && value < (double)FLT_MIN) || value > (double)FLT_MAX;
}

/* Up to 2^53 and 10^22 both factors are exact doubles, so that the result is rounded once. */
static double round_number(const decimal *d, bool single) {
    static const double tens[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                  1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    if (d->longer || d->mantissa > UINT64_C(1) << 53 || d->exponent < -22 || d->exponent > 22)
        return round_slowly(d, single);
    const double m = (double)d->mantissa, value = d->exponent < 0 ? m / tens[-d->exponent] : m * tens[d->exponent];
    if (!single)
        return value;
    return rounds_twice(value) ? round_slowly(d, true) : (double)(float)value;
}

static bool begins(const char *at, const char *end, const char *word) {
    const size_t length = strlen(word);
    return (size_t)(end - at) >= length && strncasecmp(at, word, length) == 0;
}

static const char *read_word(const char *at, const char *end, double *out) {
    static const struct {
        const char *word;
        double value;
    } words[] = {{"infinity", INFINITY}, {"inf", INFINITY}, {"nan", NAN}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (begins(at, end, words[i].word)) {
            *out = words[i].value;
            return at + strlen(words[i].word);
        }
    return NULL;
}

/* "1.#INF00", "1.#QNAN0", "1.#IND": what Microsoft's C library wrote once, `at` being the "#". */
static const char *read_microsoft(const char *at, const char *end, double *out) {
    *out = begins(at, end, "#inf") ? (double)INFINITY : (double)NAN;
    for (at++; at < end && (is_digit(at, end) || (*at >= 'A' && *at <= 'Z') || (*at >= 'a' && *at <= 'z')); at++)
        ;
    return at;
}

const char *import_number(const char *at, const char *end, bool single, double *out) {
    decimal d = {0};
    const bool minus = at < end && *at == '-';
    at += at < end && (*at == '-' || *at == '+');
    d.first = at;
    at = read_digits(at, end, false, &d);
    if (at < end && *at == '.')
        at = read_digits(at + 1, end, true, &d);
    d.behind = at;
    if (!d.any)
        at = read_word(d.first, end, out);
    else if (at < end && *at == '#')
        at = read_microsoft(at, end, out);
    else {
        at = read_exponent(at, end, &d);
        *out = round_number(&d, single);
    }
    if (at && minus)
        *out = -*out;
    return at;
}
