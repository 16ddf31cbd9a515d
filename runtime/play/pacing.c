#include "pacing.h"
#include <errno.h>
#include <stdbool.h>

#define NS_PER_S 1000000000

double pacing_now_ms(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* start + frame / fps. A double's 53 bits keep nanoseconds exact over the first hundred days. */
static struct timespec due(const pacing *p) {
    double seconds = (double)p->shown / p->fps;
    time_t whole = (time_t)seconds;
    long nanoseconds = p->start.tv_nsec + (long)((seconds - (double)whole) * NS_PER_S);
    struct timespec at = {.tv_sec = p->start.tv_sec + whole + nanoseconds / NS_PER_S, .tv_nsec = nanoseconds % NS_PER_S};
    return at;
}

static bool passed(const struct timespec *at) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec > at->tv_sec || (now.tv_sec == at->tv_sec && now.tv_nsec > at->tv_nsec);
}

void pacing_wait(pacing *p, const volatile sig_atomic_t *stop) {
    if (p->fps <= 0)
        return;
    if (p->shown == 0) {
        /* The clock starts with the first frame that is ready: what a device does only once is no delay of the playback. */
        (void)clock_gettime(CLOCK_MONOTONIC, &p->start);
    } else {
        struct timespec at = due(p);
        if (passed(&at))
            p->late++;
        else
            while (!*stop && clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, NULL) == EINTR)
                continue;
    }
    p->shown++;
}
