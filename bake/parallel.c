#include "parallel.h"
#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

#define CHUNK 64u /* items that a thread takes at a time */
#define MAX_THREADS 256u

typedef struct work {
    void (*run)(void *user, uint32_t item);
    void *user;
    uint32_t items;
    atomic_uint next; /* chunk */
} work;

static void *worker(void *user) {
    work *w = user;
    for (;;) {
        const uint64_t first = (uint64_t)atomic_fetch_add(&w->next, 1) * CHUNK;
        for (uint64_t i = first; i < first + CHUNK && i < w->items; i++)
            w->run(w->user, (uint32_t)i);
        if (first + CHUNK >= w->items)
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
    while (started + 1 < threads && started < MAX_THREADS && pthread_create(pool + started, NULL, worker, &w) == 0)
        started++;
    worker(&w);
    for (unsigned i = 0; i < started; i++)
        pthread_join(pool[i], NULL);
}
