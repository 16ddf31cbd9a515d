#include "work_budget.h"
#include "failure.h"
#include "line_reader.h"
#include "sinks/output.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define HEAD "vitrine-work 1"

static vit_status read_head(line_reader *r, work_budget *out, vit_text *why) {
    char *words[6], *colon;
    uint64_t first, end;
    vit_status status = line_next(r, why);
    if (status == VIT_OK && strcmp(r->text, HEAD) != 0)
        return line_bad(r, why, "not a file of work counts: the first line must be '" HEAD "'");
    if (status == VIT_OK)
        status = line_next(r, why);
    if (status != VIT_OK)
        return status;
    if (!line_split(r->text, words, 6, WORK_BUDGET_NAME) || strcmp(words[0], "frames") != 0 || strcmp(words[2], "view") != 0 ||
        strcmp(words[4], "format") != 0 || (colon = strchr(words[1], ':')) == NULL)
        return line_bad(r, why, "must be 'frames A:B view NAME format NAME'");
    *colon = '\0';
    if (!line_number(words[1], UINT32_MAX, &first) || !line_number(colon + 1, UINT32_MAX, &end) || first >= end)
        return line_bad(r, why, "frames A:B must have A < B");
    out->first = (uint32_t)first;
    out->end = (uint32_t)end;
    (void)snprintf(out->view, sizeof out->view, "%s", words[3]);
    (void)snprintf(out->format, sizeof out->format, "%s", words[5]);
    return VIT_OK;
}

static const work_budget_row *find(const work_budget *b, const char *pass, const char *kind) {
    for (uint32_t i = 0; i < b->count; i++)
        if (strcmp(b->rows[i].pass, pass) == 0 && strcmp(b->rows[i].kind, kind) == 0)
            return &b->rows[i];
    return NULL;
}

static vit_status read_row(line_reader *r, work_budget *out, vit_text *why) {
    char *words[4];
    uint64_t sum, max, frames = out->end - out->first;
    if (!line_split(r->text, words, 4, WORK_BUDGET_NAME) || !line_number(words[2], UINT64_MAX, &sum) ||
        !line_number(words[3], UINT64_MAX, &max))
        return line_bad(r, why, "must be 'PASS KIND SUM MAX', or 'end' on the last line");
    if (max > sum || max < sum / frames) /* NOLINT(clang-analyzer-core.DivideZero): read_head() wants first < end */
        return line_bad(r, why, "the maximum of a frame cannot be that, with this sum over the frames");
    if (find(out, words[0], words[1]) != NULL)
        return line_bad(r, why, "a second line of this pass and kind");
    if (out->count == WORK_BUDGET_ROWS)
        return line_bad(r, why, "too many lines");
    work_budget_row *row = &out->rows[out->count++];
    (void)snprintf(row->pass, sizeof row->pass, "%s", words[0]);
    (void)snprintf(row->kind, sizeof row->kind, "%s", words[1]);
    row->sum = sum;
    row->max = max;
    return VIT_OK;
}

static vit_status read_all(line_reader *r, work_budget *out, vit_text *why) {
    vit_status status = read_head(r, out, why);
    while (status == VIT_OK) {
        status = line_next(r, why);
        if (status == VIT_OK && strcmp(r->text, "end") == 0)
            break;
        if (status == VIT_OK)
            status = read_row(r, out, why);
    }
    return status == VIT_OK ? line_end(r, why) : status;
}

vit_status work_budget_read(const char *path, work_budget *out, vit_text *why) {
    line_reader r;
    *out = (work_budget){.path = path, .rows = calloc(WORK_BUDGET_ROWS, sizeof *out->rows)};
    if (out->rows == NULL)
        return play_fail(why, VIT_FAILED, "%s: out of memory", path);
    vit_status status = line_open(&r, path, why);
    if (status != VIT_OK)
        return status;
    status = read_all(&r, out, why);
    line_close(&r);
    return status;
}

void work_budget_free(work_budget *b) {
    free(b->rows);
    *b = (work_budget){0};
}

vit_status work_budget_check_frames(const work_budget *b, uint32_t first, uint32_t end, const char *view, const char *format,
                                    vit_text *why) {
    if (b->first == first && b->end == end && strcmp(b->view, view) == 0 && strcmp(b->format, format) == 0)
        return VIT_OK;
    return play_fail(why, VIT_USAGE,
                     "--work-budget %s counts --frames %u:%u --view %s --format %s, but %u:%u %s %s is to be played", b->path,
                     b->first, b->end, b->view, b->format, first, end, view, format);
}

/* What the file allows for a pass and kind. */
static work_budget_row allowed(const work_budget *b, const char *pass, const char *kind) {
    const work_budget_row *row = find(b, pass, kind);
    return row != NULL ? *row : (work_budget_row){.sum = 0};
}

/* One count over its budget: by its sum or, with no more in all, in its fullest frame. */
static void say_over(const work_budget_row *limit, uint64_t sum, uint64_t max, const work_counts *w, char *text, size_t size) {
    if (sum > limit->sum)
        (void)snprintf(text, size, "%" PRIu64 " in frames %u:%u, %" PRIu64 " allowed, %" PRIu64 " over", sum, w->first, w->end,
                       limit->sum, sum - limit->sum);
    else
        (void)snprintf(text, size, "%" PRIu64 " in the fullest frame, %" PRIu64 " allowed, %" PRIu64 " over", max, limit->max,
                       max - limit->max);
}

vit_status work_budget_check(const work_budget *b, const work_counts *w, vit_text *better, vit_text *why) {
    uint32_t over = 0, fewer = 0;
    char first[256] = "";
    better->text[0] = '\0';
    for (uint32_t p = 0; p < w->passes; p++)
        for (uint32_t k = 0; k < w->kinds; k++) {
            if (!w->same[k])
                continue;
            const char *pass = w->pass_names[p], *kind = w->kind_names[k];
            const work_budget_row limit = allowed(b, pass, kind);
            uint64_t sum = w->sum[p][k], max = w->max[p][k];
            if (sum > limit.sum || max > limit.max) {
                char what[160];
                say_over(&limit, sum, max, w, what, sizeof what);
                if (over++ == 0)
                    (void)snprintf(first, sizeof first, "pass %s, %s: %s", pass, kind, what);
            } else if (sum < limit.sum || max < limit.max) {
                if (fewer++ == 0)
                    (void)snprintf(better->text, sizeof better->text,
                                   "work budget: less than allowed: pass %s, %s: %" PRIu64 " of %" PRIu64, pass, kind, sum,
                                   limit.sum);
            }
        }
    size_t length = strlen(better->text);
    if (fewer > 1)
        (void)snprintf(better->text + length, sizeof better->text - length, ", and %u more", fewer - 1);
    if (over == 0)
        return VIT_OK;
    if (over == 1)
        return play_fail(why, VIT_BUDGET, "work budget missed: %s", first);
    return play_fail(why, VIT_BUDGET, "work budget missed: %s (%u counts are over)", first, over);
}

static void print_rows(const work_counts *w, FILE *to) {
    for (uint32_t p = 0; p < w->passes; p++)
        for (uint32_t k = 0; k < w->kinds; k++)
            if (w->same[k] && w->sum[p][k] > 0)
                (void)fprintf(to, "%s %s %" PRIu64 " %" PRIu64 "\n", w->pass_names[p], w->kind_names[k], w->sum[p][k],
                              w->max[p][k]);
}

vit_status work_budget_write(const char *path, const work_counts *w, const char *view, const char *format, vit_text *why) {
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    if (to == NULL)
        return play_fail(why, VIT_FAILED, "%s: out of memory", path);
    (void)fprintf(to, HEAD
                  "\n# Exact work of vitrine-play: pass, kind, sum over the frames, most of a frame. Equal on every device.\n");
    (void)fprintf(to, "frames %u:%u view %s format %s\n", w->first, w->end, view, format);
    print_rows(w, to);
    (void)fputs("end\n", to);
    vit_status status =
        fclose(to) == 0 ? output_file(path, text, size, why) : play_fail(why, VIT_FAILED, "%s: out of memory", path);
    free(text);
    return status;
}
