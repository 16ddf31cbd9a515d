/* light_units.c: the units of what mesh files say of light, and the watts that the baker takes it for.
 *
 * glTF's point and spot lights are in candela, its directional ones in lux, what its materials emit in nits. Exporters get
 * lights by 683 lm/W from the watts that their users set, but write emission as it is, in W/(m2 sr) (Blender, "standard"
 * lighting). So `light_units = "auto"` divides the lights of glTF files by 683, and nothing else; "photometric" takes
 * everything in mesh files by the letter of glTF, "radiometric" as it stands. Other formats state no unit: their numbers are
 * taken as they stand but for "photometric". */
#ifndef VIT_BAKE_LIGHT_UNITS_H
#define VIT_BAKE_LIGHT_UNITS_H

#include "import/model.h"
#include "common/progress.h"

/* W/sr a candela and W/m2 a lux, or 1. states_unit: the file's format says candela. */
double light_units_of_light(const scene *s, bool states_unit);
/* W/(m2 sr) a unit of a mesh file's emission. */
double light_units_of_emission(const scene *s);

/* A line for every light of a mesh file that the scene takes, one for all that are not taken, and one for what materials emit.
 */
void light_units_say(const scene *s, const model *m, progress *p);

#endif
