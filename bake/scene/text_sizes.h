/* Bytes of the texts in a scene, with the zero at their end. */
#ifndef VIT_SCENE_TEXT_SIZES_H
#define VIT_SCENE_TEXT_SIZES_H

#define SCENE_PATH 1024
#define SCENE_NAME 128

#endif
