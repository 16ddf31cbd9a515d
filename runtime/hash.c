/* hash.c: the one hash of the product, XXH3-64 with seed 0. Sections of a pack, frames and traced buffers all use it.
 * XXH3 gives the same 64-bit number of the same bytes on little- and big-endian hosts; no secret, no seed, so the number is
 * comparable anywhere. Numbers wider than a byte are hashed as little-endian machines have them.
 */
#include "byte_order.h"
#include "passes.h"
#include "xxh3.h"

uint64_t vit_hash(const void *data, size_t bytes) {
    return XXH3_64bits(data, bytes);
}

uint64_t vit_hash_frame(const void *pixels, vit_format format, size_t bytes) {
    return vit_hash_words(pixels, bytes, vit_format_word(format));
}
