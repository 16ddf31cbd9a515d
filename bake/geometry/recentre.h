/* recentre.c: scenes far from the origin. Floats are fine near zero and coarse far from it: at 1e6 m they are 6 cm apart. So
 * the baker moves a scene that lies far away, and what is in it, to the origin before anything becomes a float. */
#ifndef VIT_BAKE_SCENE_MOVE_H
#define VIT_BAKE_SCENE_MOVE_H

#include "import/model.h"

#define SCENE_FAR 2.0 /* half diagonals from the origin to the box's middle */

/* If the model's box lies far from the origin: where the origin should be, on a grid as coarse as the box. */
bool scene_is_far(const model *m, double origin[3]);
/* Takes `origin` from all places in the scene: meshes, camera, lights. The model is to be imported again. */
void scene_move(scene *s, const double origin[3]);

#endif
