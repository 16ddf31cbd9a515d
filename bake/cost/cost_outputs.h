/* cost_outputs.c: what vitrine-cost writes, and what else would make its work be for nothing, looked at before. */
#ifndef VIT_COST_OUTPUTS_H
#define VIT_COST_OUTPUTS_H

#include "cost/cost_options.h"
#include "pack/pipeline.h"

/* VIT_FAILED: a file of -o, --write or --cache could not be written. VIT_USAGE: there is no such knob or frame. VIT_BAD_INPUT:
 * --write is no scene. */
vit_status cost_outputs_check(const cost_options *o, const scene *s, vit_text *why);
/* VIT_USAGE: one of them is a file that is read, as far as these are known by now. */
vit_status cost_outputs_are_no_inputs(const cost_options *o, const pipeline *p, vit_text *why);

#endif
