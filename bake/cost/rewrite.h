/* rewrite.c: another quality block in a scene file. */
#ifndef VIT_COST_REWRITE_H
#define VIT_COST_REWRITE_H

#include "vitrine.h"

/* Puts `settings` ("photons = 4000; ...") between the braces of the top-level group `quality` of `text`; a file without one
 * gets one at its end. All other bytes stay. Returns a new string (the caller frees it), NULL if memory or a closing brace is
 * missing. */
char *rewrite_text(const char *text, const char *settings);

/* The same for a file, which is replaced whole. VIT_BAD_INPUT: it cannot be read, is no text, or its quality block is in a file
 * that it includes. VIT_FAILED: it cannot be written. */
vit_status rewrite_file(const char *path, const char *settings, vit_text *why);

/* Whether rewrite_file() can be expected to succeed: the file is a scene and may be written. */
vit_status rewrite_check(const char *path, vit_text *why);

#endif
