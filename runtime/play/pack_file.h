/* pack_file.c: a pack in memory, read-only and in place. */
#ifndef VIT_PLAY_PACK_FILE_H
#define VIT_PLAY_PACK_FILE_H

#include "vitrine.h"
#include <stdbool.h>
#include <sys/types.h>

typedef struct pack_file {
    const void *bytes; /* page-aligned */
    size_t size;       /* bytes, never 0 */
    dev_t device;      /* with `inode`, what file this is */
    ino_t inode;
} pack_file;

/* VIT_BAD_INPUT: missing, unreadable, not a regular file, or empty. What is inside is the library's business. */
vit_status pack_file_map(const char *path, pack_file *out, vit_text *why);
/* True if `path` names the mapped file: writing there would pull the pack away under the library. */
bool pack_file_is(const pack_file *pack, const char *path);
void pack_file_unmap(pack_file *pack);

#endif
