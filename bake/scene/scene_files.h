/* scene_files.c: a scene file and what it includes, looked at before libconfig does. */
#ifndef VIT_BAKE_SCENE_FILES_H
#define VIT_BAKE_SCENE_FILES_H

#include "scene/fields.h"
#include "common/inputs.h"
#include "scene/text_sizes.h"

/* Notes all of them in `files`. missing: the first include that is not there, for libconfig to report; "" if all are. */
bool scene_files_check(const config_place *at, inputs *files, char missing[SCENE_PATH]);

#endif
