#include "machine_load.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/times.h>

#define LEAST_TICKS 20 /* of all processors together: the counters go in steps of one */

machine_load machine_load_now(void) {
    machine_load l = {0};
    enum { USER, NICE, SYSTEM, IDLE, WAIT, IRQ, SOFT, STEAL, TICKS };
    uint64_t ticks[TICKS];
    char line[512];
    struct tms own;
    FILE *f = fopen("/proc/stat", "re");
    if (f == NULL)
        return l;
    const char *at = fgets(line, sizeof line, f);
    (void)fclose(f);
    if (at == NULL || strncmp(at, "cpu ", 4) != 0 || times(&own) == (clock_t)-1)
        return l;
    at += 4;
    for (int i = 0; i < TICKS; i++) {
        char *end;
        ticks[i] = strtoull(at, &end, 10);
        if (end == at)
            return l;
        at = end;
    }
    l.busy = ticks[USER] + ticks[NICE] + ticks[SYSTEM] + ticks[IRQ] + ticks[SOFT] + ticks[STEAL];
    l.all = l.busy + ticks[IDLE] + ticks[WAIT];
    l.own = (uint64_t)(own.tms_utime + own.tms_stime);
    return l;
}

double machine_load_others(const machine_load *from, const machine_load *to) {
    if (to->all < from->all + LEAST_TICKS || to->busy < from->busy || to->own < from->own)
        return -1;
    const double all = (double)(to->all - from->all), others = (double)(to->busy - from->busy) - (double)(to->own - from->own);
    return others > 0 ? others / all : 0;
}
