/* Where frames go. A sink is a row of functions in a file of its own; sink.c holds the table. To add one: write the
 * file, add a line to SINKS. Nothing else in the player knows a sink by name. */
#ifndef VIT_PLAY_SINK_H
#define VIT_PLAY_SINK_H

#include "vitrine.h"
#include <stdbool.h>

typedef struct sink_setup {
    const char *target;     /* the text after "KIND:"; "" if the kind takes none */
    uint32_t width, height; /* pixels */
    double fps;             /* frames per second */
    size_t frame_bytes;     /* a tightly packed frame in the asked format */
} sink_setup;

typedef enum sink_writes {
    SINK_NOTHING,
    SINK_STREAM, /* frames one after another into a file, or to stdout if the target is "-" */
    SINK_FILE,   /* one file */
    SINK_FOLDER, /* a file a frame, which end as the sink is named */
} sink_writes;

/* A sink's own memory for frames, as vit_open_info takes it. */
typedef struct sink_memory {
    void *pixels; /* aligned to 64 bytes */
    size_t pitch; /* bytes from one row to the next */
    size_t size;  /* bytes */
} sink_memory;

typedef struct sink_kind {
    const char *name;
    const char *target; /* how --help writes the target; NULL: takes none */
    const char *meaning;
    sink_writes writes;
    bool any_format; /* false: XRGB8888 only */
    /* Makes the sink's own state. Whatever fails: VIT_FAILED or VIT_USAGE, a text that names the file, nothing to close. */
    vit_status (*open)(const sink_setup *setup, void **state, vit_text *why);
    /* The memory that frames are to be rendered into, until close(); the sink is then opened before the pack is. NULL: it lends
     * none, and is opened last, when nothing else can fail any more. */
    sink_memory (*lend)(void *state);
    /* `pixels`: frame `index` of the path, tightly packed; of a sink that lends, NULL: it is there. All is written, or the text
     * says why not. */
    vit_status (*write)(void *state, const void *pixels, uint32_t index, vit_text *why);
    /* Frees the state even if it fails: the last write of a file can fail as late as this. */
    vit_status (*close)(void *state, vit_text *why);
} sink_kind;

/* In the order of --help; the first is the default. */
#define SINKS(X) X(null) X(raw) X(map) X(y4m) X(ppm) X(png)

#define X(name) extern const sink_kind sink_##name;
SINKS(X)
#undef X
enum {
#define X(name) +1
    SINK_COUNT = 0 SINKS(X)
#undef X
};

/* The kind of row `index`; NULL beyond the last. */
const sink_kind *sink_at(uint32_t index);
/* True if frames of `kind` and `target` leave through stdout. */
bool sink_uses_stdout(const sink_kind *kind, const char *target);

#endif
