/* report_text.c: numbers and text as CSV, HTML and gnuplot want them; JSON: common/json.c. */
#include "report/report_parts.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

void text_csv(FILE *to, const char *text) {
    (void)fputc('"', to);
    while (*text) {
        if (*text == '"')
            (void)fputc('"', to);
        if (text_is_control(*text)) {
            (void)fputc(' ', to);
            text++;
        } else
            text = text_copy_character(to, text);
    }
    (void)fputc('"', to);
}

/* What stands for a character in HTML; NULL: itself. */
static const char *entity_of(char c) {
    switch (c) {
    case '&':
        return "&amp;";
    case '<':
        return "&lt;";
    case '>':
        return "&gt;";
    case '"':
        return "&quot;";
    case '\'':
        return "&#39;";
    default:
        return text_is_control(c) ? " " : NULL;
    }
}

void text_html(FILE *to, const char *text) {
    while (*text) {
        const char *entity = entity_of(*text);
        if (entity) {
            (void)fputs(entity, to);
            text++;
        } else
            text = text_copy_character(to, text);
    }
}

uint32_t text_length(const char *text) {
    uint32_t length = 0;
    for (; *text; length++) {
        const uint32_t count = text_character(text);
        text += count ? count : 1;
    }
    return length;
}

/* Single quotes, between which gnuplot replaces nothing; a quote is doubled. Backquotes and backslashes, which mean something
 * elsewhere, go. */
void text_gnuplot(FILE *to, const char *text, uint32_t most) {
    const bool cut = text_length(text) > most;
    (void)fputc('\'', to);
    for (uint32_t i = 0; *text && i < (cut ? most - 1 : most); i++) {
        if (text_is_control(*text) || *text == '`' || *text == '\\') {
            (void)fputc(' ', to);
            text++;
        } else {
            if (*text == '\'')
                (void)fputc('\'', to);
            text = text_copy_character(to, text);
        }
    }
    (void)fputs(cut ? "\xE2\x80\xA6'" : "'", to);
}

void text_format(FILE *to, const char *format, double value) {
    char text[64];
    if (!isfinite(value)) {
        (void)fputs("\xE2\x80\x93", to);
        return;
    }
    (void)snprintf(text, sizeof text, format, value);
    for (const char *c = text; *c; c++)
        if (*c == '-')
            (void)fputs("\xE2\x88\x92", to);
        else
            (void)fputc(*c, to);
}

void text_3digits(FILE *to, double value) {
    const double size = fabs(value);
    if (!(size >= 1e-5 && size < 1e7)) { /* not a number as well */
        text_format(to, size > 0 ? "%.2e" : "%.0f", value);
        return;
    }
    const int digits = (int)floor(log10(size * 1.0005)) + 1; /* before the point; what rounds up to 10 has two */
    char format[16];
    (void)snprintf(format, sizeof format, "%%.%df", digits < 3 ? 3 - digits : 0);
    text_format(to, format, value);
}

void text_ms(FILE *to, double ms) {
    if (ms < 9.995)
        text_format(to, ms < 0.9995 ? "%.3f" : "%.2f", ms);
    else
        text_format(to, ms < 99.95 ? "%.1f" : "%.0f", ms);
}

void text_count(FILE *to, uint64_t count) {
    char digits[24];
    const int length = snprintf(digits, sizeof digits, "%" PRIu64, count);
    for (int i = 0; i < length; i++) {
        if (i > 0 && (length - i) % 3 == 0)
            (void)fputs("\xE2\x80\xAF", to); /* narrow no-break space */
        (void)fputc(digits[i], to);
    }
}
