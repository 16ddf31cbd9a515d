/* 3MF files made here: archives of parts, packed by libzip, or as they stand, in ZIP64 as lib3mf writes it or not. After
 * import_lab.h. */
#ifndef VIT_TESTS_THREEMF_LAB_H
#define VIT_TESTS_THREEMF_LAB_H

#include "import_lab.h"
#include <zip.h>

typedef struct lab_part {
    const char *name;
    const void *bytes;
    size_t size;
} lab_part;

#define LAB_TEXT_PART(name, text) ((lab_part){name, text, strlen(text)})

/* ---- archives ---- */

typedef struct lab_archive {
    uint8_t bytes[1 << 16];
    size_t size;
    bool zip64;
} lab_archive;

static inline void lab_number(lab_archive *a, uint64_t value, size_t size) {
    assert_true(a->size + size <= sizeof a->bytes);
    for (size_t i = 0; i < size; i++)
        a->bytes[a->size++] = (uint8_t)(value >> (8 * i));
}

static inline void lab_append(lab_archive *a, const void *bytes, size_t size) {
    assert_true(a->size + size <= sizeof a->bytes);
    memcpy(a->bytes + a->size, bytes, size);
    a->size += size;
}

/* CRC-32 of ISO 3309. */
static inline uint32_t lab_crc(const uint8_t *bytes, size_t size) {
    uint32_t crc = UINT32_MAX;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int k = 0; k < 8; k++)
            crc = crc >> 1 ^ (crc & 1 ? UINT32_C(0xedb88320) : 0);
    }
    return ~crc;
}

/* What a local header and a central one have in common (APPNOTE 4.3.7, 4.3.12); at: where the local one is. */
static inline void lab_header(lab_archive *a, const lab_part *p, bool central, size_t at) {
    const uint64_t version = a->zip64 ? 45 : 20, sizes = a->zip64 ? UINT32_MAX : p->size,
                   extra = a->zip64 ? central ? 28 : 20 : 0;
    lab_number(a, central ? 0x02014b50 : 0x04034b50, 4);
    if (central)
        lab_number(a, version, 2);
    lab_number(a, version, 2);
    lab_number(a, 0, 8); /* flags, stored, time, date */
    lab_number(a, lab_crc(p->bytes, p->size), 4);
    lab_number(a, sizes, 4);
    lab_number(a, sizes, 4);
    lab_number(a, strlen(p->name), 2);
    lab_number(a, extra, 2);
    if (central) {
        lab_number(a, 0, 10); /* comment, disk, attributes */
        lab_number(a, a->zip64 ? UINT32_MAX : at, 4);
    }
    lab_append(a, p->name, strlen(p->name));
    if (a->zip64) {
        lab_number(a, 1, 2);
        lab_number(a, extra - 4, 2);
        lab_number(a, p->size, 8);
        lab_number(a, p->size, 8);
        if (central)
            lab_number(a, at, 8);
    }
}

/* APPNOTE 4.3.14 to 4.3.16. */
static inline void lab_end(lab_archive *a, size_t parts, size_t directory) {
    const size_t end = a->size;
    if (a->zip64) {
        lab_number(a, 0x06064b50, 4);
        lab_number(a, 44, 8);
        lab_number(a, 45 | 45 << 16, 4);
        lab_number(a, 0, 8);
        lab_number(a, parts, 8);
        lab_number(a, parts, 8);
        lab_number(a, end - directory, 8);
        lab_number(a, directory, 8);
        lab_number(a, 0x07064b50, 4);
        lab_number(a, 0, 4);
        lab_number(a, end, 8);
        lab_number(a, 1, 4);
    }
    lab_number(a, 0x06054b50, 4);
    lab_number(a, 0, 4);
    lab_number(a, parts, 2);
    lab_number(a, parts, 2);
    lab_number(a, end - directory, 4);
    lab_number(a, a->zip64 ? UINT32_MAX : directory, 4);
    lab_number(a, 0, 2);
}

/* Parts as they stand. */
static inline const lab_archive *make_archive(const lab_part *parts, size_t count, bool zip64) {
    static lab_archive a;
    size_t at[16];
    assert_true(count <= 16);
    a.size = 0;
    a.zip64 = zip64;
    for (size_t i = 0; i < count; i++) {
        at[i] = a.size;
        lab_header(&a, &parts[i], false, 0);
        lab_append(&a, parts[i].bytes, parts[i].size);
    }
    const size_t directory = a.size;
    for (size_t i = 0; i < count; i++)
        lab_header(&a, &parts[i], true, at[i]);
    lab_end(&a, count, directory);
    return &a;
}

static inline void put_archive(const char *path, const lab_part *parts, size_t count, bool zip64) {
    const lab_archive *a = make_archive(parts, count, zip64);
    put_bytes(path, a->bytes, a->size);
}

static inline void put_packed_archive(const char *path, const lab_part *parts, size_t count) {
    int error;
    zip_t *z = zip_open(path, ZIP_CREATE | ZIP_TRUNCATE, &error);
    assert_non_null(z);
    for (size_t i = 0; i < count; i++) {
        zip_source_t *source = zip_source_buffer(z, parts[i].bytes, parts[i].size, 0);
        assert_true(source && zip_file_add(z, parts[i].name, source, ZIP_FL_ENC_UTF_8) >= 0);
    }
    assert_int_equal(zip_close(z), 0);
}

/* ---- models ---- */

#define CORE_NS "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\""
#define MATERIAL_NS "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\""
#define PRODUCTION_NS "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\""
#define MODEL_OF(attributes, resources, build)                                                                                 \
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model " CORE_NS " " MATERIAL_NS " " PRODUCTION_NS " " attributes             \
    "><resources>" resources "</resources><build>" build "</build></model>"
#define RELATION(target)                                                                                                       \
    LAB_TEXT_PART("_rels/.rels",                                                                                               \
                  "<?xml version=\"1.0\"?><Relationships "                                                                     \
                  "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship Target=\"" target      \
                  "\" Id=\"rel0\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>")

#define VERTEX(x, y, z) "<vertex x=\"" #x "\" y=\"" #y "\" z=\"" #z "\"/>"
#define TRIANGLE(a, b, c, rest) "<triangle v1=\"" #a "\" v2=\"" #b "\" v3=\"" #c "\" " rest "/>"
#define MESH(vertices, triangles) "<mesh><vertices>" vertices "</vertices><triangles>" triangles "</triangles></mesh>"
#define OBJECT(attributes, inside) "<object " attributes ">" inside "</object>"
#define ITEM(attributes) "<item " attributes "/>"
/* x, y from 0 to 10, z = 0. */
#define SQUARE VERTEX(0, 0, 0) VERTEX(10, 0, 0) VERTEX(10, 10, 0) VERTEX(0, 10, 0)
#define SQUARE_MESH(first, second) MESH(SQUARE, TRIANGLE(0, 1, 2, first) TRIANGLE(0, 2, 3, second))
#define PLAIN_SQUARE(id) OBJECT("id=\"" #id "\"", SQUARE_MESH("", ""))

/* t.3mf with this model and what else its archive holds. */
static inline void put_3mf_with(const char *model_text, const lab_part *more, size_t count) {
    lab_part parts[8] = {RELATION("/3D/3dmodel.model"), LAB_TEXT_PART("3D/3dmodel.model", model_text)};
    assert_true(count <= 6);
    for (size_t i = 0; i < count; i++)
        parts[2 + i] = more[i];
    put_archive(FILE_OF("t.3mf"), parts, 2 + count, true);
}

static inline void put_3mf(const char *model_text) {
    put_3mf_with(model_text, NULL, 0);
}

/* It is good, and silent. */
static inline void import_3mf(const char *model_text, model *m) {
    put_3mf(model_text);
    import_good(FILE_OF("t.3mf"), m);
    check_promises(m);
    assert_string_equal(warnings, "");
}

#endif
