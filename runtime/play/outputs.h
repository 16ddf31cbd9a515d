/* outputs.c: what a run writes, looked at before the work. */
#ifndef VIT_PLAY_OUTPUTS_H
#define VIT_PLAY_OUTPUTS_H

#include "player.h"

/* VIT_USAGE: an output is a file that the run reads (the pack, a work budget), by whatever name or link, or two outputs are one
 * file. VIT_FAILED: one cannot be written. Tries it, and leaves nothing. The frames' range must be known. */
vit_status outputs_check(const player *p, vit_text *why);

#endif
