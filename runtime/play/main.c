/* vitrine-play: maps a pack, opens it with libvitrine, plays its frames into a sink, and says how it went.
 * Flow: options -> pack -> vit_require -> (explain, or: arena -> vit_open -> sink -> frames -> counting -> report -> budgets).
 */
#include "device.h"
#include "failure.h"
#include "outputs.h"
#include "player.h"
#include "pocl_cache.h"
#include "sinks/output.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The variables of the program: the signal, Ctrl-C's or SIGTERM, read between frames, and when it came, for handlers alone. */
static volatile sig_atomic_t stop_requested;
static struct timespec requested_at;

static void on_stop(void (*handler)(int), int flags) {
    struct sigaction stop = {.sa_handler = handler, .sa_flags = flags};
    (void)sigemptyset(&stop.sa_mask);
    (void)sigaddset(&stop.sa_mask, SIGINT);
    (void)sigaddset(&stop.sa_mask, SIGTERM);
    (void)sigaction(SIGINT, &stop, NULL);
    (void)sigaction(SIGTERM, &stop, NULL);
}

/* timeout(1) and others signal a process and then its group: so a second signal that comes at once, within 1 to 2 s, is the
 * first one over again. A third is not. */
static void request_again(int number) {
    on_stop(SIG_DFL, 0);
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    if (now.tv_sec - requested_at.tv_sec >= 2) /* 1 to 2 s are over */
        (void)raise(number);                   /* comes when this returns */
}

static void request_stop(int number) {
    stop_requested = number;
    (void)clock_gettime(CLOCK_MONOTONIC, &requested_at);
    on_stop(request_again, SA_RESTART); /* the repetition interrupts nothing more */
}

/* The first Ctrl-C ends after the frame at hand; a later one, should a device or a pipe hang, ends at once. */
static void catch_signals(void) {
    struct sigaction ignore = {.sa_handler = SIG_IGN}; /* a closed pipe is an error of write(), with a text */
    on_stop(request_stop, 0);
    (void)sigaction(SIGPIPE, &ignore, NULL);
    (void)sigaction(SIGXFSZ, &ignore, NULL); /* likewise a file that gets larger than it may */
}

/* vit_require() with the file's name before what it says about the pack. */
static vit_status require(player *p, vit_text *why) {
    vit_text cause;
    vit_status status = vit_require(&p->info, &p->need, &cause);
    if (status == VIT_BAD_INPUT)
        return play_fail(why, status, "%s: %s", p->options->pack, cause.text);
    if (status != VIT_OK)
        return play_fail(why, status, "%s", cause.text);
    return VIT_OK;
}

static vit_status refuse_size(player *p, vit_text *why) {
    vit_text unused;
    char size[32] = "";
    if (pack_file_map(p->options->pack, &p->pack, &unused) == VIT_OK) {
        p->info = (vit_open_info){.pack = p->pack.bytes, .pack_size = p->pack.size};
        if (require(p, &unused) == VIT_OK)
            (void)snprintf(size, sizeof size, " (%ux%u)", p->need.width, p->need.height);
    }
    return play_fail(why, VIT_USAGE, "--size: the size is fixed by the pack%s: set output in the scene file and bake again",
                     size);
}

static vit_status check_frames(player *p, vit_text *why) {
    const play_options *o = p->options;
    p->first = o->first;
    p->end = o->end == 0 ? p->need.frames : o->end;
    if (p->first >= p->need.frames || p->end > p->need.frames)
        return play_fail(why, VIT_USAGE, "--frames: the pack has frames 0 to %u (--frames 0:%u is all)", p->need.frames - 1,
                         p->need.frames);
    p->all = o->loop == 0 ? UINT64_MAX : (uint64_t)(p->end - p->first) * o->loop;
    return VIT_OK;
}

static vit_status take_memory(void **out, size_t size, size_t alignment, const char *what, vit_text *why) {
    size_t rounded = size <= SIZE_MAX - alignment ? (size / alignment + 1) * alignment : 0; /* aligned_alloc wants a multiple */
    *out = rounded != 0 ? aligned_alloc(alignment, rounded) : NULL;
    if (*out == NULL)
        return play_fail(why, VIT_FAILED, "out of memory: %zu bytes for the %s", size, what);
    return VIT_OK;
}

static vit_status open_sink(player *p, vit_text *why) {
    const play_options *o = p->options;
    sink_setup setup = {.target = o->target,
                        .width = p->need.width,
                        .height = p->need.height,
                        .fps = (double)p->need.fps,
                        .frame_bytes = p->need.frame_bytes};
    vit_status status = o->sink->open(&setup, &p->sink, why);
    p->sink_is_open = status == VIT_OK;
    return status;
}

/* A progress line would run through printed lines if both go to the terminal. */
static bool has_progress(const play_options *o) {
    return !o->quiet && isatty(STDERR_FILENO) && !o->trace && !(o->hash && isatty(STDOUT_FILENO));
}

static bool is_timed(const play_options *o) {
    return o->report || o->report_file != NULL || o->has_budget;
}

/* Devices do some of their work at the first frame only, such as compiling: where times are asked for, one frame comes before
 * them. */
static vit_status warm_up(player *p, vit_text *why) {
    return is_timed(p->options) || p->options->pace
               ? vit_frame(p->v, p->first, p->frame.memory.pixels, p->frame.memory.pitch, why)
               : VIT_OK;
}

static void tell_note(const vit_text *note) {
    if (note->text[0] != '\0')
        (void)fprintf(stderr, "vitrine-play: %s\n", note->text);
}

static vit_status open_vit(player *p, vit_text *why) {
    vit_status status = require(p, why); /* the arena's size depends on the device */
    if (status == VIT_OK)
        status = take_memory(&p->arena, p->need.host_bytes, 64, "library's arena", why);
    p->info.arena = p->arena;
    p->info.arena_size = p->need.host_bytes;
    return status == VIT_OK ? vit_open(&p->info, &p->v, why) : status;
}

/* A device that nobody asked for need not be able to. */
static vit_status open_or_fall_back(player *p, vit_text *why) {
    vit_text note = {""};
    vit_status status = open_vit(p, why);
    if (status != VIT_FAILED || !device_fall_back(p->options, &p->info, &note, why))
        return status;
    tell_note(&note);
    free(p->arena);
    return open_vit(p, why);
}

/* The sink's memory, or our own. */
static vit_status take_framebuffer(player *p, vit_text *why) {
    const sink_kind *sink = p->options->sink;
    sink_memory lent;
    vit_status status = sink->lend != NULL ? open_sink(p, why) : VIT_OK;
    if (status == VIT_OK && sink->lend != NULL)
        lent = sink->lend(p->sink);
    if (status == VIT_OK)
        status = framebuffer_take(&p->frame, sink->lend != NULL ? &lent : NULL, &p->need, why);
    p->info.framebuffer = p->frame.memory.pixels;
    p->info.framebuffer_pitch = p->frame.memory.pitch;
    p->info.framebuffer_size = p->frame.memory.size;
    return status;
}

/* A sink that lends no memory comes last: it may empty a file, so by then nothing else should fail. */
static vit_status open_all(player *p, vit_text *why) {
    const play_options *o = p->options;
    vit_status status = take_framebuffer(p, why);
    if (status == VIT_OK)
        status = open_or_fall_back(p, why);
    p->verdict = (verdict){.compare = o->verify,
                           .print = o->hash,
                           .format = o->format,
                           .begin = p->first,
                           .hashes = p->hashes,
                           .golden = p->golden};
    if (status == VIT_OK)
        status = verdict_begin(&p->verdict, p->v, p->first, p->end, why);
    if (status == VIT_OK)
        status = warm_up(p, why);
    if (status == VIT_OK)
        status = report_begin(&p->report, p->all, is_timed(o) ? p->need.pass_count : 0, has_progress(o), why);
    p->pacing = (pacing){.fps = o->pace ? (double)p->need.fps : 0};
    if (status == VIT_OK && !p->sink_is_open)
        status = open_sink(p, why);
    return status;
}

static vit_status play_frame(player *p, uint32_t index, vit_text *why) {
    double began = pacing_now_ms();
    vit_status status = vit_frame(p->v, index, p->frame.memory.pixels, p->frame.memory.pitch, why);
    if (status == VIT_OK)
        status = report_frame(&p->report, p->v, pacing_now_ms() - began, why);
    if (status == VIT_OK && verdict_hashes(&p->verdict))
        status = verdict_frame(&p->verdict, p->v, index, framebuffer_rows(&p->frame), p->need.frame_bytes, why);
    if (status == VIT_OK) {
        pacing_wait(&p->pacing, &stop_requested);
        status = p->options->sink->write(p->sink, p->frame.lent ? NULL : framebuffer_rows(&p->frame), index, why);
    }
    if (status == VIT_OK)
        report_progress(&p->report, ++p->done, p->all);
    return status;
}

static vit_status play_frames(player *p, vit_text *why) {
    uint32_t length = p->end - p->first;
    vit_status status = VIT_OK;
    while (status == VIT_OK && p->done < p->all && !stop_requested)
        if (p->options->trace)
            status = trace_frames(p->v, &p->need, p->first, p->end, &stop_requested, &p->done, why);
        else
            status = play_frame(p, p->first + (uint32_t)(p->done % length), why);
    return status;
}

/* The round of frames, and how many the sink took. */
static vit_status play(player *p, vit_text *why) {
    vit_status status = open_all(p, why);
    p->load = machine_load_now();
    if (status == VIT_OK)
        status = play_frames(p, why);
    const machine_load after = machine_load_now();
    p->others = machine_load_others(&p->load, &after);
    report_progress_clear(&p->report);
    if (status == VIT_OK)
        status = vit_stats(p->v, &p->last, why);
    if (p->v)
        report_faults(p->v, stderr);
    vit_close(p->v); /* it may still have the sink's memory */
    if (p->sink_is_open) {
        vit_text late; /* the first failure is the one to tell */
        vit_status closed = p->options->sink->close(p->sink, &late);
        if (status == VIT_OK && closed != VIT_OK)
            status = play_fail(why, closed, "%s", late.text);
    }
    return status;
}

/* Times and frames first, from a vit that does not count; then the work. */
static vit_status play_and_count(player *p, vit_text *why) {
    const play_options *o = p->options;
    vit_status status = options_plays(o) ? play(p, why) : VIT_OK;
    if (status == VIT_OK && options_counts(o) && !stop_requested)
        status = work_count(&p->info, p->first, p->end, has_progress(o), &stop_requested, &p->work, why);
    p->stopped_by = stop_requested;
    if (status == VIT_OK)
        status = conclude(p, why);
    report_free(&p->report);
    framebuffer_free(&p->frame);
    free(p->arena);
    return status;
}

/* What can be wrong with budgets shows before the first frame. */
static vit_status check_budgets(player *p, vit_text *why) {
    const play_options *o = p->options;
    vit_status status = o->has_budget ? budget_check_names(&o->budget, &p->need, why) : VIT_OK;
    if (status == VIT_OK && o->work_budget != NULL)
        status = work_budget_read(o->work_budget, &p->limit, why);
    if (status == VIT_OK && o->work_budget != NULL)
        status = work_budget_check_frames(&p->limit, p->first, p->end, options_view_name(o->view),
                                          options_format_name(o->format), why);
    return status;
}

/* Room for hashes, and the file to compare with. */
static vit_status check_golden(player *p, vit_text *why) {
    const play_options *o = p->options;
    const golden_frames frames = player_frames(p);
    const size_t count = p->end - p->first;
    if (o->golden != NULL || o->write_golden != NULL || o->report_file != NULL)
        if ((p->hashes = calloc(count, sizeof *p->hashes)) == NULL)
            return play_fail(why, VIT_FAILED, "out of memory: %zu hashes", count);
    if (o->golden == NULL)
        return VIT_OK;
    if ((p->golden = calloc(count, sizeof *p->golden)) == NULL)
        return play_fail(why, VIT_FAILED, "out of memory: %zu hashes", count);
    return golden_read(o->golden, &frames, p->golden, why);
}

/* Options of the device host, where another one plays by default. */
static vit_status check_host_options(const player *p, vit_text *why) {
    const play_options *o = p->options;
    vit_text name = {""};
    const char *option = options_of_host(o);
    if (option == NULL || p->info.device == VIT_DEVICE_HOST || vit_device_name(p->info.device, &name) == NULL)
        return VIT_OK;
    return play_fail(why, VIT_USAGE, "%s is for --device host, not for the default, %.300s", option, name.text);
}

static vit_status run_pack(player *p, vit_text *why) {
    const play_options *o = p->options;
    if (o->size != NULL)
        return refuse_size(p, why);
    vit_status status = pack_file_map(o->pack, &p->pack, why);
    if (status != VIT_OK)
        return status;
    p->info = (vit_open_info){.pack = p->pack.bytes,
                              .pack_size = p->pack.size,
                              .threads = o->threads,
                              .host_isa = o->host_isa,
                              .wide_divide = o->wide_divide,
                              .lanes = o->lanes,
                              .group = o->group,
                              .format = o->format,
                              .view = o->view,
                              .profile = is_timed(o),
                              .max_nodes = o->max_nodes,
                              .max_list = o->max_list};
    vit_text note = {""};
    status = device_choose(o, &p->info, &note, why);
    if (!o->explain)
        tell_note(&note);
    if (status == VIT_OK)
        status = check_host_options(p, why);
    if (status == VIT_OK)
        status = require(p, why);
    if (status == VIT_OK && o->explain) {
        report_explain(o->pack, p->pack.size, &p->need, stdout);
        return VIT_OK;
    }
    if (status == VIT_OK)
        status = check_frames(p, why);
    if (status == VIT_OK)
        status = check_budgets(p, why);
    if (status == VIT_OK)
        status = check_golden(p, why);
    if (status == VIT_OK)
        status = outputs_check(p, why);
    if (status == VIT_OK)
        status = play_and_count(p, why);
    return status;
}

static vit_status run(const play_options *o, vit_text *why) {
    if (o->help) {
        options_help(stdout);
        return VIT_OK;
    }
    if (o->version) {
        (void)puts("vitrine-play " VIT_VERSION);
        return VIT_OK;
    }
    if (o->list_devices)
        return device_list(why);
    player p = {.options = o};
    vit_status status = run_pack(&p, why);
    pack_file_unmap(&p.pack);
    work_budget_free(&p.limit);
    free(p.hashes);
    free(p.golden);
    return status;
}

int main(int argc, char **argv) {
    vit_text why = {""};
    play_options options;
    catch_signals();
    pocl_cache_mend_environment();
    vit_status status = options_parse(argc, argv, &options, &why);
    if (status == VIT_OK)
        status = run(&options, &why);
    if (status == VIT_OK)
        status = output_flush_stdout(&why); /* a full disk behind stdout shows only here */
    if (status != VIT_OK)
        (void)fprintf(stderr, "vitrine-play: %s\n", why.text);
    return (int)status;
}
