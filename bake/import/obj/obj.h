/* OBJ with MTL. */
#ifndef VIT_BAKE_OBJ_H
#define VIT_BAKE_OBJ_H

#include "import/import_format.h"

extern const import_format obj_format;

#endif
