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

#define PATH_SIZE 4096 /* longer paths are refused: Linux's own limit */

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
    char partial[PATH_SIZE];
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
    char partial[PATH_SIZE + sizeof ".part"];
    if (strlen(path) >= PATH_SIZE)
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
    char path[PATH_SIZE];
    int length = snprintf(path, sizeof path, "%s/frame_%05u.%s", folder, index, extension);
    if (length < 0 || (size_t)length >= sizeof path)
        return failed(folder, ENAMETOOLONG, why);
    return write_and_rename(path, bytes, size, why);
}

vit_status output_file(const char *path, const void *bytes, size_t size, vit_text *why) {
    struct stat s;
    return stat(path, &s) == 0 && !S_ISREG(s.st_mode) ? write_all(path, bytes, size, why)
                                                      : write_and_rename(path, bytes, size, why);
}

vit_status output_flush_stdout(vit_text *why) {
    errno = 0;
    if (fflush(stdout) == 0 && !ferror(stdout))
        return VIT_OK;
    return failed("stdout", errno != 0 ? errno : EIO, why);
}
