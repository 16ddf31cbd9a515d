/* Data URIs (RFC 2397): base64 (RFC 4648), or characters with percent signs. */
#include "import/gltf/gltf_file.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static int value_of(char c) {
    if (c >= 'A' && c <= 'Z')
        return c - 'A';
    if (c >= 'a' && c <= 'z')
        return c - 'a' + 26;
    if (c >= '0' && c <= '9')
        return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

static int hex(char c) {
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* Past the padding nothing counts. False: a character that is none of base64's. */
static bool from_base64(const char *text, size_t length, uint8_t *to, size_t *size) {
    uint32_t word = 0;
    unsigned bits = 0;
    *size = 0;
    for (size_t i = 0; i < length && text[i] != '=' && text[i] != '%'; i++) {
        const int value = value_of(text[i]);
        if (value < 0)
            return false;
        word = (word << 6 | (uint32_t)value) & 0xffffff;
        bits += 6;
        if (bits >= 8) {
            bits -= 8;
            to[(*size)++] = (uint8_t)(word >> bits);
        }
    }
    return true;
}

static void from_percent(const char *text, size_t length, uint8_t *to, size_t *size) {
    *size = 0;
    for (size_t i = 0; i < length; i++) {
        const int high = text[i] == '%' && i + 2 < length ? hex(text[i + 1]) : -1, low = high >= 0 ? hex(text[i + 2]) : -1;
        to[(*size)++] = low >= 0 ? (uint8_t)(16 * high + low) : (uint8_t)text[i];
        i += low >= 0 ? 2 : 0;
    }
}

bool gltf_is_data(const char *uri) {
    return strncasecmp(uri, "data:", 5) == 0;
}

bool gltf_data(const char *uri, import_bytes *out) {
    static const char mark[] = ";base64";
    const char *comma = strchr(uri, ',');
    if (!comma)
        return false;
    const size_t head = (size_t)(comma - uri), length = strlen(comma + 1);
    const bool base64 = head >= sizeof mark - 1 && strncasecmp(comma - (sizeof mark - 1), mark, sizeof mark - 1) == 0;
    uint8_t *bytes = malloc(length + 1);
    *out = (import_bytes){.at = bytes, .owned = bytes};
    if (!bytes)
        return false;
    if (!base64)
        from_percent(comma + 1, length, bytes, &out->size);
    else if (!from_base64(comma + 1, length, bytes, &out->size)) {
        import_drop_bytes(out);
        return false;
    }
    return true;
}
