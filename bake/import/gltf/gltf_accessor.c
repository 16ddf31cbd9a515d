/* Accessors (3.6.2): every type of component, normalized or not, strided, sparse, without a view. */
#include "import/gltf/gltf_file.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An accessor of zeros costs its file nothing: more elements than this must stand behind it somewhere. */
#define ZEROS_AT_LEAST ((uint64_t)1 << 20)

typedef struct accessor {
    const uint8_t *at; /* first element; NULL: zeros */
    size_t stride;     /* bytes */
    uint32_t count, kind;
    unsigned components, size;    /* of an element; bytes of a component */
    unsigned rows, column_stride; /* components and bytes of a matrix's column; a vector is one column */
    bool normalized;
    const uint8_t *sparse_index, *sparse_value;
    uint32_t sparse_count, sparse_kind;
} accessor;

enum { BYTE = 5120, UNSIGNED_BYTE = 5121, SHORT = 5122, UNSIGNED_SHORT = 5123, UNSIGNED_INT = 5125, FLOAT = 5126 };

static unsigned size_of(uint32_t kind) {
    switch (kind) {
    case BYTE:
    case UNSIGNED_BYTE:
        return 1;
    case SHORT:
    case UNSIGNED_SHORT:
        return 2;
    case UNSIGNED_INT:
    case FLOAT:
        return 4;
    default:
        return 0;
    }
}

/* A component, whatever its address. */
static double component(const uint8_t *at, uint32_t kind) {
    const uint32_t two = size_of(kind) > 1 ? at[0] | (uint32_t)at[1] << 8 : at[0];
    const uint32_t four = size_of(kind) > 2 ? two | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24 : two;
    float value;
    switch (kind) {
    case BYTE:
        return (double)(four < 128 ? (int)four : (int)four - 256);
    case SHORT:
        return (double)(four < 32768 ? (int)four : (int)four - 65536);
    case FLOAT:
        memcpy(&value, &four, sizeof value);
        return (double)value;
    default:
        return (double)four;
    }
}

/* 3.11 */
static double normalize(double value, uint32_t kind) {
    switch (kind) {
    case BYTE:
        return fmax(value / 127.0, -1.0);
    case UNSIGNED_BYTE:
        return value / 255.0;
    case SHORT:
        return fmax(value / 32767.0, -1.0);
    case UNSIGNED_SHORT:
        return value / 65535.0;
    case UNSIGNED_INT:
        return value / 4294967295.0;
    default:
        return value;
    }
}

static bool read_shape(const json_t *json, accessor *a) {
    static const struct {
        const char *name;
        unsigned rows, columns;
    } shapes[] = {{"SCALAR", 1, 1}, {"VEC2", 2, 1}, {"VEC3", 3, 1}, {"VEC4", 4, 1},
                  {"MAT2", 2, 2},   {"MAT3", 3, 3}, {"MAT4", 4, 4}};
    const char *name = gltf_text(json, "type", "");
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        if (strcmp(shapes[i].name, name) == 0) {
            a->rows = shapes[i].rows;
            a->components = a->rows * shapes[i].columns;
            a->column_stride = shapes[i].columns > 1 ? (a->rows * a->size + 3) / 4 * 4 : a->rows * a->size;
            return true;
        }
    return false;
}

/* Bytes from an element's first to its last. */
static size_t span(const accessor *a) {
    return (size_t)(a->components / a->rows - 1) * a->column_stride + (size_t)a->rows * a->size;
}

/* `count` elements of `size` bytes, `stride` apart, from `offset` on in a view of `length` bytes. */
static bool fits(size_t length, size_t offset, size_t stride, size_t size, uint32_t count) {
    return offset <= length && size <= length - offset &&
           (count == 0 || stride == 0 || count - 1 <= (length - offset - size) / stride);
}

static bool find_data(gltf_file *g, uint32_t index, const json_t *json, accessor *a) {
    uint32_t view;
    size_t offset, length, stride;
    if (!gltf_size(json, "byteOffset", &offset))
        return import_fail(g->im, "accessor %u has no offset that could be", index);
    if (!gltf_index(json, "bufferView", &view)) {
        if (a->count > ZEROS_AT_LEAST + g->bytes)
            return import_fail(g->im, "accessor %u has %u elements without data", index, a->count);
        return true;
    }
    if (!gltf_view(g, view, &a->at, &length, &stride))
        return false;
    const size_t packed = (size_t)(a->components / a->rows) * a->column_stride;
    a->stride = stride > 0 ? stride : packed;
    if (!fits(length, offset, a->stride, span(a), a->count))
        return import_fail(g->im, "accessor %u is out of range: %u elements in a view of %zu bytes", index, a->count, length);
    a->at += offset;
    return true;
}

static bool sparse_part(gltf_file *g, uint32_t index, const json_t *part, size_t size, uint32_t count, const uint8_t **at) {
    uint32_t view;
    size_t offset, length, stride;
    (void)gltf_index(part, "bufferView", &view);
    if (!gltf_size(part, "byteOffset", &offset) || !gltf_view(g, view, at, &length, &stride))
        return false;
    if (!fits(length, offset, size, size, count))
        return import_fail(g->im, "accessor %u: its sparse part is out of range", index);
    *at += offset;
    return true;
}

static bool find_sparse(gltf_file *g, uint32_t index, const json_t *json, accessor *a) {
    const json_t *sparse = json_object_get(json, "sparse");
    const json_t *indices = json_object_get(sparse, "indices"), *values = json_object_get(sparse, "values");
    if (!json_is_object(sparse))
        return true;
    (void)gltf_index(sparse, "count", &a->sparse_count);
    (void)gltf_index(indices, "componentType", &a->sparse_kind);
    const unsigned size = size_of(a->sparse_kind);
    if ((a->sparse_kind != UNSIGNED_BYTE && a->sparse_kind != UNSIGNED_SHORT && a->sparse_kind != UNSIGNED_INT) ||
        a->sparse_count == GLTF_NONE || a->sparse_count > a->count)
        return import_fail(g->im, "accessor %u: its sparse part cannot be", index);
    return sparse_part(g, index, indices, size, a->sparse_count, &a->sparse_index) &&
           sparse_part(g, index, values, (size_t)(a->components / a->rows) * a->column_stride, a->sparse_count,
                       &a->sparse_value);
}

static bool open_accessor(gltf_file *g, uint32_t index, accessor *a) {
    const json_t *json = gltf_item(g, "accessors", index);
    *a = (accessor){0};
    if (!json)
        return import_fail(g->im, "there is no accessor %u", index);
    (void)gltf_index(json, "componentType", &a->kind);
    (void)gltf_index(json, "count", &a->count);
    a->size = size_of(a->kind);
    a->normalized = json_is_true(json_object_get(json, "normalized"));
    if (a->size == 0 || a->count == GLTF_NONE || !read_shape(json, a))
        return import_fail(g->im, "accessor %u has no type or count that could be", index);
    return find_data(g, index, json, a) && find_sparse(g, index, json, a);
}

uint32_t gltf_accessor_count(const gltf_file *g, uint32_t index) {
    uint32_t count;
    (void)gltf_index(gltf_item(g, "accessors", index), "count", &count);
    return count == GLTF_NONE ? 0 : count;
}

float gltf_normalized(const gltf_file *g, uint32_t index, double value) {
    const json_t *json = gltf_item(g, "accessors", index);
    uint32_t kind;
    (void)gltf_index(json, "componentType", &kind);
    return (float)(json_is_true(json_object_get(json, "normalized")) ? normalize(value, kind) : value);
}

static void decode_element(const accessor *a, const uint8_t *at, float *to) {
    for (unsigned c = 0; c < a->components; c++) {
        const double value =
            component(at + (size_t)(c / a->rows) * a->column_stride + (size_t)(c % a->rows) * a->size, a->kind);
        to[c] = (float)(a->normalized ? normalize(value, a->kind) : value);
    }
}

static uint32_t sparse_at(const accessor *a, uint32_t i) {
    return (uint32_t)component(a->sparse_index + (size_t)i * size_of(a->sparse_kind), a->sparse_kind);
}

/* Words that lie as they are wanted are taken where they lie. */
static bool as_they_lie(const accessor *a, uint32_t kind) {
    return a->at && a->kind == kind && !a->normalized && a->sparse_count == 0 && a->components == a->rows &&
           a->stride % sizeof(uint32_t) == 0 && (uintptr_t)a->at % sizeof(uint32_t) == 0;
}

bool gltf_read_floats(gltf_file *g, uint32_t index, unsigned components, gltf_floats *out) {
    accessor a;
    *out = (gltf_floats){0};
    if (!open_accessor(g, index, &a))
        return false;
    if (a.components < components || a.components == 0)
        return import_fail(g->im, "accessor %u has %u components, not %u", index, a.components, components);
    out->count = a.count;
    out->stride = out->components = a.components;
    if (as_they_lie(&a, FLOAT)) {
        out->at = (const float *)(const void *)a.at;
        out->stride = a.stride / sizeof(float);
        return true;
    }
    float *to = calloc((size_t)a.count + 1, a.components * sizeof *to);
    out->at = out->owned = to;
    if (!to)
        return import_fail(g->im, "out of memory");
    for (size_t i = 0; a.at && i < a.count; i++)
        decode_element(&a, a.at + i * a.stride, to + i * a.components);
    for (uint32_t i = 0; i < a.sparse_count; i++) {
        const uint32_t at = sparse_at(&a, i);
        if (at >= a.count) {
            gltf_drop_floats(out);
            return import_fail(g->im, "accessor %u: its sparse part names element %u of %u", index, at, a.count);
        }
        decode_element(&a, a.sparse_value + (size_t)i * (a.components / a.rows) * a.column_stride,
                       to + (size_t)at * a.components);
    }
    return true;
}

bool gltf_read_indices(gltf_file *g, uint32_t index, gltf_indices *out) {
    accessor a;
    *out = (gltf_indices){0};
    if (!open_accessor(g, index, &a))
        return false;
    if (a.components != 1 || a.kind == FLOAT)
        return import_fail(g->im, "accessor %u holds no indices", index);
    out->count = a.count;
    if (as_they_lie(&a, UNSIGNED_INT) && a.stride == sizeof(uint32_t)) {
        out->at = (const uint32_t *)(const void *)a.at;
        return true;
    }
    uint32_t *to = calloc((size_t)a.count + 1, sizeof *to);
    out->at = out->owned = to;
    if (!to)
        return import_fail(g->im, "out of memory");
    for (size_t i = 0; a.at && i < a.count; i++)
        to[i] = (uint32_t)(int64_t)component(a.at + i * a.stride, a.kind); /* of a negative one: out of range */
    for (uint32_t i = 0; i < a.sparse_count; i++)
        if (sparse_at(&a, i) < a.count)
            to[sparse_at(&a, i)] = (uint32_t)(int64_t)component(a.sparse_value + (size_t)i * a.size, a.kind);
    return true;
}

void gltf_drop_floats(gltf_floats *f) {
    free(f->owned);
    *f = (gltf_floats){0};
}
