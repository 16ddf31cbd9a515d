/* What device_host.c and the kernels compiled as C (kernels.c) share. */
#ifndef VIT_HOST_H
#define VIT_HOST_H

#include "../passes.h"

/* A pass of a frame: what the kernels' parameters are taken from, by the names of the table's arguments. */
typedef struct host_call {
    void *buffers[B_COUNT]; /* NULL: not called for */
    uint32_t frame, round, layers, level, run, chunks, max_nodes, max_list, pitch, pass;
    uint64_t effects; /* vit_launch.effects */
    vit_view view;
    vit_format format;
} host_call;

/* The kernels, compiled for one width and one instruction set. */
typedef struct host_program {
    const char *isa; /* "baseline", or what the machine must have: see programs.c */
    uint32_t lanes;
    /* Runs work-items first .. first + count - 1 of the pass call->pass; any thread, several at once. */
    void (*run)(const host_call *call, size_t first, size_t count);
} host_program;

/* The program for this width and instruction set; NULL isa: the best that this machine has. NULL: there is none, or the machine
 * cannot run it. Width 0: the one that suits the instruction set. */
const host_program *vit_host_find(const char *isa, uint32_t lanes);
/* What vit_host_find() takes here, best first; NULL beyond the last. */
const char *vit_host_isa(uint32_t index);

#endif
