#include "import/import_zip.h"
#include <stdlib.h>

#define MOST ((size_t)1 << 30) /* bytes */

/* In steps: sizes that an archive states are not believed. */
void *import_unzipped(zip_file_t *from, size_t *size) {
    char *bytes = NULL;
    zip_int64_t got = 1;
    *size = 0;
    for (size_t room = 1 << 16; got > 0 && room <= MOST; room *= 2) {
        char *grown = realloc(bytes, room);
        if (!grown)
            break;
        bytes = grown;
        while (*size < room && (got = zip_fread(from, bytes + *size, room - *size)) > 0)
            *size += (size_t)got;
    }
    if (got == 0)
        return bytes;
    free(bytes);
    return NULL;
}
