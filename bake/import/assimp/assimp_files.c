/* What of the disk Assimp gets to see: plain files, to be read. Each that it opens is noted, and earns time and memory. */
#include "import/assimp/assimp_scene.h"
#include <assimp/cfileio.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* One that is open; Assimp's UserData. */
typedef struct plain_file {
    FILE *file;
    char *text; /* its bytes as they are handed on, if they are not as they stand in it */
} plain_file;

static FILE *of(const struct aiFile *f) {
    return ((const plain_file *)(const void *)f->UserData)->file;
}

static size_t read_some(struct aiFile *f, char *to, size_t size, size_t count) {
    return size ? fread(to, size, count, of(f)) : 0;
}

static size_t write_nothing(struct aiFile *f, const char *from, size_t size, size_t count) {
    (void)f;
    (void)from;
    (void)size;
    (void)count;
    return 0;
}

static size_t tell(struct aiFile *f) {
    const long at = ftell(of(f));
    return at < 0 ? 0 : (size_t)at;
}

static size_t size_of(struct aiFile *f) {
    const long at = ftell(of(f));
    const long end = at >= 0 && fseek(of(f), 0, SEEK_END) == 0 ? ftell(of(f)) : -1;
    return at >= 0 && fseek(of(f), at, SEEK_SET) == 0 && end > 0 ? (size_t)end : 0;
}

static enum aiReturn seek(struct aiFile *f, size_t offset, enum aiOrigin origin) {
    const int from = origin == aiOrigin_SET ? SEEK_SET : origin == aiOrigin_CUR ? SEEK_CUR : SEEK_END;
    return fseek(of(f), (long)offset, from) == 0 ? aiReturn_SUCCESS : aiReturn_FAILURE;
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

/* Formats whose text is read, and mended, here before Assimp sees it. */
static bool is_mended(const char *path) {
    return import_has_suffix(path, ".dae") || import_has_suffix(path, ".x3d") || import_has_suffix(path, ".amf") ||
           import_has_suffix(path, ".off");
}

/* That text in memory, as Assimp can read it. What cannot be had so stays the file as it is. */
static void mend_text(assimp_scene *a, plain_file *f, const char *path, size_t bytes) {
    char *text = malloc(bytes + 1);
    size_t size = text ? fread(text, 1, bytes, f->file) : 0;
    const bool whole = size > 0 && size == bytes;
    if (whole && import_has_suffix(path, ".dae"))
        text = assimp_mend_collada(a, text, &size);
    else if (whole && import_has_suffix(path, ".x3d"))
        text = assimp_mend_x3d(a, text, &size);
    else if (whole && import_has_suffix(path, ".off"))
        assimp_read_off(a, text, size);
    else if (whole)
        text = assimp_read_amf(a, text, &size);
    FILE *mended = size > 0 ? fmemopen(text, size, "rb") : NULL;
    if (!mended) {
        free(text);
        rewind(f->file);
        return;
    }
    (void)fclose(f->file);
    *f = (plain_file){mended, text};
}

/* Somewhere in the file from where it stands; it is rewound. */
static bool has_word(FILE *file, const char *word) {
    char piece[1 << 14];
    const size_t length = strlen(word);
    size_t kept = 0, got;
    bool found = false;
    while (!found && (got = fread(piece + kept, 1, sizeof piece - kept, file)) > 0) {
        const size_t size = kept + got;
        for (size_t i = 0; !found && i + length <= size; i++)
            found = memcmp(piece + i, word, length) == 0;
        kept = size < length ? size : length - 1;
        memmove(piece, piece + size - kept, kept);
    }
    rewind(file);
    return found;
}

static struct aiFile *open_file(struct aiFileIO *io, const char *path, const char *mode) {
    assimp_scene *a = (assimp_scene *)(void *)io->UserData;
    size_t bytes;
    FILE *file = strpbrk(mode, "wa+") ? NULL : open_plain(path, &bytes);
    struct aiFile *f = file ? malloc(sizeof *f) : NULL;
    plain_file *plain = f ? calloc(1, sizeof *plain) : NULL;
    if (!plain) {
        if (file)
            (void)fclose(file);
        free(f);
        return NULL;
    }
    plain->file = file;
    import_note_file(a->im, path, bytes);
    if (import_has_suffix(path, ".fbx"))
        a->vertex_normals = has_word(file, "ByVertice");
    if (is_mended(path))
        mend_text(a, plain, path, bytes);
    *f = (struct aiFile){.ReadProc = read_some,
                         .WriteProc = write_nothing,
                         .TellProc = tell,
                         .FileSizeProc = size_of,
                         .SeekProc = seek,
                         .FlushProc = flush_nothing,
                         .UserData = (char *)(void *)plain};
    return f;
}

static void close_file(struct aiFileIO *io, struct aiFile *f) {
    (void)io;
    if (f) {
        plain_file *plain = (plain_file *)(void *)f->UserData;
        (void)fclose(plain->file);
        free(plain->text);
        free(plain);
        free(f);
    }
}

struct aiFileIO assimp_files(assimp_scene *a) {
    return (struct aiFileIO){.OpenProc = open_file, .CloseProc = close_file, .UserData = (char *)(void *)a};
}
