/* option_values.c: from the text of an option's value to a field. */
#ifndef VIT_PLAY_OPTION_VALUES_H
#define VIT_PLAY_OPTION_VALUES_H

#include "options.h"

/* Names and what they mean, in the order of vit_format and vit_view. */
extern const char *const option_format_names[VIT_FORMAT_COUNT], *const option_format_meanings[VIT_FORMAT_COUNT];
extern const char *const option_view_names[VIT_VIEW_COUNT], *const option_view_meanings[VIT_VIEW_COUNT];

/* Decimal digits only, up to *end; false on overflow, sign, space or nothing at all. */
bool option_number(const char *text, const char *end, uint32_t *out);

/* VIT_USAGE: the text says what the option takes. `value` is NULL only where it may be left out. */
typedef vit_status set_fn(play_options *o, const char *value, vit_text *why);
set_fn option_set_out, option_set_frames, option_set_golden, option_set_write_golden, option_set_loop, option_set_view,
    option_set_format, option_set_lanes, option_set_group, option_set_report, option_set_budget, option_set_percentile,
    option_set_work_budget, option_set_write_work_budget, option_set_size, option_set_device, option_set_host_isa;

#endif
