/* main.c: the list of scenes; each writes its meshes and textures into a folder. */
#ifndef VIT_SCENES_SCENES_H
#define VIT_SCENES_SCENES_H

#include <stdbool.h>
#include <stddef.h>

#define SCENES_PATH 4096

/* What a scene's maker says about its work; `file` names what could not be written. */
typedef struct scenes_report {
    const char *file;
    size_t triangles;
} scenes_report;

/* False: a file could not be written, errno says why. */
typedef bool scene_maker(const char *dir, scenes_report *report);

scene_maker cornell_make, furnace_make, atrium_make, balls_make, rooms_make;

/* dir/name + extension. False, with errno ENAMETOOLONG, if it does not fit. */
bool scenes_path(char out[SCENES_PATH], const char *dir, const char *name, const char *extension);

#endif
