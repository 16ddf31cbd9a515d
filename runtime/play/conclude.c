#include "failure.h"
#include "player.h"
#include "report_json.h"
#include "sinks/output.h"
#include <inttypes.h>
#include <stdlib.h>

golden_frames player_frames(const player *p) {
    return (golden_frames){.first = p->first,
                           .end = p->end,
                           .view = options_view_name(p->options->view),
                           .format = options_format_name(p->options->format),
                           .width = p->need.width,
                           .height = p->need.height};
}

/* What held and what did not. */
typedef struct conclusion {
    vit_status status;
    vit_text why;    /* VIT_OK: "" */
    vit_text better; /* less work than allowed */
    vit_text noise;  /* of --budget */
} conclusion;

static vit_status write_report(const player *p, const conclusion *c, vit_text *why) {
    const play_options *o = p->options;
    const uint64_t round = p->end - p->first;
    vit_text device;
    if (vit_device_name(p->info.device, &device) == NULL)
        return play_fail(why, VIT_FAILED, "%s", device.text);
    report_json j = {.pack = o->pack,
                     .device = device.text,
                     .view = options_view_name(o->view),
                     .format = options_format_name(o->format),
                     .first = p->first,
                     .end = p->end,
                     .times = &p->report,
                     .need = &p->need,
                     .last = &p->last,
                     .late = p->pacing.late,
                     .work = p->work.frames == round ? &p->work : NULL,
                     .hashes = p->hashes,
                     .hash_count = p->done < round ? p->done : round,
                     .verified = o->verify,
                     .golden = o->golden != NULL,
                     .verdict = c->status,
                     .verdict_text = c->why.text,
                     .noise = c->noise.text};
    return report_json_write(o->report_file, &j, why);
}

/* Also of a run that was interrupted. Hashes that are wrong already are not written as right ones. */
static vit_status write_files(const player *p, const conclusion *c, vit_text *why) {
    const play_options *o = p->options;
    const golden_frames frames = player_frames(p);
    const uint64_t round = p->end - p->first;
    vit_status status = VIT_OK;
    if (o->write_work_budget != NULL && p->work.frames == round)
        status = work_budget_write(o->write_work_budget, &p->work, frames.view, frames.format, why);
    if (status == VIT_OK && o->write_golden != NULL && p->done >= round && c->status != VIT_MISMATCH)
        status = golden_write(o->write_golden, &frames, p->hashes, why);
    if (status == VIT_OK && o->report_file != NULL)
        status = write_report(p, c, why);
    return status;
}

/* Tables, whole and at once: other lines may go to the same terminal or pipe. */
static vit_status tell(const player *p, vit_text *why) {
    const play_options *o = p->options;
    char *text = NULL;
    size_t size = 0;
    FILE *table = open_memstream(&text, &size);
    if (table == NULL)
        return play_fail(why, VIT_FAILED, "out of memory for the report");
    if (o->report)
        report_print(&p->report, &p->need, &p->last, p->pacing.late, o->pace, table);
    if (o->count_work && p->work.frames > 0)
        work_print(&p->work, table);
    vit_status status = fclose(table) == 0 ? VIT_OK : play_fail(why, VIT_FAILED, "out of memory for the report");
    if (status == VIT_OK && (o->hash || sink_uses_stdout(o->sink, o->target)))
        (void)fwrite(text, 1, size, stderr);
    else if (status == VIT_OK) {
        (void)fwrite(text, 1, size, stdout);
        status = output_flush_stdout(why);
    }
    free(text);
    report_dropped(options_plays(o) ? &p->last : &p->work.last, stderr);
    return status;
}

/* A loop has no other good end than SIGTERM, which is how a service is stopped. */
static bool is_cut_short(const player *p) {
    return p->options->loop == 1 || p->stopped_by != SIGTERM;
}

static vit_status judge(const player *p, conclusion *c) {
    const play_options *o = p->options;
    const uint32_t round = p->end - p->first;
    if (options_plays(o) && p->done < p->all && is_cut_short(p))
        /* A range has a frame. NOLINTNEXTLINE(clang-analyzer-core.DivideZero) */
        return play_fail(&c->why, VIT_FAILED, "interrupted at frame %u", p->first + (uint32_t)(p->done % round));
    if (options_counts(o) && p->work.frames < round && is_cut_short(p))
        return play_fail(&c->why, VIT_FAILED, "interrupted at frame %u, counting", p->first + (uint32_t)p->work.frames);
    vit_status status = verdict_end(&p->verdict, &c->why);
    if (status == VIT_OK && o->work_budget != NULL && p->work.frames == round)
        status = work_budget_check(&p->limit, &p->work, &c->better, &c->why);
    if (status == VIT_OK && o->has_budget)
        status = budget_check(&o->budget, o->percentile, p->others, &p->report, &p->need, &c->noise, &c->why);
    return status;
}

static const char *what_became_of_frames(const play_options *o) {
    if (o->verify)
        return "; every hash is the pack's";
    if (o->golden != NULL)
        return "; every hash is the file's";
    return o->out_given || o->hash ? "" : "; none kept (no --out)";
}

static void summarise(const player *p) {
    const play_options *o = p->options;
    if (p->pacing.late > 0)
        (void)fprintf(stderr, "%" PRIu64 " frames were late\n", p->pacing.late);
    vit_text name;
    const char *device = vit_device_name(p->info.device, &name);
    if (options_plays(o))
        report_closing(&p->report, device != NULL ? device : "a device that is gone", what_became_of_frames(o), stderr);
    if (options_counts(o) && p->work.frames > 0)
        (void)fprintf(stderr, "work of %" PRIu64 " %s counted%s\n", p->work.frames, p->work.frames == 1 ? "frame" : "frames",
                      o->work_budget != NULL ? ", within its budget" : "");
}

vit_status conclude(player *p, vit_text *why) {
    const play_options *o = p->options;
    conclusion c = {.status = VIT_OK};
    vit_text trouble;
    c.status = judge(p, &c);
    vit_status status = tell(p, &trouble);
    if (status == VIT_OK)
        status = write_files(p, &c, &trouble);
    if (status != VIT_OK)
        return play_fail(why, status, "%s", trouble.text);
    if (!o->quiet && c.better.text[0] != '\0')
        (void)fprintf(stderr, "%s\n", c.better.text);
    if (!o->quiet && c.status == VIT_OK && c.noise.text[0] != '\0')
        (void)fprintf(stderr, "%s\n", c.noise.text);
    if (c.status != VIT_OK)
        return play_fail(why, c.status, "%s", c.why.text);
    if (!o->quiet && !o->trace)
        summarise(p);
    return VIT_OK;
}
