/* Which settings are tried. Errors and work are exact, so that every machine tries the same ones. */
#include "cost/pareto.h"
#include "cost/sweep_parts.h"
#include <stdlib.h>
#include <string.h>

#define ROUND 6u /* settings that a round adds before the front is looked at again */

/* Takes over the settings that the list has beyond out->count, and makes their pictures and errors. */
static vit_status take_over(sweep *s, vit_text *why) {
    cost_results *r = s->out;
    const uint32_t first = r->count;
    for (; r->count < s->knobs.count; r->count++) {
        const knob_setting *k = &s->knobs.settings[r->count];
        cost_setting *to = &r->settings[r->count];
        memcpy(to->name, k->name, sizeof to->name);
        memcpy(to->knob, k->knob, sizeof to->knob);
        scene_quality_text(&k->quality, to->values, sizeof to->values);
        to->elsewhere = !knobs_in_quality(k);
    }
    vit_status status = sweep_pictures(s, first, why);
    return status == VIT_OK ? sweep_errors(s, why) : status;
}

static pareto_point work_and_nmse(const cost_setting *s) {
    return (pareto_point){(double)s->work, s->total.nmse};
}

/* One step from every setting on the front, then the next step, until the round is full. */
static vit_status add_round(sweep *s, vit_text *why) {
    const uint32_t upto = s->knobs.count + ROUND;
    vit_status status = VIT_OK;
    bool more = true;
    for (uint32_t step = 0; more && status == VIT_OK; step++) {
        more = false;
        for (uint32_t i = 0; i < s->out->count && s->knobs.count < upto && status == VIT_OK; i++)
            if (pareto_on_front(s->out, i, work_and_nmse))
                more |= knobs_beside(&s->knobs, i, step, &status, why);
    }
    return status;
}

vit_status sweep_search(sweep *s, vit_text *why) {
    const uint32_t alone = s->knobs.count, left = s->knobs.most - alone;
    progress_stage(s->progress, "settings: packs, pictures");
    if (!s->knobs.values)
        return take_over(s, why);
    vit_status status = knobs_spread(&s->knobs, alone + left / 3, why);
    if (status == VIT_OK)
        status = take_over(s, why);
    while (status == VIT_OK && s->out->work_count > 0 && s->knobs.count < s->knobs.most) {
        status = add_round(s, why);
        if (s->knobs.count == s->out->count)
            break; /* the front's surroundings are known */
        if (status == VIT_OK)
            status = take_over(s, why);
    }
    if (status == VIT_OK)
        status = knobs_spread(&s->knobs, s->knobs.most, why);
    return status == VIT_OK && s->knobs.count > s->out->count ? take_over(s, why) : status;
}
