/* The file is mapped, not read: an installed pack is shared by all players and costs no copy. Whoever truncates it while it
 * plays gets the player killed (SIGBUS), as with any mapped file; replacing it by rename is safe. */
#include "pack_file.h"
#include "failure.h"
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

static vit_status map_descriptor(int fd, const char *path, pack_file *out, vit_text *why) {
    struct stat s;
    if (fstat(fd, &s) != 0)
        return play_fail(why, VIT_BAD_INPUT, "%s: %s", path, strerror(errno));
    if (S_ISDIR(s.st_mode))
        return play_fail(why, VIT_BAD_INPUT, "%s: is a directory, not a pack", path);
    if (!S_ISREG(s.st_mode))
        return play_fail(why, VIT_BAD_INPUT, "%s: is not a regular file (a pack is mapped, so it cannot come from a pipe)",
                         path);
    if (s.st_size <= 0)
        return play_fail(why, VIT_BAD_INPUT, "%s: is empty", path);
    if ((uintmax_t)s.st_size > SIZE_MAX)
        return play_fail(why, VIT_BAD_INPUT, "%s: %jd bytes are too many for this machine", path, (intmax_t)s.st_size);
    void *bytes = mmap(NULL, (size_t)s.st_size, PROT_READ, MAP_PRIVATE, fd, 0);
    if (bytes == MAP_FAILED)
        return play_fail(why, VIT_BAD_INPUT, "%s: cannot be mapped: %s", path, strerror(errno));
    *out = (pack_file){.bytes = bytes, .size = (size_t)s.st_size};
    return VIT_OK;
}

vit_status pack_file_map(const char *path, pack_file *out, vit_text *why) {
    /* O_NONBLOCK: opening a pipe must not wait for a writer; it changes nothing for a regular file. */
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0)
        return play_fail(why, VIT_BAD_INPUT, "%s: %s", path, strerror(errno));
    vit_status status = map_descriptor(fd, path, out, why);
    (void)close(fd); /* only read from: nothing to lose */
    return status;
}

void pack_file_unmap(pack_file *pack) {
    if (pack->size != 0)
        (void)munmap((void *)(uintptr_t)pack->bytes, pack->size);
    *pack = (pack_file){0};
}
