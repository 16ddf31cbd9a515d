/* chunks.c: one function over many chunks of work on all threads. */
#ifndef VIT_COST_CHUNKS_H
#define VIT_COST_CHUNKS_H

#include <signal.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct chunk_work {
    void (*run)(void *user, uint32_t chunk, uint64_t *rays); /* by any thread; must not care for the order; adds to *rays */
    void (*done)(void *user, double fraction);               /* by the calling thread, now and then; may be NULL */
    void *user;
    uint32_t first, step, count; /* chunks first, first + step, ... below count */
    unsigned threads;
    const volatile sig_atomic_t *cancel; /* may be NULL */
} chunk_work;

/* Returns when all chunks are done. False: cancelled, some were not. `rays` is added to. */
bool chunks_run(const chunk_work *w, uint64_t *rays);
/* 0: as many as there are cores, shared among `sharing` processes; at least 1. */
unsigned chunks_threads(unsigned asked, unsigned sharing);

#endif
