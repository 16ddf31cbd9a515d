/* What of the disk Assimp gets to see: plain files, to be read. Each that it opens is noted, and earns time and memory. */
#include "import/assimp/assimp_scene.h"
#include <assimp/cfileio.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static size_t read_some(struct aiFile *f, char *to, size_t size, size_t count) {
    return size ? fread(to, size, count, (FILE *)(void *)f->UserData) : 0;
}

static size_t write_nothing(struct aiFile *f, const char *from, size_t size, size_t count) {
    (void)f;
    (void)from;
    (void)size;
    (void)count;
    return 0;
}

static size_t tell(struct aiFile *f) {
    const long at = ftell((FILE *)(void *)f->UserData);
    return at < 0 ? 0 : (size_t)at;
}

static size_t size_of(struct aiFile *f) {
    struct stat s;
    return fstat(fileno((FILE *)(void *)f->UserData), &s) == 0 && s.st_size > 0 ? (size_t)s.st_size : 0;
}

static enum aiReturn seek(struct aiFile *f, size_t offset, enum aiOrigin origin) {
    const int from = origin == aiOrigin_SET ? SEEK_SET : origin == aiOrigin_CUR ? SEEK_CUR : SEEK_END;
    return fseek((FILE *)(void *)f->UserData, (long)offset, from) == 0 ? aiReturn_SUCCESS : aiReturn_FAILURE;
}

static void flush_nothing(struct aiFile *f) {
    (void)f;
}

/* A pipe without a writer must not be waited for, and a device has no end. */
static FILE *open_plain(const char *path, size_t *size) {
    struct stat s;
    const int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    FILE *file = fd >= 0 && fstat(fd, &s) == 0 && S_ISREG(s.st_mode) ? fdopen(fd, "rb") : NULL;
    if (!file && fd >= 0)
        (void)close(fd);
    *size = file ? (size_t)s.st_size : 0;
    return file;
}

static struct aiFile *open_file(struct aiFileIO *io, const char *path, const char *mode) {
    assimp_scene *a = (assimp_scene *)(void *)io->UserData;
    size_t bytes;
    FILE *file = strpbrk(mode, "wa+") ? NULL : open_plain(path, &bytes);
    struct aiFile *f = file ? malloc(sizeof *f) : NULL;
    if (!f) {
        if (file)
            (void)fclose(file);
        return NULL;
    }
    *f = (struct aiFile){.ReadProc = read_some,
                         .WriteProc = write_nothing,
                         .TellProc = tell,
                         .FileSizeProc = size_of,
                         .SeekProc = seek,
                         .FlushProc = flush_nothing,
                         .UserData = (char *)(void *)file};
    import_note_file(a->im, path, bytes);
    return f;
}

static void close_file(struct aiFileIO *io, struct aiFile *f) {
    (void)io;
    if (f) {
        (void)fclose((FILE *)(void *)f->UserData);
        free(f);
    }
}

struct aiFileIO assimp_files(assimp_scene *a) {
    return (struct aiFileIO){.OpenProc = open_file, .CloseProc = close_file, .UserData = (char *)(void *)a};
}
