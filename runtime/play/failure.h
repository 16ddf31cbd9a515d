/* failure.c: the one-line errors of the player. */
#ifndef VIT_PLAY_FAILURE_H
#define VIT_PLAY_FAILURE_H

#include "vitrine.h"

/* Fills `why` and returns `status`, so that a failing function ends in `return play_fail(...)`. Control characters (a line
 * feed in a file's name, say) become '?': an error is one line. */
__attribute__((format(printf, 3, 4))) vit_status play_fail(vit_text *why, vit_status status, const char *format, ...);

#endif
