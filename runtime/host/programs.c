/* Which programs this library has (host_programs.h, made by the Makefile: a line PROGRAM(isa, lanes) each, the best isa first)
 * and which of them this machine can run. */
#include "host.h"
#include <string.h>

#define PROGRAM(isa, lanes) extern const host_program vit_host_##isa##_##lanes;
#include "host_programs.h"
#undef PROGRAM

static const host_program *const programs[] = {
#define PROGRAM(isa, lanes) &vit_host_##isa##_##lanes,
#include "host_programs.h"
#undef PROGRAM
};
#define PROGRAM_COUNT (sizeof programs / sizeof *programs)

/* The instructions that the Makefile lets the compiler use for each. */
static int can_run(const char *isa) {
#if defined(__x86_64__)
    if (strcmp(isa, "avx2") == 0)
        return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (strcmp(isa, "avx512") == 0)
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
               __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma");
#endif
    return strcmp(isa, "baseline") == 0;
}

/* Measured: see tests/bench/LOG.md. */
static uint32_t lanes_that_suit(const char *isa) {
    return strcmp(isa, "avx512") == 0 ? 16 : strcmp(isa, "avx2") == 0 ? 8 : 1;
}

const char *vit_host_isa(uint32_t index) {
    const char *last = "";
    for (size_t i = 0; i < PROGRAM_COUNT; i++) {
        if (strcmp(programs[i]->isa, last) == 0 || !can_run(programs[i]->isa))
            continue;
        last = programs[i]->isa;
        if (index-- == 0)
            return last;
    }
    return NULL;
}

const host_program *vit_host_find(const char *isa, uint32_t lanes) {
    const host_program *first = NULL;
    isa = isa ? isa : vit_host_isa(0);
    if (!isa || !can_run(isa))
        return NULL;
    for (size_t i = 0; i < PROGRAM_COUNT; i++) {
        if (strcmp(programs[i]->isa, isa) != 0)
            continue;
        first = first ? first : programs[i];
        if (programs[i]->lanes == (lanes == 0 ? lanes_that_suit(isa) : lanes))
            return programs[i];
    }
    return lanes == 0 ? first : NULL;
}
