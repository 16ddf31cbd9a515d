/* glTF files made here: accessors are added one by one, the rest is written out as JSON. After import_lab.h. */
#ifndef VIT_TESTS_GLTF_LAB_H
#define VIT_TESTS_GLTF_LAB_H

#include "import_lab.h"
#include <stdarg.h>

enum { GLTF_BYTE = 5120, GLTF_UBYTE = 5121, GLTF_SHORT = 5122, GLTF_USHORT = 5123, GLTF_UINT = 5125, GLTF_FLOAT = 5126 };

typedef struct gltf_lab {
    uint8_t bin[8192];
    size_t size;
    char views[8192], accessors[8192];
    int view_count, accessor_count;
} gltf_lab;

static inline void lab_text(char *to, size_t room, const char *format, ...) __attribute__((format(printf, 3, 4)));
static inline void lab_text(char *to, size_t room, const char *format, ...) {
    const size_t used = strlen(to);
    va_list args;
    va_start(args, format);
    const int added = vsnprintf(to + used, room - used, format, args);
    va_end(args);
    assert_true(added >= 0 && used + (size_t)added < room);
}

/* A view of these bytes; `more` are further members: ",\"byteStride\":8". Its number. */
static inline int lab_view(gltf_lab *l, const void *bytes, size_t size, const char *more) {
    while (l->size % 4)
        l->bin[l->size++] = 0xee;
    assert_true(l->size + size <= sizeof l->bin);
    memcpy(l->bin + l->size, bytes, size);
    lab_text(l->views, sizeof l->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu%s}", l->view_count ? "," : "",
             l->size, size, more);
    l->size += size;
    return l->view_count++;
}

/* An accessor to view `view`, or none if that is negative. Its number. */
static inline int lab_accessor(gltf_lab *l, int view, int kind, const char *type, size_t count, const char *more) {
    char place[64] = "";
    if (view >= 0)
        (void)snprintf(place, sizeof place, "\"bufferView\":%d,", view);
    lab_text(l->accessors, sizeof l->accessors, "%s{%s\"componentType\":%d,\"count\":%zu,\"type\":\"%s\"%s}",
             l->accessor_count ? "," : "", place, kind, count, type, more);
    return l->accessor_count++;
}

static inline int lab_data(gltf_lab *l, const void *bytes, size_t size, int kind, const char *type, size_t count,
                           const char *more) {
    return lab_accessor(l, lab_view(l, bytes, size, ""), kind, type, count, more);
}

/* The unit square's half, (0,0) (1,0) (0,1), in z = 0. */
static inline int lab_triangle(gltf_lab *l) {
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    return lab_data(l, corners, sizeof corners, GLTF_FLOAT, "VEC3", 3, "");
}

/* NAME.bin and NAME.gltf; `rest` goes into the top level. */
static inline void lab_write(const gltf_lab *l, const char *name, const char *rest) {
    static char json[40000];
    char path[256];
    json[0] = '\0';
    (void)snprintf(path, sizeof path, FOLDER "/%s.bin", name);
    put_bytes(path, l->bin, l->size ? l->size : 1);
    lab_text(json, sizeof json, "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"%s.bin\",\"byteLength\":%zu}]", name,
             l->size ? l->size : 1);
    lab_text(json, sizeof json, ",\"bufferViews\":[%s],\"accessors\":[%s],%s}", l->views, l->accessors, rest);
    (void)snprintf(path, sizeof path, FOLDER "/%s.gltf", name);
    put(path, json);
}

#define LAB_SCENE "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
#define LAB_FILE FILE_OF("lab.gltf")

/* One primitive with these attributes and further members, imported. */
static inline void lab_import(const gltf_lab *l, const char *attributes, const char *more, const char *rest, model *m) {
    char text[4096];
    (void)snprintf(text, sizeof text, LAB_SCENE "\"meshes\":[{\"primitives\":[{\"attributes\":{%s}%s}]}]%s", attributes, more,
                   rest);
    lab_write(l, "lab", text);
    import_good(LAB_FILE, m);
    check_promises(m);
}

static inline void lab_refused(const gltf_lab *l, const char *rest, const char *what) {
    lab_write(l, "lab", rest);
    refuse(LAB_FILE, false, what);
}

static inline bool near(double a, double b) {
    return fabs(a - b) < 1e-5;
}

/* Vertex `i` of the model. */
static inline void vertex_is(const model *m, size_t i, double x, double y, double z) {
    const float *p = m->position + 3 * i;
    if (!near((double)p[0], x) || !near((double)p[1], y) || !near((double)p[2], z))
        fail_msg("vertex %zu is (%g, %g, %g), want (%g, %g, %g)", i, (double)p[0], (double)p[1], (double)p[2], x, y, z);
}

static inline void uv_is(const model *m, size_t i, double u, double v) {
    const float *t = m->uv + 2 * i;
    if (!near((double)t[0], u) || !near((double)t[1], v))
        fail_msg("uv %zu is (%g, %g), want (%g, %g)", i, (double)t[0], (double)t[1], u, v);
}

#endif
