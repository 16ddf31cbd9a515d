/* What stb_image does without a word: it fills up pictures that are cut short (JPEGs from 2.28 on), and does not turn round
 * TGA's rows that run from right to left. */
#include "import/image_whole.h"
#include <string.h>

static uint32_t little_endian(const uint8_t *at, int count) {
    uint32_t value = 0;
    for (int i = 0; i < count; i++)
        value |= (uint32_t)at[i] << 8 * i;
    return value;
}

/* ---- TGA (Truevision 2.0): it has no mark; no other format that is read has such a second and third byte ---- */

enum { TGA_HEAD = 18, TGA_PACKED = 8, TGA_RIGHT = 0x10 };

static bool is_tga(const uint8_t *bytes, size_t size) {
    const int kind = size >= TGA_HEAD ? bytes[2] & ~TGA_PACKED : 0;
    return kind >= 1 && kind <= 3 && bytes[1] <= 1;
}

static bool tga_is_cut(const uint8_t *bytes, size_t size) {
    const size_t map = bytes[1] ? little_endian(bytes + 5, 2) * (size_t)((bytes[7] + 7) / 8) : 0;
    const uint64_t pixels = (uint64_t)little_endian(bytes + 12, 2) * little_endian(bytes + 14, 2);
    const size_t each = (size_t)((bytes[16] + 7) / 8);
    size_t at = TGA_HEAD + bytes[0] + map;
    if (!(bytes[2] & TGA_PACKED))
        return at + pixels * each > size;
    for (uint64_t got = 0; got < pixels;) {
        if (at >= size)
            return true;
        const size_t run = (size_t)(bytes[at] & 0x7f) + 1;
        at += 1 + (bytes[at] & 0x80 ? each : run * each);
        got += run;
    }
    return at > size;
}

/* ---- BMP ---- */

enum { BMP_HEAD = 54 }; /* with the smallest head of its second kind */

static bool is_bmp(const uint8_t *bytes, size_t size) {
    return size >= BMP_HEAD && memcmp(bytes, "BM", 2) == 0 && little_endian(bytes + 14, 4) >= 40;
}

static bool bmp_is_cut(const uint8_t *bytes, size_t size) {
    const uint32_t height = little_endian(bytes + 22, 4);
    const uint64_t rows = height > INT32_MAX ? 0 - height : height; /* below 0: from the top */
    const uint64_t bits = (uint64_t)little_endian(bytes + 18, 4) * little_endian(bytes + 28, 2);
    const uint64_t row = (bits + 31) / 32 * 4, last = (bits + 7) / 8; /* some leave out what fills up the last row */
    return rows > size || row > size || (rows > 0 && little_endian(bytes + 10, 4) + (rows - 1) * row + last > size);
}

/* ---- JPEG (T.81, annex B) ---- */

enum { SOS = 0xda, EOI = 0xd9 };

/* Without the marker of its end, which no code in its scans can be (B.1.1.5). */
static bool jpeg_is_cut(const uint8_t *bytes, size_t size) {
    size_t at = 2;
    while (at + 4 <= size && bytes[at] == 0xff && bytes[at + 1] != SOS)
        at += bytes[at + 1] == 0xff ? 1 : 2 + ((size_t)bytes[at + 2] << 8 | bytes[at + 3]);
    for (; at + 2 <= size; at++)
        if (bytes[at] == 0xff && bytes[at + 1] == EOI)
            return false;
    return true;
}

bool image_is_cut(const uint8_t *bytes, size_t size) {
    if (size >= 4 && bytes[0] == 0xff && bytes[1] == 0xd8)
        return jpeg_is_cut(bytes, size);
    if (is_bmp(bytes, size))
        return bmp_is_cut(bytes, size);
    return is_tga(bytes, size) && tga_is_cut(bytes, size);
}

bool image_is_packed_bmp(const uint8_t *bytes, size_t size) {
    const uint32_t packing = is_bmp(bytes, size) ? little_endian(bytes + 30, 4) : 0;
    return packing == 1 || packing == 2;
}

void image_turn(const uint8_t *bytes, size_t size, uint8_t *rgba, int width, int height) {
    if (!is_tga(bytes, size) || !(bytes[17] & TGA_RIGHT))
        return;
    for (int y = 0; y < height; y++)
        for (int left = 0, right = width - 1; left < right; left++, right--) {
            uint8_t *a = rgba + 4 * ((size_t)y * (size_t)width + (size_t)left), *b = a + 4 * (size_t)(right - left), swap[4];
            memcpy(swap, a, 4);
            memcpy(a, b, 4);
            memcpy(b, swap, 4);
        }
}
