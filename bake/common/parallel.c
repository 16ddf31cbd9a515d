#include "common/parallel.h"
#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

#define MOST_CHUNK 64u /* items that a thread takes at a time; fewer where that would leave threads idle */
#define CHUNKS 16u     /* a thread takes, at least */
#define MAX_THREADS 256u

typedef struct work {
    void (*run)(void *user, uint32_t item);
    void *user;
    uint32_t items, chunk;
    atomic_uint next; /* chunk */
} work;

static void *worker(void *user) {
    work *w = user;
    for (;;) {
        const uint64_t first = (uint64_t)atomic_fetch_add(&w->next, 1) * w->chunk;
        for (uint64_t i = first; i < first + w->chunk && i < w->items; i++)
            w->run(w->user, (uint32_t)i);
        if (first + w->chunk >= w->items)
            return NULL;
    }
}

void parallel_for(unsigned threads, uint32_t items, void (*run)(void *user, uint32_t item), void *user) {
    pthread_t pool[MAX_THREADS];
    unsigned started = 0;
    work w = {.run = run, .user = user, .items = items};
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    if (threads == 0)
        threads = cores > 0 ? (unsigned)cores : 1;
    w.chunk = items / threads / CHUNKS;
    w.chunk = w.chunk < 1 ? 1 : w.chunk > MOST_CHUNK ? MOST_CHUNK : w.chunk;
    while (started + 1 < threads && started < MAX_THREADS && pthread_create(pool + started, NULL, worker, &w) == 0)
        started++;
    worker(&w);
    for (unsigned i = 0; i < started; i++)
        pthread_join(pool[i], NULL);
}
