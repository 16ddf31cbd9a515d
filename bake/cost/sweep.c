/* default pack -> reference -> settings -> pictures, work -> errors, a better reference if need be -> times -> front. */
#include "cost/sweep_parts.h"
#include "common/fail.h"
#include "cost/pareto.h"
#include "cost/machine.h"
#include "reference/spread.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* NMSE of a first reference, from which the smallest error of a setting is judged, and the part of that which its own may be.
 * To choose a setting less will do: all are compared with one picture, whose noise adds the same to each on average, and is
 * taken off. relMSE has no such figure. */
#define FIRST_ERROR 1e-3
#define ERROR_PART 10
#define FIRST_ERROR_TO_CHOOSE 4e-3
#define ERROR_PART_TO_CHOOSE 4
#define MOST_REFERENCES 4

bool sweep_cancelled(const sweep *s, vit_text *why) {
    if (s->in->cancel && *s->in->cancel)
        (void)bake_fail(why, VIT_FAILED, "interrupted");
    return s->in->cancel && *s->in->cancel;
}

static vit_status fail(vit_status status, vit_text *why, const char *cause) {
    return bake_fail(why, status, "%s", cause);
}

/* Evenly spread over the path, ascending; the one nearest to the compared frame gives way to it. */
static vit_status choose_frames(sweep *s, vit_text *why) {
    const uint32_t all = (uint32_t)s->in->pipeline->scene.frames, most = s->in->frames ? s->in->frames : SWEEP_FRAMES,
                   count = all < most ? all : most;
    const int64_t want = s->in->frame < 0 ? all / 2 : s->in->frame;
    if (want >= all) {
        return bake_fail(why, VIT_USAGE, "--frame: the path has frames 0 to %u", all - 1);
    }
    for (uint32_t i = 0; i < count; i++) {
        s->frames[i] = count > 1 ? (uint32_t)((uint64_t)i * (all - 1) / (count - 1)) : 0;
        if (llabs((int64_t)s->frames[i] - want) < llabs((int64_t)s->frames[s->at] - want))
            s->at = i;
    }
    s->frames[s->at] = (uint32_t)want;
    s->frame_count = count;
    return VIT_OK;
}

static vit_status choose_grid(sweep *s, vit_text *why) {
    const scene *c = &s->in->pipeline->scene;
    const uint32_t shorter = (uint32_t)(c->width < c->height ? c->width : c->height);
    s->grid =
        (images_grid){.width = (uint32_t)c->width, .height = (uint32_t)c->height, .every = s->in->every ? s->in->every : 1};
    while (s->in->every == 0 && (uint64_t)images_across(&s->grid) * images_down(&s->grid) > SWEEP_GRID)
        s->grid.every++;
    s->points = (size_t)images_across(&s->grid) * images_down(&s->grid);
    if (s->grid.every / 2 < shorter)
        return VIT_OK;
    return fail(VIT_USAGE, why, "--every: no pixel of so small a frame is compared");
}

static vit_status pack_default(sweep *s, vit_text *why) {
    pipeline *p = s->in->pipeline;
    vit_status status = pipeline_settle_indirect(p, why); /* knobs are its settings */
    if (status != VIT_OK)
        return status;
    pipeline_choice choice = pipeline_default(p);
    choice.frames = s->frames;
    choice.frame_count = s->frame_count;
    status = pipeline_pack(p, &choice, &s->base, why);
    if (status != VIT_OK)
        return status;
    s->direct_only = calloc(s->base.tracks.light_count + 1u, sizeof *s->direct_only);
    if (!s->direct_only)
        return fail(VIT_FAILED, why, "out of memory");
    for (uint32_t i = 0; i < s->base.tracks.light_count; i++)
        s->direct_only[i] = !p->scene.automatic && !p->scene.lights[i].photons;
    return VIT_OK;
}

static void reference_step(void *user, double fraction, double seconds_left) {
    (void)seconds_left; /* the line estimates it as well */
    progress_step(user, fraction);
}

static vit_status make_reference(sweep *s, double target, vit_text *why) {
    reference *r = &s->out->reference;
    s->truth = (reference_input){.sections = &s->base.sections,
                                 .direct_only = s->direct_only,
                                 .frame = s->at,
                                 .every = s->grid.every,
                                 .bounces = s->base.plan.scene.bounces,
                                 .target = target,
                                 .max_samples = s->in->max_samples,
                                 .threads = s->in->pipeline->threads,
                                 .cache = s->in->cache,
                                 .cancel = s->in->cancel,
                                 .progress = reference_step,
                                 .user = s->progress};
    progress_stage(s->progress, "reference");
    reference_free(r);
    vit_status status = reference_render(&s->truth, r, why);
    progress_end(s->progress);
    if (status == VIT_OK)
        progress_line(s->progress, false, "reference: %u paths a pixel, NMSE of its own error %.2g", r->samples, r->error);
    if (status == VIT_OK && (r->width != images_across(&s->grid) || r->height != images_down(&s->grid)))
        return fail(VIT_FAILED, why, "the reference has another size than the grid");
    return status;
}

/* Knows the settings that stand alone; sweep_search() adds the others. */
static vit_status list_settings(sweep *s, vit_text *why) {
    const scene_quality *q = &s->in->pipeline->scene.quality;
    const knobs_input in = {.base = q,
                            .radius = (double)s->base.plan.scene.radius,
                            .effects = s->base.plan.scene.effects,
                            .only = s->in->knobs,
                            .in_quality = s->in->to_choose,
                            .most = s->in->settings};
    char idle[256];
    knobs_idle(&in, idle, sizeof idle);
    if (idle[0] && in.effects & VIT_BIT(INDIRECT))
        progress_line(s->progress, false, "indirect light by %s: nothing to turn is left to %s",
                      settings_indirect_name(q->indirect), idle);
    vit_status status =
        s->in->list ? s->in->list(s->in->list_user, q, in.radius, &s->knobs, why) : knobs_open(&in, &s->knobs, why);
    if (status != VIT_OK)
        return status;
    s->out->settings = calloc(s->knobs.most, sizeof *s->out->settings);
    s->packs = calloc(s->knobs.most, sizeof *s->packs);
    s->indirect = calloc(s->knobs.most, sizeof *s->indirect);
    s->directs = calloc(s->knobs.most, sizeof *s->directs);
    return s->out->settings && s->packs && s->indirect && s->directs ? VIT_OK : fail(VIT_FAILED, why, "out of memory");
}

static double error_part(const sweep *s) {
    return sweep_own_error_off(s) ? ERROR_PART_TO_CHOOSE : ERROR_PART;
}

/* Errors mean something when the reference's own is below a part of the smallest: what it must fall below, 0 if it has. */
static double better_target(const sweep *s) {
    const double least = sweep_smallest_error(s) / error_part(s), own = s->out->reference.error;
    const bool more = s->out->reference.samples < s->in->max_samples;
    return s->in->reference_error > 0 || !more || own <= least ? 0 : least / 1.2; /* a little less: the error falls as well */
}

static void say_reference(const sweep *s) {
    const double least = sweep_smallest_error(s), own = s->out->reference.error;
    const cost_results *r = s->out;
    if (own > least / error_part(s))
        progress_line(s->progress, true,
                      "warning: the reference's own error, NMSE %.2g, is more than 1/%.0f of the smallest error, %.2g: more "
                      "--max-samples, or a "
                      "smaller --reference-error",
                      own, error_part(s), least);
    progress_line(s->progress, false,
                  "direct light against the reference: NMSE %.2g, largest difference %.2g of the mean; bounce limit: NMSE %.2g",
                  r->direct.nmse, r->direct_largest, r->truncation.nmse);
}

/* Rank 0 says how good the reference must be, until it is; all ranks make it. */
static vit_status compare(sweep *s, vit_text *why) {
    const bool first_rank = spread_rank() == 0;
    const double first = sweep_own_error_off(s) ? FIRST_ERROR_TO_CHOOSE : FIRST_ERROR;
    double target = s->in->reference_error > 0 ? s->in->reference_error : first;
    vit_status status = VIT_OK;
    for (int round = 0; round < MOST_REFERENCES && target > 0; round++) {
        status = make_reference(s, target, why);
        if (spread_any(status != VIT_OK))
            return status != VIT_OK ? status : fail(VIT_FAILED, why, "another rank failed");
        if (first_rank && round == 0)
            status = sweep_search(s, why);
        if (first_rank && status == VIT_OK)
            status = sweep_errors(s, why);
        target = first_rank && status == VIT_OK ? better_target(s) : 0;
        spread_share(&target, sizeof target);
    }
    return status;
}

static void describe(sweep *s) {
    const pipeline *p = s->in->pipeline;
    cost_results *r = s->out;
    vit_text text;
    const char *device = vit_device_name(s->in->device, &text),
               *name = p->scene.name[0] ? p->scene.name : strrchr(p->scene.path, '/');
    (void)snprintf(r->scene, sizeof r->scene, "%.*s", COST_NAME - 1, name ? name + (*name == '/') : p->scene.path);
    (void)snprintf(r->device, sizeof r->device, "%.*s", (int)sizeof r->device - 1, device ? device : "");
    machine_cpu(r->cpu, sizeof r->cpu);
    r->width = s->grid.width;
    r->height = s->grid.height;
    r->frame = s->frames[s->at];
    r->every = s->grid.every;
}

static vit_status run(sweep *s, vit_text *why) {
    vit_status status = choose_frames(s, why);
    if (status == VIT_OK)
        status = choose_grid(s, why);
    describe(s);
    if (status == VIT_OK)
        status = pack_default(s, why);
    if (status == VIT_OK && spread_rank() == 0)
        status = list_settings(s, why);
    if (spread_any(status != VIT_OK))
        return status != VIT_OK ? status : fail(VIT_FAILED, why, "another rank failed");
    status = compare(s, why);
    if (status == VIT_OK && s->in->normals)
        status = sweep_normals(s, why);
    const bool first_rank = spread_rank() == 0;
    spread_end(); /* the other ranks must not take time from what is timed */
    if (status != VIT_OK || !first_rank)
        return status;
    sweep_compare_direct(s);
    progress_end(s->progress);
    say_reference(s);
    if (s->in->repeats > 0 && s->in->fit_ms > 0)
        status = sweep_times_to_fit(s, why);
    else if (s->in->repeats > 0)
        status = sweep_times(s, why);
    if (status == VIT_OK)
        pareto_mark(s->out);
    return status;
}

vit_status sweep_run(const sweep_input *in, cost_results *out, vit_text *why) {
    sweep s = {.in = in, .progress = in->pipeline->progress, .out = out, .brief = in->to_choose};
    memset(out, 0, sizeof *out);
    vit_status status = run(&s, why);
    progress_end(s.progress);
    for (uint32_t i = 0; i < out->count; i++) {
        if (s.packs)
            sweep_drop_pack(&s, i);
        if (s.indirect)
            free(s.indirect[i]);
    }
    for (uint32_t i = 0; i < s.direct_count; i++)
        free(s.directs[i].image);
    free(s.directs);
    free(s.packs);
    free(s.indirect);
    knobs_close(&s.knobs);
    free(s.direct_only);
    pipeline_packed_free(&s.base);
    if (status != VIT_OK)
        sweep_free(out);
    return status;
}

void sweep_free(cost_results *r) {
    for (uint32_t i = 0; i < r->count && r->settings; i++)
        free(r->settings[i].image);
    free(r->settings);
    reference_free(&r->reference);
    memset(r, 0, sizeof *r);
}

vit_status sweep_quality(const cost_setting *s, scene_quality *out, vit_text *why) {
    *out = (scene_quality){.photons = 1, .bounces = 1, .tile = 8}; /* all of it is overwritten */
    return scene_quality_apply(s->values, out, why);
}
