/* EXT_meshopt_compression: libmeshoptimizer decodes the bytes, which is exact; the filters are the
 * extension's formulas, since the library's differ in their last bits by release and processor. */
#include "import/gltf/gltf_file.h"
#include <math.h>
#include <meshoptimizer.h>
#include <stdlib.h>
#include <string.h>

/* Decoded bytes that a byte can stand for: two bits for 16 bytes at the least, a byte for three indices of 4. */
#define MOST_A_BYTE 64

static int32_t signed_at(const uint8_t *at, size_t size) {
    int16_t value;
    memcpy(&value, at, sizeof value);
    return size == 1 ? (int8_t)at[0] : value;
}

static void put_signed(uint8_t *at, size_t size, int32_t value) {
    const int16_t two = (int16_t)value;
    if (size == 1)
        at[0] = (uint8_t)value;
    else
        memcpy(at, &two, sizeof two);
}

/* Halves go away from 0. */
static int32_t rounded(double value) {
    return (int32_t)(value + (value < 0.0 ? -0.5 : 0.5));
}

/* Unit vectors as octahedra: x, y, and what stands for 1. */
static void filter_octahedral(uint8_t *bytes, size_t count, size_t stride) {
    const size_t size = stride / 4;
    const double most = size == 1 ? 127.0 : 32767.0;
    for (size_t i = 0; i < count; i++, bytes += stride) {
        double v[3];
        const double one = (double)signed_at(bytes + 2 * size, size);
        for (size_t k = 0; k < 2; k++)
            v[k] = one > 0.0 ? (double)signed_at(bytes + k * size, size) / one : 0.0;
        v[2] = 1.0 - fabs(v[0]) - fabs(v[1]);
        const double below = v[2] < 0.0 ? -v[2] : 0.0;
        for (int k = 0; k < 2; k++)
            v[k] -= v[k] < 0.0 ? -below : below;
        const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        for (size_t k = 0; k < 3; k++)
            put_signed(bytes + k * size, size, rounded(v[k] / length * most));
    }
}

/* Quaternions by their three smaller components; the last word has scale and place of the largest. */
static void filter_quaternion(uint8_t *bytes, size_t count, size_t stride) {
    for (size_t i = 0; i < count; i++, bytes += stride) {
        const int32_t word = signed_at(bytes + 6, 2);
        const double range = sqrt(0.5) / (double)(word | 3);
        const size_t largest = (size_t)(word & 3);
        double v[3], rest = 1.0;
        for (size_t k = 0; k < 3; k++) {
            v[k] = (double)signed_at(bytes + 2 * k, 2) * range;
            rest -= v[k] * v[k];
        }
        for (size_t k = 0; k < 3; k++)
            put_signed(bytes + 2 * ((largest + 1 + k) % 4), 2, rounded(fmax(-1.0, fmin(v[k], 1.0)) * 32767.0));
        put_signed(bytes + 2 * largest, 2, rounded(sqrt(fmax(rest, 0.0)) * 32767.0));
    }
}

/* Floats as 2^e m: 24 bits of m, 8 of e. */
static void filter_exponential(uint8_t *bytes, size_t count, size_t stride) {
    for (size_t i = 0; i < count * (stride / 4); i++, bytes += 4) {
        uint32_t word;
        memcpy(&word, bytes, sizeof word);
        const int32_t e = (int32_t)(word >> 24), m = (int32_t)(word & 0xffffff);
        const float value = (float)ldexp((double)(m < 0x800000 ? m : m - 0x1000000), e < 128 ? e : e - 256);
        memcpy(bytes, &value, sizeof value);
    }
}

static bool apply_filter(const char *filter, uint8_t *bytes, size_t count, size_t stride) {
    if (strcmp(filter, "NONE") == 0)
        return true;
    if (strcmp(filter, "OCTAHEDRAL") == 0 && (stride == 4 || stride == 8))
        filter_octahedral(bytes, count, stride);
    else if (strcmp(filter, "QUATERNION") == 0 && stride == 8)
        filter_quaternion(bytes, count, stride);
    else if (strcmp(filter, "EXPONENTIAL") == 0 && stride % 4 == 0)
        filter_exponential(bytes, count, stride);
    else
        return false;
    return true;
}

static bool decode(const char *mode, uint8_t *to, size_t count, size_t stride, const uint8_t *from, size_t size) {
    if (strcmp(mode, "ATTRIBUTES") == 0 && stride % 4 == 0 && stride <= 256)
        return meshopt_decodeVertexBuffer(to, count, stride, from, size) == 0;
    if (strcmp(mode, "TRIANGLES") == 0 && (stride == 2 || stride == 4) && count % 3 == 0)
        return meshopt_decodeIndexBuffer(to, count, stride, from, size) == 0;
    if (strcmp(mode, "INDICES") == 0 && (stride == 2 || stride == 4))
        return meshopt_decodeIndexSequence(to, count, stride, from, size) == 0;
    return false;
}

bool gltf_meshopt(gltf_file *g, uint32_t view, const json_t *how, import_bytes *out) {
    uint32_t buffer;
    size_t offset, size, stride, count;
    const uint8_t *from;
    (void)gltf_index(how, "buffer", &buffer);
    if (!gltf_size(how, "byteOffset", &offset) || !gltf_size(how, "byteLength", &size) ||
        !gltf_size(how, "byteStride", &stride) || !gltf_size(how, "count", &count) || stride == 0 || stride > 256 ||
        count == 0 || count > size * MOST_A_BYTE)
        return import_fail(g->im, "buffer view %u: its compression has no sizes that could be", view);
    if (!gltf_buffer(g, buffer, offset, size, &from))
        return false;
    /* The size is exact but for indices of two bytes, which never become four. */
    const size_t bytes = count * stride;
    uint8_t *to = bytes / MOST_A_BYTE <= size ? calloc(bytes, 1) : NULL;
    *out = (import_bytes){.at = to, .owned = to, .size = bytes};
    if (!to)
        return import_fail(g->im, "buffer view %u: more than its compression can hold", view);
    if (decode(gltf_text(how, "mode", ""), to, count, stride, from, size) &&
        apply_filter(gltf_text(how, "filter", "NONE"), to, count, stride))
        return true;
    import_drop_bytes(out);
    return import_fail(g->im, "buffer view %u: its compressed data cannot be read", view);
}
