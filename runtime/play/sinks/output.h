/* output.c: the files, folders and stdout that sinks write to. Every write is checked; texts name the file. */
#ifndef VIT_PLAY_OUTPUT_H
#define VIT_PLAY_OUTPUT_H

#include "vitrine.h"
#include <stdbool.h>

#define OUTPUT_PATH_SIZE 4096 /* longer paths are refused: Linux's own limit */

/* A file, or stdout, that is written front to back. */
typedef struct output {
    int fd;
    bool is_stdout;
    const char *path; /* the caller's, must outlive this; "stdout" for stdout */
} output;

/* `path` "-" is stdout; a file is made, or emptied if there is one. */
vit_status output_open(const char *path, output *out, vit_text *why);
vit_status output_write(const output *o, const void *bytes, size_t size, vit_text *why);
vit_status output_close(output *o, vit_text *why);

/* Makes `path` and the folders above it where they are missing. */
vit_status output_folder(const char *path, vit_text *why);
/* Writes folder/frame_00012.extension under another name and renames it: who finds the file finds it whole. */
vit_status output_frame_file(const char *folder, uint32_t index, const char *extension, const void *bytes, size_t size,
                             vit_text *why);

/* Where `path` leads if it is a symbolic link, or one to others: a link is followed, not replaced, also to a file that is not
 * there yet. Else `path` itself. */
void output_follow(const char *path, char target[OUTPUT_PATH_SIZE]);
/* Does output_file() replace `target`, where `path` leads? Else it writes to what is there: a device, a pipe, a file without a
 * name, or what is this program's stdout or stderr (/dev/stdout), which would go on into a file without a name. */
bool output_replaces(const char *path, char target[OUTPUT_PATH_SIZE]);

/* Writes a whole file in the same way, if it is a plain one. */
vit_status output_file(const char *path, const void *bytes, size_t size, vit_text *why);

/* Flushes what was printed to stdout and says whether all of it arrived. */
vit_status output_flush_stdout(vit_text *why);

#endif
