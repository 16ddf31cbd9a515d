/* parallel.c: one function over many items on all threads. */
#ifndef VIT_BAKE_PARALLEL_H
#define VIT_BAKE_PARALLEL_H

#include <stdint.h>

/* Calls run(user, item) for all items, in any order, on `threads` threads (0: all cores), this one included; on fewer if the
 * system gives no more. An item's result must depend on the item alone. */
void parallel_for(unsigned threads, uint32_t items, void (*run)(void *user, uint32_t item), void *user);

#endif
