/* Preloaded into a tool, it sends the tool a signal at a chosen moment of its work on the files of one folder: so a test can
 * stop a process between any two steps of saving without a clock, and without a line of test code in the product.
 *
 *   SIGNAL_FOLDER  path of the folder, as the tool is given it; calls on other files pass through uncounted
 *   SIGNAL_AT      the moment, its number from 1 or its name: before-CALL, after-CALL, and half-of-write
 *   SIGNAL_NUMBER  which signal; without it SIGKILL
 *
 * The moment is told on stderr ("signal: after-rename") just before the signal. Calls that libc makes inside itself (stdio,
 * opendir) are not seen: whoever counts on a call must check that it was told. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

static atomic_int moments;

static void moment(const char *when, const char *call) {
    const char *at = getenv("SIGNAL_AT"), *number = getenv("SIGNAL_NUMBER");
    char name[32], line[64];
    (void)snprintf(name, sizeof name, "%s-%s", when, call);
    const int count = atomic_fetch_add(&moments, 1) + 1;
    if (!at || (count != atoi(at) && strcmp(name, at) != 0))
        return;
    (void)snprintf(line, sizeof line, "signal: %s\n", name);
    (void)syscall(SYS_write, STDERR_FILENO, line, strlen(line));
    (void)raise(number ? atoi(number) : SIGKILL);
}

static bool is_below(const char *folder, const char *path) {
    const size_t length = strlen(folder);
    return length > 0 && strncmp(path, folder, length) == 0 && (path[length] == '/' || path[length] == '\0');
}

static bool within(const char *path) {
    const char *folder = getenv("SIGNAL_FOLDER");
    return folder && is_below(folder, path);
}

/* By where it lies: a file that has no name any more is not of the folder. */
static bool concerns_file(int file) {
    char link[64], path[PATH_MAX], whole[PATH_MAX];
    const char *folder = getenv("SIGNAL_FOLDER");
    (void)snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    const ssize_t length = readlink(link, path, sizeof path - 1);
    path[length > 0 ? length : 0] = '\0';
    return folder && realpath(folder, whole) && is_below(whole, path);
}

static bool concerns(int directory, const char *path) {
    return path[0] == '/' || directory == AT_FDCWD ? within(path) : concerns_file(directory);
}

/* `call` between its two moments, if it is about the folder. */
#define AROUND(about, name, call)                                                                                              \
    const bool seen = about;                                                                                                   \
    if (seen)                                                                                                                  \
        moment("before", name);                                                                                                \
    const long result = call;                                                                                                  \
    if (seen)                                                                                                                  \
    moment("after", name)

static int opened(int directory, const char *path, int flags, mode_t mode) {
    AROUND(concerns(directory, path), "open", syscall(SYS_openat, directory, path, flags, mode));
    return (int)result;
}

/* Under the names that a caller with 64-bit offsets is linked to as well; the headers' own declarations would rename these. */
#define OPENS(function, symbol)                                                                                                \
    int function(const char *path, int flags, ...) __asm__(symbol);                                                            \
    int function(const char *path, int flags, ...) {                                                                           \
        va_list list;                                                                                                          \
        va_start(list, flags);                                                                                                 \
        const mode_t mode = flags & O_CREAT ? va_arg(list, mode_t) : 0;                                                        \
        va_end(list);                                                                                                          \
        return opened(AT_FDCWD, path, flags, mode);                                                                            \
    }
#define OPENS_AT(function, symbol)                                                                                             \
    int function(int directory, const char *path, int flags, ...) __asm__(symbol);                                             \
    int function(int directory, const char *path, int flags, ...) {                                                            \
        va_list list;                                                                                                          \
        va_start(list, flags);                                                                                                 \
        const mode_t mode = flags & O_CREAT ? va_arg(list, mode_t) : 0;                                                        \
        va_end(list);                                                                                                          \
        return opened(directory, path, flags, mode);                                                                           \
    }
OPENS(open_32, "open")
OPENS(open_64, "open64")
OPENS_AT(openat_32, "openat")
OPENS_AT(openat_64, "openat64")

ssize_t write(int file, const void *bytes, size_t size) {
    const bool seen = concerns_file(file);
    size_t half = 0;
    if (seen) {
        moment("before", "write");
        const ssize_t written = syscall(SYS_write, file, bytes, size / 2);
        if (written < 0)
            return written;
        half = (size_t)written;
        moment("half-of", "write");
    }
    const ssize_t rest = syscall(SYS_write, file, (const char *)bytes + half, size - half);
    if (seen)
        moment("after", "write");
    return rest < 0 ? rest : (ssize_t)half + rest;
}

int fsync(int file) {
    AROUND(concerns_file(file), "fsync", syscall(SYS_fsync, file));
    return (int)result;
}

int close(int file) {
    AROUND(concerns_file(file), "close", syscall(SYS_close, file));
    return (int)result;
}

int rename(const char *from, const char *to) {
    AROUND(within(from) || within(to), "rename", syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0u));
    return (int)result;
}

int unlink(const char *path) {
    AROUND(within(path), "unlink", syscall(SYS_unlinkat, AT_FDCWD, path, 0));
    return (int)result;
}

int unlinkat(int directory, const char *path, int flags) {
    AROUND(concerns(directory, path), "unlink", syscall(SYS_unlinkat, directory, path, flags));
    return (int)result;
}
