#include "import/gltf_extensions.h"
#include "common/file_trouble.h"
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* The JSON text may hold whole buffers. */
#define MOST_BYTES ((size_t)1 << 30)

static bool is_read(const char *name) {
    static const char *const known[] = {"KHR_lights_punctual",   "KHR_materials_transmission",
                                        "KHR_materials_volume",  "KHR_materials_ior",
                                        "KHR_texture_transform", "KHR_materials_pbrSpecularGlossiness"};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
        if (strcmp(known[i], name) == 0)
            return true;
    return false;
}

/* The JSON text of the file, ended by a zero byte; NULL: it is no glTF 2 file, or cannot be read. */
static char *read_json(const char *path) {
    unsigned char head[20];
    struct stat s;
    FILE *f = file_trouble(path) ? NULL : fopen(path, "rb");
    if (!f)
        return NULL;
    size_t size = fstat(fileno(f), &s) == 0 && s.st_size > 0 ? (size_t)s.st_size : 0;
    if (fread(head, 1, sizeof head, f) == sizeof head && memcmp(head, "glTF", 4) == 0) {
        const size_t chunk = head[12] | (size_t)head[13] << 8 | (size_t)head[14] << 16 | (size_t)head[15] << 24;
        size = memcmp(head + 16, "JSON", 4) == 0 && chunk < size ? chunk : 0;
    } else
        rewind(f);
    char *text = size > 0 && size <= MOST_BYTES ? malloc(size + 1) : NULL;
    if (text)
        text[fread(text, 1, size, f)] = '\0';
    (void)fclose(f);
    return text;
}

static const char *past_space(const char *t) {
    return t + strspn(t, " \t\r\n");
}

/* Past the string that begins at t. */
static const char *past_string(const char *t) {
    for (t++; *t && *t != '"'; t++)
        t += *t == '\\' && t[1] != '\0';
    return *t ? t + 1 : t;
}

static int add(gltf_extension *list, int count, const char *name, size_t length, bool required) {
    gltf_extension e = {.required = required};
    if (length >= sizeof e.name)
        return count;
    memcpy(e.name, name, length);
    for (int i = 0; i < count; i++)
        if (strcmp(list[i].name, e.name) == 0) {
            list[i].required = list[i].required || required;
            return count;
        }
    if (count == GLTF_EXTENSIONS)
        return count;
    e.read = is_read(e.name);
    list[count] = e;
    return count + 1;
}

/* The strings of an array. */
static int add_all(gltf_extension *list, int count, const char *t, bool required) {
    for (t = past_space(t + 1); *t == '"'; t = past_space(t + (*t == ','))) {
        const char *end = past_string(t);
        if (end - t > 2 && end[-1] == '"')
            count = add(list, count, t + 1, (size_t)(end - t) - 2, required);
        t = past_space(end);
    }
    return count;
}

int gltf_extensions(const char *path, gltf_extension list[GLTF_EXTENSIONS]) {
    static const char used[] = "\"extensionsUsed\"", required[] = "\"extensionsRequired\"";
    char *text = read_json(path);
    int count = 0, depth = 0;
    for (const char *t = text ? text : ""; *t;) {
        if (*t != '"') {
            depth += *t == '{' || *t == '[';
            depth -= *t == '}' || *t == ']';
            t++;
            continue;
        }
        const char *end = past_string(t), *colon = past_space(end), *value = *colon == ':' ? past_space(colon + 1) : colon;
        const size_t length = (size_t)(end - t);
        const bool uses = length == sizeof used - 1 && memcmp(t, used, length) == 0;
        const bool requires = length == sizeof required - 1 && memcmp(t, required, length) == 0;
        if (depth == 1 && *value == '[' && (uses || requires))
            count = add_all(list, count, value, requires);
        t = end;
    }
    free(text);
    return count;
}
