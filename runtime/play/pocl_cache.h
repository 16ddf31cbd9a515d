/* pocl_cache.c: where PoCL keeps what it compiles, and whether it can: it gives no device, no program, or ends the process
 * where it cannot. */
#ifndef VIT_PLAY_POCL_CACHE_H
#define VIT_PLAY_POCL_CACHE_H

#include "vitrine.h"
#include <stdbool.h>

/* Before the first call of OpenCL: takes a variable of the environment away that PoCL ends the process for. */
void pocl_cache_mend_environment(void);

/* True if the cache's folder cannot be written, or has so little room that PoCL may run out of it. `why`: the folder, the cause
 * and the cure. */
bool pocl_cache_in_trouble(vit_text *why);

/* Is the text PoCL's: the name of a device, or of a platform without one? */
bool pocl_is_named(const char *text);

#endif
