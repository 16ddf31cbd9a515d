#define _DEFAULT_SOURCE /* sysconf's number of processors */
#include "common/parallel.h"
#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

#define MOST_CHUNK 64u /* items that a thread takes at a time; fewer where that would leave threads idle */
#define CHUNKS 16u     /* a thread takes, at least */
#define MAX_THREADS 256u

typedef struct running {
    const parallel_work *w;
    atomic_uint_fast64_t next; /* place among the chunks */
    atomic_uint_fast64_t sum;
    uint64_t places;
} running;

static bool cancelled(const parallel_work *w) {
    return w->cancel && *w->cancel;
}

static void take_chunks(running *r, bool reports) {
    uint64_t sum = 0;
    while (!cancelled(r->w)) {
        const uint64_t place = atomic_fetch_add(&r->next, 1);
        if (place >= r->places)
            break;
        r->w->run(r->w->user, (uint32_t)(r->w->first + place * r->w->step), &sum);
        if (reports && r->w->done)
            r->w->done(r->w->user, (double)(place + 1) / (double)r->places);
    }
    atomic_fetch_add(&r->sum, sum);
}

static void *worker(void *user) {
    take_chunks(user, false);
    return NULL;
}

bool parallel_run(const parallel_work *w, uint64_t *sum) {
    pthread_t pool[MAX_THREADS];
    unsigned started = 0;
    const unsigned threads = parallel_threads(w->threads, 1);
    running r = {.w = w, .places = w->first < w->count ? (w->count - w->first + w->step - 1) / w->step : 0};
    while (started + 1 < threads && started + 1 < r.places && started < MAX_THREADS &&
           pthread_create(pool + started, NULL, worker, &r) == 0)
        started++;
    take_chunks(&r, true);
    for (unsigned i = 0; i < started; i++)
        pthread_join(pool[i], NULL);
    *sum += atomic_load(&r.sum);
    return !cancelled(w) || atomic_load(&r.next) >= r.places + started + 1;
}

unsigned parallel_threads(unsigned asked, unsigned sharing) {
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    const unsigned share = cores > 0 && sharing > 0 ? (unsigned)cores / sharing : 1;
    const unsigned threads = asked ? asked : share ? share : 1;
    return threads < MAX_THREADS ? threads : MAX_THREADS;
}

typedef struct items {
    void (*run)(void *user, uint32_t item);
    void *user;
    uint32_t count, chunk;
} items;

static void run_items(void *user, uint32_t chunk, uint64_t *sum) {
    const items *i = user;
    const uint64_t first = (uint64_t)chunk * i->chunk;
    (void)sum;
    for (uint64_t k = first; k < first + i->chunk && k < i->count; k++)
        i->run(i->user, (uint32_t)k);
}

void parallel_for(unsigned threads, uint32_t count, void (*run)(void *user, uint32_t item), void *user) {
    items i = {.run = run, .user = user, .count = count};
    uint64_t sum = 0;
    threads = parallel_threads(threads, 1);
    i.chunk = count / threads / CHUNKS;
    i.chunk = i.chunk < 1 ? 1 : i.chunk > MOST_CHUNK ? MOST_CHUNK : i.chunk;
    const parallel_work w = {
        .run = run_items, .user = &i, .step = 1, .count = count / i.chunk + (count % i.chunk > 0), .threads = threads};
    (void)parallel_run(&w, &sum); /* cannot be cancelled */
}
