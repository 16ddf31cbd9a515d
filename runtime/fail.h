/* fail.c: one line of text that says why, and the status that goes with it. */
#ifndef VIT_FAIL_H
#define VIT_FAIL_H

#include "vitrine.h"

/* Writes the line, if anybody wants it (`why` may be NULL), and returns `status`. */
vit_status vit_fail(vit_text *why, vit_status status, const char *format, ...) __attribute__((format(printf, 3, 4)));

#endif
