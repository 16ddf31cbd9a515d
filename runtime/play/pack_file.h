/* pack_file.c: a pack in memory, read-only and in place. */
#ifndef VIT_PLAY_PACK_FILE_H
#define VIT_PLAY_PACK_FILE_H

#include "vitrine.h"

typedef struct pack_file {
    const void *bytes; /* page-aligned */
    size_t size;       /* bytes, never 0 */
} pack_file;

/* VIT_BAD_INPUT: missing, unreadable, not a regular file, or empty. What is inside is the library's business. */
vit_status pack_file_map(const char *path, pack_file *out, vit_text *why);
void pack_file_unmap(pack_file *pack);

#endif
