/* 3MF. */
#ifndef VIT_BAKE_THREEMF_H
#define VIT_BAKE_THREEMF_H

#include "import/import_format.h"

extern const import_format threemf_format;

#endif
