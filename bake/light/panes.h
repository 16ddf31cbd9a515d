/* panes.c: light that comes straight through panes of thin glass. */
#ifndef VIT_LIGHT_PANES_H
#define VIT_LIGHT_PANES_H

#include "light/photon_rays.h"

/* Does the scene have any, as its effects are? */
bool panes_there(const photon_scene *s);
/* The part of light from `distance` metres along the unit direction d that gets to p; 0: something opaque is in between.
 * panes: there are some. *mirror: the part that the first pane as seen from the light reflects, -1: there is none. */
vec3 panes_pass(const photon_rays *rays, bool panes, vec3 p, vec3 d, float distance, float *mirror);

#endif
