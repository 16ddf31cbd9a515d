/* settings.c: the settings of a scene's quality block, by the one table of them (settings.inc). */
#ifndef VIT_BAKE_SETTINGS_H
#define VIT_BAKE_SETTINGS_H

#include "vitrine.h"
#include <stdbool.h>

enum { FILTER_NEAREST, FILTER_BILINEAR, FILTER_TRILINEAR };
enum { LIGHTMAP_RAYS, LIGHTMAP_BAKED, LIGHTMAP_AUTO };
enum { INDIRECT_PHOTONS, INDIRECT_BASIS, INDIRECT_RADIOSITY, INDIRECT_AUTO };
enum { RECEIVERS_CELLS, RECEIVERS_POINTS };
enum { CACHE_BAKED, CACHE_PROGRESSIVE };

typedef struct scene_quality {
#define SETTING(type, member, ...) type member;
#include "scene/settings.inc"
#undef SETTING
} scene_quality;

enum {
#define SETTING(type, member, ...) SETTING_AT_##member,
#include "scene/settings.inc"
#undef SETTING
    SETTINGS
};
#define SETTING_BIT(member) ((uint64_t)1 << SETTING_AT_##member)
_Static_assert(SETTINGS < 64, "sets of settings, and fields_read()'s beside one more field, are 64 bits");

extern const scene_quality settings_default;

/* The word of INDIRECT_*. */
const char *settings_indirect_name(int maker);
/* What no single setting says. False: why->text is a sentence about it, "'light_zones' needs zones = true". */
bool settings_agree(const scene_quality *q, vit_text *why);

#endif
