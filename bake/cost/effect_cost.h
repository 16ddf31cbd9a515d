/* effect_cost.c: what each effect adds to a pack, found by doing without it. */
#ifndef VIT_COST_ADDS_H
#define VIT_COST_ADDS_H

#include "pack/pipeline.h"

#define EFFECT_COST_FRAMES 3 /* first, middle and last of the path, whose work is averaged */

typedef struct effect_cost {
    bool found;    /* else nothing is known: the effect is not in the pack, or a pack cannot be played without it */
    int64_t bytes; /* of the device's buffers */
    int64_t work;  /* work units per frame (fit.h) */
} effect_cost;

typedef struct effect_costs {
    uint64_t device_bytes, work; /* of the whole pack */
    effect_cost effect[64];      /* by the effect's bit */
} effect_costs;

/* Effects that are measured: those of materials, sky and pixels (EFFECTS_NAMED), the lights together and indirect
 * light, whatever makes it. */
#define EFFECT_COST_MEASURED (EFFECTS_NAMED | VIT_BIT(LIGHTS) | VIT_BIT(INDIRECT))

/* The pack without these effects, and without what then has nothing to do: lights, and indirect light if no source is left. The
 * caller frees *bytes. Bounds stay those of the whole pack, and so do baked photons, as long as there are any: what an effect
 * did to them does not show. */
vit_status effect_cost_without(const pack_sections *whole, uint64_t effects, void **bytes, size_t *size, vit_text *why);

/* Measures on the device `host`, with exact counts: the same figures on every machine. */
vit_status effect_cost_measure(const pipeline_packed *p, unsigned threads, progress *shown, effect_costs *out, vit_text *why);

#endif
