/* What must be timed to find the most accurate setting within so many milliseconds. Errors and work are known and exact; work
 * foretells times up to a factor (bake/cost/README.md, "Fit"), so what is wrong by more than a setting that fits, or would take
 * far too long, need not be timed, nor need its kernels be compiled. */
#include "cost/sweep_parts.h"
#include "common/fail.h"
#include <math.h>
#include <stdlib.h>

#define AT_ONCE 3  /* settings timed beside the default */
#define SPARES 3   /* settings that fit, before less accurate ones do not count: the best may not hold on all frames */
#define UNSURE 1.5 /* times what is foretold may be wrong by */

static double error_of(const sweep *s, uint32_t i) {
    const cost_error *e = &s->out->settings[i].total;
    return s->in->relmse ? e->relmse : e->nmse;
}

static bool is_timed(const sweep *s, uint32_t i) {
    return s->out->settings[i].timed > 0;
}

static bool fits(const sweep *s, uint32_t i) {
    return is_timed(s, i) && !s->out->settings[i].elsewhere && s->out->settings[i].ms_p95 <= s->in->fit_ms;
}

/* Milliseconds (95th percentile) of a setting by those of the timed one that is most like it in work. */
static double foretold(const sweep *s, uint32_t i) {
    const cost_setting *c = &s->out->settings[i];
    const double work = c->work > 0 ? (double)c->work : 1;
    double nearest = INFINITY, ms = 0;
    for (uint32_t k = 0; k < s->out->count; k++) {
        const cost_setting *o = &s->out->settings[k];
        const double other = o->work > 0 ? (double)o->work : 1, apart = fabs(log(other / work));
        if (is_timed(s, k) && apart < nearest) {
            nearest = apart;
            ms = o->ms_p95 * work / other;
        }
    }
    return ms;
}

/* The error that a setting must stay below to matter: that of the SPARES-th best that fits. *some: any fits. */
static double error_to_beat(const sweep *s, bool *some) {
    double best[SPARES];
    for (int k = 0; k < SPARES; k++)
        best[k] = INFINITY;
    *some = false;
    for (uint32_t i = 0; i < s->out->count; i++) {
        if (!fits(s, i))
            continue;
        *some = true;
        double e = error_of(s, i);
        for (int k = 0; k < SPARES; k++)
            if (e < best[k]) {
                const double rest = best[k];
                best[k] = e;
                e = rest;
            }
    }
    return best[SPARES - 1];
}

/* The next one to be timed: the most accurate that may fit, or, while none fits, the cheapest if it may come closer.
 * out->count: none is left. */
static uint32_t next_of(const sweep *s, const bool *taken) {
    bool some;
    double closest = INFINITY;
    const double below = error_to_beat(s, &some);
    const uint32_t none = s->out->count;
    uint32_t best = none, cheapest = none;
    for (uint32_t i = 0; i < s->out->count; i++) {
        const cost_setting *c = &s->out->settings[i];
        if (c->elsewhere)
            continue;
        if (is_timed(s, i))
            closest = fmin(closest, c->ms_p95);
        if (taken[i] || is_timed(s, i))
            continue;
        if (cheapest == none || c->work < s->out->settings[cheapest].work)
            cheapest = i;
        if (error_of(s, i) < below && foretold(s, i) <= UNSURE * s->in->fit_ms &&
            (best == none || error_of(s, i) < error_of(s, best)))
            best = i;
    }
    if (best != none || some)
        return best;
    return cheapest != none && foretold(s, cheapest) < closest ? cheapest : none;
}

static uint64_t bytes_of(const cost_setting *c) {
    return c->device_bytes + c->pack_bytes;
}

/* list[1 ..]: at most AT_ONCE, fewer if memory is short, but one if there is any. Returns the length of the list. */
static uint32_t fill_list(const sweep *s, bool *taken, uint32_t list[AT_ONCE + 1]) {
    uint64_t bytes = bytes_of(&s->out->settings[0]);
    uint32_t count = 1;
    list[0] = 0;
    while (count <= AT_ONCE) {
        const uint32_t i = next_of(s, taken);
        if (i == s->out->count)
            break;
        bytes += bytes_of(&s->out->settings[i]);
        if (count > 1 && bytes > s->in->memory)
            break;
        taken[i] = true;
        list[count++] = i;
    }
    return count;
}

vit_status sweep_times_to_fit(sweep *s, vit_text *why) {
    bool *taken = calloc(s->out->count, sizeof *taken);
    uint32_t list[AT_ONCE + 1] = {0}, count = 1;
    vit_status status = VIT_OK;
    s->brief = false;
    if (!taken)
        return bake_fail(why, VIT_FAILED, "out of memory");
    for (bool more = true; status == VIT_OK && more; more = count > 1) {
        status = sweep_time_some(s, list, count, why);
        count = status == VIT_OK ? fill_list(s, taken, list) : 1;
    }
    uint32_t timed = 0;
    for (uint32_t i = 0; i < s->out->count && status == VIT_OK; i++) {
        timed += is_timed(s, i);
        if (!is_timed(s, i))
            s->out->settings[i].ms = s->out->settings[i].ms_p95 = INFINITY;
    }
    if (status == VIT_OK)
        progress_line(s->progress, false, "times: %u of %u settings could be the answer and were timed", timed, s->out->count);
    free(taken);
    return status;
}
