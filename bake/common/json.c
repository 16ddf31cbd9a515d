#include "common/json.h"
#include <math.h>
#include <stdlib.h>

void text_number(FILE *to, double value, const char *otherwise) {
    if (!isfinite(value)) {
        (void)fputs(otherwise, to);
        return;
    }
    char digits[40];
    for (int precision = 6; precision <= 17; precision++) {
        (void)snprintf(digits, sizeof digits, "%.*g", precision, value);
        if (strtod(digits, NULL) == value)
            break;
    }
    (void)fputs(digits, to);
}

uint32_t text_character(const char *text) {
    const unsigned char *t = (const unsigned char *)text;
    if (t[0] < 0x80)
        return 1;
    uint32_t count = 0;
    if (t[0] >= 0xC2 && t[0] < 0xF5)
        count = t[0] < 0xE0 ? 2 : t[0] < 0xF0 ? 3 : 4;
    for (uint32_t i = 1; i < count; i++)
        if ((t[i] & 0xC0) != 0x80)
            return 0;
    if ((t[0] == 0xE0 && t[1] < 0xA0) || (t[0] == 0xED && t[1] >= 0xA0) || (t[0] == 0xF0 && t[1] < 0x90) ||
        (t[0] == 0xF4 && t[1] >= 0x90))
        return 0;
    return count;
}

const char *text_copy_character(FILE *to, const char *text) {
    const uint32_t count = text_character(text);
    if (count == 0) {
        (void)fputs("\xEF\xBF\xBD", to);
        return text + 1;
    }
    (void)fwrite(text, 1, count, to);
    return text + count;
}

bool text_is_control(char c) {
    return (unsigned char)c < 0x20 || c == 0x7F;
}

void text_json(FILE *to, const char *text) {
    (void)fputc('"', to);
    while (*text) {
        if (*text == '"' || *text == '\\')
            (void)fprintf(to, "\\%c", *text++);
        else if (text_is_control(*text) || *text == '<' || *text == '>' || *text == '&')
            (void)fprintf(to, "\\u%04x", (unsigned)(unsigned char)*text++);
        else
            text = text_copy_character(to, text);
    }
    (void)fputc('"', to);
}
