/* Lanes of kernels/lanes.clh as vectors of GCC and Clang, 8 or 16 wide, on any machine: the compiler splits what is wider than
 * the machine's own. HOST_EACH builds a vector of one expression a lane; compilers make one instruction of it where there is
 * one. */
#ifndef VIT_HOST_VECTORS_H
#define VIT_HOST_VECTORS_H

typedef float lf __attribute__((vector_size(4 * VIT_LANES)));
typedef int li __attribute__((vector_size(4 * VIT_LANES)));
typedef uint lu __attribute__((vector_size(4 * VIT_LANES)));
typedef ushort host_shorts __attribute__((vector_size(2 * VIT_LANES)));

#if VIT_LANES == 8
#define HOST_EACH(T, E) ((T){E(0), E(1), E(2), E(3), E(4), E(5), E(6), E(7)})
#else
#define HOST_EACH(T, E)                                                                                                        \
    ((T){E(0), E(1), E(2), E(3), E(4), E(5), E(6), E(7), E(8), E(9), E(10), E(11), E(12), E(13), E(14), E(15)})
#endif

static inline lf host_splat_f(float x) {
#define E(i) x
    return HOST_EACH(lf, E);
}

static inline li host_splat_i(int x) {
    return HOST_EACH(li, E);
}

static inline lu host_splat_u(uint x) {
    return HOST_EACH(lu, E);
#undef E
}

#define HOST_NUMBER(i) i
#define L_INDEX HOST_EACH(li, HOST_NUMBER)
#define L_F(x) host_splat_f(x)
#define L_I(x) host_splat_i(x)
#define L_U(x) host_splat_u(x)
#define L_BOOL(x) (x)
#define L_FROM_INT(x) __builtin_convertvector(x, lf)
#define L_TRUNC(x) __builtin_convertvector(x, li)
#define L_AS_INT(x) ((li)(x))
#define L_AS_FLOAT(x) ((lf)(x))
#define L_AS_UINT(x) ((lu)(x))

/* Without such instructions these are calls of the C library, a lane each: in one place, not in thousands. */
#ifdef __FP_FAST_FMAF
#define HOST_INLINE static inline __attribute__((always_inline))
#else
#define HOST_INLINE static __attribute__((noinline, unused))
#endif

#define HOST_OF_LANES(name, E)                                                                                                 \
    HOST_INLINE lf name(lf x) {                                                                                                \
        return HOST_EACH(lf, E);                                                                                               \
    }
#define E(i) __builtin_sqrtf(x[i])
HOST_OF_LANES(host_sqrt, E)
#undef E
#define E(i) __builtin_floorf(x[i])
HOST_OF_LANES(host_floor, E)
#undef E

static inline lf host_fabs(lf x) {
    return (lf)((li)x & 0x7fffffff);
}

HOST_INLINE lf host_fma(lf a, lf b, lf c) {
#define E(i) __builtin_fmaf(a[i], b[i], c[i])
    return HOST_EACH(lf, E);
#undef E
}

static inline lu host_mul_hi_l(lu a, lu b) {
#define E(i) host_mul_hi(a[i], b[i])
    return HOST_EACH(lu, E);
#undef E
}

/* m ? a : b, lane by lane. */
static inline lf l_sel(li m, lf a, lf b) {
    return (lf)(((li)a & m) | ((li)b & ~m));
}

static inline li l_sel_i(li m, li a, li b) {
    return (a & m) | (b & ~m);
}

static inline lu l_sel_u(li m, lu a, lu b) {
    return (a & (lu)m) | (b & ~(lu)m);
}

static inline li host_min_l(li a, li b) {
    return l_sel_i(b < a, b, a);
}

static inline li host_max_l(li a, li b) {
    return l_sel_i(b > a, b, a);
}

#define fma(a, b, c) _Generic((a), lf : host_fma, default : __builtin_fmaf)(a, b, c)
#define sqrt(x) _Generic((x), lf : host_sqrt, default : __builtin_sqrtf)(x)
#define floor(x) _Generic((x), lf : host_floor, default : __builtin_floorf)(x)
#define fabs(x) _Generic((x), lf : host_fabs, default : __builtin_fabsf)(x)
#define mul_hi(a, b) _Generic((a), lu : host_mul_hi_l, default : host_mul_hi)(a, b)
#define min(a, b) _Generic((a), li : host_min_l, uint : host_min_u, default : host_min_i)(a, b)
#define max(a, b) _Generic((a), li : host_max_l, uint : host_max_u, default : host_max_i)(a, b)

/* p[i] lane by lane; every index must be readable. */
#if VIT_LANES == 8
#define L_GATHER(T, p, i)                                                                                                      \
    ((T){(p)[(i)[0]], (p)[(i)[1]], (p)[(i)[2]], (p)[(i)[3]], (p)[(i)[4]], (p)[(i)[5]], (p)[(i)[6]], (p)[(i)[7]]})
#else
#define L_GATHER(T, p, i)                                                                                                      \
    ((T){(p)[(i)[0]], (p)[(i)[1]], (p)[(i)[2]], (p)[(i)[3]], (p)[(i)[4]], (p)[(i)[5]], (p)[(i)[6]], (p)[(i)[7]], (p)[(i)[8]],  \
         (p)[(i)[9]], (p)[(i)[10]], (p)[(i)[11]], (p)[(i)[12]], (p)[(i)[13]], (p)[(i)[14]], (p)[(i)[15]]})
#endif

/* Loads and stores of any alignment. */
#define HOST_MEMORY(V, T, name)                                                                                                \
    static inline V host_load_##name(const T *p) {                                                                             \
        V v;                                                                                                                   \
        memcpy(&v, p, sizeof v);                                                                                               \
        return v;                                                                                                              \
    }                                                                                                                          \
    static inline void host_store_##name(V v, T *p) {                                                                          \
        memcpy(p, &v, sizeof v);                                                                                               \
    }
HOST_MEMORY(lf, float, f)
HOST_MEMORY(li, int, i)
HOST_MEMORY(lu, uint, u)
HOST_MEMORY(host_shorts, ushort, s)
#define L_LOAD(p) _Generic(*(p), float : host_load_f, int : host_load_i, uint : host_load_u)(p)
#define L_STORE(v, p) _Generic(*(p), float : host_store_f, int : host_store_i, uint : host_store_u)(v, p)
#define L_LOAD_SHORTS(p) __builtin_convertvector(host_load_s(p), lf)
#define L_STORE_SHORTS(v, p) host_store_s(__builtin_convertvector(v, host_shorts), p)

/* Sums over lanes by parts of four, which every machine with vectors has. */
typedef long long host_pair __attribute__((vector_size(16)));
typedef int host_four __attribute__((vector_size(16)));
typedef union host_parts {
    li all;
    host_pair pairs[VIT_LANES / 4];
    host_four fours[VIT_LANES / 4];
} host_parts;

static inline ulong host_or(li v) {
    host_parts p = {v};
    host_pair r = p.pairs[0];
    for (int i = 1; i < VIT_LANES / 4; i++)
        r |= p.pairs[i];
    return (ulong)(r[0] | r[1]);
}

static inline int l_any(li m) {
    return host_or(m) != 0;
}

static inline uint l_or(lu v) {
    ulong both = host_or((li)v);
    return (uint)(both | both >> 32);
}

/* One bit a lane, lane 0 lowest. */
static inline uint l_bits(li m) {
    return l_or((lu)m & (host_splat_u(1) << (lu)L_INDEX));
}

/* Smallest lane; any order gives the same integer. */
static inline int l_reduce_min(li v) {
    host_parts p = {v};
    host_four r = p.fours[0];
    for (int i = 1; i < VIT_LANES / 4; i++) {
        host_four less = p.fours[i] < r;
        r = (p.fours[i] & less) | (r & ~less);
    }
    return host_min_i(host_min_i(r[0], r[1]), host_min_i(r[2], r[3]));
}

#endif
