/* pool.c: a fixed number of threads that share the work-items of one pass at a time. The caller of vit_host_pool_run() is one
 * of them. */
#ifndef VIT_HOST_POOL_H
#define VIT_HOST_POOL_H

#include "vitrine.h"
#include <pthread.h>
#include <stdatomic.h>

#define HOST_MAX_THREADS 256

/* Items first .. first + count - 1, on any thread. */
typedef void host_items_fn(void *user, size_t first, size_t count);

typedef struct host_pool {
    pthread_mutex_t lock;
    pthread_cond_t begin, end; /* a round began; the last helper finished it */
    uint32_t helpers;          /* threads besides the caller */
    uint32_t busy;             /* helpers that have not finished the round */
    uint64_t round;
    int stop;
    host_items_fn *fn; /* of the round, as are the next four */
    void *user;
    size_t items, grain;
    atomic_size_t next; /* the first item that nobody took */
    pthread_t threads[HOST_MAX_THREADS];
} host_pool;

/* threads: the caller included; 0: one a processor that the process may use. VIT_FAILED: the system gives no thread. */
vit_status vit_host_pool_open(host_pool *p, uint32_t threads, vit_text *why);
/* Returns when all items are done. Runs them in the default floating-point environment, whatever the caller's is. */
void vit_host_pool_run(host_pool *p, host_items_fn *fn, void *user, size_t items);
void vit_host_pool_close(host_pool *p);

#endif
