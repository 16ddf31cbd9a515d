#include "cost/fit_pack.h"
#include "common/fail.h"
#include "cost/machine.h"
#include "cost/sweep.h"
#include "cost/timing.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* 95th percentile of the milliseconds of all frames, each played at least once and at least SWEEP_LEAST_REPEATS in all. */
static vit_status measure(const pipeline *p, uint32_t device, const pipeline_packed *packed, const char *name, double *p95,
                          vit_text *why) {
    const uint32_t frames = packed->plan.scene.frames, repeats = frames > SWEEP_LEAST_REPEATS ? frames : SWEEP_LEAST_REPEATS;
    timing_entry e = {.name = name,
                      .pack = packed->bytes,
                      .pack_size = packed->size,
                      .ms = calloc(repeats, sizeof(double)),
                      .pass_ms = calloc((size_t)repeats * VIT_MAX_PASSES, sizeof(double))};
    const timing_input in = {.entries = &e, .count = 1, .device = device, .repeats = repeats};
    vit_status status;
    progress_stage(p->progress, "the budget, on all frames");
    if (e.ms && e.pass_ms)
        status = timing_measure(&in, why);
    else
        status = bake_fail(why, VIT_FAILED, "out of memory");
    progress_end(p->progress);
    if (status == VIT_OK)
        *p95 = timing_percentile(e.ms, repeats, 95);
    free(e.ms);
    free(e.pass_ms);
    return status;
}

/* Packs setting `chosen`. *holds: it keeps the budget on all frames; if not, its measured time replaces that of the sweep. */
static vit_status try_setting(pipeline *p, uint32_t device, const fit_budget *b, cost_setting *chosen, pipeline_packed *out,
                              bool *holds, vit_text *why) {
    *holds = true;
    vit_status status = sweep_quality(chosen, &p->scene.quality, why);
    p->indirect_why[0] = '\0';
    const pipeline_choice choice = pipeline_default(p);
    if (status == VIT_OK)
        status = pipeline_pack(p, &choice, out, why);
    if (status != VIT_OK || !(b->ms > 0))
        return status;
    double p95 = 0;
    status = measure(p, device, out, chosen->name, &p95, why);
    *holds = status == VIT_OK && p95 <= b->ms;
    if (status == VIT_OK && !*holds) {
        progress_line(p->progress, false, "%s: %.2f ms (95th percentile) on all frames, too long", chosen->name, p95);
        chosen->ms_p95 = p95;
    } else if (status == VIT_OK)
        progress_line(p->progress, false, "%s: %.2f ms (95th percentile) on all frames", chosen->name, p95);
    if (!*holds)
        pipeline_packed_free(out);
    return status;
}

static vit_status choose(pipeline *p, uint32_t device, const fit_budget *b, cost_results *r, pipeline_packed *out,
                         vit_text *why) {
    for (bool holds = false;;) {
        uint32_t chosen;
        vit_status status = fit_choose(r, b, &chosen, why);
        if (status != VIT_OK) {
            fit_print(r, b, r->count, stdout);
            return status;
        }
        status = try_setting(p, device, b, &r->settings[chosen], out, &holds, why);
        if (status != VIT_OK)
            return status;
        if (holds) {
            fit_print(r, b, chosen, stdout);
            printf("\n%s\nquality: { %s};\n", r->settings[chosen].name, r->settings[chosen].values);
            return VIT_OK;
        }
    }
}

vit_status fit_pack(pipeline *p, uint32_t device, const fit_budget *budget, pipeline_packed *out, vit_text *why) {
    char folder[4096];
    cost_results results;
    const sweep_input in = {.pipeline = p,
                            .device = device,
                            .fit_ms = budget->ms,
                            .to_choose = true,
                            .relmse = budget->relmse,
                            .settings = SWEEP_SETTINGS,
                            .frame = -1,
                            .repeats = budget->ms > 0 ? SWEEP_REPEATS : 0,
                            .max_samples = SWEEP_SAMPLES,
                            .cache = machine_cache_folder(folder, sizeof folder),
                            .memory = machine_memory()};
    memset(out, 0, sizeof *out);
    vit_status status = sweep_run(&in, &results, why);
    if (status == VIT_OK)
        status = choose(p, device, budget, &results, out, why);
    sweep_free(&results);
    return status;
}
