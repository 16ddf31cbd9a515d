/* timing.c: milliseconds of many settings, measured in turns so that a drift of the machine hits all of them alike. */
#ifndef VIT_COST_TIMING_H
#define VIT_COST_TIMING_H

#include "report/results.h"
#include <signal.h>

/* One setting. */
typedef struct timing_entry {
    const char *name;
    const void *pack;
    size_t pack_size;
    uint32_t lanes;
    double *ms;          /* out, `repeats` values: a frame from its call to its end */
    double *pass_ms;     /* out, repeats * VIT_MAX_PASSES values: repeat by repeat */
    uint32_t pass_count; /* out */
    char pass_names[VIT_MAX_PASSES][32];
} timing_entry;

typedef struct timing_input {
    timing_entry *entries;
    uint32_t count;
    uint32_t device;
    uint32_t repeats; /* rounds: in each, every entry plays one frame; the next round the next frame of the pack */
    void (*progress)(void *user, double fraction);
    void *user;
    void (*between)(void *other); /* called once a round, in turn with the entries; may be NULL */
    void *other;
    const volatile sig_atomic_t *cancel;
} timing_input;

/* Opens all packs (XRGB8888, rendered in place where the device can), plays all frames of each once, compares their hashes with
 * the pack's, and only then measures. VIT_MISMATCH: a hash differs. VIT_FAILED: out of memory, cancelled. */
vit_status timing_measure(const timing_input *in, vit_text *why);

/* Of `count` >= 1 values, in any order: they get sorted. */
double timing_median(double *values, uint32_t count);
/* The least value that at least `percent` of them do not exceed. */
double timing_percentile(double *values, uint32_t count, double percent);
/* Median of |value - median|. */
double timing_deviation(double *values, uint32_t count);

#endif
