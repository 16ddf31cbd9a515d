/* names.c: the names that there are, for who asked for one that there is not. */
#ifndef VIT_BAKE_NAMES_H
#define VIT_BAKE_NAMES_H

#include <stddef.h>

typedef const char *name_fn(const void *list, int index);

enum { NAMES_TEXT = 288 }; /* bytes that are enough for names_offer() */

/* "; there are 'a', 'b', 'c' and 4 more", those most like `wanted` first, each name once; "; there is none". */
void names_offer(const char *wanted, name_fn *name, const void *list, int count, char text[NAMES_TEXT]);

#endif
