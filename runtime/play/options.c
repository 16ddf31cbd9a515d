/* One table holds the options: parser and --help are made from it. Adding an option is adding a row. */
#include "options.h"
#include "failure.h"
#include <stddef.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

typedef vit_status set_fn(play_options *o, const char *value, vit_text *why);

/* What a row does: sets a flag, a number within bounds, or calls `set`. */
typedef struct option {
    const char *name;
    const char *value; /* as --help writes it; NULL: a flag, takes none */
    const char *meaning;
    size_t field;         /* offset in play_options: a bool for flags, a uint32_t for numbers */
    uint32_t least, most; /* numbers */
    set_fn *set;          /* not NULL: neither flag nor plain number */
} option;

static const char *const format_names[] = {
    [VIT_FORMAT_XRGB8888] = "xrgb8888",
    [VIT_FORMAT_RGB565] = "rgb565",
    [VIT_FORMAT_RGBA32F] = "rgba32f",
};
static const char *const format_meanings[] = {
#define X(name, bytes, meaning) [VIT_FORMAT_##name] = meaning,
    VIT_FORMATS(X)
#undef X
};
#define FORMAT_COUNT (sizeof format_names / sizeof format_names[0])

static const char *const view_names[] = {
#define X(name, meaning) #name,
    VIT_VIEWS(X)
#undef X
};
static const char *const view_meanings[] = {
#define X(name, meaning) meaning,
    VIT_VIEWS(X)
#undef X
};
#define VIEW_COUNT (sizeof view_names / sizeof view_names[0])

/* Decimal digits only, up to *end; false on overflow, sign, space or nothing at all. */
static bool read_number(const char *text, const char *end, uint32_t *out) {
    uint64_t value = 0;
    if (text == end)
        return false;
    for (; text != end; text++) {
        if (*text < '0' || *text > '9')
            return false;
        value = value * 10 + (uint64_t)(*text - '0');
        if (value > UINT32_MAX)
            return false;
    }
    *out = (uint32_t)value;
    return true;
}

static vit_status set_out(play_options *o, const char *value, vit_text *why) {
    const char *colon = strchr(value, ':');
    size_t length = colon != NULL ? (size_t)(colon - value) : strlen(value);
    const sink_kind *kind = NULL;
    for (uint32_t i = 0; sink_at(i) != NULL && kind == NULL; i++)
        if (strlen(sink_at(i)->name) == length && strncmp(sink_at(i)->name, value, length) == 0)
            kind = sink_at(i);
    if (kind == NULL)
        return play_fail(why, VIT_USAGE, "--out: unknown kind '%.*s' (null, raw, y4m, ppm or png)", (int)length, value);
    if (kind->target == NULL && colon != NULL)
        return play_fail(why, VIT_USAGE, "--out %s takes no target, got '%s'", kind->name, value);
    if (kind->target != NULL && (colon == NULL || colon[1] == '\0'))
        return play_fail(why, VIT_USAGE, "--out %s needs a target: %s:%s", kind->name, kind->name, kind->target);
    o->sink = kind;
    o->target = colon != NULL ? colon + 1 : "";
    o->out_given = true;
    return VIT_OK;
}

static vit_status set_frames(play_options *o, const char *value, vit_text *why) {
    const char *colon = strchr(value, ':'), *end = value + strlen(value);
    uint32_t first = 0, last = UINT32_MAX;
    bool good, to_the_end = colon != NULL && colon + 1 == end;
    if (colon == NULL) {
        good = read_number(value, end, &first) && first < UINT32_MAX;
        last = good ? first + 1 : 0;
    } else {
        bool has_first = colon != value;
        good = (has_first || !to_the_end) && (!has_first || read_number(value, colon, &first)) &&
               (to_the_end || read_number(colon + 1, end, &last));
    }
    if (!good)
        return play_fail(why, VIT_USAGE, "--frames takes A:B, A:, :B or N (frames from 0), got '%s'", value);
    if (first >= last)
        return play_fail(why, VIT_USAGE, "--frames %s: no frame is in it (A:B is A up to but not including B)", value);
    o->first = first;
    o->end = to_the_end ? 0 : last;
    return VIT_OK;
}

static vit_status set_view(play_options *o, const char *value, vit_text *why) {
    for (size_t i = 0; i < VIEW_COUNT; i++)
        if (strcmp(view_names[i], value) == 0) {
            o->view = (vit_view)i;
            return VIT_OK;
        }
    return play_fail(why, VIT_USAGE, "--view: unknown view '%s' (--help lists them)", value);
}

static vit_status set_format(play_options *o, const char *value, vit_text *why) {
    for (size_t i = 0; i < FORMAT_COUNT; i++)
        if (strcasecmp(format_names[i], value) == 0) {
            o->format = (vit_format)i;
            return VIT_OK;
        }
    return play_fail(why, VIT_USAGE, "--format: unknown format '%s' (xrgb8888, rgb565 or rgba32f)", value);
}

static vit_status set_lanes(play_options *o, const char *value, vit_text *why) {
    uint32_t n;
    if (!read_number(value, value + strlen(value), &n) || (n != 0 && n != 1 && n != 8 && n != 16))
        return play_fail(why, VIT_USAGE, "--lanes takes 0, 1, 8 or 16, got '%s'", value);
    o->lanes = n;
    return VIT_OK;
}

static vit_status set_group(play_options *o, const char *value, vit_text *why) {
    uint32_t n;
    if (!read_number(value, value + strlen(value), &n) || n > 256 || (n & (n - 1)) != 0)
        return play_fail(why, VIT_USAGE, "--group takes 0 or a power of two up to 256, got '%s'", value);
    o->group = n;
    return VIT_OK;
}

/* Taken here, refused in main.c: the message names the pack's own size. */
static vit_status set_size(play_options *o, const char *value, vit_text *why) {
    (void)why;
    o->size = value;
    return VIT_OK;
}

#define FLAG(name, field, meaning)                                                                                             \
    { name, NULL, meaning, offsetof(play_options, field), 0, 0, NULL }
#define NUMBER(name, field, least, meaning)                                                                                    \
    { name, "N", meaning, offsetof(play_options, field), least, UINT32_MAX, NULL }
#define WORD(name, value, set, meaning)                                                                                        \
    { name, value, meaning, 0, 0, 0, set }

static const option table[] = {
    WORD("out", "KIND:TARGET", set_out, "where frames go; see Sinks (default: null)"),
    WORD("frames", "A:B", set_frames, "frames A up to but not including B; also A: and :B and a single N (default: all)"),
    NUMBER("loop", loop, 1, "play the range N times (default: 1)"),
    FLAG("fps", pace, "play at the pack's rate and count late frames (default: as fast as possible)"),
    FLAG("verify", verify, "compare each frame's hash with the pack's golden hash"),
    FLAG("hash", hash, "print one line a frame: index and hash"),
    FLAG("trace", trace, "print one line a pass and frame: index, pass, hash of what it wrote"),
    FLAG("report", report, "at the end: time a pass, memory a buffer, work of the last frame"),
    FLAG("explain", explain, "what the pack asks for: effects, passes, buffers, bytes; needs no device"),
    WORD("view", "NAME", set_view, "what the frames show; see Views (default: final)"),
    WORD("format", "NAME", set_format, "pixels of null and raw; see Formats (default: xrgb8888)"),
    FLAG("list-devices", list_devices, "index and name of each device"),
    NUMBER("device", device, 0, "play on device N of --list-devices (default: 0)"),
    WORD("lanes", "N", set_lanes, "samples a work-item: 1, 8, 16, or 0 for what suits; changes no bit"),
    WORD("group", "N", set_group, "work-items a work-group: a power of two up to 256, or 0 for what suits; changes no bit"),
    NUMBER("max-nodes", max_nodes, 1, "replace the pack's bound of hierarchy nodes (tests)"),
    NUMBER("max-list", max_list, 1, "replace the pack's bound of list entries (tests)"),
    WORD("size", "WxH", set_size, "always refused: the size is fixed by the pack"),
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
    if (!read_number(value, value + strlen(value), &n) || n < row->least || n > row->most)
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
    if (value == NULL)
        return play_fail(why, VIT_USAGE, "--%s needs a value: --%s %s", row->name, row->name, row->value);
    if (equals == NULL)
        (*next)++;
    return apply(row, o, value, why);
}

/* Options that exclude each other. */
static vit_status check(const play_options *o, vit_text *why) {
    bool to_stdout = sink_uses_stdout(o->sink, o->target);
    if (o->pack == NULL)
        return play_fail(why, VIT_USAGE, "no pack: vitrine-play scene.vit [options] (--help lists all)");
    if (o->verify && o->view != VIT_VIEW_final)
        return play_fail(why, VIT_USAGE, "--verify goes with no --view but final: golden hashes are of the picture");
    if (!o->sink->any_format && o->format != VIT_FORMAT_XRGB8888)
        return play_fail(why, VIT_USAGE, "--out %s takes --format xrgb8888 only, got %s", o->sink->name,
                         options_format_name(o->format));
    if (o->trace && (o->verify || o->hash || o->report || o->pace || o->sink != sink_at(0)))
        return play_fail(why, VIT_USAGE, "--trace plays alone: without --verify, --hash, --report, --fps and --out");
    if (o->hash && to_stdout)
        return play_fail(why, VIT_USAGE, "--hash and --out %s:- both want stdout", o->sink->name);
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

const char *options_format_name(vit_format format) {
    return format_names[format];
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
        (void)fprintf(to, "  %-22s %s\n", left, table[i].meaning);
    }
    (void)fputs("\nSinks (--out)\n", to);
    for (uint32_t i = 0; sink_at(i) != NULL; i++) {
        const sink_kind *kind = sink_at(i);
        (void)snprintf(left, sizeof left, "%s%s%s", kind->name, kind->target != NULL ? ":" : "",
                       kind->target != NULL ? kind->target : "");
        (void)fprintf(to, "  %-22s %s\n", left, kind->meaning);
    }
    help_names(to, "Views (--view)", view_names, view_meanings, VIEW_COUNT);
    help_names(to, "Formats (--format)", format_names, format_meanings, FORMAT_COUNT);
    (void)fputs("\nExamples\n"
                "  vitrine-play scene.vit --out png:frames --frames 0:24\n"
                "  vitrine-play scene.vit --out y4m:- | ffmpeg -i - scene.mp4\n"
                "  vitrine-play scene.vit --out y4m:- --fps --loop 10 | mpv -\n"
                "  vitrine-play scene.vit --verify && echo the same bits\n"
                "  vitrine-play scene.vit --report --device 1\n"
                "  vitrine-play scene.vit --view clusters --frames 12 --out png:insides\n"
                "\nExit codes\n",
                to);
#define X(name, value, meaning) (void)fprintf(to, "  %d  %s\n", value, meaning);
    VIT_STATUSES(X)
#undef X
}
