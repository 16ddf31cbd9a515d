/* What the files of live.h share. Private to bake/radiosity. */
#ifndef VIT_RADIOSITY_LIVE_PARTS_H
#define VIT_RADIOSITY_LIVE_PARTS_H

#include "radiosity/live.h"

/* live_points.c: fills patches, points and their counts. */
vit_status live_points(const live_input *in, const patch_set *p, live *out, vit_text *why);
/* live_rows.c: fills rows and words. */
vit_status live_rows(const live_input *in, const patch_set *p, live *out, vit_text *why);

#endif
