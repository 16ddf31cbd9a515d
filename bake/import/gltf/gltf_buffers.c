/* Where bytes come from: the file itself, its binary chunk, files beside it, data URIs. */
#include "common/json.h"
#include "import/gltf/gltf_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GLB_HEAD = 12, CHUNK_HEAD = 8 };

static uint32_t word_at(const uint8_t *at) {
    return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

/* GLB (4.4): a head, a chunk of JSON, perhaps a binary one; others are passed over. */
static bool find_chunks(gltf_file *g) {
    const uint8_t *file = g->file.at;
    const uint32_t stated = g->file.size >= GLB_HEAD ? word_at(file + 8) : 0;
    if (g->file.size < GLB_HEAD + CHUNK_HEAD || stated < GLB_HEAD + CHUNK_HEAD)
        return import_fail(g->im, "is cut short");
    const size_t size = stated < g->file.size ? stated : g->file.size;
    for (size_t at = GLB_HEAD; size - at >= CHUNK_HEAD;) {
        const size_t length = word_at(file + at), left = size - at - CHUNK_HEAD;
        const uint8_t *kind = file + at + 4, *bytes = file + at + CHUNK_HEAD;
        if (length > left)
            return import_fail(g->im, "is cut short: a chunk of %zu bytes where %zu are left", length, left);
        if (at == GLB_HEAD && memcmp(kind, "JSON", 4) != 0)
            return import_fail(g->im, "has no JSON in its first chunk");
        if (at == GLB_HEAD) {
            g->json = bytes;
            g->json_size = length;
        } else if (memcmp(kind, "BIN", 4) == 0 && !g->chunk) {
            g->chunk = bytes;
            g->chunk_size = length;
        }
        at += CHUNK_HEAD + length;
    }
    return true;
}

static bool make_lists(gltf_file *g) {
    g->buffer_count = gltf_count(g, "buffers");
    g->view_count = gltf_count(g, "bufferViews");
    g->image_count = gltf_count(g, "images");
    g->buffers = calloc(g->buffer_count + 1, sizeof *g->buffers);
    g->views = calloc(g->view_count + 1, sizeof *g->views);
    g->images = calloc(g->image_count + 1, sizeof *g->images);
    return g->buffers && g->views && g->images ? true : import_fail(g->im, "out of memory");
}

/* Integers as doubles: what no 64 bits hold would be an error otherwise, wherever it stands. */
#define JSON_FLAGS (JSON_DECODE_INT_AS_REAL | JSON_ALLOW_NUL)

/* The text again, with what is no UTF-8 in it mended: names in old encodings are no reason to refuse a file. */
static json_t *parse_mended(const gltf_file *g, json_error_t *error) {
    char *copy = malloc(g->json_size + 1), *mended = NULL;
    size_t size = 0;
    FILE *to = copy ? open_memstream(&mended, &size) : NULL;
    json_t *root = NULL;
    if (to) {
        memcpy(copy, g->json, g->json_size);
        copy[g->json_size] = '\0';
        for (const char *at = copy; *at;)
            at = text_copy_character(to, at);
    }
    if (to && fclose(to) == 0)
        root = json_loadb(mended, size, JSON_FLAGS, error);
    free(copy);
    free(mended);
    return root;
}

bool gltf_open(gltf_file *g) {
    static const uint8_t mark[3] = {0xef, 0xbb, 0xbf}; /* a byte order mark is no error (4.2) */
    json_error_t error;
    if (!import_map(g->im, g->im->file, &g->file))
        return import_fail(g->im, "is empty or cannot be read");
    g->json = g->file.at;
    g->json_size = g->file.size;
    g->bytes = g->file.size;
    if (g->file.size >= 4 && memcmp(g->file.at, "glTF", 4) == 0 && !find_chunks(g))
        return false;
    if (g->json_size >= sizeof mark && memcmp(g->json, mark, sizeof mark) == 0) {
        g->json += sizeof mark;
        g->json_size -= sizeof mark;
    }
    /* Padding of zeros, which GLB does not allow and some write. */
    while (g->json_size > 0 && g->json[g->json_size - 1] == '\0')
        g->json_size--;
    g->root = json_loadb((const char *)g->json, g->json_size, JSON_FLAGS, &error);
    if (!g->root && json_error_code(&error) == json_error_invalid_utf8)
        g->root = parse_mended(g, &error);
    if (!g->root)
        return import_fail(g->im, "line %d, column %d: %.150s", error.line, error.column, error.text);
    if (!json_is_object(g->root))
        return import_fail(g->im, "is no glTF");
    return make_lists(g);
}

static void drop_all(import_bytes *list, size_t count) {
    for (size_t i = 0; list && i < count; i++)
        import_drop_bytes(&list[i]);
    free(list);
}

void gltf_close(gltf_file *g) {
    for (size_t i = 0; g->meshes && i < g->mesh_count; i++)
        gltf_drop_mesh(&g->meshes[i]);
    free(g->meshes);
    free(g->nodes);
    free(g->places);
    drop_all(g->buffers, g->buffer_count);
    drop_all(g->views, g->view_count);
    drop_all(g->images, g->image_count);
    json_decref(g->root);
    import_drop_bytes(&g->file);
}

static bool load_file(gltf_file *g, uint32_t index, const char *uri) {
    char path[SCENE_PATH];
    if (!import_resolve(g->im, uri, path) || !import_map(g->im, path, &g->buffers[index]))
        return import_fail(g->im, "buffer %u: '%.150s' is not there, is empty or cannot be read", index, uri);
    g->bytes += g->buffers[index].size;
    return true;
}

/* The first buffer without a URI is the binary chunk, which may be longer by what pads it. */
static bool load_buffer(gltf_file *g, uint32_t index, const json_t *buffer) {
    import_bytes *to = &g->buffers[index];
    const char *uri = gltf_text(buffer, "uri", NULL);
    size_t stated;
    if (!gltf_size(buffer, "byteLength", &stated) || stated == 0)
        return import_fail(g->im, "buffer %u has no length", index);
    if (uri && gltf_is_data(uri)) {
        if (!gltf_data(uri, to))
            return import_fail(g->im, "buffer %u: its data cannot be read", index);
    } else if (uri) {
        if (!load_file(g, index, uri))
            return false;
    } else if (index == 0 && g->chunk) {
        to->at = g->chunk;
        to->size = g->chunk_size;
    } else
        return import_fail(g->im, "buffer %u has no data", index);
    if (to->size < stated)
        return import_fail(g->im, "buffer %u has %zu bytes of %zu", index, to->size, stated);
    return true;
}

bool gltf_buffer(gltf_file *g, uint32_t index, size_t offset, size_t size, const uint8_t **at) {
    const json_t *buffer = gltf_item(g, "buffers", index);
    if (!buffer)
        return import_fail(g->im, "there is no buffer %u", index);
    if (!g->buffers[index].at && !load_buffer(g, index, buffer))
        return false;
    const size_t length = g->buffers[index].size;
    if (offset > length || size > length - offset)
        return import_fail(g->im, "%zu bytes from %zu on lie outside of buffer %u, which has %zu", size, offset, index, length);
    *at = g->buffers[index].at + offset;
    return true;
}

bool gltf_view(gltf_file *g, uint32_t index, const uint8_t **at, size_t *size, size_t *stride) {
    const json_t *view = gltf_item(g, "bufferViews", index);
    const json_t *packed = gltf_extension(view, "EXT_meshopt_compression");
    uint32_t buffer;
    size_t offset;
    if (!view)
        return import_fail(g->im, "there is no buffer view %u", index);
    if (!gltf_size(view, "byteLength", size) || !gltf_size(view, "byteOffset", &offset) ||
        !gltf_size(view, "byteStride", stride))
        return import_fail(g->im, "buffer view %u has no length, offset or stride that could be", index);
    if (packed) {
        if (!g->views[index].at && !gltf_meshopt(g, index, packed, &g->views[index]))
            return false;
        *at = g->views[index].at;
        *size = g->views[index].size;
        return true;
    }
    (void)gltf_index(view, "buffer", &buffer);
    return gltf_buffer(g, buffer, offset, *size, at);
}

const char *gltf_image_bytes(gltf_file *g, uint32_t index, const uint8_t **at, size_t *size) {
    const json_t *image = gltf_item(g, "images", index);
    const char *uri = gltf_text(image, "uri", NULL);
    uint32_t view;
    size_t stride;
    if (uri && gltf_is_data(uri)) {
        if (!g->images[index].at && !gltf_data(uri, &g->images[index]))
            return "has data that cannot be read";
        *at = g->images[index].at;
        *size = g->images[index].size;
        return NULL;
    }
    vit_text kept = *g->im->why; /* a texture that is missing may be only a warning */
    if (gltf_index(image, "bufferView", &view) && gltf_view(g, view, at, size, &stride))
        return NULL;
    *g->im->why = kept;
    return "is missing";
}
