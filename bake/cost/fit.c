#include "cost/fit.h"
#include "common/fail.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Work units of one of a kind: about tenths of a nanosecond. Whole numbers, so that sums are equal everywhere; how they were
 * found: bake/cost/README.md, "Fit". */
static const struct {
    const char *kind;
    uint64_t units;
} weights[] = {
    {"view_rays", 140}, {"shadow_rays", 130}, {"chain_rays", 700}, {"gloss_rays", 700},     {"photon_rays", 4400},
    {"node_tests", 12}, {"pairs", 250},       {"evaluations", 7},  {"surface_points", 160}, {"texture_fetches", 100},
};

static uint64_t weight_of(const char *kind) {
    for (size_t i = 0; i < sizeof weights / sizeof weights[0]; i++)
        if (strcmp(weights[i].kind, kind) == 0)
            return weights[i].units;
    return 0;
}

/* What a pass moves counts only if it counts nothing else: a unit a byte. Elsewhere most bytes are read from caches, many
 * times. */
static uint64_t pass_units(const uint64_t work[VIT_MAX_WORKS], const char *const *names, uint32_t count) {
    uint64_t units = 0, bytes = 0;
    for (uint32_t k = 0; k < count; k++) {
        units += weight_of(names[k]) * work[k];
        bytes += strcmp(names[k], "bytes") == 0 ? work[k] : 0;
    }
    return units > 0 ? units : bytes;
}

uint64_t fit_work_units(const uint64_t work[][VIT_MAX_WORKS], uint32_t passes, const char *const *names, uint32_t count) {
    uint64_t units = 0;
    for (uint32_t p = 0; p < passes; p++)
        units += pass_units(work[p], names, count);
    return units;
}

static double price(const cost_setting *s, const fit_budget *b) {
    return b->work > 0 ? (double)s->work : s->ms_p95;
}

static double error_of(const cost_setting *s, const fit_budget *b) {
    return b->relmse ? s->total.relmse : s->total.nmse;
}

static bool fits(const cost_setting *s, const fit_budget *b) {
    return b->work > 0 ? s->work <= b->work : s->ms_p95 <= b->ms;
}

/* Whether `s` is the better choice. */
static bool better(const cost_setting *s, const cost_setting *than, const fit_budget *b) {
    if (error_of(s, b) != error_of(than, b))
        return error_of(s, b) < error_of(than, b);
    return price(s, b) < price(than, b);
}

static vit_status refuse(const cost_results *r, const fit_budget *b, uint32_t closest, vit_text *why) {
    if (closest == r->count)
        return bake_fail(why, VIT_BUDGET, "no setting is left to choose from");
    const cost_setting *c = &r->settings[closest];
    if (b->work > 0)
        return bake_fail(why, VIT_BUDGET,
                         "no setting fits %" PRIu64 " work units a frame: the closest, '%s', takes %" PRIu64 ", %" PRIu64
                         " too many",
                         b->work, c->name, c->work, c->work - b->work);
    return bake_fail(why, VIT_BUDGET,
                     "no setting fits %g ms: the closest, '%s', takes %.2f ms (95th percentile), %.2f ms too long", b->ms,
                     c->name, c->ms_p95, c->ms_p95 - b->ms);
}

vit_status fit_choose(const cost_results *r, const fit_budget *b, uint32_t *chosen, vit_text *why) {
    uint32_t best = r->count, closest = r->count;
    if (b->work > 0 && r->work_count == 0) {
        return bake_fail(why, VIT_FAILED, "this build counts no work: only a budget in milliseconds can be fitted");
    }
    for (uint32_t i = 0; i < r->count; i++) {
        const cost_setting *s = &r->settings[i];
        if (s->elsewhere || isinf(price(s, b)))
            continue;
        if (closest == r->count || price(s, b) < price(&r->settings[closest], b))
            closest = i;
        if (fits(s, b) && (best == r->count || better(s, &r->settings[best], b)))
            best = i;
    }
    *chosen = best;
    return best == r->count ? refuse(r, b, closest, why) : VIT_OK;
}

/* No other setting costs at most as much, in what the budget counts, and is at most as wrong. */
static bool on_pareto_front(const cost_results *r, const fit_budget *b, uint32_t i) {
    const cost_setting *s = &r->settings[i];
    for (uint32_t k = 0; k < r->count; k++) {
        const cost_setting *o = &r->settings[k];
        if (k == i || o->elsewhere || price(o, b) > price(s, b) || error_of(o, b) > error_of(s, b))
            continue;
        if (price(o, b) < price(s, b) || error_of(o, b) < error_of(s, b) || k < i)
            return false;
    }
    return !s->elsewhere;
}

/* The front's settings and the choice, cheapest first: order[0 .. result - 1]. */
static uint32_t front_order(const cost_results *r, const fit_budget *b, uint32_t chosen, uint32_t *order) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        if ((i != chosen && !on_pareto_front(r, b, i)) || isinf(price(&r->settings[i], b))) /* not timed */
            continue;
        uint32_t at = count++;
        for (; at > 0 && price(&r->settings[order[at - 1]], b) > price(&r->settings[i], b); at--)
            order[at] = order[at - 1];
        order[at] = i;
    }
    return count;
}

static void print_row(const cost_setting *s, bool chosen, FILE *to) {
    (void)fprintf(to, "%c %8.2f %8.2f %14" PRIu64 " %9.5f %9.5f %+8.2f  %s\n", chosen ? '>' : ' ', s->ms, s->ms_p95, s->work,
                  s->total.nmse, s->total.relmse, 100 * s->total.bias, s->name);
}

void fit_print(const cost_results *r, const fit_budget *b, uint32_t chosen, FILE *to) {
    uint32_t *order = calloc((size_t)r->count + 1, sizeof *order);
    if (!order)
        return; /* a table less; the choice is said in any case */
    const uint32_t count = front_order(r, b, chosen, order);
    (void)fprintf(to, "  %8s %8s %14s %9s %9s %8s  %s\n", "ms", "p95 ms", "work units", "NMSE", "relMSE", "bias %", "setting");
    for (uint32_t i = 0; i < count; i++)
        print_row(&r->settings[order[i]], order[i] == chosen, to);
    free(order);
}
