/* OpenCL C 1.2 in C11: as much of it as kernels/ uses, so that the same text compiles for the host. A work-item is a call, a
 * work-group is one work-item: barriers are nothing and local memory is the call's own. With VIT_LANES > 1 vectors.h adds
 * lanes.
 *
 * The bits: every function here is exact or correctly rounded, as in OpenCL (kernels/strict.clh); compile with
 * -ffp-contract=off. fma is the machine's where the compiler may use it, else the C library's, which is slow and right. */
#ifndef VIT_HOST_OPENCL_C_H
#define VIT_HOST_OPENCL_C_H

#include <float.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

_Static_assert(FLT_EVAL_METHOD == 0, "floats are computed as floats");

typedef unsigned char uchar;
typedef unsigned short ushort;
typedef unsigned int uint;
typedef uint64_t ulong;
typedef float float4 __attribute__((vector_size(16)));

#define kernel static
#define global
#define local
#define constant static const
#define barrier(flags) ((void)0)
#define VIT_FLOAT4(x, y, z, w) ((float4){x, y, z, w})

/* The call's work-item; set by host_run (kernels.c). */
static _Thread_local size_t host_item;
#define get_global_id(dimension) (host_item)
#define get_group_id(dimension) (host_item)
#define get_local_id(dimension) ((size_t)0)
#define get_local_size(dimension) ((size_t)1)

static inline uint host_bits(float x) {
    uint bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline float as_float(uint bits) {
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline uint host_same(uint x) {
    return x;
}
#define as_uint(x) _Generic((x), float : host_bits, default : host_same)(x)
#define as_int(x) ((int)as_uint(x))

static inline uint host_clz(uint x) {
    return x == 0 ? 32u : (uint)__builtin_clz(x);
}
#define clz(x) host_clz(x)
#define popcount(x) ((uint)__builtin_popcount(x))

static inline uint add_sat(uint a, uint b) {
    return a + b < a ? UINT32_MAX : a + b;
}

static inline int host_min_i(int a, int b) {
    return b < a ? b : a;
}

static inline int host_max_i(int a, int b) {
    return b > a ? b : a;
}

static inline uint host_min_u(uint a, uint b) {
    return b < a ? b : a;
}

static inline uint host_max_u(uint a, uint b) {
    return b > a ? b : a;
}

static inline uint host_mul_hi(uint a, uint b) {
    return (uint)((ulong)a * b >> 32);
}

static inline float4 vload4(size_t i, const float *p) {
    float4 v;
    memcpy(&v, p + 4 * i, sizeof v);
    return v;
}

static inline void vstore4(float4 v, size_t i, float *p) {
    memcpy(p + 4 * i, &v, sizeof v);
}

/* Atomics of 32 bits; order of memory does not matter, as in OpenCL 1.2: passes are ordered by the device. Each gives what was
 * there. */
#define atomic_add(p, v) __atomic_fetch_add(p, v, __ATOMIC_RELAXED)
#define atomic_or(p, v) __atomic_fetch_or(p, v, __ATOMIC_RELAXED)
#define atomic_min(p, v) _Generic(*(p), int : host_atomic_min_i, uint : host_atomic_min_u)(p, v)
#define atomic_max(p, v) _Generic(*(p), int : host_atomic_max_i, uint : host_atomic_max_u)(p, v)
#define HOST_ATOMIC_EXTREME(name, type, better)                                                                                \
    static inline type name(volatile type *p, type v) {                                                                        \
        type old = __atomic_load_n(p, __ATOMIC_RELAXED);                                                                       \
        while (v better old && !__atomic_compare_exchange_n(p, &old, v, 1, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {              \
        }                                                                                                                      \
        return old;                                                                                                            \
    }
HOST_ATOMIC_EXTREME(host_atomic_min_i, int, <)
HOST_ATOMIC_EXTREME(host_atomic_min_u, uint, <)
HOST_ATOMIC_EXTREME(host_atomic_max_i, int, >)
HOST_ATOMIC_EXTREME(host_atomic_max_u, uint, >)

#if VIT_LANES == 1
#define fma(a, b, c) __builtin_fmaf(a, b, c)
#define sqrt(x) __builtin_sqrtf(x)
#define floor(x) __builtin_floorf(x)
#define fabs(x) __builtin_fabsf(x)
#define mul_hi(a, b) host_mul_hi(a, b)
#define min(a, b) _Generic((a), uint : host_min_u, default : host_min_i)(a, b)
#define max(a, b) _Generic((a), uint : host_max_u, default : host_max_i)(a, b)
#else
#include "vectors.h"
#endif

#endif
