/* scene_text.c: what of a scene file's text the releases of libconfig read differently, or wrongly without a word. */
#ifndef VIT_BAKE_SCENE_TEXT_H
#define VIT_BAKE_SCENE_TEXT_H

#include "scene/fields.h"

#define SCENE_BOM "\xef\xbb\xbf"

/* Refuses whole numbers that begin with 0, are not decimal or go beyond 32 bits (with L: 64), a comma that nothing follows, and
 * UTF-16. `text` ends with a zero byte at text[size]. False: "path:line: what". */
bool scene_text_check(const config_place *at, const char *path, const char *text, size_t size);

#endif
