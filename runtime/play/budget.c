#include "budget.h"
#include "failure.h"
#include <stdlib.h>
#include <string.h>

#define MS_MAX 1e6
#define PART_MAX 96

static bool read_ms(const char *text, double *out) {
    char *end;
    if (*text == '\0' || strspn(text, "0123456789.") != strlen(text))
        return false;
    *out = strtod(text, &end);
    return *end == '\0' && *out > 0 && *out <= MS_MAX;
}

static vit_status add(budget *b, const char *part, vit_text *why) {
    const char *equals = strchr(part, '=');
    size_t length = equals != NULL ? (size_t)(equals - part) : 0;
    double ms;
    if ((equals != NULL && (length == 0 || length >= BUDGET_NAME)) || !read_ms(equals != NULL ? equals + 1 : part, &ms))
        return play_fail(why, VIT_USAGE, "--budget takes MS or PASS=MS, with commas between (33 or visibility=5,33), got '%s'",
                         part);
    if (equals == NULL) {
        if (b->frame_ms > 0)
            return play_fail(why, VIT_USAGE, "--budget: the frame has two budgets, the second is '%s'", part);
        b->frame_ms = ms;
        return VIT_OK;
    }
    for (uint32_t i = 0; i < b->count; i++)
        if (strlen(b->passes[i].name) == length && strncmp(b->passes[i].name, part, length) == 0)
            return play_fail(why, VIT_USAGE, "--budget: pass %s has two budgets", b->passes[i].name);
    if (b->count == VIT_MAX_PASSES)
        return play_fail(why, VIT_USAGE, "--budget: more than %d passes", VIT_MAX_PASSES);
    memcpy(b->passes[b->count].name, part, length);
    b->passes[b->count++].ms = ms;
    return VIT_OK;
}

vit_status budget_parse(const char *text, budget *out, vit_text *why) {
    *out = (budget){0};
    for (;;) {
        char part[PART_MAX];
        size_t length = strcspn(text, ",");
        if (length >= sizeof part)
            return play_fail(why, VIT_USAGE, "--budget: '%.40s...' is too long", text);
        memcpy(part, text, length);
        part[length] = '\0';
        vit_status status = add(out, part, why);
        if (status != VIT_OK || text[length] == '\0')
            return status;
        text += length + 1;
    }
}

static uint32_t find(const vit_requirements *need, const char *name) {
    uint32_t i = 0;
    while (i < need->pass_count && strcmp(need->passes[i], name) != 0)
        i++;
    return i;
}

vit_status budget_check_names(const budget *b, const vit_requirements *need, vit_text *why) {
    for (uint32_t i = 0; i < b->count; i++)
        if (find(need, b->passes[i].name) == need->pass_count)
            return play_fail(why, VIT_USAGE, "--budget: the pack's frames have no pass '%s' (--explain lists them)",
                             b->passes[i].name);
    return VIT_OK;
}

/* The budget of a pass, ms; 0: it has none. */
static double allowed(const budget *b, const char *pass) {
    for (uint32_t i = 0; i < b->count; i++)
        if (strcmp(b->passes[i].name, pass) == 0)
            return b->passes[i].ms;
    return 0;
}

unsigned budget_percentile(unsigned asked, double others) {
    return asked != 0 ? asked : others > BUDGET_BUSY ? 50 : 95;
}

/* Which frames the verdict is of, and how far it can be trusted. */
static void say_noise(const budget *b, unsigned asked, unsigned percentile, double others, const report *r, vit_text *out) {
    const times t = report_frame_times(r);
    char over[64] = "", noisy[64] = "", load[96] = "";
    size_t count = 0;
    for (size_t i = 0; i < report_timed(r); i++)
        count += r->frame_ms[i] > b->frame_ms;
    if (b->frame_ms > 0)
        (void)snprintf(over, sizeof over, ", %zu of %zu frames over", count, report_timed(r));
    if (t.p95 > t.p50 * BUDGET_NOISY)
        (void)snprintf(noisy, sizeof noisy, "; noisy: p95 is %.2f times p50", t.p95 / t.p50);
    if (others >= 0)
        (void)snprintf(load, sizeof load, "; other programs had %.0f %% of the processors%s", others * 100,
                       asked == 0 && percentile == 50 ? ", so the median decides" : "");
    (void)snprintf(out->text, sizeof out->text, "budget by %s: frame p50 %.3f, p95 %.3f, max %.3f ms%s%s%s",
                   times_percentile_name(percentile), t.p50, t.p95, t.max, over, noisy, load);
}

vit_status budget_check(const budget *b, unsigned asked, double others, const report *r, const vit_requirements *need,
                        vit_text *noise, vit_text *why) {
    const unsigned percentile = budget_percentile(asked, others);
    const char *name = times_percentile_name(percentile);
    times t = report_frame_times(r);
    double frame = times_percentile(&t, percentile), longest = 0, first_ms = 0;
    uint32_t longest_pass = 0, first = need->pass_count, missed = 0;
    for (uint32_t i = 0; i < r->passes; i++) {
        t = report_pass_times(r, i);
        double ms = times_percentile(&t, percentile), limit = allowed(b, need->passes[i]);
        if (ms > longest) {
            longest = ms;
            longest_pass = i;
        }
        if (limit <= 0 || ms <= limit)
            continue;
        if (missed++ == 0) {
            first = i;
            first_ms = ms;
        }
    }
    say_noise(b, asked, percentile, others, r, noise);
    bool frame_over = b->frame_ms > 0 && frame > b->frame_ms;
    char whole[160] = "", part[200] = "", more[40] = "";
    if (frame_over)
        (void)snprintf(whole, sizeof whole, "frame %s %.3f ms, %g allowed, %.3f over; longest pass %s, %.3f ms", name, frame,
                       b->frame_ms, frame - b->frame_ms, need->passes[longest_pass], longest);
    if (missed > 1)
        (void)snprintf(more, sizeof more, " (%u passes are over)", missed);
    if (missed > 0) {
        double limit = allowed(b, need->passes[first]);
        (void)snprintf(part, sizeof part, "pass %s %s %.3f ms, %g allowed, %.3f over%s", need->passes[first], name, first_ms,
                       limit, first_ms - limit, more);
    }
    if (!frame_over && missed == 0)
        return VIT_OK;
    return play_fail(why, VIT_BUDGET, "budget missed: %s%s%s (%s)", whole, frame_over && missed > 0 ? "; " : "", part,
                     noise->text);
}
