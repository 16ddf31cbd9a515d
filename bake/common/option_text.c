#include "common/option_text.h"
#include <stdlib.h>
#include <string.h>

option_words option_split(const char *word, const char *next) {
    option_words o = {.value = next};
    const char *equals = strncmp(word, "--", 2) == 0 ? strchr(word, '=') : NULL;
    const size_t length = equals ? (size_t)(equals - word) : strlen(word);
    memcpy(o.name, word, length < OPTION_NAME ? length : OPTION_NAME - 1);
    o.joined = equals != NULL;
    if (equals)
        o.value = equals + 1;
    else if (next && strncmp(next, "--", 2) == 0)
        o.value = NULL;
    return o;
}

bool option_whole(const char *text, long least, long most, long *out) {
    const bool minus = text && *text == '-';
    if (!text || !text[minus] || text[minus + strspn(text + minus, "0123456789")] != '\0')
        return false;
    *out = strtol(text, NULL, 10); /* what does not fit becomes the largest long, which is beyond `most` */
    return *out >= least && *out <= most;
}

bool option_number(const char *text, double least, double most, double *out) {
    if (!text || !strpbrk(text, "0123456789") || text[strspn(text, "0123456789.eE+-")] != '\0' || *text == '+')
        return false;
    char *end;
    *out = strtod(text, &end);
    return *end == '\0' && *out >= least && *out <= most;
}

bool option_size(const char *text, int *width, int *height) {
    char across[8] = "";
    const size_t length = text ? strspn(text, "0123456789") : 0;
    long w, h;
    if (length == 0 || length >= sizeof across || text[length] != 'x')
        return false;
    memcpy(across, text, length);
    if (!option_whole(across, 1, 7680, &w) || !option_whole(text + length + 1, 1, 4320, &h))
        return false;
    *width = (int)w;
    *height = (int)h;
    return true;
}
