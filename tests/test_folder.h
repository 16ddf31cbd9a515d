/* Folders and files of a test: made, written and read whole; what cannot be done fails the test. A program whose files lie in
 * one folder of the build's defines FOLDER before it includes this, and has FILE_OF() and make_folder(). */
#ifndef VIT_TESTS_TEST_FOLDER_H
#define VIT_TESTS_TEST_FOLDER_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { TEST_FOLDER = 64 /* room for the path of a temporary folder */, READ_ALIGNMENT = 4096 };

/* A folder that may be there already. */
static inline void folder_make(const char *path) {
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        fail_msg("%s: %s", path, strerror(errno));
}

/* A folder that nobody else has. */
static inline void folder_make_temporary(char path[TEST_FOLDER]) {
    (void)snprintf(path, TEST_FOLDER, "/tmp/vitrine-test-XXXXXX");
    assert_non_null(mkdtemp(path));
}

static inline void path_join(char *path, size_t size, const char *folder, const char *name) {
    assert_in_range(snprintf(path, size, "%s/%s", folder, name), 1, size - 1);
}

static inline void put_bytes(const char *path, const void *bytes, size_t size) {
    FILE *f = fopen(path, "wb");
    if (!f)
        fail_msg("%s: %s", path, strerror(errno));
    assert_int_equal(fwrite(bytes, 1, size, f), size);
    assert_int_equal(fclose(f), 0);
}

static inline void put(const char *path, const char *text) {
    put_bytes(path, text, strlen(text));
}

/* The whole file, aligned as vit_open_info.pack wants it and ended with a zero; free() it. size: NULL, or without that zero. */
static inline void *read_file(const char *path, size_t *size) {
    FILE *f = fopen(path, "rb");
    if (!f)
        fail_msg("%s: %s", path, strerror(errno));
    assert_int_equal(fseek(f, 0, SEEK_END), 0);
    const long length = ftell(f);
    assert_true(length > 0); /* no file that a test asks for is empty */
    rewind(f);
    char *bytes = aligned_alloc(READ_ALIGNMENT, ((size_t)length / READ_ALIGNMENT + 1) * READ_ALIGNMENT);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, (size_t)length, f), length);
    (void)fclose(f);
    bytes[length] = '\0';
    if (size)
        *size = (size_t)length;
    return bytes;
}

/* The beginning of the file, as much as `size` has room for, ended with a zero. */
static inline void read_into(const char *path, char *text, size_t size) {
    FILE *f = fopen(path, "rb");
    if (!f)
        fail_msg("%s: %s", path, strerror(errno));
    text[fread(text, 1, size - 1, f)] = '\0';
    (void)fclose(f);
}

#ifdef FOLDER
#define FILE_OF(name) FOLDER "/" name

/* For cmocka. */
static inline int make_folder(void **state) {
    (void)state;
    folder_make(FOLDER);
    return 0;
}
#endif

#endif
