#include "cost/pareto.h"

bool pareto_beats(pareto_point a, pareto_point b, bool first) {
    return a.price <= b.price && a.error <= b.error && (a.price < b.price || a.error < b.error || first);
}

bool pareto_on_front(const cost_results *r, uint32_t i, pareto_point (*point)(const cost_setting *s)) {
    if (r->settings[i].elsewhere)
        return false;
    const pareto_point at = point(&r->settings[i]);
    for (uint32_t k = 0; k < r->count; k++)
        if (k != i && !r->settings[k].elsewhere && pareto_beats(point(&r->settings[k]), at, k < i))
            return false;
    return true;
}

static pareto_point time_and_nmse(const cost_setting *s) {
    return (pareto_point){s->ms, s->total.nmse};
}

static pareto_point time_and_relmse(const cost_setting *s) {
    return (pareto_point){s->ms, s->total.relmse};
}

void pareto_mark(cost_results *r) {
    for (uint32_t i = 0; i < r->count; i++) {
        r->settings[i].pareto = pareto_on_front(r, i, time_and_nmse);
        r->settings[i].pareto_relmse = pareto_on_front(r, i, time_and_relmse);
    }
}
