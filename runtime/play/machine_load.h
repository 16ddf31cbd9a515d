/* machine_load.c: how much of the machine's processors other programs take, from the counters of the system. */
#ifndef VIT_PLAY_MACHINE_LOAD_H
#define VIT_PLAY_MACHINE_LOAD_H

#include <stdint.h>

/* Since the machine and the process were started, clock ticks; all 0 where it cannot be known. */
typedef struct machine_load {
    uint64_t all, busy; /* of all processors; busy: with any program, or taken by the machine's host */
    uint64_t own;       /* with this process */
} machine_load;

machine_load machine_load_now(void);

/* Part of the processors' time from `from` to `to` that others than this process had, 0 to 1. -1: not known, or too short a
 * time to say. */
double machine_load_others(const machine_load *from, const machine_load *to);

#endif
