/* pack_write.c: lays the sections out as one file image, and puts that image under its name whole or not at all. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "pack/pack_write.h"
#include "common/fail.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

_Static_assert(!VIT_BIG_ENDIAN, "records are written as memory has them: bake on a little-endian machine");

/* Fills codes, record sizes, offsets and sizes; `total` is the file's size. */
static vit_status lay_out(const vit_scene *s, vit_pack_entry table[VIT_SECTION_COUNT], uint64_t *total, vit_text *why) {
    const struct {
        char code[5];
        uint32_t record;
        uint64_t records;
    } sections[VIT_SECTION_COUNT] = {
#define X(code, type, records) {#code, sizeof(type), records},
        VIT_SECTIONS(X)
#undef X
    };
    uint64_t end = sizeof(vit_pack_header) + VIT_SECTION_COUNT * sizeof(vit_pack_entry);
    for (int i = 0; i < VIT_SECTION_COUNT; i++) {
        const uint64_t offset = (end + VIT_PACK_ALIGN - 1) / VIT_PACK_ALIGN * VIT_PACK_ALIGN; /* end < 2^63: see below */
        if (sections[i].records > (SIZE_MAX / 2 - offset) / sections[i].record)
            return bake_fail(why, VIT_BAD_INPUT, "pack: section %s: %llu records are too many", sections[i].code,
                             (unsigned long long)sections[i].records);
        table[i] =
            (vit_pack_entry){.record = sections[i].record, .offset = offset, .size = sections[i].records * sections[i].record};
        memcpy(table[i].code, sections[i].code, sizeof table[i].code);
        end = offset + table[i].size;
    }
    *total = end;
    return VIT_OK;
}

vit_status pack_assemble(const pack_sections *in, void **bytes, size_t *size, vit_text *why) {
    *bytes = NULL;
    *size = 0;
    if (!in->data[VIT_SECTION_META])
        return bake_fail(why, VIT_BAD_INPUT, "pack: section META: missing");
    vit_pack_entry table[VIT_SECTION_COUNT];
    uint64_t total = 0;
    vit_status status = lay_out(in->data[VIT_SECTION_META], table, &total, why);
    if (status != VIT_OK)
        return status;
    /* On a page, so that records lie as they will in a mapped file; zero: the gaps are part of the format. */
    const size_t room = ((size_t)total + VIT_PACK_ALIGN - 1) / VIT_PACK_ALIGN * VIT_PACK_ALIGN;
    unsigned char *image = aligned_alloc(VIT_PACK_ALIGN, room);
    if (image)
        memset(image, 0, room);
    else
        return bake_fail(why, VIT_FAILED, "pack: out of memory for %llu bytes", (unsigned long long)total);
    for (int i = 0; i < VIT_SECTION_COUNT; i++) {
        if (table[i].size > 0 && !in->data[i]) {
            free(image);
            return bake_fail(why, VIT_BAD_INPUT, "pack: section %.4s: missing", table[i].code);
        }
        if (table[i].size > 0)
            memcpy(image + table[i].offset, in->data[i], (size_t)table[i].size);
        table[i].hash = vit_hash(image + table[i].offset, (size_t)table[i].size);
    }
    const vit_pack_header header = {.magic = VIT_PACK_MAGIC,
                                    .version = VIT_PACK_VERSION,
                                    .sections = VIT_SECTION_COUNT,
                                    .size = total,
                                    .table_hash = vit_hash(table, sizeof table)};
    memcpy(image, &header, sizeof header);
    memcpy(image + sizeof header, table, sizeof table);
    *bytes = image;
    *size = (size_t)total;
    return VIT_OK;
}

/* A variable that outlives a call, as few do (those that signal handlers set, and cost/spread.c): a handler gets no argument,
 * and what it has to remove is the file that pack_save() is writing at that moment. `armed` is set only while `path` is
 * complete. */
static struct {
    volatile sig_atomic_t armed;
    char path[PATH_MAX];
} temporary;

void pack_abandon(void) {
    if (temporary.armed)
        unlink(temporary.path); /* async-signal-safe, as POSIX lists it */
}

/* Whoever writes a temporary file holds a lock on it: a file without one was left behind by a killed process. False as well
 * where there are no locks; nothing is then ever removed. */
static bool lock(int file) {
    const struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    return fcntl(file, F_SETLK, &whole) == 0;
}

/* "NAME.tmp-PID-N". */
static bool is_temporary_of(const char *name, const char *entry) {
    const size_t length = strlen(name);
    if (strncmp(entry, name, length) != 0 || strncmp(entry + length, ".tmp-", 5) != 0)
        return false;
    const char *pid = entry + length + 5, *n = pid + strspn(pid, "0123456789");
    return n > pid && *n == '-' && n[1] && n[1 + strspn(n + 1, "0123456789")] == '\0';
}

static void folder_of(const char *path, char folder[PATH_MAX]) {
    const char *slash = strrchr(path, '/');
    snprintf(folder, PATH_MAX, "%.*s", slash ? (int)(slash - path) + 1 : 1, slash ? path : ".");
}

/* Is the file empty or does it begin as packs do? Nothing else under such a name is ours, whoever may have given it. */
static bool begins_as_pack(int file) {
    char start[sizeof VIT_PACK_MAGIC];
    const ssize_t n = pread(file, start, sizeof start, 0);
    return n == 0 || (n == (ssize_t)sizeof start && memcmp(start, VIT_PACK_MAGIC, sizeof start) == 0);
}

/* Removes what killed processes have left of `path`. */
static void remove_left_behind(const char *path) {
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/');
    folder_of(path, folder);
    DIR *d = opendir(folder);
    for (struct dirent *e = d ? readdir(d) : NULL; e; e = readdir(d)) {
        if (!is_temporary_of(slash ? slash + 1 : path, e->d_name))
            continue;
        const int file = openat(dirfd(d), e->d_name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
        if (file >= 0 && begins_as_pack(file) && lock(file))
            unlinkat(dirfd(d), e->d_name, 0);
        if (file >= 0)
            close(file);
    }
    if (d)
        closedir(d);
}

/* Locks a new file, unless another process has taken it for left behind in between. */
static bool claim(int file) {
    struct stat there;
    (void)lock(file);
    return fstat(file, &there) == 0 && there.st_nlink > 0;
}

/* Creates and locks "PATH.tmp-PID-N" with the least free N; never opens a file that is there. Returns -1 and errno. */
static int create_temporary(const char *path) {
    for (int n = 0; n < 100; n++) {
        const int length = snprintf(temporary.path, sizeof temporary.path, "%s.tmp-%ld-%d", path, (long)getpid(), n);
        if (length < 0 || (size_t)length >= sizeof temporary.path) {
            errno = ENAMETOOLONG;
            return -1;
        }
        temporary.armed = 1; /* before open: a signal between the two must not leave the file behind */
        const int file = open(temporary.path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0 && claim(file))
            return file;
        temporary.armed = 0;
        if (file >= 0)
            close(file);
        else if (errno != EEXIST && errno != EINTR)
            return -1;
    }
    return -1;
}

static bool write_all(int file, const unsigned char *bytes, size_t size) {
    const size_t most = (size_t)1 << 30; /* some systems refuse a write of 2 GiB */
    while (size > 0) {
        const ssize_t written = write(file, bytes, size < most ? size : most);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return false;
        bytes += written;
        size -= (size_t)written;
    }
    return true;
}

/* The new name lasts over a power cut only when the folder is on the disk as well. A folder that cannot be opened for
 * reading, or a file system without the notion (EINVAL), does not make the pack bad. */
static bool sync_folder(const char *path) {
    char folder[PATH_MAX];
    folder_of(path, folder);
    const int directory = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory < 0)
        return true;
    const bool synced = fsync(directory) == 0 || errno == EINVAL;
    const int error = errno;
    close(directory);
    errno = error;
    return synced;
}

/* The cause must not fall off the end of the line, so a long path loses its beginning. */
static vit_status fail_file(vit_text *why, const char *path, const char *step, int error) {
    const size_t length = strlen(path), most = sizeof why->text / 2;
    return bake_fail(why, VIT_FAILED, "%s%s: %s%s%s", length > most ? "..." : "", length > most ? path + length - most : path,
                     step, error ? ": " : "", error ? strerror(error) : "");
}

/* Returns the step that failed, with errno, or NULL. Closes `file` in any case, and last of all, since its lock goes with it.
 */
static const char *fill_and_rename(int file, const char *path, const void *bytes, size_t size) {
    const char *failed = NULL;
    if (!write_all(file, bytes, size))
        failed = "write";
    else if (fsync(file) != 0)
        failed = "fsync";
    else if (rename(temporary.path, path) != 0)
        failed = "rename";
    const int error = errno;
    if (failed)
        unlink(temporary.path);
    temporary.armed = 0;
    close(file); /* all is on the disk by now */
    errno = error;
    return failed;
}

/* rename() would replace a device, leave whoever reads a pipe waiting, and not ask whether the file may be written. */
static vit_status check_there(const char *path, vit_text *why) {
    struct stat there;
    if (stat(path, &there) != 0)
        return lstat(path, &there) != 0 ? VIT_OK : fail_file(why, path, "is a link that leads nowhere", 0);
    if (S_ISDIR(there.st_mode))
        return fail_file(why, path, "is a folder, not a regular file", 0);
    if (!S_ISREG(there.st_mode))
        return fail_file(why, path, "not a regular file", 0);
    if (access(path, W_OK) != 0)
        return fail_file(why, path, "cannot be written", errno);
    return there.st_mode & (S_IWUSR | S_IWGRP | S_IWOTH)
               ? VIT_OK
               : fail_file(why, path, "is read-only", 0); /* root may, but is not meant to */
}

vit_status pack_can_save(const char *path, vit_text *why) {
    static const unsigned char page[VIT_PACK_ALIGN] = VIT_PACK_MAGIC; /* as what a killed process leaves */
    vit_status status = check_there(path, why);
    if (status != VIT_OK)
        return status;
    const int file = create_temporary(path);
    if (file < 0)
        return fail_file(why, path, "cannot create a file there", errno);
    const bool fine = write_all(file, page, sizeof page);
    const int error = errno;
    unlink(temporary.path);
    temporary.armed = 0;
    close(file);
    return fine ? VIT_OK : fail_file(why, path, "write", error);
}

vit_status pack_can_make(const char *folder, const char *name, vit_text *why) {
    char path[PATH_MAX];
    struct stat there;
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/')
        length--;
    for (;;) {
        if (length + strlen(name) + 2 > sizeof path)
            return fail_file(why, folder, strerror(ENAMETOOLONG), 0);
        (void)snprintf(path, sizeof path, "%.*s", (int)length, folder);
        if (stat(length ? path : ".", &there) == 0)
            break;
        if (errno != ENOENT)
            return fail_file(why, folder, "cannot make this folder", errno);
        name = "vitrine"; /* the folder that is there may hold a file of that name, which is not ours */
        while (length > 0 && folder[length - 1] != '/') /* the folder above */
            length--;
        while (length > 1 && folder[length - 1] == '/')
            length--;
    }
    if (!S_ISDIR(there.st_mode))
        return fail_file(why, path, "is there and is not a folder", 0);
    (void)snprintf(path + length, sizeof path - length, "%s%s", length > 0 && path[length - 1] != '/' ? "/" : "", name);
    return pack_can_save(path, why);
}

vit_status pack_save(const char *path, const void *bytes, size_t size, vit_text *why) {
    char target[PATH_MAX];
    const vit_status status = check_there(path, why);
    if (status != VIT_OK)
        return status;
    if (realpath(path, target)) /* where a link leads: rename() would replace the link */
        path = target;
    remove_left_behind(path);
    const int file = create_temporary(path);
    if (file < 0)
        return fail_file(why, path, "cannot create a file there", errno);
    const char *failed = fill_and_rename(file, path, bytes, size);
    if (failed)
        return fail_file(why, path, failed, errno);
    return sync_folder(path) ? VIT_OK : fail_file(why, path, "fsync of the folder", errno);
}
