/* pacing.c: shows frames at the pack's rate. */
#ifndef VIT_PLAY_PACING_H
#define VIT_PLAY_PACING_H

#include <signal.h>
#include <stdint.h>
#include <time.h>

typedef struct pacing {
    double fps;            /* frames per second; 0: as fast as possible, nothing is ever late */
    struct timespec start; /* when the first frame was shown */
    uint64_t shown;        /* frames so far */
    uint64_t late;         /* of these, ready only after they were due */
} pacing;

/* Milliseconds of a clock that only goes forward. */
double pacing_now_ms(void);

/* Call with each finished frame, before it is shown: waits until the frame is due, or until a signal sets *stop. Frame n is
 * due n / fps seconds after the first one was ready. Due times are absolute, so a late frame delays none but itself. */
void pacing_wait(pacing *p, const volatile sig_atomic_t *stop);

#endif
