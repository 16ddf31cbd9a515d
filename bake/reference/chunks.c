#define _DEFAULT_SOURCE /* sysconf's number of processors */
#include "reference/chunks.h"
#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

#define MAX_THREADS 256u

typedef struct running {
    const chunk_work *w;
    atomic_uint_fast64_t next; /* place among the chunks */
    atomic_uint_fast64_t rays;
    uint64_t places;
} running;

static bool cancelled(const chunk_work *w) {
    return w->cancel && *w->cancel;
}

static void take_chunks(running *r, bool reports) {
    uint64_t rays = 0;
    while (!cancelled(r->w)) {
        const uint64_t place = atomic_fetch_add(&r->next, 1);
        if (place >= r->places)
            break;
        r->w->run(r->w->user, (uint32_t)(r->w->first + place * r->w->step), &rays);
        if (reports && r->w->done)
            r->w->done(r->w->user, (double)(place + 1) / (double)r->places);
    }
    atomic_fetch_add(&r->rays, rays);
}

static void *worker(void *user) {
    take_chunks(user, false);
    return NULL;
}

bool chunks_run(const chunk_work *w, uint64_t *rays) {
    pthread_t pool[MAX_THREADS];
    unsigned started = 0;
    running r = {.w = w, .places = w->first < w->count ? (w->count - w->first + w->step - 1) / w->step : 0};
    while (started + 1 < w->threads && started + 1 < r.places && started < MAX_THREADS &&
           pthread_create(pool + started, NULL, worker, &r) == 0)
        started++;
    take_chunks(&r, true);
    for (unsigned i = 0; i < started; i++)
        pthread_join(pool[i], NULL);
    *rays += atomic_load(&r.rays);
    return !cancelled(w) || atomic_load(&r.next) >= r.places + started + 1;
}

unsigned chunks_threads(unsigned asked, unsigned sharing) {
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    const unsigned share = cores > 0 && sharing > 0 ? (unsigned)cores / sharing : 1;
    const unsigned threads = asked ? asked : share ? share : 1;
    return threads < MAX_THREADS ? threads : MAX_THREADS;
}
