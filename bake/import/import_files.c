/* What of the disk a mesh file refers to. Each file that is opened is noted, and earns time and memory. */
#include "import/image_file.h"
#include "import/importer.h"
#include <ctype.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

void import_note_file(importer *im, const char *path, size_t bytes) {
    inputs_add(&im->m->files, path);
    import_allow(im, bytes);
}

static bool is_file(const char *path) {
    struct stat st;
    return stat(path, &st) == 0 && S_ISREG(st.st_mode) && st.st_size <= IMAGE_FILE_MOST;
}

static int hex(char c) {
    return isdigit((unsigned char)c) ? c - '0' : isxdigit((unsigned char)c) ? tolower((unsigned char)c) - 'a' + 10 : -1;
}

/* glTF names its files by URI: "my%20wood.png". */
static void decode_percent(char *text) {
    char *to = text;
    for (const char *c = text; *c; c++) {
        const int high = c[0] == '%' ? hex(c[1]) : -1;
        const int low = high >= 0 ? hex(c[2]) : -1;
        *to++ = low > 0 || (low == 0 && high > 0) ? (char)(high * 16 + low) : *c;
        if (low >= 0)
            c += 2;
    }
    *to = '\0';
}

/* Names are relative to the mesh's folder. An absolute one comes from its author's disk: its last part is tried here.
 */
bool import_resolve(const importer *im, const char *name, char path[SCENE_PATH]) {
    char plain[SCENE_PATH];
    const char *slash = strrchr(im->file, '/');
    (void)snprintf(plain, sizeof plain, "%s", name);
    for (char *c = plain; *c; c++)
        if (*c == '\\')
            *c = '/';
    const char *relative = plain;
    const char *last = strrchr(plain, '/');
    if (last && (plain[0] == '/' || (isalpha((unsigned char)plain[0]) && plain[1] == ':')))
        relative = last + 1;
    for (int pass = 0; pass < 2; pass++) {
        const int used = snprintf(path, SCENE_PATH, "%.*s%s", slash ? (int)(slash + 1 - im->file) : 0, im->file, relative);
        if (used < 0 || used >= SCENE_PATH)
            return false;
        if (is_file(path))
            return true;
        decode_percent(plain + (relative - plain));
    }
    return false;
}

bool import_map(importer *im, const char *path, import_bytes *out) {
    struct stat s;
    *out = (import_bytes){0};
    const int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC); /* a pipe without a writer is not waited for */
    const bool plain = fd >= 0 && fstat(fd, &s) == 0 && S_ISREG(s.st_mode) && s.st_size > 0;
    void *at =
        plain && (uint64_t)s.st_size <= SIZE_MAX ? mmap(NULL, (size_t)s.st_size, PROT_READ, MAP_PRIVATE, fd, 0) : MAP_FAILED;
    if (fd >= 0)
        (void)close(fd);
    if (at == MAP_FAILED)
        return false;
    out->at = at;
    out->size = out->mapped = (size_t)s.st_size;
    import_note_file(im, path, out->size);
    return true;
}

void import_drop_front(import_bytes *bytes, size_t size) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), whole = size < bytes->mapped ? size / page * page : 0;
    if (whole == 0)
        return;
    (void)munmap((void *)(uintptr_t)bytes->at, whole);
    bytes->at += whole;
    bytes->size -= whole;
    bytes->mapped -= whole;
}

void import_drop_bytes(import_bytes *bytes) {
    if (bytes->mapped > 0)
        (void)munmap((void *)(uintptr_t)bytes->at, bytes->mapped);
    free(bytes->owned);
    *bytes = (import_bytes){0};
}
