#include "verify.h"
#include "failure.h"
#include "sinks/output.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

vit_status verdict_begin(const verdict *d, const vit *v, uint32_t first, uint32_t end, vit_text *why) {
    if (!d->compare)
        return VIT_OK;
    for (uint32_t i = first; i < end; i++)
        if (vit_golden(v, i) == 0)
            return play_fail(why, VIT_MISMATCH, "the pack holds no golden hashes for this format (frame %u)", i);
    return VIT_OK;
}

bool verdict_hashes(const verdict *d) {
    return d->compare || d->print || d->hashes != NULL;
}

vit_status verdict_frame(verdict *d, const vit *v, uint32_t index, const void *pixels, size_t bytes, vit_text *why) {
    if (!verdict_hashes(d))
        return VIT_OK;
    uint64_t hash = vit_hash_frame(pixels, d->format, bytes);
    if (d->hashes != NULL)
        d->hashes[index - d->begin] = hash;
    if (d->compare || d->golden != NULL) {
        const uint64_t packs = d->compare ? vit_golden(v, index) : hash,
                       files = d->golden != NULL ? d->golden[index - d->begin] : hash;
        d->checked++;
        if ((hash != packs || hash != files) && d->differing++ == 0) {
            d->first = index;
            d->expected = hash != packs ? packs : files;
            d->got = hash;
        }
    }
    if (!d->print)
        return VIT_OK;
    (void)printf("%06" PRIu32 " %016" PRIx64 "\n", index, hash);
    return output_flush_stdout(why); /* a frame is seen when it is done, and a closed pipe ends the playing */
}

vit_status verdict_end(const verdict *d, vit_text *why) {
    if (d->differing == 0)
        return VIT_OK;
    return play_fail(why, VIT_MISMATCH,
                     "frame %" PRIu32 ": expected %016" PRIx64 ", got %016" PRIx64 " (%" PRIu64 " of %" PRIu64
                     " frames differ)",
                     d->first, d->expected, d->got, d->differing, d->checked);
}

static void print_pass(void *user, const char *pass, uint64_t hash) {
    const uint32_t *index = user;
    (void)printf("%06" PRIu32 " %s %016" PRIx64 "\n", *index, pass, hash);
}

vit_status trace_frames(vit *v, const vit_requirements *need, uint32_t first, uint32_t end, const volatile sig_atomic_t *stop,
                        uint64_t *done, vit_text *why) {
    uint64_t largest = 0;
    for (uint32_t i = 0; i < need->buffer_count; i++)
        if (need->buffers[i].bytes > largest)
            largest = need->buffers[i].bytes;
    void *scratch = largest < SIZE_MAX ? malloc((size_t)largest + 1) : NULL; /* + 1: never malloc(0), which may be NULL */
    if (scratch == NULL)
        return play_fail(why, VIT_FAILED, "--trace: out of memory for %" PRIu64 " bytes", largest);
    vit_status status = VIT_OK;
    for (uint32_t i = first; i < end && status == VIT_OK && !*stop; i++) {
        status = vit_trace(v, i, scratch, (size_t)largest, print_pass, &i, why);
        if (status == VIT_OK)
            status = output_flush_stdout(why);
        if (status == VIT_OK)
            (*done)++;
    }
    free(scratch);
    return status;
}
