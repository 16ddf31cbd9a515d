/* The one copy of stb_dxt. Its own warnings are not ours to mend. */
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wextra"
#include <stdlib.h>
#include <string.h>
#define STB_DXT_IMPLEMENTATION
#include <stb/stb_dxt.h>
