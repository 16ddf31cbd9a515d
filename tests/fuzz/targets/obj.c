/* OBJ and MTL on any bytes. */
#include "fuzz.h"

#include <string.h>

void fuzz_obj(const uint8_t *data, size_t size) {
    static const char *const names[] = {"mesh.obj", "mesh.mtl", "a b.mtl", "a.png", "a.tga", NULL};
    fuzz_files f = {.names = names};
    fuzz_write_files(&f, data, size);
    if (strstr(f.main, ".obj"))
        fuzz_import(f.main);
}
