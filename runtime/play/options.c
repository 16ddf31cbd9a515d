/* One table holds the options: parser and --help are made from it. Adding an option is adding a row. */
#include "option_values.h"
#include "failure.h"
#include <stddef.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* What a row does: sets a flag, a number within bounds, or calls `set`. */
typedef struct option {
    const char *name;
    const char *value; /* as --help writes it; NULL: a flag, takes none */
    const char *meaning;
    size_t field;         /* offset in play_options: a bool for flags, a uint32_t for numbers */
    uint32_t least, most; /* numbers */
    set_fn *set;          /* not NULL: neither flag nor plain number */
} option;

#define FLAG(name, field, meaning)                                                                                             \
    { name, NULL, meaning, offsetof(play_options, field), 0, 0, NULL }
#define NUMBER(name, field, least, most, meaning)                                                                              \
    { name, "N", meaning, offsetof(play_options, field), least, most, NULL }
#define WORD(name, value, set, meaning)                                                                                        \
    { name, value, meaning, 0, 0, 0, set }

static const option table[] = {
    WORD("out", "KIND:TARGET", option_set_out, "where frames go; see Sinks (default: null)"),
    WORD("frames", "A:B", option_set_frames,
         "frames A up to but not including B; also A: and :B and a single N (default: all)"),
    WORD("loop", "N|inf", option_set_loop, "play the range N times, or until SIGTERM, which ends a loop well (default: 1)"),
    FLAG("fps", pace, "play at the pack's rate and count late frames (default: as fast as possible)"),
    FLAG("verify", verify, "compare each frame's hash with the pack's golden hash"),
    WORD("golden", "FILE", option_set_golden,
         "exit 4 if a frame's hash is not the file's: for pictures that are committed beside a scene"),
    WORD("write-golden", "FILE", option_set_write_golden,
         "write such a file: the hashes of the frames played, of any view and format"),
    FLAG("hash", hash, "print one line a frame: index and hash"),
    FLAG("trace", trace, "print one line a pass and frame: index, pass, hash of what it wrote"),
    WORD("report", "[FILE.json]", option_set_report,
         "at the end: times a pass and memory a buffer as a table; in a file, work too"),
    FLAG("count-work", count_work, "count each pass's work exactly, in a round of its own; see Work"),
    WORD("budget", "MS", option_set_budget,
         "exit 3 if the frame, seen from the host, takes longer; PASS=MS for a pass; 5,resolve=1 for both"),
    WORD("budget-percentile", "P", option_set_percentile,
         "which frame the budget is for: 50, 95, 99 or max (default: 95, or 50 on a busy machine)"),
    WORD("work-budget", "FILE", option_set_work_budget, "exit 3 if a pass does more work than the file allows"),
    WORD("write-work-budget", "FILE", option_set_write_work_budget, "write such a file: the exact work of the frames played"),
    FLAG("explain", explain, "what the pack asks for: effects, passes, buffers, bytes; needs no device"),
    WORD("view", "NAME", option_set_view, "what the frames show; see Views (default: final)"),
    WORD("format", "NAME", option_set_format, "pixels, of sinks that take any; see Sinks, Formats (default: xrgb8888)"),
    FLAG("list-devices", list_devices, "index and name of each device; host is built in and needs no OpenCL"),
    WORD("device", "NAME|N", option_set_device,
         "play on this device: a part of its name (pocl, nvidia), gpu, cpu, host, or its number in --list-devices, which may "
         "change "
         "(default: OpenCL's first; host if that cannot play)"),
    NUMBER("threads", threads, 1, 256, "of the device host, which must play (default: one a processor); changes no bit"),
    WORD("host-isa", "NAME", option_set_host_isa,
         "instructions for the device host, which must play: baseline, avx2, avx512 (default: the best); changes no bit"),
    WORD("lanes", "N", option_set_lanes, "samples a work-item: 1, 8, 16, or 0 for what suits; changes no bit"),
    WORD("group", "N", option_set_group,
         "work-items a work-group: a power of two up to 256, or 0 for what suits; changes no bit"),
    FLAG("wide-divide", wide_divide,
         "OpenCL: divide floats as doubles, as on devices that do not round them rightly by themselves; changes no bit"),
    NUMBER("max-nodes", max_nodes, 1, UINT32_MAX, "replace the pack's bound of hierarchy nodes (tests)"),
    NUMBER("max-list", max_list, 1, UINT32_MAX, "replace the pack's bound of list entries (tests)"),
    WORD("size", "WxH", option_set_size, "always refused: the size is fixed by the pack"),
    FLAG("quiet", quiet, "no progress, no summary; errors and what was asked for remain"),
    FLAG("version", version, "print the version"),
    FLAG("help", help, "print this page"),
};
#define OPTION_COUNT (sizeof table / sizeof table[0])

static const option *find(const char *name, size_t length) {
    for (size_t i = 0; i < OPTION_COUNT; i++)
        if (strlen(table[i].name) == length && strncmp(table[i].name, name, length) == 0)
            return &table[i];
    return NULL;
}

static vit_status apply(const option *row, play_options *o, const char *value, vit_text *why) {
    void *field = (char *)o + row->field;
    if (row->set != NULL)
        return row->set(o, value, why);
    if (row->value == NULL) {
        *(bool *)field = true;
        return VIT_OK;
    }
    uint32_t n;
    /* Rows that take a value have been given one. NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker) */
    if (!option_number(value, value + strlen(value), &n) || n < row->least || n > row->most)
        return play_fail(why, VIT_USAGE, "--%s takes a number from %u to %u, got '%s'", row->name, row->least, row->most,
                         value);
    *(uint32_t *)field = n;
    return VIT_OK;
}

static vit_status set_pack(play_options *o, const char *path, vit_text *why) {
    if (o->pack != NULL)
        return play_fail(why, VIT_USAGE, "one pack at a time: '%s' and '%s'", o->pack, path);
    o->pack = path;
    return VIT_OK;
}

/* A value that may be left out is the next word only if it looks like one. */
static bool ends_in_json(const char *word) {
    size_t length = word != NULL ? strlen(word) : 0;
    return length > 5 && strcmp(word + length - 5, ".json") == 0;
}

/* `argument` begins with "--"; *next is what follows it, and is taken if the option wants a value and has no '='. */
static vit_status read_option(const char *argument, char ***next, play_options *o, vit_text *why) {
    const char *name = argument + 2, *equals = strchr(name, '=');
    size_t length = equals != NULL ? (size_t)(equals - name) : strlen(name);
    const option *row = find(name, length);
    if (row == NULL)
        return play_fail(why, VIT_USAGE, "unknown option '--%.*s' (--help lists all)", (int)length, name);
    if (row->value == NULL && equals != NULL)
        return play_fail(why, VIT_USAGE, "--%s takes no value", row->name);
    if (row->value == NULL)
        return apply(row, o, NULL, why);
    const char *value = equals != NULL ? equals + 1 : **next;
    if (row->value[0] == '[' && equals == NULL && !ends_in_json(value))
        return apply(row, o, NULL, why);
    if (value == NULL)
        return play_fail(why, VIT_USAGE, "--%s needs a value: --%s %s", row->name, row->name, row->value);
    if (equals == NULL)
        (*next)++;
    return apply(row, o, value, why);
}

/* Do stdout and stderr lead to the same file or pipe (and not to nowhere)? */
static bool has_one_end(void) {
    struct stat out, err;
    return fstat(STDOUT_FILENO, &out) == 0 && fstat(STDERR_FILENO, &err) == 0 && !S_ISCHR(out.st_mode) &&
           out.st_dev == err.st_dev && out.st_ino == err.st_ino;
}

const char *options_of_host(const play_options *o) {
    return o->threads != 0 ? "--threads" : o->host_isa != NULL ? "--host-isa" : NULL;
}

/* Options that exclude each other. */
static vit_status check(const play_options *o, vit_text *why) {
    bool to_stdout = sink_uses_stdout(o->sink, o->target);
    if (o->pack == NULL)
        return play_fail(why, VIT_USAGE, "no pack: vitrine-play scene.vit [options] (--help lists all)");
    if (o->verify && o->view != VIT_VIEW_final)
        return play_fail(why, VIT_USAGE, "--verify goes with no --view but final: golden hashes are of the picture");
    if (!o->sink->any_format && o->format != VIT_FORMAT_XRGB8888)
        return play_fail(why, VIT_USAGE, "--out %s takes --format %s only, got %s", o->sink->name,
                         options_format_name(VIT_FORMAT_XRGB8888), options_format_name(o->format));
    if (o->device != NULL && strcmp(o->device, "host") != 0 && options_of_host(o) != NULL)
        return play_fail(why, VIT_USAGE, "%s is for --device host, not for '%s'", options_of_host(o), o->device);
    if (o->trace && (o->verify || o->hash || o->report || o->pace || o->sink != sink_at(0)))
        return play_fail(why, VIT_USAGE, "--trace plays alone: without --verify, --hash, --report, --fps and --out");
    if (o->trace && (o->report_file != NULL || o->has_budget || options_counts(o)))
        return play_fail(why, VIT_USAGE, "--trace plays alone: without --report, --count-work and budgets");
    if (o->trace && (o->golden != NULL || o->write_golden != NULL))
        return play_fail(why, VIT_USAGE, "--trace plays alone: without --golden and --write-golden");
    if (o->golden != NULL && o->write_golden != NULL)
        return play_fail(why, VIT_USAGE, "--golden and --write-golden: compare with a file or write one, not both");
    if (o->percentile != 0 && !o->has_budget)
        return play_fail(why, VIT_USAGE, "--budget-percentile needs a --budget");
    if (o->hash && to_stdout)
        return play_fail(why, VIT_USAGE, "--hash and --out %s:- both want stdout", o->sink->name);
    if (to_stdout && !o->explain && has_one_end() && !(o->quiet && !o->report && !o->count_work))
        return play_fail(
            why, VIT_USAGE,
            "--out %s:- with stdout and stderr in one file or pipe: text would be among the frames (--quiet, or 2>FILE)",
            o->sink->name);
    if (to_stdout && !o->explain && isatty(STDOUT_FILENO))
        return play_fail(why, VIT_USAGE, "--out %s:- would fill the terminal: pipe it or name a file", o->sink->name);
    return VIT_OK;
}

vit_status options_parse(int argc, char **argv, play_options *out, vit_text *why) {
    *out = (play_options){.sink = sink_at(0), .target = "", .loop = 1};
    vit_status status = VIT_OK;
    bool only_files = false; /* after "--" */
    char **next = argc > 0 ? argv + 1 : argv;
    while (*next != NULL && status == VIT_OK && !out->help && !out->version) {
        const char *argument = *next++;
        if (only_files || argument[0] != '-')
            status = set_pack(out, argument, why);
        else if (strcmp(argument, "--") == 0)
            only_files = true;
        else if (strcmp(argument, "-h") == 0)
            out->help = true;
        else if (argument[1] == '-')
            status = read_option(argument, &next, out, why);
        else
            status = play_fail(why, VIT_USAGE, "unknown option '%s' (--help lists all)", argument);
    }
    if (status != VIT_OK || out->help || out->version || out->list_devices)
        return status;
    return check(out, why);
}

bool options_counts(const play_options *o) {
    return o->count_work || o->report_file != NULL || o->work_budget != NULL || o->write_work_budget != NULL;
}

bool options_plays(const play_options *o) {
    bool asked = o->out_given || o->verify || o->golden != NULL || o->write_golden != NULL || o->hash || o->report ||
                 o->report_file != NULL || o->has_budget || o->pace || o->trace;
    return asked || !options_counts(o);
}

static void help_names(FILE *to, const char *title, const char *const *names, const char *const *meanings, size_t count) {
    (void)fprintf(to, "\n%s\n", title);
    for (size_t i = 0; i < count; i++)
        (void)fprintf(to, "  %-22s %s\n", names[i], meanings[i]);
}

void options_help(FILE *to) {
    char left[64];
    (void)fputs("vitrine-play scene.vit [options]\n"
                "Plays a baked scene. The same frames have the same bits on every device.\n\nOptions\n",
                to);
    for (size_t i = 0; i < OPTION_COUNT; i++) {
        (void)snprintf(left, sizeof left, "--%s %s", table[i].name, table[i].value != NULL ? table[i].value : "");
        (void)fprintf(to, "  %-24s %s\n", left, table[i].meaning);
    }
    (void)fputs("\nSinks (--out)\n", to);
    for (uint32_t i = 0; sink_at(i) != NULL; i++) {
        const sink_kind *kind = sink_at(i);
        (void)snprintf(left, sizeof left, "%s%s%s", kind->name, kind->target != NULL ? ":" : "",
                       kind->target != NULL ? kind->target : "");
        (void)fprintf(to, "  %-22s %s%s\n", left, kind->meaning, kind->any_format ? "; takes any --format" : "");
    }
    help_names(to, "Views (--view)", option_view_names, option_view_meanings, VIT_VIEW_COUNT);
    help_names(to, "Formats (--format)", option_format_names, option_format_meanings, VIT_FORMAT_COUNT);
    (void)fputs("\nWork\n"
                "  Rays, tests, photon-cluster pairs, evaluations, texture lookups and bytes a pass, as exact numbers that are "
                "equal on\n"
                "  every device, at any lanes, groups and threads. Counted in a round of its own, since counting takes time: "
                "times and\n"
                "  frames are of a round without it, which is left out if nothing but counts is asked for.\n"
                "\nExamples\n"
                "  vitrine-play scene.vit --out png:frames --frames 0:24\n"
                "  vitrine-play scene.vit --out y4m:- | ffmpeg -i - scene.mp4\n"
                "  vitrine-play scene.vit --out y4m:- --fps --loop inf | mpv -\n"
                "  vitrine-play scene.vit --verify && echo the same bits\n"
                "  vitrine-play scene.vit --write-golden scene.golden\n"
                "  vitrine-play scene.vit --golden scene.golden --report verdict.json\n"
                "  vitrine-play scene.vit --report --device pocl\n"
                "  vitrine-play scene.vit --verify --device host --threads 2\n"
                "  vitrine-play scene.vit --budget 33 --report times.json\n"
                "  vitrine-play scene.vit --budget visibility=5,33 --budget-percentile 99\n"
                "  vitrine-play scene.vit --write-work-budget scene.work\n"
                "  vitrine-play scene.vit --work-budget scene.work\n"
                "  vitrine-play scene.vit --view clusters --frames 12 --out png:insides\n"
                "\nExit codes\n",
                to);
#define X(name, value, meaning) (void)fprintf(to, "  %d  %s\n", value, meaning);
    VIT_STATUSES(X)
#undef X
}
