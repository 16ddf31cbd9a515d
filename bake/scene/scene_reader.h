/* scene_meshes.c, scene_lights.c, scene_camera.c: the groups of a scene file. Private to scene.c and these. */
#ifndef VIT_BAKE_SCENE_READER_H
#define VIT_BAKE_SCENE_READER_H

#include "scene/fields.h"
#include "scene/scene.h"

/* Ranges that no sensible scene leaves; they keep every later product finite in float. */
#define COORDINATE "[-1e6, 1e6]"
#define RADIOMETRIC "[0, 1e9]"
#define TIME "[0, 1e6]"
#define MAX_KEYS 100000

#define FIELD_COUNT(table) ((int)(sizeof(table) / sizeof *(table)))
#define FIELD_BIT(index) ((uint32_t)1 << (index))

typedef struct reader {
    scene *s;
    config_place at;
} reader;

/* Names the group that the next errors are about: "light 2" for index 1, "camera" for index -1. */
void reader_at(reader *r, const char *group, int index);

/* *block becomes room for `count` zeroed things, never NULL. */
bool reader_allocate(reader *r, void *block, int count, size_t size);

/* Each reads its member of the top level. False: the place's `why` says why; what was read so far hangs on the scene. */
bool reader_meshes(reader *r, const config_setting_t *root);
bool reader_materials(reader *r, const config_setting_t *root);
bool reader_camera(reader *r, const config_setting_t *root);
bool reader_lights(reader *r, const config_setting_t *root);
bool reader_effects(reader *r, const config_setting_t *root);

#endif
