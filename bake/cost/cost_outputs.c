#include "cost/cost_outputs.h"
#include "common/fail.h"
#include "cost/converge.h"
#include "cost/knobs.h"
#include "report/report.h"
#include "cost/rewrite.h"
#include <stdio.h>

/* File `index` of the folder -o; NULL beyond the last. */
static const char *file_of(const cost_options *o, uint32_t index) {
    return !o->output ? NULL : o->converge ? converge_name(index) : report_name(index);
}

vit_status cost_outputs_check(const cost_options *o, const scene *s, vit_text *why) {
    vit_status status = knobs_check(o->knobs, why);
    if (status == VIT_OK && o->frame >= s->frames) {
        status = bake_fail(why, VIT_USAGE, "--frame: the path has frames 0 to %d", s->frames - 1);
    }
    if (status == VIT_OK && o->write)
        status = rewrite_check(o->write, why);
    for (uint32_t i = 0; status == VIT_OK && file_of(o, i); i++)
        status = pack_can_make(o->output, file_of(o, i), why);
    if (status == VIT_OK && o->cache && !o->no_cache)
        status = pack_can_make(o->cache, "reference", why);
    return status;
}

/* The report's files against `read`. */
static vit_status check_report(const cost_options *o, const inputs *read, vit_text *why) {
    char path[4096];
    vit_status status = VIT_OK;
    for (uint32_t i = 0; status == VIT_OK && file_of(o, i); i++) {
        (void)snprintf(path, sizeof path, "%s/%s", o->output, file_of(o, i));
        status = inputs_check_output(read, "-o", path, why);
    }
    return status;
}

vit_status cost_outputs_are_no_inputs(const cost_options *o, const pipeline *p, vit_text *why) {
    const inputs *read[] = {&p->scene.files, &p->model.files};
    inputs source = {0}, rewritten = {0};
    vit_status status = VIT_OK;
    inputs_add(&source, o->input);
    if (o->write)
        inputs_add(&rewritten, o->write);
    /* --write is there to change the scene itself. */
    const bool other = o->write && !inputs_hold(&source, o->write);
    for (size_t k = 0; k < sizeof read / sizeof read[0] && status == VIT_OK; k++) {
        status = check_report(o, read[k], why);
        if (status == VIT_OK && other)
            status = inputs_check_output(read[k], "--write", o->write, why);
    }
    if (status == VIT_OK)
        status = check_report(o, &rewritten, why);
    inputs_free(&source);
    inputs_free(&rewritten);
    return status;
}
