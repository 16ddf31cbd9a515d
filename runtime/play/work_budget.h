/* work_budget.c: exact counts of work as a file, to be compared to the unit on any device.
 *
 *     vitrine-work 1
 *     frames 0:24 view final format xrgb8888
 *     visibility view_rays 6291456 262144        pass, kind, sum and maximum over the frames; kinds equal on every device only
 *     ...                                        in the order of the frame; what is not listed is 0
 *     end
 *
 * Lines that begin with '#' say nothing. The same pack gives the same bytes everywhere. */
#ifndef VIT_PLAY_WORK_BUDGET_H
#define VIT_PLAY_WORK_BUDGET_H

#include "work_count.h"

#define WORK_BUDGET_NAME 48
#define WORK_BUDGET_ROWS (VIT_MAX_PASSES * VIT_MAX_WORKS)

typedef struct work_budget_row {
    char pass[WORK_BUDGET_NAME], kind[WORK_BUDGET_NAME];
    uint64_t sum, max;
} work_budget_row;

typedef struct work_budget {
    const char *path; /* the caller's */
    uint32_t first, end;
    char view[WORK_BUDGET_NAME], format[WORK_BUDGET_NAME];
    uint32_t count;
    work_budget_row *rows; /* [count] */
} work_budget;

/* VIT_BAD_INPUT: "FILE:LINE: cause". work_budget_free() in any case. */
vit_status work_budget_read(const char *path, work_budget *out, vit_text *why);
void work_budget_free(work_budget *b);

/* Counts of other frames, another view or format say nothing about these. VIT_USAGE. */
vit_status work_budget_check_frames(const work_budget *b, uint32_t first, uint32_t end, const char *view, const char *format,
                                    vit_text *why);
/* VIT_BUDGET: the text names the first pass and kind, in the frame's order, with more work than the file allows, and by how
 * much. Less work is good: a line in `better` ("" if there is none). */
vit_status work_budget_check(const work_budget *b, const work_counts *w, vit_text *better, vit_text *why);

/* VIT_FAILED: `path` cannot be written. */
vit_status work_budget_write(const char *path, const work_counts *w, const char *view, const char *format, vit_text *why);

#endif
