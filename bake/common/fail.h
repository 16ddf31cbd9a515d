/* fail.c: one line of text that says why, and the status that goes with it: vit_fail() of the runtime, for the baker. */
#ifndef VIT_BAKE_FAIL_H
#define VIT_BAKE_FAIL_H

#include "vitrine.h"

/* Writes the line, if anybody wants it (`why` may be NULL), and returns `status`. `why` must not be among the arguments. */
vit_status bake_fail(vit_text *why, vit_status status, const char *format, ...) __attribute__((format(printf, 3, 4)));
/* The same for lines with text from outside: control characters become '?'. */
vit_status bake_fail_plain(vit_text *why, vit_status status, const char *format, ...) __attribute__((format(printf, 3, 4)));

#endif
