/* map: the frame at hand, in a file that other programs map: frames are rendered into it where the device shares the host's
 * memory. Rows begin at multiples of 64 bytes, as those of display memory do. What follows a frame replaces it in place, so a
 * reader may see parts of two. */
#include "sink.h"
#include "../failure.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum { ROW_ALIGNMENT = 64 }; /* a cache line; a multiple of every format's pixel */

typedef struct map_state {
    const char *path;
    int fd;
    bool made;  /* there was no such file */
    bool shown; /* it holds a frame */
    sink_memory memory;
} map_state;

static vit_status failed(const char *path, int error, vit_text *why) {
    return play_fail(why, VIT_FAILED, "%s: %s", path, strerror(error));
}

/* The file is exactly as long as a frame, and has its room on the disk: a page without would end the program when it is
 * written. */
static int take_room(int fd, size_t size) {
    struct stat s;
    int error;
    if (fstat(fd, &s) != 0)
        return errno;
    if (!S_ISREG(s.st_mode)) /* a device has its size */
        return 0;
    do
        error = posix_fallocate(fd, 0, (off_t)size);
    while (error == EINTR);
    return error != 0 ? error : ftruncate(fd, (off_t)size) != 0 ? errno : 0;
}

/* Maps an open file; 0 or errno. */
static int map_file(map_state *s) {
    const int error = take_room(s->fd, s->memory.size);
    if (error != 0)
        return error;
    s->memory.pixels = mmap(NULL, s->memory.size, PROT_READ | PROT_WRITE, MAP_SHARED, s->fd, 0);
    return s->memory.pixels != MAP_FAILED ? 0 : errno;
}

static vit_status map_open(const sink_setup *setup, void **state, vit_text *why) {
    struct stat there;
    map_state *s = calloc(1, sizeof *s);
    if (s == NULL)
        return play_fail(why, VIT_FAILED, "map: out of memory");
    s->path = setup->target;
    s->memory.pitch = (setup->frame_bytes / setup->height + ROW_ALIGNMENT - 1) / ROW_ALIGNMENT * ROW_ALIGNMENT;
    s->memory.size = s->memory.pitch * setup->height;
    s->made = stat(s->path, &there) != 0;
    s->fd = open(s->path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    const int error = s->fd < 0 ? errno : map_file(s);
    if (error == 0) {
        *state = s;
        return VIT_OK;
    }
    if (s->fd >= 0) {
        (void)close(s->fd);
        if (s->made)
            (void)unlink(s->path);
    }
    vit_status status = failed(s->path, error, why);
    free(s);
    return status;
}

static sink_memory map_lend(void *state) {
    const map_state *s = state;
    return s->memory;
}

static vit_status map_write(void *state, const void *pixels, uint32_t index, vit_text *why) {
    map_state *s = state;
    (void)pixels; /* are there already */
    (void)index;
    (void)why;
    s->shown = true;
    return VIT_OK;
}

static vit_status map_close(void *state, vit_text *why) {
    map_state *s = state;
    int error = msync(s->memory.pixels, s->memory.size, MS_SYNC) != 0 ? errno : 0;
    (void)munmap(s->memory.pixels, s->memory.size);
    if (close(s->fd) != 0 && errno != EINTR && error == 0)
        error = errno;
    if (s->made && !s->shown) /* the run failed before its first frame */
        (void)unlink(s->path);
    vit_status status = error != 0 ? failed(s->path, error, why) : VIT_OK;
    free(s);
    return status;
}

const sink_kind sink_map = {
    .name = "map",
    .target = "FILE",
    .meaning = "the frame at hand, for programs that map FILE; rows begin at multiples of 64 bytes",
    .writes = SINK_FILE,
    .any_format = true,
    .open = map_open,
    .lend = map_lend,
    .write = map_write,
    .close = map_close,
};
