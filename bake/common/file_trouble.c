#include "common/file_trouble.h"
#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

const char *file_trouble(const char *path) {
    struct stat s;
    if (stat(path, &s) != 0)
        return errno == ENOENT    ? "is not there"
               : errno == ENOTDIR ? "is not there: what should be its folder is a file"
               : errno == EACCES  ? "cannot be read: its folder is closed to you"
               : errno == ELOOP   ? "cannot be read: its links go round in a circle"
                                  : "cannot be read";
    if (S_ISDIR(s.st_mode))
        return "is a folder, not a file";
    if (!S_ISREG(s.st_mode))
        return "is not a file";
    return access(path, R_OK) == 0 ? NULL : "cannot be read: it is closed to you";
}
