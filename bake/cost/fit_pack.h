/* fit_pack.c: a pack of the most accurate setting that fits a budget: vitrine-bake --fit. */
#ifndef VIT_COST_FIT_PACK_H
#define VIT_COST_FIT_PACK_H

#include "cost/fit.h"
#include "pack/pipeline.h"

/* Sweeps the scene (sweep.h, all knobs), chooses, sets p->scene.quality to the choice and packs all frames. A budget in
 * milliseconds is of `device`, and is then measured on all frames of that pack; should their 95th percentile miss it, the next
 * best setting is tried. The front and the choice go to stdout. VIT_BUDGET: nothing fits; the text names the closest miss.
 * Otherwise as sweep_run() and pipeline_pack(). */
vit_status fit_pack(pipeline *p, uint32_t device, const fit_budget *budget, pipeline_packed *out, vit_text *why);

#endif
