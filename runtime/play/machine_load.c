#include "machine_load.h"
#include <inttypes.h>
#include <stdio.h>
#include <sys/times.h>

#define LEAST_TICKS 20 /* of all processors together: the counters go in steps of one */

machine_load machine_load_now(void) {
    machine_load l = {0};
    uint64_t user, nice, system, idle, wait, irq, soft, steal;
    struct tms own;
    FILE *f = fopen("/proc/stat", "re");
    if (f == NULL)
        return l;
    /* Numbers of the system's own. NOLINTNEXTLINE(cert-err34-c) */
    const int read =
        fscanf(f, "cpu %" SCNu64 " %" SCNu64 " %" SCNu64 " %" SCNu64 " %" SCNu64 " %" SCNu64 " %" SCNu64 " %" SCNu64, &user,
               &nice, &system, &idle, &wait, &irq, &soft, &steal);
    (void)fclose(f);
    if (read != 8 || times(&own) == (clock_t)-1)
        return l;
    l.busy = user + nice + system + irq + soft + steal;
    l.all = l.busy + idle + wait;
    l.own = (uint64_t)(own.tms_utime + own.tms_stime);
    return l;
}

double machine_load_others(const machine_load *from, const machine_load *to) {
    if (to->all < from->all + LEAST_TICKS || to->busy < from->busy || to->own < from->own)
        return -1;
    const double all = (double)(to->all - from->all), others = (double)(to->busy - from->busy) - (double)(to->own - from->own);
    return others > 0 ? others / all : 0;
}
