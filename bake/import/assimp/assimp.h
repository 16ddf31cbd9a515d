/* assimp.c: mesh files through Assimp. */
#ifndef VIT_BAKE_ASSIMP_H
#define VIT_BAKE_ASSIMP_H

#include "import/import_format.h"

extern const import_format assimp_format;

#endif
