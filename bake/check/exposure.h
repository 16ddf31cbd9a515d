/* exposure.c: exposure = "auto": one factor on the exposures of all frames, by the path-traced light of the path. */
#ifndef VIT_BAKE_EXPOSURE_H
#define VIT_BAKE_EXPOSURE_H

#include "pack/pipeline.h"

#define EXPOSURE_GREY 0.18 /* radiance times exposure that the median of what is seen gets: mid grey */

/* If the scene asks for it, sets scene.exposure_factor so that the median luminance of the pixels of the check (check.h) that
 * show lit surfaces is mid grey. Threads change no bit. A path that sees nothing lit keeps the factor 1. */
vit_status exposure_settle(pipeline *p, vit_text *why);

#endif
