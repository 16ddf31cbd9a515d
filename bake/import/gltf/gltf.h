/* gltf.c: glTF 2.0, as JSON and as GLB (sections are those of Khronos' specification of it). */
#ifndef VIT_BAKE_GLTF_H
#define VIT_BAKE_GLTF_H

#include "import/import_format.h"

extern const import_format gltf_format;

#endif
