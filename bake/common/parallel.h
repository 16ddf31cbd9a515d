/* parallel.c: one function over many items on all threads. */
#ifndef VIT_BAKE_PARALLEL_H
#define VIT_BAKE_PARALLEL_H

#include <signal.h>
#include <stdbool.h>
#include <stdint.h>

/* Calls run(user, item) for all items, in any order, on `threads` threads (0: all cores), this one included; on fewer if the
 * system gives no more. An item's result must depend on the item alone. */
void parallel_for(unsigned threads, uint32_t items, void (*run)(void *user, uint32_t item), void *user);

/* The same with progress, cancellation and a sum, for chunks of work that take long. */
typedef struct parallel_work {
    void (*run)(void *user, uint32_t chunk, uint64_t *sum); /* by any thread; must not care for the order; adds to *sum */
    void (*done)(void *user, double fraction);              /* by the calling thread, now and then; may be NULL */
    void *user;
    uint32_t first, step, count;         /* chunks first, first + step, ... below count */
    unsigned threads;                    /* 0: all cores */
    const volatile sig_atomic_t *cancel; /* may be NULL */
} parallel_work;

/* Returns when all chunks are done. False: cancelled, some were not. `sum` is added to. */
bool parallel_run(const parallel_work *w, uint64_t *sum);
/* 0: as many as there are cores, shared among `sharing` processes; at least 1. */
unsigned parallel_threads(unsigned asked, unsigned sharing);

#endif
