/* device.c: which device plays, and what is said if it is not the one that was hoped for. */
#ifndef VIT_PLAY_DEVICE_H
#define VIT_PLAY_DEVICE_H

#include "options.h"
#include <stdbool.h>

/* Sets info->device: the one of --device, which must be able to play (VIT_FAILED: it cannot, and what would mend it; VIT_USAGE:
 * no such name), or else the default: OpenCL's first, or host, which `note` tells then ("": nothing to tell). `info` holds the
 * pack and how it is to be opened. */
vit_status device_choose(const play_options *o, vit_open_info *info, vit_text *note, vit_text *why);

/* After vit_open() failed with `why`: if no device was asked for, sets info->device to host, makes a note of `why`, and is
 * true. */
bool device_fall_back(const play_options *o, vit_open_info *info, vit_text *note, const vit_text *why);

/* --list-devices: devices on stdout, on stderr what keeps PoCL from being one. */
vit_status device_list(vit_text *why);

#endif
