/* 3MF on any bytes: the parts of an archive, which is made here so that the fuzzer need not know of checksums, or an archive as
 * it is. */
#include "fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zip.h>

static const char *const parts[] = {"3D/3dmodel.model", "_rels/.rels", "3D/b.model", "a.tga", "a.png"};
enum { PARTS = sizeof parts / sizeof *parts };

/* A part of the input by its name here: '/' becomes '-'. */
static void add_part(zip_t *archive, const char *folder, const char *name) {
    char path[512], plain[64];
    (void)snprintf(plain, sizeof plain, "%s", name);
    for (char *c = plain; *c; c++)
        *c = *c == '/' ? '-' : *c;
    (void)snprintf(path, sizeof path, "%s%s", folder, plain);
    FILE *file = fopen(path, "rb");
    if (!file)
        return;
    (void)fclose(file);
    zip_source_t *source = zip_source_file(archive, path, 0, -1);
    FUZZ_HOLDS(source != NULL);
    const zip_int64_t index = zip_file_add(archive, name, source, 0);
    FUZZ_HOLDS(index >= 0 && zip_set_file_compression(archive, (zip_uint64_t)index, ZIP_CM_STORE, 0) == 0);
}

void fuzz_3mf(const uint8_t *data, size_t size) {
    static const char *const names[] = {"3D-3dmodel.model", "_rels-.rels", "3D-b.model", "a.tga", "a.png", "whole.3mf", NULL};
    fuzz_files f = {.names = names};
    char folder[400], path[512];
    int error;
    fuzz_write_files(&f, data, size);
    if (strstr(f.main, "whole.3mf")) {
        fuzz_import(f.main);
        return;
    }
    (void)snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(f.main, '/') + 1 - f.main), f.main);
    (void)snprintf(path, sizeof path, "%sparts.3mf", folder);
    zip_t *archive = zip_open(path, ZIP_CREATE | ZIP_TRUNCATE, &error);
    FUZZ_HOLDS(archive != NULL);
    for (int i = 0; i < PARTS; i++)
        add_part(archive, folder, parts[i]);
    FUZZ_HOLDS(zip_close(archive) == 0);
    fuzz_import(path);
    (void)remove(path);
}
