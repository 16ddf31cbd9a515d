/* Plain write(2) instead of stdio: a frame is one large buffer, and errno says at once what went wrong. */
#include "output.h"
#include "../failure.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static vit_status failed(const char *path, int error, vit_text *why) {
    if (error == EPIPE)
        return play_fail(why, VIT_FAILED, "%s: the reader closed the pipe", path);
    return play_fail(why, VIT_FAILED, "%s: %s", path, strerror(error));
}

vit_status output_open(const char *path, output *out, vit_text *why) {
    if (strcmp(path, "-") == 0) {
        *out = (output){.fd = STDOUT_FILENO, .is_stdout = true, .path = "stdout"};
        return VIT_OK;
    }
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0)
        return failed(path, errno, why);
    *out = (output){.fd = fd, .path = path};
    return VIT_OK;
}

vit_status output_write(const output *o, const void *bytes, size_t size, vit_text *why) {
    const unsigned char *at = bytes;
    while (size > 0) {
        /* Opened by output_open(). NOLINTNEXTLINE(clang-analyzer-core.CallAndMessage) */
        ssize_t n = write(o->fd, at, size < SSIZE_MAX ? size : SSIZE_MAX);
        if (n < 0 && errno == EINTR) /* Ctrl-C: the frame is still written to its end */
            continue;
        if (n < 0)
            return failed(o->path, errno, why);
        at += n;
        size -= (size_t)n;
    }
    return VIT_OK;
}

vit_status output_close(output *o, vit_text *why) {
    /* Opened by output_open(). NOLINTNEXTLINE(clang-analyzer-core.CallAndMessage) */
    if (close(o->fd) != 0 && errno != EINTR)
        return failed(o->path, errno, why);
    return VIT_OK;
}

static vit_status make_one(const char *path, vit_text *why) {
    struct stat s;
    if (mkdir(path, 0777) == 0)
        return VIT_OK;
    int error = errno;
    if (stat(path, &s) != 0)
        return failed(path, error, why);
    if (!S_ISDIR(s.st_mode))
        return play_fail(why, VIT_FAILED, "%s: is there and is not a folder", path);
    return VIT_OK;
}

vit_status output_folder(const char *path, vit_text *why) {
    char partial[OUTPUT_PATH_SIZE];
    size_t length = strlen(path);
    if (length >= sizeof partial)
        return failed(path, ENAMETOOLONG, why);
    memcpy(partial, path, length + 1);
    for (size_t i = 1; i < length; i++) {
        if (partial[i] != '/')
            continue;
        partial[i] = '\0';
        vit_status status = make_one(partial, why);
        if (status != VIT_OK)
            return status;
        partial[i] = '/';
    }
    return make_one(partial, why);
}

static vit_status write_all(const char *path, const void *bytes, size_t size, vit_text *why) {
    output file;
    vit_status status = output_open(path, &file, why);
    if (status != VIT_OK)
        return status;
    status = output_write(&file, bytes, size, why);
    vit_text unused;
    vit_status closed = output_close(&file, status == VIT_OK ? why : &unused);
    return status == VIT_OK ? closed : status;
}

static vit_status write_and_rename(const char *path, const void *bytes, size_t size, vit_text *why) {
    char partial[OUTPUT_PATH_SIZE + sizeof ".part"];
    if (strlen(path) >= OUTPUT_PATH_SIZE)
        return failed(path, ENAMETOOLONG, why);
    (void)snprintf(partial, sizeof partial, "%s.part", path);
    vit_status status = write_all(partial, bytes, size, why);
    if (status == VIT_OK && rename(partial, path) != 0)
        status = failed(path, errno, why);
    if (status != VIT_OK)
        (void)unlink(partial);
    return status;
}

vit_status output_frame_file(const char *folder, uint32_t index, const char *extension, const void *bytes, size_t size,
                             vit_text *why) {
    char path[OUTPUT_PATH_SIZE];
    int length = snprintf(path, sizeof path, "%s/frame_%05u.%s", folder, index, extension);
    if (length < 0 || (size_t)length >= sizeof path)
        return failed(folder, ENAMETOOLONG, why);
    return write_and_rename(path, bytes, size, why);
}

void output_follow(const char *path, char target[OUTPUT_PATH_SIZE]) {
    enum { MOST_LINKS = 40 }; /* Linux's own limit */
    char link[OUTPUT_PATH_SIZE];
    (void)snprintf(target, OUTPUT_PATH_SIZE, "%s", path);
    for (int i = 0; i < MOST_LINKS; i++) {
        const ssize_t length = readlink(target, link, sizeof link - 1);
        if (length < 0) /* no link, or nothing there */
            return;
        link[length] = '\0';
        const char *slash = link[0] != '/' ? strrchr(target, '/') : NULL; /* relative to the link's folder */
        const size_t folder = slash != NULL ? (size_t)(slash - target) + 1 : 0;
        if (folder + (size_t)length >= OUTPUT_PATH_SIZE)
            break;
        memcpy(target + folder, link, (size_t)length + 1);
    }
    (void)snprintf(target, OUTPUT_PATH_SIZE, "%s", path); /* links in a circle: opening it says so */
}

static bool same(const struct stat *a, const struct stat *b) {
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

/* stdout's or stderr's descriptor if that is the file; else -1. */
static int standard_output(const struct stat *file) {
    struct stat s;
    for (int fd = STDOUT_FILENO; fd <= STDERR_FILENO; fd++)
        if (fstat(fd, &s) == 0 && same(&s, file))
            return fd;
    return -1;
}

bool output_replaces(const char *path, char target[OUTPUT_PATH_SIZE]) {
    struct stat s, t;
    output_follow(path, target);
    if (stat(path, &s) != 0)
        return errno == ENOENT;
    return S_ISREG(s.st_mode) && standard_output(&s) < 0 && stat(target, &t) == 0 && same(&s, &t);
}

vit_status output_file(const char *path, const void *bytes, size_t size, vit_text *why) {
    struct stat s;
    char target[OUTPUT_PATH_SIZE];
    if (output_replaces(path, target))
        return write_and_rename(target, bytes, size, why);
    const output standard = {.fd = stat(path, &s) == 0 ? standard_output(&s) : -1, .path = path};
    if (standard.fd < 0)
        return write_all(path, bytes, size, why);
    (void)fflush(NULL); /* what was printed comes first */
    return output_write(&standard, bytes, size, why);
}

vit_status output_flush_stdout(vit_text *why) {
    errno = 0;
    if (fflush(stdout) == 0 && !ferror(stdout))
        return VIT_OK;
    return failed("stdout", errno != 0 ? errno : EIO, why);
}
