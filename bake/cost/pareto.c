#include "cost/pareto.h"

static bool beaten(const cost_results *r, uint32_t i, bool relmse) {
    const cost_setting *s = &r->settings[i];
    const double error = relmse ? s->total.relmse : s->total.nmse;
    for (uint32_t k = 0; k < r->count; k++) {
        const cost_setting *other = &r->settings[k];
        const double others = relmse ? other->total.relmse : other->total.nmse;
        if (k == i || other->elsewhere || !(other->ms <= s->ms && others <= error))
            continue;
        if (other->ms < s->ms || others < error || k < i)
            return true;
    }
    return false;
}

void pareto_mark(cost_results *r) {
    for (uint32_t i = 0; i < r->count; i++) {
        r->settings[i].pareto = !r->settings[i].elsewhere && !beaten(r, i, false);
        r->settings[i].pareto_relmse = !r->settings[i].elsewhere && !beaten(r, i, true);
    }
}
