/* PLY on any bytes. */
#include "fuzz.h"

#include <string.h>

void fuzz_ply(const uint8_t *data, size_t size) {
    static const char *const names[] = {"mesh.ply", "a.png", "a.tga", NULL};
    fuzz_files f = {.names = names};
    fuzz_write_files(&f, data, size);
    if (strstr(f.main, ".ply"))
        fuzz_import(f.main);
}
