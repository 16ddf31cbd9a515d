/* What of the disk a mesh file refers to. Each file that is opened is noted, and earns time and memory. */
#include "import/image_file.h"
#include "import/importer.h"
#include <ctype.h>
#include <dirent.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
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

/* The name in `folder` that differs from `part` in nothing but the case of its letters, the first of several by their bytes. */
static bool name_of_any_case(const char *folder, char *part) {
    char best[NAME_MAX + 1] = "";
    DIR *all = opendir(*folder ? folder : ".");
    for (const struct dirent *e; all && (e = readdir(all));)
        if (strcasecmp(e->d_name, part) == 0 && (!*best || strcmp(e->d_name, best) < 0))
            (void)snprintf(best, sizeof best, "%s", e->d_name);
    if (all)
        (void)closedir(all);
    memcpy(part, best, strlen(best));
    return *best != '\0';
}

/* Makes of path[from] on, names and slashes, what is there in another case: files of Windows do not tell them apart. */
static bool find_any_case(char *path, size_t from) {
    for (char *part = path + from; *part;) {
        char folder[SCENE_PATH], *slash = strchr(part, '/');
        (void)snprintf(folder, sizeof folder, "%.*s", (int)(part - path), path);
        if (slash)
            *slash = '\0';
        const bool fine = *part == '\0' || name_of_any_case(folder, part);
        if (slash)
            *slash = '/';
        if (!fine || !slash)
            return fine && is_file(path);
        part = slash + 1;
    }
    return false;
}

/* Names are relative to the mesh's folder. An absolute one comes from its author's disk: its last part is tried here. What is
 * not there is looked for without regard to the case of letters.
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
    const int folder = slash ? (int)(slash + 1 - im->file) : 0;
    char coded[SCENE_PATH];
    (void)snprintf(coded, sizeof coded, "%s", relative);
    decode_percent(plain + (relative - plain));
    for (int pass = 0; pass < 4; pass++) { /* as it stands, decoded; then in any case */
        const int used = snprintf(path, SCENE_PATH, "%.*s%s", folder, im->file, pass % 2 ? relative : coded);
        if (used < 0 || used >= SCENE_PATH)
            return false;
        if (pass < 2 ? is_file(path) : find_any_case(path, (size_t)folder))
            return true;
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
