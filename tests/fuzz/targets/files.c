/* Inputs of several files, in a folder of the process's own that is gone when it ends. */
#include "fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_FILES = 8 };

/* What was made so far, for whoever comes to clean up when the process ends. */
static char folder[256];
static char paths[MAX_FILES][320];
static int count;

void fuzz_failed(const char *file, int line, const char *what) {
    (void)fprintf(stderr, "%s:%d: does not hold: %s\n", file, line, what);
    abort();
}

void fuzz_one_line(const char *text, size_t room) {
    FUZZ_HOLDS(memchr(text, 0, room) != NULL && text[0] && !strchr(text, '\n') && !strchr(text, '\r'));
}

static void remove_files(void) {
    for (int i = 0; i < count; i++)
        (void)unlink(paths[i]);
    count = 0;
}

static void remove_folder(void) {
    remove_files();
    (void)rmdir(folder);
}

static void make_folder(void) {
    if (folder[0])
        return;
    (void)snprintf(folder, sizeof folder, VIT_BUILD_DIR "/fuzz-files.XXXXXX");
    FUZZ_HOLDS(mkdtemp(folder) != NULL && atexit(remove_folder) == 0);
}

static const char *write_file(const char *name, const uint8_t *data, size_t size) {
    if (count == MAX_FILES)
        return NULL;
    char *path = paths[count++];
    (void)snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    FUZZ_HOLDS(file != NULL);
    FUZZ_HOLDS(fwrite(data, 1, size, file) == size);
    FUZZ_HOLDS(fclose(file) == 0);
    return path;
}

/* The name that a line "=== NAME" at `at` begins, and where its file begins; NULL if there is no such line. */
static const char *begun(const fuzz_files *f, const uint8_t *at, const uint8_t *end, const uint8_t **body) {
    for (int i = 0; f->names[i]; i++) {
        char line[64];
        const int length = snprintf(line, sizeof line, "=== %s\n", f->names[i]);
        if (end - at >= length && memcmp(at, line, (size_t)length) == 0) {
            *body = at + length;
            return f->names[i];
        }
    }
    return NULL;
}

/* The first line from `at` on that begins a file, or `end`. */
static const uint8_t *next_file(const fuzz_files *f, const uint8_t *at, const uint8_t *end) {
    const uint8_t *body;
    while (at < end && !begun(f, at, end, &body)) {
        const uint8_t *feed = memchr(at, '\n', (size_t)(end - at));
        at = feed ? feed + 1 : end;
    }
    return at;
}

void fuzz_write_files(fuzz_files *f, const uint8_t *data, size_t size) {
    const uint8_t *at = data, *end = data + size;
    make_folder();
    remove_files();
    f->main = NULL;
    do {
        const uint8_t *body = at;
        const char *name = begun(f, at, end, &body);
        at = next_file(f, body, end);
        const char *path = write_file(name ? name : f->names[0], body, (size_t)(at - body));
        f->main = f->main ? f->main : path;
    } while (at < end && count < MAX_FILES);
}
