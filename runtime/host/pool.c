#define _GNU_SOURCE /* sched_getaffinity: no file is read, unlike in sysconf */
#include "pool.h"
#include "../fail.h"
#include <fenv.h>
#include <sched.h>
#include <string.h>

#define GRAINS 16 /* stretches a thread takes of a pass, about: enough to even out, few enough to cost nothing */

static uint32_t processors(void) {
    cpu_set_t set;
    int count = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
    return count > 0 ? (uint32_t)count : 1;
}

/* Rounding and subnormals are part of the result: nothing that the program set for itself may count. */
static void work(host_pool *p) {
    fenv_t callers;
    (void)fegetenv(&callers);
    (void)fesetenv(FE_DFL_ENV);
    for (size_t first; (first = atomic_fetch_add(&p->next, p->grain)) < p->items;)
        p->fn(p->user, first, p->items - first < p->grain ? p->items - first : p->grain);
    (void)fesetenv(&callers);
}

static void *helper(void *user) {
    host_pool *p = user;
    uint64_t seen = 0;
    (void)pthread_mutex_lock(&p->lock);
    for (;;) {
        while (p->round == seen && !p->stop)
            (void)pthread_cond_wait(&p->begin, &p->lock);
        if (p->stop)
            break;
        seen = p->round;
        (void)pthread_mutex_unlock(&p->lock);
        work(p);
        (void)pthread_mutex_lock(&p->lock);
        if (--p->busy == 0)
            (void)pthread_cond_signal(&p->end);
    }
    (void)pthread_mutex_unlock(&p->lock);
    return NULL;
}

vit_status vit_host_pool_open(host_pool *p, uint32_t threads, vit_text *why) {
    uint32_t count = threads == 0 ? processors() : threads;
    memset(p, 0, sizeof *p);
    if (count > HOST_MAX_THREADS)
        count = HOST_MAX_THREADS;
    (void)pthread_mutex_init(&p->lock, NULL);
    (void)pthread_cond_init(&p->begin, NULL);
    (void)pthread_cond_init(&p->end, NULL);
    for (; p->helpers + 1 < count; p->helpers++) {
        int error = pthread_create(&p->threads[p->helpers], NULL, helper, p);
        if (error != 0) {
            (void)vit_fail(why, VIT_FAILED, "device host: thread %u of %u cannot be started: error %d", p->helpers + 2, count,
                           error);
            vit_host_pool_close(p);
            return VIT_FAILED;
        }
    }
    return VIT_OK;
}

void vit_host_pool_run(host_pool *p, host_items_fn *fn, void *user, size_t items) {
    const int alone = p->helpers == 0 || items <= 1; /* waking the others would cost more */
    p->fn = fn;
    p->user = user;
    p->items = items;
    p->grain = items / ((size_t)(p->helpers + 1) * GRAINS) + 1;
    atomic_store(&p->next, 0);
    if (!alone) {
        (void)pthread_mutex_lock(&p->lock);
        p->round++;
        p->busy = p->helpers;
        (void)pthread_cond_broadcast(&p->begin);
        (void)pthread_mutex_unlock(&p->lock);
    }
    work(p);
    if (alone)
        return;
    (void)pthread_mutex_lock(&p->lock);
    while (p->busy > 0)
        (void)pthread_cond_wait(&p->end, &p->lock);
    (void)pthread_mutex_unlock(&p->lock);
}

void vit_host_pool_close(host_pool *p) {
    (void)pthread_mutex_lock(&p->lock);
    p->stop = 1;
    (void)pthread_cond_broadcast(&p->begin);
    (void)pthread_mutex_unlock(&p->lock);
    for (uint32_t i = 0; i < p->helpers; i++)
        (void)pthread_join(p->threads[i], NULL);
    (void)pthread_cond_destroy(&p->begin);
    (void)pthread_cond_destroy(&p->end);
    (void)pthread_mutex_destroy(&p->lock);
}
