/* PLY files made here: a header's elements and the values as text, written in any of the three encodings. After import_lab.h.
 */
#ifndef VIT_TESTS_PLY_LAB_H
#define VIT_TESTS_PLY_LAB_H

#include "import_lab.h"

enum { LAB_TEXT, LAB_LITTLE, LAB_BIG, LAB_ENCODINGS };

typedef struct ply_lab {
    uint8_t bytes[1 << 17];
    size_t size;
} ply_lab;

static inline void lab_bytes(ply_lab *l, const void *bytes, size_t size) {
    assert_true(l->size + size <= sizeof l->bytes);
    memcpy(l->bytes + l->size, bytes, size);
    l->size += size;
}

/* The header's lines, each with this end. */
static inline void lab_line(ply_lab *l, const char *text, size_t length, const char *end) {
    lab_bytes(l, text, length);
    lab_bytes(l, end, strlen(end));
}

/* A value of the type of that name. */
static inline void lab_value(ply_lab *l, const char *type, double value, bool big) {
    uint8_t bytes[8];
    uint64_t word;
    size_t size = 4;
    if (strstr(type, "float") && !strstr(type, "64")) {
        const float f = (float)value;
        uint32_t half;
        memcpy(&half, &f, sizeof half);
        word = half;
    } else if (strstr(type, "float") || strstr(type, "double")) {
        memcpy(&word, &value, sizeof word);
        size = 8;
    } else {
        word = (uint64_t)(int64_t)value;
        size = strstr(type, "char") || strstr(type, "int8")     ? 1
               : strstr(type, "short") || strstr(type, "int16") ? 2
               : strstr(type, "int64")                          ? 8
                                                                : 4;
    }
    for (size_t k = 0; k < size; k++)
        bytes[big ? size - 1 - k : k] = (uint8_t)(word >> (8 * k));
    lab_bytes(l, bytes, size);
}

static inline double lab_next(const char **body) {
    char *end;
    const double value = strtod(*body, &end);
    assert_true(end != *body);
    *body = end;
    return value;
}

/* One row by the properties' lines from `at` on; where they end. */
static inline const char *lab_row(ply_lab *l, const char *at, const char **body, bool big) {
    char a[16], b[16], c[32];
    while (strncmp(at, "property", 8) == 0 || strncmp(at, "comment", 7) == 0) {
        if (sscanf(at, "property list %15s %15s %31s", a, b, c) == 3) {
            const double count = lab_next(body);
            lab_value(l, a, count, big);
            for (int i = 0; i < (int)count; i++)
                lab_value(l, b, lab_next(body), big);
        } else if (sscanf(at, "property %15s %31s", a, c) == 2)
            lab_value(l, a, lab_next(body), big);
        at = strchr(at, '\n') + 1;
    }
    return at;
}

/* PATH: `elements` are the header's lines between format and end, each ended by LF, which becomes `end` in the file; `body` its
 * values, as they stand in a text file. */
static inline void put_ply_ended(const char *path, int encoding, const char *elements, const char *body, const char *end) {
    static const char *const formats[] = {"format ascii 1.0", "format binary_little_endian 1.0",
                                          "format binary_big_endian 1.0"};
    static ply_lab l;
    l.size = 0;
    lab_line(&l, "ply", 3, end);
    lab_line(&l, formats[encoding], strlen(formats[encoding]), end);
    for (const char *at = elements; *at; at = strchr(at, '\n') + 1)
        lab_line(&l, at, strcspn(at, "\n"), end);
    lab_line(&l, "end_header", 10, end);
    if (encoding == LAB_TEXT)
        lab_bytes(&l, body, strlen(body));
    for (const char *at = elements; encoding != LAB_TEXT && *at;) {
        unsigned rows = 0;
        const bool element = sscanf(at, "element %*s %u", &rows) == 1;
        at = strchr(at, '\n') + 1;
        const char *next = at;
        for (unsigned i = 0; element && i < rows; i++)
            next = lab_row(&l, at, &body, encoding == LAB_BIG);
        at = next;
    }
    put_bytes(path, l.bytes, l.size);
}

static inline void put_ply(const char *path, int encoding, const char *elements, const char *body) {
    put_ply_ended(path, encoding, elements, body, "\n");
}

#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define INDICES "property list uchar int vertex_indices\n"
/* The unit square in z = 0. */
#define QUAD_VERTICES "element vertex 4\n" XYZ
#define QUAD_POINTS "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
#define TWO_FACES "element face 2\n" INDICES
#define TWO_TRIANGLES "3 0 1 2\n3 0 2 3\n"

static inline void quad_is(const model *m) {
    check_promises(m);
    assert_int_equal(m->triangles, 2);
    for (int k = 0; k < 3; k++)
        assert_true(m->lo[k] == 0.0 && m->hi[k] == (k < 2 ? 1.0 : 0.0));
    normal_at(m, 1, 1, 0, 0, 0, 1);
}

static inline void same_models(const model *a, const model *b) {
    assert_true(a->vertices == b->vertices && a->triangles == b->triangles && a->material_count == b->material_count);
    assert_memory_equal(a->position, b->position, 12 * (size_t)a->vertices);
    assert_memory_equal(a->normal, b->normal, 12 * (size_t)a->vertices);
    assert_memory_equal(a->uv, b->uv, 8 * (size_t)a->vertices);
    assert_memory_equal(a->index, b->index, 12 * (size_t)a->triangles);
    assert_memory_equal(a->material, b->material, 4 * (size_t)a->triangles);
    for (int i = 0; i < a->material_count; i++)
        assert_memory_equal(a->materials[i].albedo, b->materials[i].albedo, sizeof a->materials[i].albedo);
}

/* Imports it from each of the encodings, which must be the same model; `m` is the last. */
static inline void import_all_encodings(const char *elements, const char *body, model *m) {
    model first;
    put_ply(FILE_OF("a.ply"), LAB_TEXT, elements, body);
    import_good(FILE_OF("a.ply"), &first);
    check_promises(&first);
    for (int encoding = LAB_LITTLE; encoding < LAB_ENCODINGS; encoding++) {
        put_ply(FILE_OF("a.ply"), encoding, elements, body);
        import_good(FILE_OF("a.ply"), m);
        same_models(&first, m);
        if (encoding + 1 < LAB_ENCODINGS)
            model_free(m);
    }
    model_free(&first);
}

#endif
