/* glTF on any bytes. */
#include "fuzz.h"

#include <string.h>

/* glTF 1 is read by a library that is to run in a child alone. */
static bool is_old(const uint8_t *data, size_t size) {
    static const char key[] = "\"version\"";
    for (size_t i = 0; i + 5 <= size; i++)
        if (memcmp(data + i, "glTF\1", 5) == 0)
            return true;
    for (size_t i = 0; i + sizeof key - 1 < size; i++) {
        size_t at = i + sizeof key - 1;
        if (memcmp(data + i, key, sizeof key - 1) != 0)
            continue;
        while (at < size && memchr(" \t\r\n:\"0+", data[at], 8))
            at++;
        if (at < size && (data[at] == '1' || data[at] == '.'))
            return true;
    }
    return false;
}

void fuzz_gltf(const uint8_t *data, size_t size) {
    static const char *const names[] = {"mesh.gltf", "mesh.glb", "mesh.bin", "a.webp", "a.png", "a.tga", NULL};
    fuzz_files f = {.names = names};
    fuzz_write_files(&f, data, size);
    if (!is_old(data, size) && (strstr(f.main, ".gltf") || strstr(f.main, ".glb")))
        fuzz_import(f.main);
}
