#include "common/file_trouble.h"
#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

const char *file_trouble(const char *path) {
    struct stat s;
    if (stat(path, &s) != 0)
        switch (errno) {
        case ENOENT:
            return "is not there";
        case ENOTDIR:
            return "is not there: what should be its folder is a file";
        case EACCES:
            return "cannot be read: its folder is closed to you";
        case ELOOP:
            return "cannot be read: its links go round in a circle";
        default:
            return "cannot be read";
        }
    if (S_ISDIR(s.st_mode))
        return "is a folder, not a file";
    if (!S_ISREG(s.st_mode))
        return "is not a file";
    return access(path, R_OK) == 0 ? NULL : "cannot be read: it is closed to you";
}
