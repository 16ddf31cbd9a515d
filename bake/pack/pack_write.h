/* pack_write.c: sections to one file image. */
#ifndef VIT_BAKE_PACK_WRITE_H
#define VIT_BAKE_PACK_WRITE_H

#include "vitrine_pack.h"
#include "vitrine.h"

/* What goes into each section, in VIT_SECTIONS order; counts come from the scene in META. */
typedef struct pack_sections {
    const void *data[VIT_SECTION_COUNT];
} pack_sections;

/* Lays out the pack in one malloc'ed block (the caller frees it). The bytes depend on the sections alone. */
vit_status pack_assemble(const pack_sections *in, void **bytes, size_t *size, vit_text *why);

/* Writes `bytes` to a temporary file beside `path`, syncs and renames it: there is never a partial file under `path`.
 * The temporary file, PATH.tmp-PID-N, is removed on failure and by pack_abandon(), which a signal handler may call; what a
 * killed process left of it is removed by the next pack_save() to the same path. */
vit_status pack_save(const char *path, const void *bytes, size_t size, vit_text *why);
void pack_abandon(void);
/* Whether pack_save() could write there now: what is known before the work. Tries it with a page, and leaves nothing.
 * VIT_FAILED. */
vit_status pack_can_save(const char *path, vit_text *why);
/* Likewise for file `name` of a folder that may still have to be made, and folders above it. */
vit_status pack_can_make(const char *folder, const char *name, vit_text *why);

#endif
