/* auto.c: quality = "auto": of a ladder of settings, from cheap to dear, the first whose picture the check (check.h) finds
 * right. */
#ifndef VIT_BAKE_AUTO_H
#define VIT_BAKE_AUTO_H

#include "check/check.h"

#define AUTO_TEXT 384

/* What was chosen, and how right it is. */
typedef struct auto_found {
    check check;
    check_found found;
    uint32_t tried;
    bool right;           /* within AUTO_LIMIT; else the best of what was tried */
    char text[AUTO_TEXT]; /* the settings that differ from the defaults, as in a quality block */
} auto_found;

/* Sets p->scene.quality, but for what scene.quality_kept says. A pack of all frames then shows what was found. */
vit_status auto_choose(pipeline *p, auto_found *out, vit_text *why);
/* A line of what was chosen, and warnings. */
void auto_say(const pipeline *p, const pipeline_packed *packed, const auto_found *a);

#endif
