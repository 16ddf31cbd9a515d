/* STL on any bytes. */
#include "fuzz.h"

#include <string.h>

void fuzz_stl(const uint8_t *data, size_t size) {
    static const char *const names[] = {"mesh.stl", NULL};
    fuzz_files f = {.names = names};
    fuzz_write_files(&f, data, size);
    if (strstr(f.main, ".stl"))
        fuzz_import(f.main);
}
