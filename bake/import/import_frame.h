/* import_frame.c: in what unit and with which axis up mesh files are taken, in words. */
#ifndef VIT_BAKE_IMPORT_FRAME_H
#define VIT_BAKE_IMPORT_FRAME_H

#include "common/progress.h"
#include "import/model.h"

enum { FRAME_TEXT = 160 };
/* "1 unit is 0.01 m and z is up: the file says so". */
const char *frame_text(const model_frame *frame, char text[FRAME_TEXT]);
/* A line for each file that is scaled or turned, and one for those of which nothing says how large they are. */
void frames_say(const scene *s, const model *m, progress *p);

#endif
