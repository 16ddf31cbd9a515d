/* import_zip.c: files in ZIP archives. */
#ifndef VIT_BAKE_IMPORT_ZIP_H
#define VIT_BAKE_IMPORT_ZIP_H

#include <stddef.h>
#include <zip.h>

/* All of an open file, unpacked; free() it. NULL: it is damaged, longer than 1 GiB, or does not fit in memory. */
void *import_unzipped(zip_file_t *from, size_t *size);

#endif
