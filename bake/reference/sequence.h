/* Low-discrepancy points in the unit square: the first two dimensions of Sobol's sequence with Owen's scrambling by hashing,
 * the order shuffled a pair of dimensions, so that pairs can be joined to more dimensions. Burley, "Practical Hash-based Owen
 * Scrambling", JCGT 9(4), 2020, sections 3 and 4; the hash is its equation for Laine and Karras's permutation. */
#ifndef VIT_COST_SEQUENCE_H
#define VIT_COST_SEQUENCE_H

#include "common/kernel_math.h"

static inline uint32_t sequence_reverse(uint32_t v) {
    v = ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
    v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
    v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
    v = ((v >> 8) & 0x00ff00ffu) | ((v & 0x00ff00ffu) << 8);
    return (v >> 16) | (v << 16);
}

/* Owen's scrambling of a number whose bits are reversed: each bit is flipped by a hash of the bits below it. */
static inline uint32_t sequence_permute(uint32_t v, uint32_t seed) {
    v += seed;
    v ^= v * 0x6c50b47cu;
    v ^= v * 0xb82f1e52u;
    v ^= v * 0xc7afe638u;
    v ^= v * 0x8d22f6e6u;
    return v;
}

#define SEQUENCE_LENGTH (1u << 16)

/* Point i < SEQUENCE_LENGTH of the sequence that `seed` names, as 32-bit fractions: its first 2^n points are stratified;
 * different seeds' points are independent. */
static inline void sequence_bits(uint32_t seed, uint32_t i, uint32_t *u, uint32_t *v) {
    const uint32_t shuffled = sequence_reverse(sequence_permute(sequence_reverse(i), seed)) & (SEQUENCE_LENGTH - 1);
    uint32_t second = 0; /* Sobol's second dimension; the first is the reversed index */
    for (uint32_t bits = shuffled, column = 0x80000000u; bits; bits >>= 1, column ^= column >> 1)
        if (bits & 1u)
            second ^= column;
    const uint32_t first = sequence_permute(shuffled, pcg(seed ^ 0x9e3779b9u)); /* reversed twice */
    second = sequence_permute(sequence_reverse(second), pcg(seed ^ 0x85ebca6bu));
    *u = sequence_reverse(first);
    *v = sequence_reverse(second);
}

static inline void sequence_point(uint32_t seed, uint32_t i, float *u, float *v) {
    uint32_t a, b;
    sequence_bits(seed, i, &a, &b);
    *u = unit_float(a);
    *v = unit_float(b);
}

/* With all 32 bits, for numbers that choose twice. */
static inline void sequence_fine(uint32_t seed, uint32_t i, double *u, double *v) {
    uint32_t a, b;
    sequence_bits(seed, i, &a, &b);
    *u = (double)a * 0x1p-32;
    *v = (double)b * 0x1p-32;
}

#endif
