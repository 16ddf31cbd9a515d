/* ply.c: PLY, the Stanford polygon format (G. Turk), in text and in both byte orders. */
#ifndef VIT_BAKE_PLY_H
#define VIT_BAKE_PLY_H

#include "import/import_format.h"

extern const import_format ply_format;

#endif
