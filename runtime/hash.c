/* hash.c: the one hash of the product, XXH3-64 with seed 0. Sections of a pack, frames and traced buffers all use it.
 * XXH3 gives the same 64-bit number on little- and big-endian hosts; no secret, no seed, so the number is comparable anywhere.
 */
#include "vitrine.h"

/* The library is inlined here and nowhere else: no run-time dependency, and its warnings stay out of our own code. */
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#define XXH_INLINE_ALL
#include <xxhash.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

uint64_t vit_hash(const void *data, size_t bytes) {
    return XXH3_64bits(data, bytes);
}
