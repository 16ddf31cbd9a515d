/* hash_swapped.c: XXH3-64 of words in the other byte order, piece by piece. A file of its own: little-endian programs do not
 * link it. */
#include "byte_order.h"
#include "xxh3.h"

uint64_t vit_hash_swapped(const void *data, size_t bytes, size_t word) {
    XXH3_state_t state;
    unsigned char piece[1024];
    (void)XXH3_64bits_reset(&state);
    for (size_t done = 0, step; done < bytes; done += step) {
        step = bytes - done < sizeof piece ? bytes - done : sizeof piece;
        (void)XXH3_64bits_update(&state, vit_swap_words(piece, (const unsigned char *)data + done, step, word), step);
    }
    return XXH3_64bits_digest(&state);
}
