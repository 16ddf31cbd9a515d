/* Vitrine: plays a baked scene with global illumination, the same bits on every device.
 *
 *     vit_requirements need;
 *     vit_text why;
 *     vit_open_info info = {.pack = bytes, .pack_size = size};
 *     if (vit_require(&info, &need, &why) != VIT_OK) ...;     // checks the whole pack, allocates nothing
 *     info.arena = aligned_alloc(64, need.host_bytes);  info.arena_size = need.host_bytes;
 *     vit *v;
 *     if (vit_open(&info, &v, &why) != VIT_OK) ...;           // all buffers and kernels are made here
 *     for (uint32_t i = 0; i < need.frames; i++)
 *         vit_frame(v, i, framebuffer, stride, &why);         // no allocation, no file, no read-back but the finished frame
 *     vit_close(v);
 *
 * The library never calls malloc, opens a file or prints; the OpenCL implementation below it may. One vit is used by one
 * thread at a time; several may be open at once. Conventions: metres, y up, right-handed; W, W/m2, W/(m2 sr).
 *
 * To link: cc program.c -lvitrine -lOpenCL -lpthread -lm   (built with OPENCL=0: without -lOpenCL)
 *      or: cc program.c $(pkg-config --cflags --libs vitrine), as `make install` puts it. */
#ifndef VITRINE_H
#define VITRINE_H

#include "vitrine_frame.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define VIT_VERSION "0.1.0"

/* Results, which are also the exit codes of all tools: X(name, value, meaning). */
#define VIT_STATUSES(X)                                                                                                        \
    X(OK, 0, "done")                                                                                                           \
    X(FAILED, 1, "failed (no device, out of memory, a write that failed)")                                                     \
    X(USAGE, 2, "usage: unknown option or value")                                                                              \
    X(BUDGET, 3, "budget missed")                                                                                              \
    X(MISMATCH, 4, "verification mismatch")                                                                                    \
    X(BAD_INPUT, 5, "bad input: scene, mesh, texture or pack")

typedef enum vit_status {
#define X(name, value, meaning) VIT_##name = value,
    VIT_STATUSES(X)
#undef X
} vit_status;

/* One line, without a line feed, that names the thing and the cause of what was not VIT_OK. Whoever does not want it gives NULL
 * for `why`. */
typedef struct vit_text {
    char text[512];
} vit_text;

/* What to open and how; zero means the default for every field but pack and arena. */
typedef struct vit_open_info {
    const void *pack;  /* the whole file, 8-byte aligned (a page, as mmap gives, is faster); must outlive the vit */
    size_t pack_size;  /* bytes */
    void *arena;       /* host memory for the library, 64-byte aligned, at least vit_requirements.host_bytes */
    size_t arena_size; /* bytes */
    uint32_t device;   /* index as vit_device_name() counts; 0: the first of OpenCL; VIT_DEVICE_HOST */
    uint32_t threads;  /* VIT_DEVICE_HOST: 1 to 256; 0: one a processor. Changes no bit */
    const char
        *host_isa; /* VIT_DEVICE_HOST: "baseline" or, on x86-64, "avx2", "avx512"; NULL: the best. Changes no bit (tests) */
    uint32_t wide_divide; /* OpenCL, 1: floats are divided as doubles also where the device rounds rightly by itself. Changes no
                             bit (tests) */
    uint32_t lanes;       /* samples per work-item: 1, 8 or 16; 0: what suits the device. Changes no bit */
    uint32_t group;       /* work-items a work-group: 1..256, a power of two; 0: what suits. Changes no bit */
    vit_format format;
    vit_view view;
    void *framebuffer; /* optional: the caller's memory for frames (a mapped /dev/fb0, a window, a file), aligned to 64 bytes,
                        * alive until vit_close(). Where the device shares the host's memory, frames are rendered into it in
                        * place: give vit_frame() the same pointer and pitch. vit_open() may leave a frame there, too; bytes
                        * between rows are never touched */
    size_t framebuffer_pitch; /* bytes from one row of it to the next: whole pixels; 0: tightly packed */
    size_t framebuffer_size;  /* its bytes, (height - 1) * pitch + a row at least; 0: that many */
    uint32_t profile;         /* 1: time each pass (vit_statistics.pass_ms) */
    uint32_t count_work;   /* 1: count each pass's work (vit_statistics.pass_work); frames are slower and have the same bits */
    uint32_t record_reach; /* 1: record what the rays of each frame reach (vit_reached); the same bits (baker) */
    uint32_t max_nodes;    /* not 0: lower or raise this bound of the pack (tests, baker) */
    uint32_t max_list;     /* likewise */
} vit_open_info;

/* One row a buffer: its name, bytes and effect, from the runtime's own table. */
typedef struct vit_buffer_info {
    const char *name;
    const char *effect; /* what calls for it */
    uint64_t bytes;
} vit_buffer_info;

#define VIT_MAX_BUFFERS 96
#define VIT_MAX_PASSES 64
#define VIT_MAX_WORKS 16

typedef struct vit_requirements {
    uint32_t width, height; /* pixels */
    uint32_t frames;
    float fps;
    uint64_t effects;  /* of the pack: vitrine_pack.h has their bits */
    size_t host_bytes; /* arena; with VIT_DEVICE_HOST buffers too, but not what is used in place: the pack's sections and, if
                        * it was given, vit_open_info.framebuffer. Big-endian machines: also a copy of the sections */
    uint64_t device_bytes; /* sum of buffers[].bytes */
    uint32_t buffer_count;
    vit_buffer_info buffers[VIT_MAX_BUFFERS];
    uint32_t pass_count; /* passes of a frame, in order */
    const char *passes[VIT_MAX_PASSES];
    size_t frame_bytes; /* tightly packed framebuffer in the asked format */
} vit_requirements;

/* Counters, work and times of the last frame; extremes and what was dropped since vit_open. Equal on every device but for times
 * and `lanes`. */
typedef struct vit_statistics {
    uint64_t frames;                                         /* frames rendered since vit_open */
    const char *indirect;                                    /* the effect that makes indirect light; NULL: there is none */
    uint32_t nodes, clusters, photons, list, pairs, largest; /* last frame: see VIT_COUNTERS in counters.clh */
    uint32_t slice_min, slice_max;                           /* last frame */
    uint32_t max_nodes, max_list;                            /* largest wish of any frame since vit_open */
    uint64_t dropped_samples, dropped_entries;               /* all frames: overflow of a bound */
    uint32_t pass_count;
    const char *pass_names[VIT_MAX_PASSES];
    double pass_ms[VIT_MAX_PASSES]; /* last frame; 0 unless opened with profile */
    uint32_t lanes;                 /* samples per work-item, in use */
    uint32_t work_count;            /* kinds of work; 0 unless opened with count_work */
    const char *work_names[VIT_MAX_WORKS];
    int work_same[VIT_MAX_WORKS];                      /* 1: equal on every device; 0: compare at equal `lanes` only */
    uint64_t pass_work[VIT_MAX_PASSES][VIT_MAX_WORKS]; /* last frame, exact; kinds: VIT_WORKS in counters.clh */
} vit_statistics;

typedef struct vit vit;

/* The built-in device: the kernels compiled as C and run by threads, needs no OpenCL. Its buffers lie in the arena. */
#define VIT_DEVICE_HOST 0xffffffffu

/* "OpenCL platform / device / driver" of device `index`, or of VIT_DEVICE_HOST; NULL beyond the last of OpenCL. The text lives
 * in `why`; with NULL for that it is empty. */
const char *vit_device_name(uint32_t index, vit_text *why);

/* The device that `name` means: a number, as vit_device_name() counts; "host"; "gpu" or "cpu", as OpenCL has it; or a part of
 * what vit_device_name() says, in upper or lower case, of the platform's name before the rest ("nvidia"; "pocl" is PoCL's).
 * Numbers are not stable: they follow the order in which OpenCL's loader finds platforms. VIT_FAILED: there is none. VIT_USAGE:
 * it means several that do not have the same name, or is empty. The text lists what there is. */
vit_status vit_device_find(const char *name, uint32_t *index, vit_text *why);

/* 0, the first device of OpenCL; VIT_DEVICE_HOST if there is none. */
uint32_t vit_device_default(void);

/* Checks the pack wholly and says what vit_open() will take. Allocates nothing; `arena` may be NULL.
 * VIT_BAD_INPUT: the text names section and cause. VIT_USAGE: an option is out of range. */
vit_status vit_require(const vit_open_info *info, vit_requirements *need, vit_text *why);

/* Checks again, builds the kernels, makes every buffer, and lets the device run what it does at a kernel's first run only, so
 * that the first vit_frame() takes no longer than the next. VIT_FAILED: no such device, out of device memory, a build error.
 * VIT_USAGE: an option is out of range, also of what the device can do (group). */
vit_status vit_open(const vit_open_info *info, vit **out, vit_text *why);

/* Renders frame `index` (0 .. frames - 1) into `framebuffer`, rows `stride` bytes apart, and waits for it. Without a copy if
 * these are vit_open_info's framebuffer and its pitch. A NULL framebuffer renders without the transfer. */
vit_status vit_frame(vit *v, uint32_t index, void *framebuffer, size_t stride, vit_text *why);

/* Golden hash of frame `index` in the format that `v` was opened with, to compare with vit_hash_frame(); 0 if the pack holds
 * none. */
uint64_t vit_golden(const vit *v, uint32_t index);

/* XXH3-64 of tightly packed rows, `bytes` bytes in all, as little-endian machines have them: equal on every machine. */
uint64_t vit_hash_frame(const void *pixels, vit_format format, size_t bytes);

/* XXH3-64 of `bytes` bytes as they are. On little-endian machines vit_hash_frame() is this. */
uint64_t vit_hash(const void *data, size_t bytes);

/* Reads the counters back: not for the frame loop. */
vit_status vit_stats(vit *v, vit_statistics *out, vit_text *why);

/* What the last frame's rays reached, with record_reach: VIT_REACHED_* bits (counters.clh) a material, and of VIT_REACHED_MORE
 * other things after them. VIT_USAGE: `count` is not their number, or it was not asked for. Not for the frame loop. */
vit_status vit_reached(vit *v, uint32_t *words, uint32_t count, vit_text *why);

/* What went wrong in a frame without ending the program, or ended it. */
typedef struct vit_fault {
    const char *level;   /* "warning": the frame was shown; "error": it was not */
    const char *code;    /* a word */
    const char *pass;    /* that noticed it; NULL: none */
    const char *meaning; /* one line */
    uint32_t frame;      /* index */
    uint64_t count;      /* how many of what the meaning says */
} vit_fault;

#define VIT_MAX_FAULTS 64

/* The latest faults since vit_open, those of the frames first, then those of the device; not for the frame loop. *lost: 1 if
 * older ones were forgotten. VIT_FAILED: the device cannot be asked any more; `out` then holds what the host knows. */
vit_status vit_faults(vit *v, vit_fault out[VIT_MAX_FAULTS], uint32_t *count, int *lost, vit_text *why);

/* Renders frame `index` and calls `pass` after each pass with a hash of what the pass wrote, equal on machines of either byte
 * order. For finding the pass in which two devices part; slow. `scratch` holds the largest buffer (vit_requirements.buffers).
 */
typedef void vit_trace_fn(void *user, const char *pass, uint64_t hash);
vit_status vit_trace(vit *v, uint32_t index, void *scratch, size_t scratch_size, vit_trace_fn *pass, void *user, vit_text *why);

/* Frees the device's objects; NULL is allowed. The arena stays the caller's. */
void vit_close(vit *v);

#ifdef __cplusplus
}
#endif

#endif
