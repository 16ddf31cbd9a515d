/* What the files of live.h share. Private to bake/radiosity. */
#ifndef VIT_RADIOSITY_LIVE_PARTS_H
#define VIT_RADIOSITY_LIVE_PARTS_H

#include "radiosity/live.h"

/* live_share.c: a patch: how many points it gets, `points` on average at most, and more than half of these. False: out of
 * memory.
 */
bool live_share(const live_input *in, const patch_set *p, uint32_t points, uint32_t *share);
/* live_points.c: fills patches, points and their counts. */
vit_status live_points(const live_input *in, const patch_set *p, live *out, vit_text *why);
/* live_rows.c: fills rows and words. */
vit_status live_rows(const live_input *in, const patch_set *p, live *out, vit_text *why);

#endif
