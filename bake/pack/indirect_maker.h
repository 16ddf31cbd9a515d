/* indirect_maker.c: who makes indirect light where quality.indirect is "auto". */
#ifndef VIT_PACK_INDIRECT_MAKER_H
#define VIT_PACK_INDIRECT_MAKER_H

#include "pack/planner.h"

/* Of the light that matt surfaces get straight from lights: so much may come by mirrors and glass and be left out. */
#define MAKER_CAUSTICS 0.01
/* A light that moves farther than that of the scene's size from knot to knot leaves about as much error as photons' noise. */
#define MAKER_WIDEST 0.08

/* Sets p->indirect and p->indirect_why; the plan knows its lights' paths, and of its effects those of materials. */
vit_status indirect_maker_choose(const plan_input *in, plan *p, vit_text *why);

#endif
