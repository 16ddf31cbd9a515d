#include "option_values.h"
#include "failure.h"
#include <string.h>
#include <strings.h>

const char *const option_format_names[] = {
#define X(name, word, bytes, word_bytes, meaning) #word,
    VIT_FORMATS(X)
#undef X
};
const char *const option_format_meanings[] = {
#define X(name, word, bytes, word_bytes, meaning) meaning,
    VIT_FORMATS(X)
#undef X
};

const char *const option_view_names[] = {
#define X(name, light, meaning) #name,
    VIT_VIEWS(X)
#undef X
};
const char *const option_view_meanings[] = {
#define X(name, light, meaning) meaning,
    VIT_VIEWS(X)
#undef X
};

/* "a, b or c". */
typedef struct choice {
    char text[256];
} choice;

static choice choose(const char *const *names, size_t count) {
    choice c = {""};
    for (size_t i = 0, n = 0; i < count && n < sizeof c.text; i++)
        n += (size_t)snprintf(c.text + n, sizeof c.text - n, "%s%s", i == 0 ? "" : i + 1 < count ? ", " : " or ", names[i]);
    return c;
}

/* All sinks, or those that can write to stdout. */
static choice choose_sinks(bool streams) {
    const char *names[SINK_COUNT];
    size_t count = 0;
    for (uint32_t i = 0; sink_at(i) != NULL; i++)
        if (sink_at(i)->writes == SINK_STREAM || !streams)
            names[count++] = sink_at(i)->name;
    return choose(names, count);
}

bool option_number(const char *text, const char *end, uint32_t *out) {
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

vit_status option_set_device(play_options *o, const char *value, vit_text *why) {
    o->device = value;
    if (value[0] == '\0' || value[0] == '-')
        return play_fail(why, VIT_USAGE,
                         "--device takes a number or a part of a name of --list-devices, gpu, cpu or host, got '%s'", value);
    return VIT_OK;
}

vit_status option_set_host_isa(play_options *o, const char *value, vit_text *why) {
    (void)why; /* the library knows which there are */
    o->host_isa = value;
    return VIT_OK;
}

vit_status option_set_out(play_options *o, const char *value, vit_text *why) {
    const char *colon = strchr(value, ':');
    size_t length = colon != NULL ? (size_t)(colon - value) : strlen(value);
    const sink_kind *kind = NULL;
    for (uint32_t i = 0; sink_at(i) != NULL && kind == NULL; i++)
        if (strlen(sink_at(i)->name) == length && strncmp(sink_at(i)->name, value, length) == 0)
            kind = sink_at(i);
    if (kind == NULL)
        return play_fail(why, VIT_USAGE, "--out: unknown kind '%.*s' (%s)", (int)length, value, choose_sinks(false).text);
    if (kind->target == NULL && colon != NULL)
        return play_fail(why, VIT_USAGE, "--out %s takes no target, got '%s'", kind->name, value);
    if (kind->target != NULL && (colon == NULL || colon[1] == '\0'))
        return play_fail(why, VIT_USAGE, "--out %s needs a target: %s:%s", kind->name, kind->name, kind->target);
    if (kind->target != NULL && kind->writes != SINK_STREAM && strcmp(colon + 1, "-") == 0)
        return play_fail(why, VIT_USAGE, "--out %s:-: a %s's name is wanted; to stdout: %s", kind->name,
                         kind->writes == SINK_FOLDER ? "folder" : "file", choose_sinks(true).text);
    o->sink = kind;
    o->target = colon != NULL ? colon + 1 : "";
    o->out_given = true;
    return VIT_OK;
}

vit_status option_set_frames(play_options *o, const char *value, vit_text *why) {
    const char *colon = strchr(value, ':'), *end = value + strlen(value);
    uint32_t first = 0, last = UINT32_MAX;
    bool good, to_the_end = colon != NULL && colon + 1 == end;
    if (colon == NULL) {
        good = option_number(value, end, &first) && first < UINT32_MAX;
        last = good ? first + 1 : 0;
    } else {
        bool has_first = colon != value;
        good = (has_first || !to_the_end) && (!has_first || option_number(value, colon, &first)) &&
               (to_the_end || option_number(colon + 1, end, &last));
    }
    if (!good)
        return play_fail(why, VIT_USAGE, "--frames takes A:B, A:, :B or N (frames from 0), got '%s'", value);
    if (first >= last)
        return play_fail(why, VIT_USAGE, "--frames %s: no frame is in it (A:B is A up to but not including B)", value);
    o->first = first;
    o->end = to_the_end ? 0 : last;
    return VIT_OK;
}

vit_status option_set_loop(play_options *o, const char *value, vit_text *why) {
    o->loop = 0;
    if (strcmp(value, "inf") == 0)
        return VIT_OK;
    if (!option_number(value, value + strlen(value), &o->loop) || o->loop == 0)
        return play_fail(why, VIT_USAGE, "--loop takes a number from 1 to %u, or inf, got '%s'", UINT32_MAX, value);
    return VIT_OK;
}

vit_status option_set_view(play_options *o, const char *value, vit_text *why) {
    for (size_t i = 0; i < VIT_VIEW_COUNT; i++)
        if (strcmp(option_view_names[i], value) == 0) {
            o->view = (vit_view)i;
            return VIT_OK;
        }
    return play_fail(why, VIT_USAGE, "--view: unknown view '%s' (--help lists them)", value);
}

vit_status option_set_format(play_options *o, const char *value, vit_text *why) {
    for (size_t i = 0; i < VIT_FORMAT_COUNT; i++)
        if (strcasecmp(option_format_names[i], value) == 0) {
            o->format = (vit_format)i;
            return VIT_OK;
        }
    return play_fail(why, VIT_USAGE, "--format: unknown format '%s' (%s)", value,
                     choose(option_format_names, VIT_FORMAT_COUNT).text);
}

vit_status option_set_lanes(play_options *o, const char *value, vit_text *why) {
    uint32_t n;
    if (!option_number(value, value + strlen(value), &n) || (n != 0 && n != 1 && n != 8 && n != 16))
        return play_fail(why, VIT_USAGE, "--lanes takes 0, 1, 8 or 16, got '%s'", value);
    o->lanes = n;
    return VIT_OK;
}

vit_status option_set_group(play_options *o, const char *value, vit_text *why) {
    uint32_t n;
    if (!option_number(value, value + strlen(value), &n) || n > 256 || (n & (n - 1)) != 0)
        return play_fail(why, VIT_USAGE, "--group takes 0 or a power of two up to 256, got '%s'", value);
    o->group = n;
    return VIT_OK;
}

vit_status option_set_report(play_options *o, const char *value, vit_text *why) {
    if (value != NULL && (value[0] == '\0' || strcmp(value, "-") == 0))
        return play_fail(why, VIT_USAGE, "--report= needs a file's name; --report alone prints a table");
    if (value != NULL)
        o->report_file = value;
    else
        o->report = true;
    return VIT_OK;
}

vit_status option_set_budget(play_options *o, const char *value, vit_text *why) {
    o->has_budget = true;
    return budget_parse(value, &o->budget, why);
}

vit_status option_set_percentile(play_options *o, const char *value, vit_text *why) {
    static const unsigned known[] = {50, 95, 99, 100};
    static const char *const names[] = {"50", "95", "99", "max"};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
        if (strcmp(value, names[i]) == 0) {
            o->percentile = known[i];
            return VIT_OK;
        }
    return play_fail(why, VIT_USAGE, "--budget-percentile takes 50, 95, 99 or max, got '%s'", value);
}

static vit_status set_file(const char **field, const char *name, const char *value, vit_text *why) {
    *field = value;
    return value[0] != '\0' && strcmp(value, "-") != 0
               ? VIT_OK
               : play_fail(why, VIT_USAGE, "--%s needs a file's name, got '%s'", name, value);
}

vit_status option_set_work_budget(play_options *o, const char *value, vit_text *why) {
    return set_file(&o->work_budget, "work-budget", value, why);
}

vit_status option_set_write_work_budget(play_options *o, const char *value, vit_text *why) {
    return set_file(&o->write_work_budget, "write-work-budget", value, why);
}

vit_status option_set_golden(play_options *o, const char *value, vit_text *why) {
    return set_file(&o->golden, "golden", value, why);
}

vit_status option_set_write_golden(play_options *o, const char *value, vit_text *why) {
    return set_file(&o->write_golden, "write-golden", value, why);
}

/* Taken here, refused in main.c: the message names the pack's own size. */
vit_status option_set_size(play_options *o, const char *value, vit_text *why) {
    (void)why;
    o->size = value;
    return VIT_OK;
}

const char *options_format_name(vit_format format) {
    return option_format_names[format];
}

const char *options_view_name(vit_view view) {
    return option_view_names[view];
}
