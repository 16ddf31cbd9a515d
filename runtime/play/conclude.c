#include "failure.h"
#include "player.h"
#include "report_json.h"
#include <inttypes.h>

static vit_status write_files(const player *p, vit_text *why) {
    const play_options *o = p->options;
    const char *view = options_view_name(o->view), *format = options_format_name(o->format);
    bool counted = p->work.frames == p->end - p->first;
    vit_status status = VIT_OK;
    vit_text device;
    if (o->write_work_budget != NULL && counted)
        status = work_budget_write(o->write_work_budget, &p->work, view, format, why);
    if (o->report_file == NULL || status != VIT_OK)
        return status;
    if (vit_device_name(p->info.device, &device) == NULL)
        return play_fail(why, VIT_FAILED, "%s", device.text);
    report_json j = {.pack = o->pack,
                     .device = device.text,
                     .view = view,
                     .format = format,
                     .first = p->first,
                     .end = p->end,
                     .times = &p->report,
                     .need = &p->need,
                     .last = &p->last,
                     .late = p->pacing.late,
                     .work = counted ? &p->work : NULL};
    return report_json_write(o->report_file, &j, why);
}

/* Tables and files, also of a run that was interrupted. */
static vit_status tell(const player *p, vit_text *why) {
    const play_options *o = p->options;
    FILE *to = o->hash || sink_uses_stdout(o->sink, o->target) ? stderr : stdout;
    if (o->report)
        report_print(&p->report, &p->need, &p->last, p->pacing.late, o->pace, to);
    if (o->count_work && p->work.frames > 0)
        work_print(&p->work, to);
    report_dropped(options_plays(o) ? &p->last : &p->work.last, stderr);
    return write_files(p, why);
}

static vit_status check_verdicts(player *p, vit_text *why) {
    const play_options *o = p->options;
    vit_text better = {""};
    vit_status status = verdict_end(&p->verdict, why);
    if (status == VIT_OK && o->work_budget != NULL && p->work.frames == p->end - p->first)
        status = work_budget_check(&p->limit, &p->work, &better, why);
    if (status == VIT_OK && o->has_budget)
        status = budget_check(&o->budget, o->percentile != 0 ? o->percentile : 95, &p->report, &p->need, why);
    if (better.text[0] != '\0' && !o->quiet)
        (void)fprintf(stderr, "%s\n", better.text);
    return status;
}

static void summarise(const player *p) {
    const play_options *o = p->options;
    if (p->pacing.late > 0)
        (void)fprintf(stderr, "%" PRIu64 " frames were late\n", p->pacing.late);
    vit_text name;
    const char *device = vit_device_name(p->info.device, &name);
    if (options_plays(o))
        report_summary(&p->report, device != NULL ? device : "a device that is gone",
                       o->verify                 ? "; every hash is the pack's"
                       : o->out_given || o->hash ? ""
                                                 : "; none kept (no --out)",
                       stderr);
    if (options_counts(o) && p->work.frames > 0)
        (void)fprintf(stderr, "work of %" PRIu64 " %s counted%s\n", p->work.frames, p->work.frames == 1 ? "frame" : "frames",
                      o->work_budget != NULL ? ", within its budget" : "");
}

/* A loop has no other good end than SIGTERM, which is how a service is stopped. */
static bool is_cut_short(const player *p) {
    return p->options->loop == 1 || p->stopped_by != SIGTERM;
}

vit_status conclude(player *p, vit_text *why) {
    const play_options *o = p->options;
    vit_status status = tell(p, why);
    if (status == VIT_OK && options_plays(o) && p->done < p->all && is_cut_short(p))
        /* A range has a frame. NOLINTNEXTLINE(clang-analyzer-core.DivideZero) */
        return play_fail(why, VIT_FAILED, "interrupted at frame %u", p->first + (uint32_t)(p->done % (p->end - p->first)));
    if (status == VIT_OK && options_counts(o) && p->work.frames < p->end - p->first && is_cut_short(p))
        return play_fail(why, VIT_FAILED, "interrupted at frame %u, counting", p->first + (uint32_t)p->work.frames);
    if (status == VIT_OK)
        status = check_verdicts(p, why);
    if (status == VIT_OK && !o->quiet && !o->trace)
        summarise(p);
    return status;
}
