#include "pocl_cache.h"
#include "failure.h"
#include <errno.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#define ROOM ((uint64_t)64 << 20) /* bytes; programs of ours take 1 to 5 million and as much again while they are made */
#define FILES 256                 /* a program's folders and files */
#define CURE "set POCL_CACHE_DIR to a folder with room"

void pocl_cache_mend_environment(void) {
    const char *named = getenv("POCL_CACHE_DIR");
    if (named != NULL && named[0] == '\0')
        (void)unsetenv("POCL_CACHE_DIR");
}

bool pocl_is_named(const char *text) {
    return strstr(text, "Portable Computing Language") != NULL;
}

/* As PoCL looks for it. */
static bool find_folder(char *path, size_t size) {
    const char *named = getenv("POCL_CACHE_DIR"), *caches = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    int length;
    if (named != NULL && named[0] != '\0')
        length = snprintf(path, size, "%s", named);
    else if (caches != NULL && caches[0] != '\0')
        length = snprintf(path, size, "%s/pocl", caches);
    else if (home != NULL)
        length = snprintf(path, size, "%s/.cache/pocl", home);
    else
        length = snprintf(path, size, "/tmp/pocl");
    return length > 0 && (size_t)length < size;
}

/* Cuts the path down to the part of it that is there: where the rest would have to be made. */
static void cut_to_existing(char *path) {
    struct stat s;
    while (stat(path, &s) != 0 && (errno == ENOENT || errno == ENOTDIR)) {
        char *slash = strrchr(path, '/');
        if (slash != NULL && slash != path) {
            *slash = '\0';
            continue;
        }
        path[0] = slash == NULL ? '.' : '/'; /* there is room for it: path named something below */
        path[1] = '\0';
        return;
    }
}

static bool has_little_room(const char *path, char *text, size_t size) {
    struct statvfs v;
    struct rlimit most;
    if (getrlimit(RLIMIT_FSIZE, &most) == 0 && most.rlim_cur != RLIM_INFINITY && most.rlim_cur < ROOM) {
        (void)snprintf(text, size, "files may have %ju bytes at most (ulimit -f)", (uintmax_t)most.rlim_cur);
        return true;
    }
    if (statvfs(path, &v) != 0)
        return false;
    if (v.f_blocks == 0) { /* as in /proc */
        (void)snprintf(text, size, "not a place for files");
        return true;
    }
    const uint64_t room = (uint64_t)v.f_bavail * v.f_frsize;
    if (room < ROOM)
        (void)snprintf(text, size, "%.1f MB are left on the disk", (double)room * 1e-6);
    else if (v.f_files > 0 && v.f_favail < FILES)
        (void)snprintf(text, size, "%ju files are left on the disk", (uintmax_t)v.f_favail);
    else
        return false;
    return true;
}

bool pocl_cache_in_trouble(vit_text *why) {
    char folder[PATH_MAX], there[PATH_MAX], room[96];
    struct stat s;
    if (!find_folder(folder, sizeof folder)) {
        (void)play_fail(why, VIT_FAILED, "PoCL cannot compile: the path of its cache is too long: " CURE);
        return true;
    }
    memcpy(there, folder, sizeof there);
    cut_to_existing(there);
    const char *cause = NULL;
    if (stat(there, &s) == 0 && !S_ISDIR(s.st_mode))
        cause = strerror(ENOTDIR);
    else if (access(there, W_OK | X_OK) != 0)
        cause = strerror(errno);
    else if (has_little_room(there, room, sizeof room))
        cause = room;
    if (cause == NULL)
        return false;
    (void)play_fail(why, VIT_FAILED, "PoCL cannot compile in its cache %.200s (%s): " CURE, folder, cause);
    return true;
}
