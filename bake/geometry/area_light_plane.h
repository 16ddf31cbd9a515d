/* area_light_plane.c: faces that emit are not in the very place of others. */
#ifndef VIT_BAKE_LAMP_PLANE_H
#define VIT_BAKE_LAMP_PLANE_H

#include "import/model.h"
#include "vitrine_pack.h"
#include <stdbool.h>

/* A panel that a modeller put into the plane of a ceiling is in one place with it: which of the two a ray meets is up to
 * rounding, and the panel's light is covered where the ceiling is met. Such triangles that emit move by AREA_LIGHT_PLANE ray
 * offsets, `ray_offset` metres each, to the side that most of the path's `frames` cameras are on; lids of closed bodies stay.
 * *moved: how many; none where more than AREA_LIGHT_PLANE_MOST emit. False: out of memory, and nothing has moved. */
#define AREA_LIGHT_PLANE 16.0
#define AREA_LIGHT_PLANE_MOST 4096u
bool area_light_plane(model *m, const vit_camera *cameras, uint32_t frames, float ray_offset, uint32_t *moved);

#endif
