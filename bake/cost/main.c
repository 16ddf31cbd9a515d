/* vitrine-cost: scene -> sweep -> report, choice. */
#include "check/exposure.h"
#include "common/fail.h"
#include "cost/converge.h"
#include "cost/cost_options.h"
#include "cost/cost_outputs.h"
#include "cost/fit.h"
#include "cost/machine.h"
#include "report/report.h"
#include "cost/rewrite.h"
#include "reference/spread.h"
#include "cost/sweep.h"
#include <stdio.h>
#include <string.h>

/* Set by Ctrl-C and SIGTERM; the sweep looks at it between steps, and unfinished references are kept. */
static volatile sig_atomic_t cancel;

static void on_signal(int number) {
    (void)number;
    cancel = 1;
}

/* The first Ctrl-C ends cleanly after the step at hand; a second one at once. */
static void catch_signals(void) {
    struct sigaction stop = {.sa_handler = on_signal, .sa_flags = (int)SA_RESETHAND};
    (void)sigaction(SIGINT, &stop, NULL);
    (void)sigaction(SIGTERM, &stop, NULL);
}

/* The device whose frames are timed. OpenCL is looked at only if there is something to time. */
static vit_status find_device(const cost_options *o, uint32_t *out, vit_text *why) {
    *out = VIT_DEVICE_HOST;
    if (o->device)
        return vit_device_find(o->device, out, why);
    if (o->output || o->fit > 0)
        *out = vit_device_default();
    vit_text none;
    if ((o->output || o->fit > 0) && *out == VIT_DEVICE_HOST && !o->quiet && !vit_device_name(0, &none))
        fprintf(stderr, "%s; timing the built-in device host\n", none.text);
    return VIT_OK;
}

static vit_status load(const cost_options *o, pipeline *p, vit_text *why) {
    p->strict = o->strict;
    p->threads = o->threads;
    p->device = VIT_DEVICE_HOST;
    vit_status status = pipeline_read(o->input, &p->scene, why);
    if (status != VIT_OK)
        return status;
    if (o->width) {
        p->scene.width = o->width;
        p->scene.height = o->height;
    }
    status = spread_rank() == 0 ? cost_outputs_check(o, &p->scene, why) : VIT_OK; /* it writes for all */
    if (status == VIT_OK)
        status = cost_outputs_are_no_inputs(o, p, why);
    if (spread_any(status != VIT_OK))
        return status == VIT_OK ? bake_fail(why, VIT_FAILED, "rank 0 cannot write its files") : status;
    status = pipeline_load(p, why);
    if (status == VIT_OK)
        status = exposure_settle(p, why);
    return status == VIT_OK ? cost_outputs_are_no_inputs(o, p, why) : status;
}

static vit_status fit(const cost_options *o, const cost_results *r, vit_text *why) {
    const fit_budget budget = {.ms = o->fit, .work = (uint64_t)o->fit_work, .relmse = o->relmse};
    uint32_t chosen;
    vit_status status = fit_choose(r, &budget, &chosen, why);
    if (status == VIT_OK || status == VIT_BUDGET)
        fit_print(r, &budget, chosen, stdout);
    if (status != VIT_OK)
        return status;
    printf("\n%s\nquality: { %s};\n", r->settings[chosen].name, r->settings[chosen].values);
    return o->write ? rewrite_file(o->write, r->settings[chosen].values, why) : VIT_OK;
}

static vit_status converge(const cost_options *o, const sweep_input *in, vit_text *why) {
    converge_results r;
    const converge_plan steps = {o->converge, o->shrink};
    vit_status status = converge_run(in, &steps, &r, why);
    if (status != VIT_OK || r.count == 0)
        return status;
    converge_print(&r, stdout);
    return converge_write(&r, o->output, why);
}

static vit_status run(const cost_options *o, pipeline *p, cost_results *r, vit_text *why) {
    char folder[4096];
    uint32_t device;
    vit_status status = find_device(o, &device, why);
    const sweep_input in = {.pipeline = p,
                            .device = device,
                            .fit_ms = o->output ? 0 : o->fit, /* a report shows all times */
                            .to_choose = !o->output,
                            .relmse = o->relmse,
                            .knobs = o->knobs,
                            .settings = o->settings,
                            .frame = o->frame,
                            .every = o->every,
                            .repeats = o->output || o->fit > 0 ? o->repeats : 0, /* work needs no times */
                            .reference_error = o->reference_error,
                            .max_samples = o->max_samples,
                            .cache = o->no_cache ? NULL
                                     : o->cache  ? o->cache
                                                 : machine_cache_folder(folder, sizeof folder),
                            .memory = o->memory > 0 ? (uint64_t)o->memory << 20 : machine_memory(),
                            .cancel = &cancel};
    if (spread_any(status != VIT_OK))
        return status == VIT_OK ? bake_fail(why, VIT_FAILED, "another rank has no such device") : status;
    status = load(o, p, why);
    if (status == VIT_OK && o->converge)
        return converge(o, &in, why);
    if (status == VIT_OK)
        status = sweep_run(&in, r, why);
    if (status != VIT_OK || r->count == 0)
        return status;
    if (o->output) {
        progress_stage(p->progress, "report");
        status = report_write(r, o->output, why);
        progress_end(p->progress);
    }
    return status == VIT_OK && (o->fit > 0 || o->fit_work > 0) ? fit(o, r, why) : status;
}

int main(int argc, char **argv) {
    cost_options o;
    cost_results r = {.count = 0};
    pipeline p;
    vit_text why = {""};
    memset(&p, 0, sizeof p);
    spread_begin(&argc, &argv);
    vit_status status = cost_options_parse(argc, argv, &o, &why);
    const bool talks = spread_rank() == 0;
    progress line = progress_make(o.quiet || !talks);
    p.progress = &line;
    if (status == VIT_OK && o.help && talks)
        cost_options_help();
    else if (status == VIT_OK && o.version && talks)
        puts("vitrine-cost " VIT_VERSION);
    else if (status == VIT_OK && !o.help && !o.version) {
        catch_signals();
        status = run(&o, &p, &r, &why);
        progress_end(&line);
    }
    if (status == VIT_OK && (fflush(stdout) != 0 || ferror(stdout)))
        status = bake_fail(&why, VIT_FAILED, "standard output: write failed");
    if (status != VIT_OK && (talks || spread_size() == 1))
        fprintf(stderr, "vitrine-cost: %s\n", why.text);
    sweep_free(&r);
    pipeline_free(&p);
    spread_end();
    return status;
}
