/* The kernels as C, for one width (VIT_LANES) and instruction set (HOST_ISA, the compiler's options): a host_program named
 * HOST_PROGRAM. The Makefile compiles this file several times; kernel_list.h includes kernels/ in their order. */
#include "host.h"
#include "../pass_table.h"
#include "opencl_c.h"

/* What a program in OpenCL is compiled for: here variables of the thread, set for each stretch of work-items. */
#define X(bit, name, macro, why) static _Thread_local uint VIT_EFFECT_##macro;
VIT_EFFECTS(X)
#undef X
#define X(macro) static _Thread_local uint VIT_EFFECT_##macro;
VIT_MODES(X)
#undef X
static _Thread_local vit_view VIT_VIEW;
static _Thread_local vit_format VIT_FORMAT;
static _Thread_local uint host_counts;
#define VIT_WITH(effect) 1
#define VIT_WITH_DENSE 1
#define VIT_COUNT_WORK 1
#define WORK_WANTED host_counts

#include "kernel_list.h"

static void set_variables(const host_call *call) {
#define X(bit, name, macro, why) VIT_EFFECT_##macro = call->effects >> bit & 1u;
    VIT_EFFECTS(X)
#undef X
#define X(macro) VIT_EFFECT_##macro = (call->effects & ON_##macro) != 0;
    VIT_MODES(X)
#undef X
    VIT_VIEW = call->view;
    VIT_FORMAT = call->format;
    host_counts = (call->effects & ON_WORK) != 0;
}

/* A row of the table as a call of its kernel. */
#define B(name) (call->buffers[B_##name])
#define V(name) (call->name)
#define X(name, when, rounds, extent, repeat, writes, ...)                                                                     \
    static void run_##name(const host_call *call) {                                                                            \
        name(__VA_ARGS__);                                                                                                     \
    }
VIT_PASSES(X)
#undef X
#undef B
#undef V

#define X(name, ...) run_##name,
static void (*const run_pass[])(const host_call *) = {VIT_PASSES(X)};
#undef X

static void run(const host_call *call, size_t first, size_t count) {
    set_variables(call);
    for (size_t i = 0; i < count; i++) {
        host_item = first + i;
        run_pass[call->pass](call);
    }
}

extern const host_program HOST_PROGRAM;
const host_program HOST_PROGRAM = {HOST_ISA, VIT_LANES, run};
