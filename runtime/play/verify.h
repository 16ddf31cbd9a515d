/* verify.c: what frames hash to: --verify, --golden, --hash, --trace. */
#ifndef VIT_PLAY_VERIFY_H
#define VIT_PLAY_VERIFY_H

#include "vitrine.h"
#include <signal.h>
#include <stdbool.h>

typedef struct verdict {
    bool compare, print;    /* --verify, --hash */
    uint32_t begin;         /* first frame of the range */
    uint64_t *hashes;       /* of the range's frames, as last played; NULL: not kept */
    const uint64_t *golden; /* likewise, of --golden's file; NULL: not compared */
    vit_format format;      /* of the frames */
    uint64_t checked;       /* frames compared with a golden hash */
    uint64_t differing;     /* of these, not equal */
    uint32_t first;         /* frame of the first difference */
    uint64_t expected, got;
} verdict;

/* VIT_MISMATCH: the pack has no golden hash for a frame of first .. end - 1, in v's format. Nothing was rendered yet. */
vit_status verdict_begin(const verdict *d, const vit *v, uint32_t first, uint32_t end, vit_text *why);
/* Does verdict_frame() look at the pixels? */
bool verdict_hashes(const verdict *d);
/* Hashes a finished frame, if asked to; a difference is noted and is no failure yet. VIT_FAILED: stdout takes no more. */
vit_status verdict_frame(verdict *d, const vit *v, uint32_t index, const void *pixels, size_t bytes, vit_text *why);
/* VIT_MISMATCH: the text says which frame differed first. */
vit_status verdict_end(const verdict *d, vit_text *why);

/* Plays frames first .. end - 1 and prints "frame pass hash" lines on stdout; stops between frames once *stop is set. `done`
 * counts the frames. */
vit_status trace_frames(vit *v, const vit_requirements *need, uint32_t first, uint32_t end, const volatile sig_atomic_t *stop,
                        uint64_t *done, vit_text *why);

#endif
