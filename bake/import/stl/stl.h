/* stl.c: STL, the format of stereolithography, in text and in binary. */
#ifndef VIT_BAKE_STL_H
#define VIT_BAKE_STL_H

#include "import/import_format.h"

extern const import_format stl_format;

#endif
